"""Points along both fillets of a tooth, and the stress along the surface there from the nodes of a meshed sector."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from scipy import sparse

from fenics_gears.geometry.gear import Gear
from fenics_gears.geometry.outline import ToothOutline, tooth_outline

from .element_nodes import ElementNodes
from .element_sizes import arc_lengths
from .sector_boundary import root_curve

if TYPE_CHECKING:
    from .recovery import GearRecovery

# Points of one fillet, without the one where the tangent is at 30 degrees to the tooth's centreline, 60 of an internal
# gear, in the section normal to the tooth.
POINTS = 24
# The same where flanks are resolved over the face, on sections with fewer elements.
POINTS_OVER_FACE = 12
SECTION_ANGLE = np.radians(30.0)
SECTION_ANGLE_OF_RING = np.radians(60.0)
CURVE_SAMPLES = 2001
# The one slice of a plane sector.
WHOLE = np.ones((1, 1))


@dataclass(frozen=True)
class FilletCurve:
    """The points of the drive side's fillet at which stress is evaluated; the coast side's are their mirror images.

    samples: (k, 2), the root finely sampled from the middle of the tooth space. length: (p,), along it. tangents: (p,
    2). tangent_angle: (p,), rad, between tangent and the tooth's centreline. The first points go from the root circle
    to the form circle, the last is the one at `section_angle`, not a number where the fillet has no such tangent.
    """

    outline: ToothOutline
    samples: np.ndarray
    length: np.ndarray
    tangents: np.ndarray
    tangent_angle: np.ndarray


def fillet_curve(gear: Gear, points: int = POINTS) -> FilletCurve:
    """The points of a gear's fillets."""
    outline = tooth_outline(gear, CURVE_SAMPLES)
    samples = root_curve(outline)
    along = arc_lengths(samples)
    start = along[-1] - arc_lengths(outline.fillet)[-1]
    length = start + (along[-1] - start) * (np.arange(points) + 0.5) / points
    angles = _angles(outline, samples)
    inside = along >= start
    section = np.interp(section_angle(gear), angles[inside][::-1], along[inside][::-1], left=np.nan, right=np.nan)
    length = np.append(length, section)
    tangents = np.column_stack([np.interp(length, along, part) for part in _tangents(samples).T])
    tangents /= np.linalg.norm(tangents, axis=1)[:, None]
    tangent_angle = np.append(np.interp(length[:-1], along, angles), section_angle(gear))
    return FilletCurve(outline, samples, length, tangents, tangent_angle)


def section_angle(gear: Gear) -> float:
    """Angle (rad) in the transverse section of the tangent at SECTION_ANGLE in the normal one, of an internal gear at
    SECTION_ANGLE_OF_RING (ISO 6336-3)."""
    angle = SECTION_ANGLE_OF_RING if gear.internal else SECTION_ANGLE
    return float(np.arctan(np.tan(angle) * gear.rack_stretch)) if gear.helix_angle else angle


def fillet_rows(recovery: GearRecovery, curve: FilletCurve, averages: np.ndarray = WHOLE) -> sparse.csr_matrix:
    """Stress (S 2 p, dofs) at the points of the drive side's fillet, then the coast side's, slice by slice; zero where
    the fillet has no such point. It is per displacement of a sector in modules, for E = 1 MPa.

    Along the fillet's profile and across the tooth's trace, as in a section normal to the tooth. averages: (S, h), of
    slices over the sector's heights.
    """
    sector = recovery.sector
    parts = []
    twist = 0.0 if sector.sweep is None else sector.sweep.twist
    for side in (0, 1):
        nodes, *tables = fillet_weights(curve, sector.section, sector.held, side)
        weights, tangents = (np.nan_to_num(each) for each in tables)
        x, y = (weights @ sector.section.points[nodes]).T
        trace = np.column_stack([-twist * y, twist * x, np.ones(len(x))])
        profile = np.pad(tangents, ((0, 0), (0, 1)))
        across = profile - ((profile * trace).sum(axis=1) / (trace**2).sum(axis=1))[:, None] * trace
        length = np.linalg.norm(across, axis=1)[:, None]
        directions = np.divide(across, length, out=np.zeros_like(across), where=length > 0.0)
        parts.append(recovery.stress.rows(nodes, weights, directions, averages))
    points = len(curve.length)
    order = np.arange(2 * points * len(averages)).reshape(2, len(averages), points).swapaxes(0, 1).ravel()
    return sparse.vstack(parts, format="csr")[order]


def fillet_weights(
    curve: FilletCurve, nodes: ElementNodes, held: np.ndarray, side: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Nodes (k,) along the root on the drive (0) or coast side (1), their weights (p, k) at the fillet's points, and
    the tangents (p, 2) there. Not a number where the fillet has no such point. `held`: nodes of the sector's cuts and
    hub."""
    root, place = _root_nodes(curve, nodes, held, side)
    tangents = curve.tangents if side == 0 else curve.outline.coast(curve.tangents)
    return root, _interpolation(place, curve.length), tangents


def _root_nodes(curve: FilletCurve, nodes: ElementNodes, held: np.ndarray, side: int) -> tuple[np.ndarray, np.ndarray]:
    """Nodes (k,) along the root on one side without those on the cut, and their lengths along the curve, ascending."""
    gear = curve.outline.gear
    free = np.setdiff1d(np.unique(nodes.boundary_sides), held)
    radius = gear.sign * np.linalg.norm(nodes.points[free], axis=1)
    below_form = radius < gear.form_radius + 1e-9 * abs(gear.form_radius)
    free = free[below_form & (radius > 0.5 * (gear.bore_radius + gear.root_radius))]
    points = nodes.points[free] if side == 0 else curve.outline.coast(nodes.points[free])
    # 50 ms that a run with gears from the cache does not take.
    from scipy.spatial import cKDTree

    distance, nearest = cKDTree(curve.samples).query(points)
    # Nodes of the other side are far away; the middles of sides lie a little off the curve, on its chords.
    own = distance < 0.02 * gear.module
    lengths = arc_lengths(curve.samples)[nearest[own]]
    order = np.argsort(lengths)
    return free[own][order], lengths[order]


def _interpolation(nodes: np.ndarray, wanted: np.ndarray) -> np.ndarray:
    """Weights (p, k) of linear interpolation between ascending places (k,), constant beyond them."""
    ahead = np.clip(np.searchsorted(nodes, np.nan_to_num(wanted)), 1, len(nodes) - 1)
    part = np.clip((wanted - nodes[ahead - 1]) / (nodes[ahead] - nodes[ahead - 1]), 0.0, 1.0)
    weights = np.zeros((len(wanted), len(nodes)))
    rows = np.arange(len(wanted))
    weights[rows, ahead - 1] = 1.0 - part
    weights[rows, ahead] = part
    return weights


def _tangents(points: np.ndarray) -> np.ndarray:
    tangents = np.gradient(points, arc_lengths(points), axis=0)
    return tangents / np.linalg.norm(tangents, axis=1)[:, None]


def _angles(outline: ToothOutline, points: np.ndarray) -> np.ndarray:
    """Angle (rad) between the curve's tangent and the tooth's centreline, falling from the root on."""
    axis = np.array([np.cos(outline.centreline_angle), np.sin(outline.centreline_angle)])
    tangents = _tangents(points)
    angles = np.arctan2(tangents[:, 0] * axis[1] - tangents[:, 1] * axis[0], tangents @ axis)
    return angles if angles[0] > 0.0 else -angles
