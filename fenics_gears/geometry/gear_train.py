"""Gears that stand in more than one mesh: where the second mesh of an idler is while the first one is at its start.

Angles are counter-clockwise, rad, seen so that the first mesh's pinion turns counter-clockwise: the idler turns
clockwise, is pushed on its counter-clockwise flanks and pushes with the others.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import floor, pi

from fenics_gears.errors import GeometryError

from .gear import Gear
from .outline import centreline_angle
from .pair import GearPair


@dataclass(frozen=True)
class SecondMesh:
    """The second mesh of an idler, seen when pair 0 of the first one comes to its start of contact.

    `phase` (0 to 1): mesh cycles that pair 0 of the second mesh is past its own start of contact. `teeth`: pitches by
    which its tooth on the idler stands counter-clockwise of that of the first mesh's pair 0. `to_first`, `to_second`:
    directions of both mates from the idler.
    """

    phase: float
    teeth: int
    to_first: float
    to_second: float


def second_mesh(first: GearPair, second: GearPair, to_first: float, to_second: float) -> SecondMesh:
    """Of the idler that is the wheel of the `first` mesh and the pinion of the `second`, with its mates in those
    directions.

    In a tooth's frame the involute of its counter-clockwise flank starts a quarter turn clockwise. Contact at a roll
    angle is on the line that touches the base circle by that angle further clockwise. The line of action touches it by
    the operating pressure angle clockwise of the direction to the mate. Flanks on the other side are the mirror image
    at the tooth's centreline, so that phases depend on the thickness of the idler's teeth.
    """
    idler = second.pinion
    radius = idler.base_radius
    roll = (first.line_of_action_length - first.path_start) / radius
    tooth_of_first = to_first - first.operating_pressure_angle + 0.5 * pi + roll
    start_of_flank = 2.0 * centreline_angle(idler) + 0.5 * pi
    roll_of_second = to_second + second.operating_pressure_angle - start_of_flank - tooth_of_first
    pitches = (roll_of_second * radius - second.path_start) / idler.base_pitch
    whole = floor(pitches)
    return SecondMesh(pitches - whole, whole, to_first, to_second)


def begun_at(idlers: Sequence[SecondMesh | None]) -> list[tuple[float, int]]:
    """Of each mesh the mesh cycles (0 to 1) by which it is past a start of contact as the run begins; and by how many
    whole ones its pairs are counted later, so that this is below 1. `idlers`: of its pinion, where this is one."""
    found = [(0.0, 0)]
    for idler in idlers[1:]:
        ahead = 0.0 if idler is None else found[-1][0] + idler.phase
        found.append((ahead - floor(ahead), floor(ahead)))
    return found


def check_apart(one: Gear, other: Gear, distance: float, words: str) -> None:
    """Raise GeometryError where two gears that do not mesh overlap; `words`: which."""
    if distance < one.tip_radius + other.tip_radius:
        raise GeometryError(
            f"{words} overlap: their centres are {distance:.4g} mm apart, their tip circles need"
            f" {one.tip_radius + other.tip_radius:.4g} mm; change the directions of the meshes"
        )
