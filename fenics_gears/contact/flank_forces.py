"""Forces on the nodes of either gear's flanks from forces at contact nodes, `N^T p`, as the flank compliance has
them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import cast

import numpy as np
from scipy import sparse

from fenics_gears.geometry.gear import Gear

from .compliance_product import directions
from .face import Face
from .interpolation import FlankInterpolation
from .tooth_pair import COAST, ToothPair

# A tooth pair counted on is a tooth ahead (counter-clockwise) on the pinion, and behind on the wheel.
SENSE_OF_TEETH = (1, -1)


def flank_rows(gear: int, pair: ToothPair, tangential: bool) -> sparse.coo_array:
    """Forces (2 f, n or 2 n) on flank nodes, in the tooth's frame, per unit force at the pair's contact nodes, normals
    first.

    `gear`: 0 the pinion, 1 the wheel. A positive contact force pushes on the flank; that of friction acts against e_y
    of the tooth's frame. The coast flank's are in the frame mirrored at the tooth's centreline, as its compliance is.
    """
    return _pushed(pair.interpolation[gear], directions(pair.place.contact_rolls[gear], tangential))


def _pushed(nodes: FlankInterpolation, axes: np.ndarray) -> sparse.coo_array:
    """The same where contact nodes see these `nodes` of the flank and have axes (1 or 2, components)."""
    (count, width), (kinds, components) = nodes.near.shape, axes.shape
    on_flank = (nodes.first[:, None] + np.arange(width)) * components
    loaded = np.broadcast_to(on_flank[..., None] + np.arange(components), (kinds, count, width, components))
    own = np.broadcast_to(np.arange(kinds * count).reshape(kinds, count, 1, 1), loaded.shape)
    values = -nodes.near[..., None] * axes[:, None, None]
    shape = components * nodes.flank_nodes, kinds * count
    return sparse.coo_array((values.ravel(), (loaded.ravel(), own.ravel())), shape)


def sector_of(gear: int, pair: ToothPair) -> int:
    """Pitches, counter-clockwise, from the tooth of pair 0 to the one of this pair."""
    return SENSE_OF_TEETH[gear] * pair.place.teeth[gear]


def rows_in_slice(gear: int, data: Gear, face: Face, pair: ToothPair, tangential: bool) -> sparse.coo_array:
    """Forces (f components, n or 2 n) on the nodes of a flank in the pair's slice, in the tooth's own frame, per unit
    force at the pair's contact nodes: N over a face of many slices, of one N/mm."""
    if face.slices == 1:
        nodes, axes = pair.interpolation[gear], directions(pair.place.contact_rolls[gear], tangential) / face.widths[0]
    else:
        # Imported here: plane scenes have none.
        from .face_pairing import FacePair, directions_on_face

        nodes, axes = cast(FacePair, pair).coarse[gear], directions_on_face(pair.place, face, gear, tangential)
    if pair.place.flank == COAST:
        axes[:, :2] = axes[:, :2] @ centreline_mirror(data).T
    return _pushed(nodes, axes)


def flank_forces(
    gear: int, data: Gear, face: Face, averages: np.ndarray, pairs: Sequence[ToothPair], forces: Sequence[np.ndarray]
) -> dict[int, np.ndarray]:
    """Forces (flanks, h, f components) on the flank nodes of a gear's loaded teeth, in each tooth's own frame at that
    height, as of `rows_in_slice`.

    `averages` (slices, h): over each slice, of values at the heights of the gear's nodes. A slice moves as the average
    over its width; its force spreads over the nodes accordingly. `forces`: of each pair's contact nodes in its slice,
    (n,) or (2 n,) with friction's, N. Teeth go by `sector_of`.
    """
    both = any(pair.place.flank == COAST for pair in pairs)
    result: dict[int, np.ndarray] = {}
    for pair, force in zip(pairs, forces):
        if not force.any():
            continue
        section = rows_in_slice(gear, data, face, pair, len(force) > len(pair.offsets)) @ force
        total = result.setdefault(sector_of(gear, pair), np.zeros((2 if both else 1, averages.shape[1], len(section))))
        total[pair.place.flank if both else 0] += averages[pair.place.slice][:, None] * section
    return result


def centreline_mirror(gear: Gear) -> np.ndarray:
    """Reflection (2, 2) at the tooth's centreline in its body frame."""
    angle = 2.0 * (-0.5 * np.pi - gear.tooth_half_angle_at_base)
    return np.array([[np.cos(angle), np.sin(angle)], [np.sin(angle), -np.cos(angle)]])
