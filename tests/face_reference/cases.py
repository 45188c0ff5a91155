"""The pairs, sizes and loads of the reference, and one analysis."""

from dataclasses import dataclass
from math import atan, cos, radians, tan

import numpy as np
from tests.face_reference.contact_points import PairPoints, Position, compliance, pair_points
from tests.face_reference.section_mesh import SectionSizes, section_mesh
from tests.face_reference.swept_gear import Sweep, SweptGear

from fenics_gears import Gear, GearPair, Material

NORMAL_MODULE, NORMAL_PRESSURE_ANGLE, TEETH, FACE_WIDTH = 3.0, radians(20.0), (24, 32), 7.5
STEEL = Material(206000.0, 0.3)
# Layers of half the face, mm, from the end face inwards.
HALF_LAYERS = (0.08, 0.12, 0.18, 0.27, 0.36, 0.44, 0.46, 0.46, 0.46, 0.46, 0.46)


def reference_pair(helix_angle: float) -> GearPair:
    """In its transverse section, on its nominal centre distance; helix angle in rad."""
    module, angle = NORMAL_MODULE / cos(helix_angle), atan(tan(NORMAL_PRESSURE_ANGLE) / cos(helix_angle))
    gears = []
    for teeth in TEETH:
        radius = 0.5 * teeth * module
        root = radius - 1.25 * NORMAL_MODULE
        gears.append(Gear(teeth, module, angle, 0.0, radius + NORMAL_MODULE, root, 0.5 * root, 0.38 * NORMAL_MODULE))
    return GearPair(*gears, 0.5 * sum(TEETH) * module, FACE_WIDTH)


def base_slope(helix_angle: float) -> float:
    """tau = tan(beta_b) of a right-hand pinion."""
    return tan(helix_angle) * cos(atan(tan(NORMAL_PRESSURE_ANGLE) / cos(helix_angle)))


@dataclass(frozen=True)
class Sizes:
    """`section` of both gears; `layers` of half the face, mm; `contact`: spacing of contact nodes, mm, and `reach`:
    their largest offset, mm."""

    section: SectionSizes = SectionSizes(0.063)
    layers: tuple[float, ...] = HALF_LAYERS
    contact: float = 0.0315
    reach: float = 0.284

    @property
    def heights(self) -> np.ndarray:
        """Layers' boundaries and middles over the face, mm."""
        ends = np.concatenate([[0.0], np.cumsum([*self.layers, *self.layers[::-1]])])
        ends -= 0.5 * ends[-1]
        return np.insert(ends, np.arange(1, len(ends)), 0.5 * (ends[1:] + ends[:-1]))

    @property
    def offsets(self) -> np.ndarray:
        """Offsets of contact nodes from the line of action, mm."""
        half = int(round(self.reach / self.contact))
        return self.contact * np.arange(-half, half + 1)


@dataclass
class Assembled:
    """Both gears' compliance at one position, for any opening of the flanks."""

    position: Position
    points: list[PairPoints]
    matrix: np.ndarray


def touching_pairs(position: Position, sizes: Sizes) -> list[int]:
    """Pairs with a point of both flanks within reach of the line of action."""
    y, z = (each.ravel() for each in np.meshgrid(sizes.offsets, sizes.heights))
    return [index for index in range(-2, 4) if position.flank_points(index, y, z)[2].any()]


def bands(position: Position, pairs: list[int], sizes: Sizes) -> tuple[dict, dict]:
    """Roll angles (rad) between which each loaded tooth of pinion and wheel touches."""
    y, z = (each.ravel() for each in np.meshgrid(sizes.offsets, sizes.heights))
    found: tuple[dict, dict] = {}, {}
    for index in pairs:
        rolls, _, there = position.flank_points(index, y, z)
        for gear, key, roll in zip(found, (index, -index), rolls):
            gear[key] = float(roll[there].min()), float(roll[there].max())
    return found


def assembled(helix_angle: float, phase: float, sizes: Sizes = Sizes(), plane: bool = False) -> Assembled:
    """Mesh, factorise, and find the compliance between contact nodes at a phase."""
    position = Position(reference_pair(helix_angle), base_slope(helix_angle), phase)
    pairs = touching_pairs(position, sizes)
    gears = []
    for gear, band, twist in zip(
        (position.pair.pinion, position.pair.wheel), bands(position, pairs, sizes), position.twists
    ):
        section = section_mesh(gear, band, sizes.section)
        gears.append(SweptGear(section, Sweep(sizes.heights, twist, plane), STEEL))
        print(f"  {len(section.cells)} triangles, {gears[-1].unknowns} unknowns", flush=True)
    points = [pair_points(position, index, sizes.offsets, tuple(gears), np.zeros_like) for index in pairs]
    points = [each for each in points if each is not None]
    matrix = compliance(position, points, tuple(gears), mirrored=helix_angle == 0.0)
    return Assembled(position, points, matrix)
