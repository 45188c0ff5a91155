"""Gears that stand in more than one mesh: where each mesh is as the run begins, and which teeth of such a gear its
meshes count alike.

A mesh is described in a frame in which its pinion turns counter-clockwise. A gear that drives in two meshes, or is
driven in both, is loaded on the same flanks of its teeth and has one frame for both; a gear that is driven in one and
drives in the other, an idler, is loaded on both flanks, and the frame of the other mesh is the mirror image.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from math import cos, floor, pi, sin
from typing import TypeVar

import numpy as np

from fenics_gears.errors import GeometryError
from fenics_gears.inputs.problem import NOTHING_DONE

from .gear import Gear
from .outline import centreline_angle
from .pair import GearPair
from .train_graph import PINION, TrainGraph, turns_of_shafts

# Of phases, in mesh cycles.
ROUND_OFF = 1e-9
# The number of a tooth, or a place between teeth.
Tooth = TypeVar("Tooth", int, float)


@dataclass(frozen=True)
class SharedGear:
    """A gear in two `meshes`, `sides`: what it is in either, 0 the pinion, 1 the wheel. `tooth`: of pair 0 of the
    second mesh, in pitches counter-clockwise of that of pair 0 of the first, as the frame of the first has them."""

    meshes: tuple[int, int]
    sides: tuple[int, int]
    tooth: int

    @property
    def mirrored(self) -> bool:
        """Whether its meshes load opposite flanks."""
        return self.sides[0] != self.sides[1]

    @property
    def first(self) -> int:
        """Number of the tooth of pair 0 of the second mesh, as those of the first mesh number their teeth: in the order
        in which they mesh."""
        return self.tooth if self.sides[0] else -self.tooth

    def flank(self, mesh: int, flank: tuple[Tooth, int]) -> tuple[Tooth, int]:
        """A flank as the first mesh counts teeth and flanks, from how the first (0) or the second (1) counts them."""
        tooth, side = flank
        if mesh == 0:
            return flank
        return (self.tooth - tooth, 1 - side) if self.mirrored else (self.tooth + tooth, side)


@dataclass(frozen=True)
class Layout:
    """Where the meshes of a train stand: the `pairs` of its gears, and the `directions` (rad) of each wheel from its
    pinion, counter-clockwise, where the first shaft turns so. That of an internal gear is the direction in which its
    teeth are, away from its centre: the distance of the centres is negative. `begun`: phase at which a mesh that has
    no gear in common with those before it stands as the run begins, 0 unless given."""

    graph: TrainGraph
    pairs: Sequence[GearPair]
    directions: Sequence[float]
    begun: Sequence[float] = ()

    @cached_property
    def turns(self) -> list[Fraction]:
        """Turns of each shaft in one turn of the first, in either sense."""
        return turns_of_shafts(self.graph, [pair.teeth for pair in self.pairs])

    @cached_property
    def phases(self) -> list[float]:
        """Of each mesh the mesh cycles (0 to 1) by which it is past a start of contact as the run begins; that of the
        first of those that have gears in common is where they have `begun`."""
        found: dict[int, float] = {}
        while len(found) < len(self.pairs):
            first = next(mesh for mesh in range(len(self.pairs)) if mesh not in found)
            found[first] = self.begun[first] if self.begun else 0.0
            waiting = True
            while waiting:
                known = {each[0]: each for each in self._links(found)}
                waiting = bool(known)
                for mesh, (_, gear, before) in known.items():
                    found[mesh] = _within_a_cycle(found[before] + self._past(gear, before, mesh))
        return [found[mesh] for mesh in range(len(self.pairs))]

    def _links(self, found: dict[int, float]) -> list[tuple[int, int, int]]:
        """Meshes whose phase is not found yet, with a gear that they share with one whose phase is, and that one."""
        return [
            (mesh, gear, before)
            for gear in reversed(self.graph.shared)
            for mesh, _ in self.graph.sides[gear]
            for before, _ in reversed(self.graph.sides[gear])
            if mesh not in found and before in found
        ]

    def not_closed(self) -> list[tuple[int, int, float]]:
        """Gears and their meshes whose phases do not follow from those of the gear's first mesh, and by how many mesh
        cycles (-0.5 to 0.5) they are off: in loops of gears without a shaft that could be turned."""
        found = []
        for gear in self.graph.shared:
            (first, _), *others = self.graph.sides[gear]
            for mesh, _ in others:
                off = self.phases[first] + self._past(gear, first, mesh) - self.phases[mesh]
                found.append((gear, mesh, off - round(off)))
        return found

    def shared(self, gear: int, first: int, second: int) -> SharedGear:
        """A gear in two of its meshes."""
        sides = dict(self.graph.sides[gear])
        ahead = round(self.phases[second] - self.phases[first] - self._past(gear, first, second))
        return SharedGear((first, second), (sides[first], sides[second]), self._sense(gear, first, second) * ahead)

    def gear(self, number: int) -> Gear:
        """A gear by its number."""
        mesh, side = self.graph.sides[number][0]
        return self.pairs[mesh].gears[side]

    def axes(self, mesh: int) -> np.ndarray:
        """Directions (2, 2), in rows, along and off the line of action of a mesh."""
        sense = self.graph.sense(mesh)
        along = self.directions[mesh] + sense * (0.5 * pi - self.pairs[mesh].operating_pressure_angle)
        # In the mirror image the direction off the line is on its other side.
        return np.array([[cos(along), sin(along)], [-sense * sin(along), sense * cos(along)]])

    def tooth_angle(self, gear: int) -> float:
        """Where the centreline of a tooth of a gear stands as the run begins, rad counter-clockwise."""
        mesh, side = self.graph.sides[gear][0]
        sense = self.graph.sense(mesh)
        own = self.gear(gear)
        turned = (1.0 if side == PINION else -1.0) * own.angular_pitch * self.phases[mesh]
        # From the frame of a tooth to its centreline.
        return sense * (self._tooth_at_start(mesh, side, sense, False) + turned + centreline_angle(own))

    def _sense(self, gear: int, first: int, second: int) -> int:
        """1 where a tooth further counter-clockwise, in the first mesh's frame, is further on its way in the second."""
        sides = dict(self.graph.sides[gear])
        onwards = 1 if sides[second] == PINION else -1
        return onwards if sides[first] == sides[second] else -onwards

    def _past(self, gear: int, first: int, second: int) -> float:
        """Mesh cycles by which the tooth of pair 0 of the first mesh is past its start of contact in the second one, as
        the first one's pair is at its own start."""
        sides = dict(self.graph.sides[gear])
        mirrored = sides[first] != sides[second]
        sense = self.graph.sense(first)
        tooth = self._tooth_at_start(first, sides[first], sense, False)
        there = self._tooth_at_start(second, sides[second], sense, mirrored)
        return self._sense(gear, first, second) * (tooth - there) / self.gear(gear).angular_pitch

    def _tooth_at_start(self, mesh: int, side: int, sense: int, mirrored: bool) -> float:
        """Angle (rad) of the frame of a tooth at the start of contact of a mesh, in a frame that is the mirror image of
        the train's where `sense` is -1; `mirrored`: its clockwise flank is loaded.

        In a tooth's frame the involute of its counter-clockwise flank starts a quarter turn clockwise. Contact at a
        roll angle is on the line that touches the base circle by that angle further clockwise. The line of action
        touches it by the operating pressure angle clockwise of the direction to the mate. Flanks on the other side are
        the mirror image at the tooth's centreline, so that phases depend on the thickness of the teeth.
        """
        pair = self.pairs[mesh]
        gear = pair.gears[side]
        begun = pair.path_start if side == PINION else pair.line_of_action_length - pair.path_start
        roll = begun / gear.base_radius
        to_mate = sense * (self.directions[mesh] + (0.0 if side == PINION else pi))
        if mirrored:
            return to_mate + pair.operating_pressure_angle - 2.0 * centreline_angle(gear) - 0.5 * pi - roll
        return to_mate - pair.operating_pressure_angle + 0.5 * pi + roll


def _within_a_cycle(phase: float) -> float:
    """The part of a phase beyond whole cycles; round-off does not part meshes that are at the same place."""
    return 0.0 if abs(phase - round(phase)) < ROUND_OFF else phase - floor(phase)


def check_apart(one: Gear, other: Gear, distance: float, words: str) -> None:
    """Raise GeometryError where two gears that do not mesh overlap; `words`: which."""
    if one.internal or other.internal:
        ring, within = (one, other) if one.internal else (other, one)
        overlap = distance + within.tip_radius > abs(ring.tip_radius)
        need = (
            f"and the smaller one reaches {distance + within.tip_radius:.4g} mm from the centre of the internal gear,"
            f" whose tip circle has a radius of {abs(ring.tip_radius):.4g} mm"
        )
    else:
        overlap = distance < one.tip_radius + other.tip_radius
        need = f"their tip circles need {one.tip_radius + other.tip_radius:.4g} mm"
    if overlap:
        raise GeometryError(
            f"{words} overlap: their centres are {distance:.4g} mm apart, {need}. Change the directions of the meshes."
            f" {NOTHING_DONE}"
        )
