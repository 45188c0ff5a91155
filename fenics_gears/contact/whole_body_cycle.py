"""Mesh cycles of a pair whose teeth are not all alike: contact operators depend on the teeth in mesh.

Cycles whose teeth in mesh respond alike share their operators; the others have their own: with one cracked tooth, the
few cycles in which it can be in mesh.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from fenics_gears.contact.mesh_cycle import Cycle, MeshCycle, Position, pair_places
from fenics_gears.contact.operator import CompliancePairing
from fenics_gears.contact.tooth_pair import Flanks, PairNodes
from fenics_gears.elasticity.compliance import FlankCompliance
from fenics_gears.elasticity.whole_body.compliance import WholeBodyCompliance

# Teeth respond alike where their compliances agree to this part of the largest, a fifth of the error of a default mesh.
# The effect of a crack on the next teeth falls by about half from tooth to tooth.
ALIKE = 1e-4
SAME_ROLL = 1e-9
GEARS = (0, 1)


@dataclass(frozen=True)
class TeethInMesh:
    """A body as a mesh cycle sees it: teeth counted counter-clockwise from `first`, the body's tooth in drive pair
    0."""

    body: WholeBodyCompliance
    first: int

    @property
    def flanks(self) -> int:
        """Working flanks of a tooth."""
        return self.body.flanks

    @property
    def element_order(self) -> int:
        """Order of the displacement along a flank element."""
        return self.body.element_order

    def rolls_of(self, tooth: int) -> np.ndarray:
        """Roll angles (n,), rad, of the flank nodes of a tooth."""
        return self.body.rolls_of(self.first + tooth)

    def between(self, responding: int, loaded: int, sides: tuple[int, int] = (0, 0)) -> np.ndarray:
        """Compliance of one tooth's flank under forces on another's; sides: as of `FlankCompliance`."""
        return self.body.between(self.first + responding, self.first + loaded, sides)

    def key(self, responding: int, loaded: int) -> tuple[int, int]:
        """Key of the compliance between two teeth."""
        return (self.first + responding) % self.body.teeth, (self.first + loaded) % self.body.teeth


class WholeBodyCycle(Cycle):
    """The mesh cycles of a run; each is a `MeshCycle` of its own where its teeth are, and shared where they respond
    alike.

    Tooth 0 of either body is that of pair 0 at the start of the run. Arguments as of `MeshCycle`; at least one gear has
    a `WholeBodyCompliance`.
    """

    traits = MeshCycle.traits

    def __init__(self, flanks: Flanks, grid, steps: int, coordinates: list[int], tangential: bool, corner=None):
        super().__init__(flanks.pair, grid, steps, flanks.compliance[0].flanks == 2, corner)
        self._flanks, self._coordinates, self._tangential = flanks, coordinates, tangential
        self._blocks: tuple[dict, dict] = ({}, {})
        self._first_alike: tuple[dict[int, int], ...] = ({}, {})
        self._cycles: dict[tuple[int, int], MeshCycle] = {}

    def pairs_at(self, index: int) -> tuple[PairNodes, ...]:
        """The tooth pairs of the first cycle that can touch at position `index` (0 to steps - 1)."""
        return self.of_cycle(0).pairs_at(index)

    def position(self, step: int) -> Position:
        """The contact equations at `step`."""
        return self.of_cycle(step // self.steps).position(step)

    def between(self, step: float, before: float) -> Position:
        """The contact equations at a step that may lie between whole ones."""
        return self.of_cycle(int(step // self.steps)).between(step, before)

    def of_cycle(self, number: int) -> MeshCycle:
        """The mesh cycle of that number, counted from the start of the run."""
        key = tuple(self._like(gear, number) for gear in GEARS)
        if key not in self._cycles:
            self._cycles[key] = self._made(key)
        return self._cycles[key]

    @property
    def bodies(self) -> tuple:
        """Flank compliance of pinion and wheel."""
        return self._flanks.compliance

    @property
    def kinds(self) -> int:
        """Number of different cycles so far, each with operators of its own."""
        return len(self._cycles)

    def _like(self, gear: int, number: int) -> int:
        """The first tooth of a gear's earlier cycle whose teeth in mesh respond as those of cycle `number` do."""
        body = self._flanks.compliance[gear]
        if body.alike:
            return 0
        first = first_tooth(gear, number) % body.teeth
        known = self._first_alike[gear]
        if first not in known:
            distinct = sorted(set(known.values()))
            known[first] = next((each for each in distinct if self._respond_alike(gear, first, each)), first)
        return known[first]

    def _respond_alike(self, gear: int, one: int, other: int) -> bool:
        body, teeth = self._flanks.compliance[gear], self._teeth[gear]
        if not all(same_rolls(body.rolls_of(one + tooth), body.rolls_of(other + tooth)) for tooth in teeth):
            return False
        largest = np.abs(body.between(one, one).diagonal()).max()
        return all(
            np.abs(body.between(one + a, one + b) - body.between(other + a, other + b)).max() <= ALIKE * largest
            for a in teeth for b in teeth if 0 <= a - b <= body.offsets
        )  # fmt: skip

    @cached_property
    def _teeth(self) -> tuple[range, range]:
        """Teeth of either gear that can be in mesh during a cycle or a step before it, counter-clockwise of that in
        pair 0."""
        places = [
            place
            for step in range(self.steps)
            for place in pair_places(self.pair, self.grid, step / self.steps, corner=self.corner)
        ]
        found = []
        for gear in GEARS:
            ahead = [place.ahead(gear) for place in places]
            # At the start of a cycle the pairs of the step before it have indices higher by one.
            before = [each + (1 if gear == 0 else -1) for each in ahead]
            found.append(range(min(ahead + before), max(ahead + before) + 1))
        return tuple(found)

    def _made(self, first: tuple[int, int]) -> MeshCycle:
        compliance = tuple(
            body if body.alike else TeethInMesh(body, tooth) for body, tooth in zip(self._flanks.compliance, first)
        )
        flanks = Flanks(self._flanks.pair, compliance, self._flanks.removal)
        pairing = CompliancePairing(flanks, kept=self._blocks)
        made = MeshCycle(flanks, self.grid, self.steps, self._coordinates, self._tangential, self.corner, pairing)
        made.kept = self.kept
        same_nodes = next(
            (each for each in self._cycles.values() if self._same_nodes(each.flanks.compliance, compliance)), None
        )
        if same_nodes is not None:
            made.share_pairs(same_nodes)
        return made

    def _same_nodes(self, one: tuple[FlankCompliance, ...], other: tuple[FlankCompliance, ...]) -> bool:
        """Whether the flank nodes of all teeth in mesh stand at the same roll angles, so that contact nodes see them
        alike."""
        return all(
            same_rolls(one[gear].rolls_of(tooth), other[gear].rolls_of(tooth))
            for gear in GEARS
            for tooth in self._teeth[gear]
        )


def same_rolls(one: np.ndarray, other: np.ndarray) -> bool:
    """Whether two flanks have nodes at the same roll angles (rad), but for the last digits of points in a file."""
    return one.shape == other.shape and bool(np.abs(one - other).max() <= SAME_ROLL)


def first_tooth(gear: int, cycle: int) -> int:
    """Tooth of the pinion (0) or the wheel (1), counted counter-clockwise, that reaches the start of contact with a
    mesh cycle.

    The pinion turns counter-clockwise, so that its teeth come into mesh clockwise, one after the other; the wheel's the
    other way.
    """
    return -cycle if gear == 0 else cycle
