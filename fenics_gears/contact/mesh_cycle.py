"""The contact operators of all positions that one mesh cycle passes, built once and used by every cycle.

Steps are counted from phase 0, where a new tooth pair reaches the theoretical start of contact; step `i` is at phase
`i / steps`. Where all teeth are alike, the equations at a phase are the same in every cycle; only the pairs' numbers
move on. Further gaps are added to those of the nodes and change nothing else. Runs that differ in gaps alone have all
operators in common, also those of places between steps that are asked for again.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterable, Sequence
from copy import copy
from dataclasses import dataclass
from itertools import groupby
from math import ceil
from typing import Any, Generic, TypeVar

import numpy as np

from fenics_gears.system.memory import Kept, give_back

from .addresses import GAP, NODES
from .face import one_slice
from .kinematics import nodes_before
from .mesh import Mesh, contact_operators
from .mixed_form import StepEquations
from .operator import Passage, Position, StepRows
from .places import counted_from
from .step_solver import StepSolution
from .tooth_pair import Nodes, PairNodes, over_nodes

# Places between steps that runs have in common divide a step by so many.
COMMON_PLACES = 64


Value = TypeVar("Value")


def in_common(place: float) -> bool:
    """Whether a place, in steps, is one that several runs ask for: a step, or one of few between steps."""
    return place * COMMON_PLACES % 1.0 == 0.0


class PerPosition(Generic[Value]):
    """A function of the position in the mesh cycle alone, called once for each place in common; `known`: its values so
    far, which functions alike may share."""

    def __init__(self, function: Callable[[Position], Value], known: dict[float, Value] | None = None):
        self._function = function
        self._known = {} if known is None else known

    def __call__(self, position: Position) -> Value:
        value = self._known.get(position.index)
        if value is None:
            value = self._function(position)
            if in_common(position.index):
                self._known[position.index] = value
        return value


# Gaps added at contact nodes (n,), mm along the line of action, negative where material is in excess: at a position, in
# every mesh cycle; and at a step of the run.
Opening = Callable[[Position], np.ndarray]
Deviation = Callable[[float, Position], np.ndarray]


@dataclass(frozen=True)
class Gaps:
    """Parts of the gaps, mm along the line of action.

    `profile` (n,): left by the flanks themselves at a position, that of the nodes where None. `openings`, `deviations`:
    added. `of_steps`: the profiles of all steps of a mesh cycle one after the other, where they are known.
    """

    profile: Callable[[Position], np.ndarray] | None = None
    openings: tuple[Opening, ...] = ()
    deviations: tuple[Deviation, ...] = ()
    of_steps: np.ndarray | None = None


class Cycle:
    """Contact equations of a `mesh` over one mesh cycle of `steps` positions, each built when it is first asked for.

    `coordinates`: which centre coordinates are unknowns; `tangential`: whether friction acts.
    """

    def __init__(self, mesh: Mesh, steps: int, coordinates: list[int], tangential: bool):
        self.mesh = mesh
        self.steps = steps
        self.coordinates = coordinates
        self.tangential = tangential
        self.pair = mesh.pair
        self.grid = mesh.grid
        self.traits = mesh.traits
        self.bodies = mesh.bodies
        self.coast_flanks = mesh.coast_flanks
        self.corner = mesh.corner
        self.face = mesh.face or one_slice(mesh.pair.face_width)
        self.gaps = Gaps()
        self.kept = Kept()
        self._pairs: dict[tuple, tuple[PairNodes, ...]] = {}
        self._built: dict[tuple[Mesh, float], Position] = {}
        self._held: dict[tuple[Mesh, float], Position] = {}
        self._positions = self._built  # with openings, if there are any
        self._shared: dict[type, Any] = {}

    @property
    def longest_lever(self) -> float:
        """Of friction about the wheel's axis, at its tip, by that of the normal force."""
        return self.pair.wheel.tip_roll_angle

    def with_gaps(self, gaps: Gaps) -> Cycle:
        """The same contact nodes and operators, which both have in common, with other gaps."""
        other = copy(self)
        other.gaps = gaps
        other._positions = self._built if gaps.profile is None and not gaps.openings else self._opened_steps(gaps)
        return other

    def frictionless(self, coordinates: list[int]) -> Cycle:
        """The same contact nodes for these centre coordinates, without friction and gaps."""
        return Cycle(self.mesh, self.steps, coordinates, False)

    def _opened_steps(self, gaps: Gaps) -> dict[tuple[Mesh, float], Position]:
        """All steps of a mesh cycle with these gaps, where their profiles are known and there are no openings; else
        none: each is then opened when it is asked for."""
        keys = [(self.mesh, step) for step in range(self.steps)]
        if gaps.of_steps is None or gaps.openings or not all(key in self._built for key in keys):
            return {}
        true = [self._built[key] for key in keys]
        gap = self.face.cosine * gaps.of_steps
        rows = self.shared(StepRows).of(true).copy()
        ends = np.cumsum(rows[:, NODES])
        rows[:, GAP] = gap.ctypes.data + gap.itemsize * (ends - rows[:, NODES])
        own = [gap[first:end] for first, end in zip([0, *ends.tolist()], ends.tolist())]
        return {key: position.with_gap(*each) for key, position, each in zip(keys, true, zip(own, rows))}

    @property
    def alike(self) -> bool:
        """Whether positions of all mesh cycles have the same contact nodes."""
        return self.mesh.of_cycle is None

    def true_place(self, step: float) -> tuple[Cycle, float]:
        """The cycle whose operators are here at a step, and the place there, in steps."""
        return self, step % self.steps

    def alike_nodes(self, step: int) -> list[tuple[tuple, slice]]:
        """Contact nodes of meshes that pass the very same places as others, by those; none of a mesh by itself."""
        return []

    @property
    def steps_until_alike(self) -> int:
        """After how many steps meshes are first where meshes have been."""
        return self.steps

    def shared(self, kind: type[Value]) -> Value:
        """The one object of a kind that runs on these operators share, whatever their gaps."""
        return self._shared.setdefault(kind, kind())

    def position(self, step: int) -> Position:
        """The contact equations at `step` (any integer)."""
        return self._deviating(step, self._found(step))

    def build(self, steps: Sequence[int]) -> None:
        """Build the positions at consecutive steps together, in half the time that each takes by itself; those that are
        not kept are there until others are built so."""
        if self.alike:
            steps = steps[: self.steps]
        keys = {(self._mesh_at(step), step % self.steps): step for step in steps}
        missing = {key: keys[key] for key in keys if key not in self._built}
        if missing:
            self._held = dict(zip(missing, self._build([(step, step - 1) for step in missing.values()])))
            self._keep(self._held)

    def between(self, step: float, before: float) -> Position:
        """The contact equations at `step`, with the step before at `before`; both may lie between whole steps. Kept
        only at places in common after the last whole step.

        Only of a mesh that is divisible, and at halves, quarters and so on, which are exact: `step` decides which
        pairs touch.
        """
        if before == ceil(step) - 1 and in_common(step):
            return self._deviating(step, self._found(step))
        return self._deviating(step, self.opened(self._build([(step, before)])[0]))

    def give_up(self) -> bool:
        """Give up what is kept, and keep half as much from now on; whether there was anything."""
        if not self._built:
            return False
        self.kept.most = 0.5 * self.kept.taken
        self.kept.taken = 0.0
        # Shared objects take memory too, and have addresses of what is given up.
        for known in (self._built, self._positions, self._held, self._pairs, self._shared):
            known.clear()
        give_back()
        return True

    def pair_number(self, step: int, index: int | np.ndarray):
        """Number of a pair counted through the run: pair `c` reaches the start of contact at the beginning of cycle
        `c`."""
        return step // self.steps - index

    def solve(
        self, position: Position, problem: StepEquations, status: np.ndarray, last: StepSolution | None
    ) -> StepSolution:
        """Solve a step at a position from the sets `status` (n,), as the mesh does; `last`: the step before, None at
        the start. Raises ContactNotConverged."""
        return self.mesh.solve(position, problem, status, last)

    def pairs_at(self, index: int) -> tuple[PairNodes, ...]:
        """The tooth pairs that can touch at position `index` (0 to steps - 1) of the first mesh cycle."""
        (pairs,) = self._pairs_at([(self._mesh_at(index).nodes, index)]).values()
        return pairs

    def _mesh_at(self, step: float) -> Mesh:
        of_cycle = self.mesh.of_cycle
        return self.mesh if of_cycle is None else of_cycle(int(step // self.steps))

    def _pairs_at(self, asked: Iterable[tuple[Nodes, float]]) -> dict[tuple[Nodes, float], tuple[PairNodes, ...]]:
        """The tooth pairs at positions that may lie between two steps; only those of whole steps are kept."""
        found = {}
        missing = defaultdict(list)
        for key in dict.fromkeys(asked):
            if key in self._pairs:
                found[key] = self._pairs[key]
            else:
                missing[key[0]].append(key[1])
        for nodes, indices in missing.items():
            made = nodes([index / self.steps for index in indices])
            found |= {(nodes, index): pairs for index, pairs in zip(indices, made)}
        self._pairs |= {key: pairs for key, pairs in found.items() if key[1] == int(key[1])}
        return found

    def _build(self, steps: Sequence[tuple[float, float]]) -> list[Position]:
        """The positions at some steps, each after the one before it."""
        found: list[Position] = []
        for mesh, own in groupby(steps, lambda step: self._mesh_at(step[0])):
            found += self._built_of(mesh, list(own))
        return found

    def _built_of(self, mesh: Mesh, steps: list[tuple[float, float]]) -> list[Position]:
        """The same, all of one mesh."""
        indices = [(step % self.steps, before % self.steps) for step, before in steps]
        pairs_at = self._pairs_at((mesh.nodes, index) for both in indices for index in both)
        pairs = []
        previous = []
        for (step, before), (index, index_before) in zip(steps, indices):
            pairs.append(pairs_at[mesh.nodes, index])
            cycles = int(step // self.steps - before // self.steps)
            previous.append(counted_from(cycles, pairs_at[mesh.nodes, index_before]))
        same = nodes_before(list(zip(pairs, previous)), self.grid.spacing)
        passages = [
            Passage(own, earlier if self.tangential else None, node_before, *index, (step - before) / self.steps)
            for own, earlier, node_before, index, (step, before) in zip(pairs, previous, same, indices, steps)
        ]
        operators = contact_operators(self.pair, passages, self.coordinates, mesh.responses(passages), self.face)
        return [
            Position(operator, passage.node_before, passage.index, mesh.nodes)
            for operator, passage in zip(operators, passages)
        ]

    def true_positions(self, steps: Sequence[tuple[float, float]]) -> list[Position]:
        """The positions at some steps, each after the one before it, without gaps of their own; those in common are
        kept where there is room."""
        keys = {
            (step, before): (self._mesh_at(step), step % self.steps)
            for step, before in steps
            if before == ceil(step) - 1 and in_common(step)
        }
        known = {each: found for each, key in keys.items() if (found := self._built.get(key) or self._held.get(key))}
        missing = [each for each in steps if each not in known]
        made = dict(zip(missing, self._build(missing)))
        self._keep({keys[each]: position for each, position in made.items() if each in keys})
        return [known.get(each) or made[each] for each in steps]

    def _keep(self, built: dict[tuple[Mesh, float], Position]) -> None:
        """Keep positions as far as there is room."""
        # The first ones stay: marches go round and round, and would find none of the last ones again.
        self._built |= {key: position for key, position in built.items() if self.kept.takes(position.bytes)}

    def _found(self, step: float) -> Position:
        """The position at a place in common, with the whole step before it as the one before: kept, or built."""
        key = self._mesh_at(step), step % self.steps
        found = self._positions.get(key)
        if found is None:
            (built,) = self.true_positions([(step, ceil(step) - 1)])
            found = self.opened(built)
            if key in self._built:
                self._positions[key] = found
        return found

    def opened(self, position: Position) -> Position:
        """The position with the profile and the openings of these gaps."""
        if self.gaps.profile is None and not self.gaps.openings:
            return position
        profile = self.gaps.profile
        gap = over_nodes(position.operator.pairs, "gap") if profile is None else profile(position)
        for opening in self.gaps.openings:
            gap = gap + opening(position)
        # Openings are measured along the line of action, gaps along the normal.
        return position.with_gap(np.ascontiguousarray(self.face.cosine * gap))

    def _deviating(self, step: float, position: Position) -> Position:
        if not self.gaps.deviations:
            return position
        gap = position.operator.gap
        for deviation in self.gaps.deviations:
            gap = gap + self.face.cosine * deviation(step, position)
        return position.with_gap(np.ascontiguousarray(gap))
