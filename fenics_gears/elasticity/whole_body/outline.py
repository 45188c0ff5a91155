"""Bore, tips and drive flanks on the boundary of a meshed gear, found by their position: the mesh needs no names.

The gear's centre is the origin; the mesh is turned so that the tooth whose drive flank is nearest to the body frame of
a tooth (`geometry.involute`) is tooth 0. Drive flanks are the counter-clockwise sides of the teeth.
"""

from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from fenics_gears.errors import SceneError
from fenics_gears.geometry.gear import Gear
from fenics_gears.geometry.involute import arc_length, involute_function
from fenics_gears.geometry.outline import centreline_angle, rotation

from ..mesh_data import BodyMesh, boundary_sides, joined_cells

# How far points of bore, tips and flanks may lie off the gear data, in modules; gaps are computed from true involutes.
OUTLINE_TOLERANCE = 2e-3
# How far above the form circle a flank's first element may begin, in parts of its length; below it the displacement is
# continued.
UNCOVERED = 0.5
# Boundary points this near to an involute, in modules, were meant to lie on it: messages give their distance.
NEARLY = 0.1
# Factors by which a mesh is too small or too large, and the unit that it probably is in.
UNITS = {1e-3: "metres", 1.0 / 25.4: "inches", 1e3: "micrometres"}


@dataclass(frozen=True)
class WholeBody:
    """A meshed gear, mm, whose edges are "hub" and "flank 0", "flank 1", ... counted counter-clockwise, tooth 0 in its
    body frame. coarsest_flank: the longest element along a flank, mm."""

    mesh: BodyMesh
    coarsest_flank: float


def whole_body(mesh: BodyMesh, gear: Gear) -> WholeBody:
    """Find bore and flanks of a gear in its mesh (mm, about the origin).

    Raises SceneError where the mesh is not one connected gear of these data.
    """
    _check_connected(mesh)
    sides = boundary_sides(mesh.cells)
    outer = np.linalg.norm(mesh.points[sides], axis=-1)
    tolerance = OUTLINE_TOLERANCE * gear.module
    _check_size(float(outer.max()), gear, tolerance)
    _check_teeth(sides[np.abs(outer - gear.tip_radius).max(axis=1) <= tolerance], gear)
    hub = sides[np.abs(outer - gear.bore_radius).max(axis=1) <= tolerance]
    _check_bore(mesh.points, hub, outer, gear)
    _check_whole(mesh.points, np.unique(hub))
    turned = mesh.points @ rotation(_standing_angle(mesh.points[np.unique(sides)], gear))
    flanks = _flanks(turned, sides, gear, tolerance)
    _check_thickness(turned[np.unique(sides)], gear, tolerance)
    longest = max(np.linalg.norm(turned[flank[:, 0]] - turned[flank[:, 1]], axis=1).max() for flank in flanks)
    edges = {"hub": hub, **{f"flank {tooth}": flank for tooth, flank in enumerate(flanks)}}
    return WholeBody(BodyMesh(turned, mesh.cells, edges), float(longest))


def drive_flank_angle(gear: Gear, radius: np.ndarray) -> np.ndarray:
    """Polar angle (rad) of a drive flank at radii (mm) in its tooth's body frame; below the base circle that of its
    start."""
    return -0.5 * np.pi - involute_function(gear.roll_angle(np.maximum(radius, gear.base_radius)))


def _check_connected(mesh: BodyMesh) -> None:
    piece = joined_cells(mesh.cells)
    counts = np.bincount(piece)
    if len(counts) > 1:
        smallest = np.flatnonzero(piece == np.argmin(counts))
        where = mesh.points[mesh.cells[smallest]].mean(axis=(0, 1))
        raise SceneError(
            f"the mesh has {len(counts)} parts that do not hold together; the smallest, of {len(smallest)}"
            f" cells, lies about x = {where[0]:.4g} mm, y = {where[1]:.4g} mm. A tooth that a crack has cut off carries"
            " nothing; parts that should be one need their common points to be the same points"
        )


def _check_size(largest: float, gear: Gear, tolerance: float) -> None:
    if abs(largest - gear.tip_radius) <= tolerance:
        return
    ratio = largest / gear.tip_radius
    units = {**UNITS, 1.0 / gear.module: "modules"}
    probable = next((words for factor, words in units.items() if abs(ratio / factor - 1.0) < 0.01), None)
    unit = f" Is it in {probable}? Lengths of a mesh are in mm." if probable else ""
    raise SceneError(
        f"the farthest point of the mesh is {largest:.6g} mm from the origin, the gear's tip radius is"
        f" {gear.tip_radius:.6g} mm.{unit} Allowed: {tolerance:.2g} mm of difference, the gear's centre at the origin"
    )


def _check_teeth(tips: np.ndarray, gear: Gear) -> None:
    points = np.unique(tips)
    ends = np.searchsorted(points, tips)
    links = coo_matrix((np.ones(len(tips)), (ends[:, 0], ends[:, 1])), shape=(len(points), len(points)))
    teeth = connected_components(links, directed=False)[0] if len(points) else 0
    if teeth != gear.teeth:
        raise SceneError(
            f"the mesh has {teeth} tooth tips on its tip circle, the gear of the scene has {gear.teeth} teeth;"
            " each must have its tip"
        )


def _check_bore(points: np.ndarray, hub: np.ndarray, radii: np.ndarray, gear: Gear) -> None:
    ends = points[hub]
    turns = np.angle((ends[:, 1] @ [1.0, 1.0j]) / (ends[:, 0] @ [1.0, 1.0j])) if len(hub) else np.zeros(0)
    covered = np.abs(turns).sum() / (2.0 * np.pi)
    if abs(covered - 1.0) > 1e-6:
        raise SceneError(
            f"no bore of radius {gear.bore_radius:.6g} mm (the scene's bore_diameter is"
            f" {2.0 * gear.bore_radius:.6g} mm): its circle is covered to {covered:.0%}; the innermost point of the"
            f" boundary is {radii.min():.6g} mm from the origin"
        )


def _check_whole(points: np.ndarray, bore: np.ndarray) -> None:
    """Raise SceneError where a crack opens on the bore."""
    distance, _ = cKDTree(points).query(points[bore], k=2)
    twice = bore[distance[:, 1] <= 1e-9 * np.abs(points).max()]
    if len(twice):
        x, y = points[twice[0]]
        raise SceneError(
            f"a crack opens on the bore near x = {x:.4g} mm, y = {y:.4g} mm; the bore is held as a whole and"
            " has each point once"
        )


def _standing_angle(points: np.ndarray, gear: Gear) -> float:
    """Angle (rad) by which the mesh is turned, from the points (k, 2) of all drive flanks, up to whole pitches."""
    radius = np.linalg.norm(points, axis=1)
    tolerance = OUTLINE_TOLERANCE * gear.module
    between = (radius > gear.form_radius) & (radius < gear.tip_form_radius - tolerance)
    if not between.any():
        raise SceneError("the boundary of the mesh has no points on the flanks, between form circle and tip circle")
    pitch = gear.angular_pitch
    window = 2.0 * tolerance / gear.base_radius
    angle = np.arctan2(points[between, 1], points[between, 0]) - drive_flank_angle(gear, radius[between])
    angle = np.sort(np.mod(angle, pitch))
    twice = np.concatenate([angle, angle + pitch])
    within = np.searchsorted(twice, angle + window, side="right") - np.arange(len(angle))
    densest = int(np.argmax(within))
    median = float(np.median(twice[densest : densest + within[densest]]))
    return (median + 0.5 * pitch) % pitch - 0.5 * pitch


def _flanks(points: np.ndarray, sides: np.ndarray, gear: Gear, tolerance: float) -> list[np.ndarray]:
    """Sides (k, 2) of each drive flank, from the form circle to the tip."""
    boundary = np.unique(sides)
    radius = np.linalg.norm(points[boundary], axis=1)
    tooth, on_drive_side, off = _off_involute(points[boundary], gear)
    off = np.abs(off)
    known = {tuple(side) for side in sides.tolist()}
    chains = []
    for each in range(gear.teeth):
        own = on_drive_side & (tooth == each)
        chain, problem = _chain(points, known, boundary[own & (off <= tolerance)], gear, tolerance)
        if problem:
            on_flank = own & (radius > gear.form_radius + tolerance) & (radius < gear.tip_form_radius - tolerance)
            worst = float(np.max(off[on_flank & (off <= NEARLY * gear.module)], initial=0.0))
            raise SceneError(
                f"the drive flank of tooth {each}, counted counter-clockwise, {problem}{_deviation(worst, tolerance)}"
            )
        chains.append(chain)
    return chains


def _off_involute(points: np.ndarray, gear: Gear) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Of points (k, 2): the tooth they belong to, whether they are on its counter-clockwise side, and their distance
    (mm), counter-clockwise, from its drive flank. An involute that is turned moves by the arc of its base circle."""
    angle = np.arctan2(points[:, 1], points[:, 0])
    ahead = np.mod(angle - centreline_angle(gear), 2.0 * np.pi) / gear.angular_pitch
    tooth = np.floor(ahead + 0.5).astype(int) % gear.teeth
    off = angle - drive_flank_angle(gear, np.linalg.norm(points, axis=1)) - gear.angular_pitch * tooth
    return tooth, np.mod(ahead, 1.0) < 0.5, gear.base_radius * ((off + np.pi) % (2.0 * np.pi) - np.pi)


def _check_thickness(points: np.ndarray, gear: Gear, tolerance: float) -> None:
    """Raise SceneError where the coast flanks are out of place."""
    radius = np.linalg.norm(points, axis=1)
    between = points[(radius > gear.form_radius + tolerance) & (radius < gear.tip_form_radius - tolerance)]
    axis = 2.0 * centreline_angle(gear)
    mirrored = between @ np.array([[np.cos(axis), np.sin(axis)], [np.sin(axis), -np.cos(axis)]])
    _, on_drive_side, off = _off_involute(mirrored, gear)
    stands_off = float(np.median(off[on_drive_side])) if on_drive_side.any() else 0.0
    if abs(stands_off) > tolerance:
        raise SceneError(
            f"the teeth are {'thicker' if stands_off > 0.0 else 'thinner'} than those of the scene"
            f" (profile_shift): the flanks opposite the drive flanks stand {1e3 * abs(stands_off):.4g} um off their"
            f" involutes; allowed are {1e3 * tolerance:.3g} um"
        )


def _deviation(worst: float, tolerance: float) -> str:
    if worst <= tolerance:
        return ""
    return (
        f". Points of the boundary there lie up to {1e3 * worst:.4g} um off the gear's involute; allowed are"
        f" {1e3 * tolerance:.3g} um. Contact goes by the gear data: wear and other deviations of a flank belong into"
        " [flank_errors], chamfers of tips into tip_chamfer of the gear"
    )


def _chain(
    points: np.ndarray, known: set, candidates: np.ndarray, gear: Gear, tolerance: float
) -> tuple[np.ndarray, str]:
    """Sides of one flank from points that lie on its involute, and what is wrong with them."""
    radius = np.linalg.norm(points[candidates], axis=1)
    order = np.argsort(radius)
    candidates = candidates[order]
    radius = radius[order]
    # Of the points at and below the form circle the highest begins the flank; below it there is fillet.
    first = max(int(np.searchsorted(radius, gear.form_radius + tolerance, side="right")) - 1, 0)
    chain = np.sort(np.stack([candidates[first:-1], candidates[first + 1 :]], axis=-1), axis=1)
    broken = [place for place, side in enumerate(chain.tolist()) if tuple(side) not in known]
    if broken or len(chain) < 2:
        where = f"is broken near radius {radius[first + broken[0]]:.5g} mm" if broken else f"has {len(chain)} elements"
        return chain, f"is not one line of elements from form circle to tip: it {where}. No crack may open on it"
    length = arc_length(gear.base_radius, gear.roll_angle(np.maximum(radius[first:], gear.base_radius)))
    form, tip = arc_length(gear.base_radius, np.array([gear.form_roll_angle, gear.tip_roll_angle]))
    if length[0] - form > UNCOVERED * (length[1] - length[0]) + tolerance or tip - length[-1] > 2.0 * tolerance:
        problem = (
            f"has points on the involute from radius {radius[first]:.5g} mm to {radius[-1]:.5g} mm only; it goes"
            f" from the form circle, radius {gear.form_radius:.5g} mm, to the tip, radius {gear.tip_radius:.5g} mm"
        )
        return chain, problem
    return chain, ""
