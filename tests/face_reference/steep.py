"""Resolved models of an ordinary steep pair: module 1.6 mm, 28 deg, 23 and 67 teeth, 10.7 mm wide."""

from dataclasses import dataclass

import numpy as np
from tests.face_reference.cases import STEEL
from tests.face_reference.contact_points import Position, compliance, pair_points
from tests.face_reference.graded_gear import GradedGear, Grading, halvings_wanted
from tests.face_reference.section_mesh import SectionSizes, rotated, section_mesh
from tests.face_reference.swept_gear import Sweep
from tests.face_reference.unilateral import pressed

from fenics_gears import base_helix_angle, gear_pair, scene_from_text
from fenics_gears.geometry.outline import tooth_outline

SCENE = """
[gears]
module = "1.6 mm"
pressure_angle = "20 deg"
helix_angle = "28 deg"
face_width = "{width} mm"
pinion = {{ teeth = 23, profile_shift = 0.2, bore_diameter = "20 mm" }}
wheel = {{ teeth = 67, profile_shift = 0.0, bore_diameter = "60 mm" }}
material = {{ youngs_modulus = "206 GPa", poissons_ratio = 0.3 }}
[load]
pinion_torque = "{torque} N m"
"""
WIDTH = 10.7
# N, along n: 200 N m over 32 mm.
TORQUE = 200.0 * WIDTH / 32.0
# Offsets (mm) at which the least distance of the flanks is looked for, and beyond which they do not touch.
OFFSETS = np.linspace(-1.0, 1.0, 161)
WITHIN = 0.045


@dataclass(frozen=True)
class Sizes:
    """`section` of both gears; `layers`: thinnest ones over the face; `heights`: those of contact nodes over the face;
    `contact`: their spacing across the line of contact, mm; `teeth_beside` the loaded ones, of pinion and wheel."""

    band: float = 0.08
    depth: float = 0.12
    body: float = 6.0
    tooth: float = 1.6
    fillet: float = 0.9
    growth: float = 0.6
    teeth_beside: tuple[int, int] = (11, 33)
    layers: int = 64
    grading: Grading = Grading()
    heights: int = 24
    contact: float = 0.05

    def levels(self, width: float) -> np.ndarray:
        return np.linspace(-0.5 * width, 0.5 * width, 2 * self.layers + 1)

    def contact_heights(self, width: float) -> np.ndarray:
        """Even, but for thin cells at either end; on boundaries of the thinnest layers, mm."""
        boundaries = self.levels(width)[::2]
        inner = np.linspace(0, self.layers, self.heights + 1).round().astype(int)
        return boundaries[np.unique([*inner, 1, 2, self.layers - 2, self.layers - 1])]

    @property
    def offsets(self) -> np.ndarray:
        fine = self.contact * np.arange(0, int(round(0.3 / self.contact)) + 1)
        far = [*fine, 0.36, 0.45, 0.57, 0.72]
        return np.array([*(-np.array(far[:0:-1])), *far])


def steep_pair():
    return gear_pair(scene_from_text(SCENE.format(width=WIDTH, torque=TORQUE)).gears)


def position_at(phase: float) -> Position:
    pair = steep_pair()
    return Position(pair, float(np.tan(base_helix_angle(pair.pinion))), phase)


def force(position: Position) -> float:
    """N, along n."""
    return 1e3 * TORQUE / position.pair.pinion.base_radius / position.cosine


def lines_of_contact(position: Position, levels: np.ndarray) -> dict[int, tuple[np.ndarray, np.ndarray]]:
    """Of tooth pairs that may touch: roll angles (rad) of pinion and wheel where the flanks are nearest at each level;
    NaN where they are too far apart."""
    found = {}
    y, z = (each.ravel() for each in np.meshgrid(OFFSETS, levels))
    for index in range(-3, 5):
        rolls, gap, there = position.flank_points(index, y, z)
        gap = np.where(there, gap * position.cosine, np.inf).reshape(len(levels), -1)
        nearest, row = gap.argmin(axis=1), np.arange(len(levels))
        touches = gap[row, nearest] < WITHIN
        if touches.any():
            at = row * len(OFFSETS) + nearest
            found[index] = tuple(np.where(touches, each[at], np.nan) for each in rolls)
    return found


def distances(section, gear, teeth: dict[int, np.ndarray]) -> np.ndarray:
    """Of the section's nodes from the nearest line of contact, at each level (n, levels), mm."""
    outline, levels = tooth_outline(gear, 101), len(next(iter(teeth.values())))
    found = np.full((len(section.points), levels), np.inf)
    for tooth, rolls in teeth.items():
        at = np.flatnonzero(~np.isnan(rolls))
        places = rotated(outline.involute(rolls[at]), tooth * gear.angular_pitch)
        away = np.linalg.norm(section.points[:, None, :] - places[None], axis=-1)
        found[:, at] = np.minimum(found[:, at], away)
    return found


@dataclass
class Resolved:
    """What a model gives: approach (µm, along the transverse line of action), line load (N/mm, along n) of each tooth
    pair at `heights` (mm)."""

    approach: float
    heights: np.ndarray
    line_loads: dict[int, np.ndarray]


def graded_gear(position: Position, number: int, lines, sizes: Sizes) -> GradedGear:
    gear = (position.pair.pinion, position.pair.wheel)[number]
    teeth = {(index, -index)[number]: rolls[number] for index, rolls in lines.items()}
    # Contact reaches half of the widest offsets' cell beyond the nearest points.
    reach = 0.5 / gear.base_radius
    ends = (gear.form_roll_angle, gear.tip_roll_angle)
    bands = {
        tooth: (max(np.nanmin(rolls) - reach, ends[0]), min(np.nanmax(rolls) + reach, ends[1]))
        for tooth, rolls in teeth.items()
    }
    section = section_mesh(gear, bands, SectionSizes(sizes.band, sizes.depth, sizes.fillet, sizes.tooth, sizes.body,
                                                     sizes.growth, sizes.teeth_beside[number]))  # fmt: skip
    away = distances(section, gear, teeth)
    of_layers = np.minimum(np.minimum(away[:, :-1:2], away[:, 1::2]), away[:, 2::2])
    width = position.pair.face_width
    doubled = halvings_wanted(of_layers, width / sizes.layers, sizes.grading)
    made = GradedGear(section, Sweep(sizes.levels(width), position.twists[number]), STEEL, doubled)
    print(f"  {len(section.cells)} triangles, {made.nodes} nodes, {made.unknowns} unknowns", flush=True)
    return made


def resolved(
    position: Position, load: float, sizes: Sizes = Sizes(), tooth_pairs: tuple[int, ...] | None = None
) -> Resolved:
    """Under a load (N, along n); `tooth_pairs` alone touch, all unless given."""
    width = position.pair.face_width
    lines = lines_of_contact(position, sizes.levels(width))
    lines = {index: rolls for index, rolls in lines.items() if tooth_pairs is None or index in tooth_pairs}
    gears = tuple(graded_gear(position, number, lines, sizes) for number in (0, 1))
    heights = sizes.contact_heights(width)
    points = [pair_points(position, index, sizes.offsets, gears, np.zeros_like, heights) for index in lines]
    points = [each for each in points if each is not None]
    print(f"  contact nodes {[len(each.chosen) for each in points]}", flush=True)
    matrix = compliance(position, points, gears)
    areas, gaps = (np.concatenate([getattr(each, name) for each in points]) for name in ("areas", "gaps"))
    pressure, approach = pressed(matrix, gaps, areas, load)
    share = np.convolve(np.diff(heights), [0.5, 0.5])
    loads, first = {}, 0
    for each in points:
        part = slice(first, first + len(each.chosen))
        loads[each.index] = np.bincount(each.level, (pressure * areas)[part], minlength=len(heights)) / share
        first = part.stop
    return Resolved(1e3 * approach / position.cosine, heights, loads)
