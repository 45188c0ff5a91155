"""The contact operators of all positions that one mesh cycle passes, built once and used by every cycle.

Steps are counted from phase 0, where a new tooth pair reaches the theoretical start of contact; step `i` stands at
phase `i / steps`. All teeth being alike, the equations at a phase are the same in every cycle; only the pairs' numbers
move on.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from math import inf
from typing import TYPE_CHECKING

import numpy as np

from fenics_gears.contact.addresses import GAP, addresses
from fenics_gears.contact.operator import CompliancePairing, ContactOperator, contact_operator, node_slices
from fenics_gears.contact.step_solver import StepProblem, StepSolution, solve_step
from fenics_gears.contact.tooth_pair import Flanks, PairNodes, Place, ToothPair, coast_place, drive_place, tooth_pair
from fenics_gears.contact.window import ContactGrid, flank_ends, window
from fenics_gears.geometry.pair import GearPair

if TYPE_CHECKING:
    from fenics_gears.contact.corner import CornerContact
    from fenics_gears.contact.face import Face


@dataclass(frozen=True)
class Position:
    """The contact operator of one phase, and for each node the one it was a step before, (n,), -1 where it is new."""

    operator: ContactOperator
    carried_from: np.ndarray

    @cached_property
    def in_memory(self) -> tuple[np.ndarray, list[np.ndarray]]:
        """For compiled code: number of contact nodes, then addresses of the operator's arrays (10,), by the names in
        `contact.addresses`; and those arrays.

        The previous compliance lies there by columns: few nodes are loaded.
        """
        operator = self.operator
        found, held = addresses([
            operator.compliance, operator.jacobian, operator.gap, operator.on_drive_flanks, operator.node_pair,
            self.carried_from,
            operator.rigid_slip, operator.previous_jacobian,
            None if operator.previous_compliance is None else operator.previous_compliance.T,
        ])  # fmt: skip
        return np.array([operator.nodes, *found], dtype=np.int64), held

    @property
    def bytes(self) -> int:
        """Size of the arrays of the contact operator."""
        return sum(array.nbytes for array in self.in_memory[1])

    def with_gap(self, gap: np.ndarray) -> Position:
        """The same position with other gaps (n,), mm; what is known of it already is not found again."""
        operator, (row, held) = replace(self.operator, gap=gap), self.in_memory
        operator.__dict__.update(node_pair=self.operator.node_pair, on_drive_flanks=self.operator.on_drive_flanks)
        changed, row = replace(self, operator=operator), row.copy()
        row[GAP] = gap.ctypes.data
        changed.__dict__["in_memory"] = row, [*held, gap]
        return changed


# Cost, the search for touching pairs and the cycle itself ask for the same places.
@lru_cache(maxsize=4096)
def pair_places(
    pair: GearPair, grid: ContactGrid, phase: float, coast_flanks: bool = False, corner: CornerContact | None = None
) -> tuple[Place, ...]:
    """Every pair of flanks whose window is not empty at `phase` (0 <= phase < 1): drive flanks, then coast flanks if
    asked for.

    Index 0 is the pair that reached the start of contact last, 1 the one before it, -1 the one to come. `corner`: tips
    touch by their edges too; places are theoretical ones all the same.
    """

    def can_touch(place: Place) -> bool:
        if corner is not None:
            from fenics_gears.contact.corner import pair_reaches

            return pair_reaches(pair, grid, corner, place)
        return window(flank_ends(pair, place.contact_rolls), grid) is not None

    # Off the line of action a tip can touch up to the window's length before and after the path of contact.
    reach = 2 + int(np.ceil(grid.length / pair.base_pitch))
    candidates = range(-reach, int(np.ceil(pair.contact_ratio)) + reach)
    sides = (drive_place, coast_place) if coast_flanks else (drive_place,)
    places = (side(pair, k, pair.path_start + (phase + k) * pair.base_pitch) for side in sides for k in candidates)
    return tuple(place for place in places if can_touch(place))


@dataclass(frozen=True)
class CycleTraits:
    """What the contact nodes of a cycle are.

    `divisible`: there are positions between its steps; `nodes_on_flanks`: nodes are points of the flanks, springs are
        not;
    `has_pressure`: forces of nodes are a pressure on the flank, those of springs and rigid flanks are not;
        `prescribes_friction`:
    friction follows from the place of a tooth pair, not from the slip of its nodes; `own_solver`: steps are not solved
    by Newton's method first.
    """

    divisible: bool = False
    nodes_on_flanks: bool = True
    has_pressure: bool = True
    prescribes_friction: bool = False
    own_solver: bool = False


# Of the memory that contact operators may take: what is kept for good, and what a march holds of a block of steps, the
# one before it beside.
SHARE_KEPT, SHARE_OF_A_BLOCK = 0.7, 0.12


@dataclass
class Kept:
    """How much memory (bytes) operators may take and the kept ones do; those beyond are made again each time the cycle
    comes round."""

    most: float = inf
    taken: float = 0.0

    def takes(self, size: float) -> bool:
        """Whether there is room for this many bytes more, which are then counted."""
        if self.taken + size > SHARE_KEPT * self.most:
            return False
        self.taken += size
        return True


class Cycle:
    """Contact equations over one mesh cycle of `steps` positions of a gear pair, each built when it is first asked for.

    A route to them says in `_pair` which contact nodes a tooth pair has, and in `_position` how they respond; `corner`:
    tip edges that touch off the line of action.
    """

    traits = CycleTraits()
    # Slices of the flanks along the axes (`contact.face`), where these are resolved.
    face: Face | None = None

    def __init__(
        self,
        pair: GearPair,
        grid: ContactGrid,
        steps: int,
        coast_flanks: bool = False,
        corner: CornerContact | None = None,
    ):
        self.pair, self.grid, self.steps, self.coast_flanks, self.corner = pair, grid, steps, coast_flanks, corner
        self._pairs: dict[int, tuple[PairNodes, ...]] = {}
        self._positions: dict[int, Position] = {}
        self.kept = Kept()

    @property
    def bodies(self) -> tuple:
        """Flank compliance of pinion and wheel; empty where they have none."""
        return ()

    @property
    def base(self) -> Cycle:
        """The cycle whose contact nodes this one has: itself, unless it is made on another one."""
        return self

    def contact_width(self, place: Place) -> float:
        """Length (mm) of the line of contact of a tooth pair, or of its slice of the face."""
        return self.pair.face_width if self.face is None else float(self.face.contact_widths[place.slice])

    def position(self, step: int) -> Position:
        """The contact equations at `step` (any integer)."""
        index = step % self.steps
        found = self._positions.get(index)
        if found is None:
            found = self._build(index, index - 1)
            # The first ones stay: marches go round and round, and would find none of the last ones again.
            if self.kept.takes(found.bytes):
                self._positions[index] = found
        return found

    def keeps(self, index: int) -> bool:
        """Whether position `index` (0 to steps - 1) has been built and is kept."""
        return index in self._positions

    def between(self, step: float, before: float) -> Position:
        """The contact equations at `step`, with the step before at `before`; both may lie between whole steps. Not
        kept.

        Only of a cycle that is divisible, and at halves, quarters and so on, which are exact: `step` decides which
        pairs touch.
        """
        return self._build(step, before)

    def pair_number(self, step: int, index: int | np.ndarray):
        """Number of a pair counted through the run: pair `c` reaches the start of contact at the beginning of cycle
        `c`."""
        return step // self.steps - index

    def solve(
        self, position: Position, problem: StepProblem, status: np.ndarray, last: StepSolution | None
    ) -> StepSolution:
        """Solve a step at a position from the sets `status` (n,); `last`: the step before, None at the start.

        Raises ContactNotConverged.
        """
        return solve_step(problem, status)

    def pairs_at(self, index: int) -> tuple[PairNodes, ...]:
        """The tooth pairs that can touch at position `index` (0 to steps - 1)."""
        if index not in self._pairs:
            self._pairs[index] = self._pairs_of(index)
        return self._pairs[index]

    def _build(self, step: float, before: float) -> Position:
        (cycle, index), (earlier, previous_index) = divmod(step, self.steps), divmod(before, self.steps)
        pairs, previous = self._pairs_near(index), self._pairs_near(previous_index)
        if cycle != earlier:
            # Passing the end of a cycle every pair's index rises by one.
            passed = int(cycle - earlier)
            previous = tuple(
                replace(pair, place=replace(pair.place, index=pair.place.index + passed)) for pair in previous
            )
        carried = carried_nodes(pairs, previous, self.grid.spacing)
        return self._position(
            index, pairs, previous, self.pair.pinion.angular_pitch * (step - before) / self.steps, carried
        )

    def _pairs_near(self, index: float) -> tuple[PairNodes, ...]:
        """The tooth pairs at a position that may lie between two steps; only those of whole steps are kept."""
        return self.pairs_at(int(index)) if index == int(index) else self._pairs_of(index)

    def _pairs_of(self, index: float) -> tuple[PairNodes, ...]:
        places = pair_places(self.pair, self.grid, index / self.steps, self.coast_flanks, self.corner)
        return tuple(pair for pair in map(self._pair, places) if pair is not None)

    def _pair(self, place: Place) -> PairNodes | None:
        raise NotImplementedError

    def _position(self, index: int, pairs, previous, advance: float, carried: np.ndarray) -> Position:
        """`advance`: rotation (rad) of the pinion since the position of the pairs `previous`."""
        raise NotImplementedError


class MeshCycle(Cycle):
    """Contact nodes that see either gear's one flank compliance through interpolation.

    `coordinates`: which centre coordinates are unknowns; `tangential`: whether friction acts; `corner`: how tips touch
        off the line of
    action, along it where None; `pairing`: of these flanks, one of its own unless given.
    """

    traits = CycleTraits(divisible=True)

    def __init__(
        self,
        flanks: Flanks,
        grid: ContactGrid,
        steps: int,
        coordinates: list[int],
        tangential: bool,
        corner: CornerContact | None = None,
        pairing: CompliancePairing | None = None,
    ):
        super().__init__(flanks.pair, grid, steps, coast_flanks=flanks.compliance[0].flanks == 2, corner=corner)
        self.flanks, self._coordinates, self._tangential = flanks, coordinates, tangential
        self._pairing = pairing or CompliancePairing(flanks)

    @property
    def bodies(self) -> tuple:
        """Flank compliance of pinion and wheel."""
        return self.flanks.compliance

    def share_pairs(self, other: MeshCycle) -> None:
        """Use the contact nodes of another cycle, whose flanks have nodes at the same places."""
        self._pairs = other._pairs

    def _pair(self, place: Place) -> ToothPair | None:
        if self.corner is not None:
            from fenics_gears.contact.corner import corner_pair

            return corner_pair(self.flanks, self.grid, self.corner, place)
        return tooth_pair(self.flanks, self.grid, place)

    def _position(self, index: int, pairs, previous, advance: float, carried: np.ndarray) -> Position:
        operator = contact_operator(
            self.flanks,
            self._pairing,
            pairs,
            coordinates=self._coordinates,
            previous=previous if self._tangential else None,
            advance=advance,
        )
        return Position(operator, carried)


def carried_nodes(pairs: tuple[PairNodes, ...], previous: tuple[PairNodes, ...], spacing: float) -> np.ndarray:
    """For each node the one of the same pair that it was a step before; -1 where there is none.

    Beside an edge, with which nodes move, it is the one with as many nodes between it and the edge; else the one at the
    same offset.
    """
    earlier = {_key(pair): (nodes.start, pair.offsets) for nodes, pair in zip(node_slices(previous), previous)}
    carried = np.full(sum(len(pair.offsets) for pair in pairs), -1)
    for nodes, pair in zip(node_slices(pairs), pairs):
        if _key(pair) in earlier:
            first, offsets = earlier[_key(pair)]
            found = _same_nodes(pair.offsets, offsets, spacing)
            carried[nodes] = np.where(found >= 0, first + found, -1)
    return carried


def _same_nodes(now: np.ndarray, before: np.ndarray, spacing: float) -> np.ndarray:
    """For each node now, at offsets (n,), mm, the place of the same one among those before, -1 for none."""
    edges = _closer(now, spacing) & _closer(before, spacing)
    places = np.arange(len(now))
    if edges == {0}:
        return np.where(places < len(before), places, -1)
    if edges == {-1}:
        places = places + len(before) - len(now)
        return np.maximum(places, -1)
    nearest = np.abs(now[:, None] - before).argmin(axis=1)
    return np.where(np.abs(now - before[nearest]) <= 0.75 * spacing, nearest, -1)


def _closer(offsets: np.ndarray, spacing: float) -> set[int]:
    """The ends, 0 and -1, at which the nodes stand closer, since an edge is there."""
    if len(offsets) < 3:
        return set()
    return {
        end for end, cell in ((0, offsets[1] - offsets[0]), (-1, offsets[-1] - offsets[-2])) if cell < 0.5 * spacing
    }


def _key(pair: PairNodes) -> tuple[int, int, int]:
    return pair.place.flank, pair.place.index, pair.place.slice
