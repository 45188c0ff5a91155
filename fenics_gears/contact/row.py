"""Contact of meshes that move together: the contact nodes of all one after the other, over the coordinates of the
train. Compliance is summed over bodies, so that meshes in which the same gear stands feel each other.

A mesh is described in a frame in which its pinion turns counter-clockwise. From one mesh to the next along a row the
frame is the mirror image, in which the other flanks of the gear between them are its drive flanks.

A mesh with a coefficient of friction s mu has its tangential displacements here times s and its tangential forces by s:
with the one coefficient mu they obey the same law, and do the same work. Of a mesh without friction, s = 0, none are
left but those that each node would have by itself; these stay zero.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from copy import copy
from dataclasses import dataclass, replace
from math import floor, lcm

import numpy as np

from fenics_gears.system.memory import Kept

from .idler import Part, RowCompliance, units_of
from .mesh import Mesh
from .mesh_cycle import Cycle, Deviation, Gaps
from .mixed_form import StepEquations
from .operator import SHARE_FORMED, ContactOperator, Position
from .places import counted_from
from .row_on_points import WheelOnPoints
from .step_solver import StepSolution, solve_step
from .tooth_pair import PairNodes


def at_phase(mesh: Mesh, phase: float, ahead: int = 0, steps: int = 1) -> Mesh:
    """A mesh whose pairs are so many mesh cycles (0 to 1) further on their way, and further `ahead` by whole steps, of
    which a mesh cycle has so many: then they pass the very same places, to the last digit."""

    def place(each: float) -> tuple[int, float]:
        """Whole mesh cycles before a place, and the rest."""
        if not ahead:
            return 0, each
        step = each * steps
        whole = round(step)
        cycles, rest = divmod((whole if abs(step - whole) < STEP_ROUND_OFF else step) + ahead, steps)
        return int(cycles), rest / steps

    def nodes(phases: Sequence[float]) -> list[tuple[PairNodes, ...]]:
        places = [place(each) for each in phases]
        passed = [floor(each + phase) for _, each in places]
        found = mesh.nodes([each + phase - whole for (_, each), whole in zip(places, passed)])
        return [counted_from(-whole - before, pairs) for whole, (before, _), pairs in zip(passed, places, found)]

    return replace(mesh, nodes=nodes, ahead=phase + ahead / steps) if phase or ahead else mesh


# Of places in steps.
STEP_ROUND_OFF = 1e-6


# The gaps of a mesh on the operators of its cycle.
GapsOf = Callable[[Cycle], Gaps]


@dataclass(frozen=True)
class MeshOfRow:
    """A mesh of a train: its `cycle` over the coordinates (l,) of its own two gears, and how these follow (l, k) from
    those of the train; no contact moves the last `modes` of these. `offset` (l,), mm: where its own coordinates are as
    nothing moves, none unless given. `deviations`: gaps that differ from mesh cycle to mesh cycle; its cycle has none
    of these. `friction`: its coefficient, by that of the equations of all meshes."""

    cycle: Cycle
    coordinates: np.ndarray
    offset: np.ndarray | None = None
    modes: int = 0
    deviations: tuple[Deviation, ...] = ()
    friction: float = 1.0

    def with_gaps_of(self, offset: np.ndarray | None, gaps_of: GapsOf) -> MeshOfRow:
        """The same operators with another offset and other gaps."""
        gaps = gaps_of(self.cycle)
        # Deviations of all meshes are added together.
        cycle = self.cycle.with_gaps(replace(gaps, deviations=()))
        return replace(self, cycle=cycle, offset=offset, deviations=gaps.deviations)

    def deviating(self, step: float, position: Position) -> Position:
        """Its position at a step (any, also after whole cycles), with its deviations."""
        if not self.deviations:
            return position
        opened = sum(deviation(step, position) for deviation in self.deviations)
        # Openings are measured along the line of action, gaps along the normal.
        gap = position.operator.gap + self.cycle.face.cosine * opened
        return position.with_gap(np.ascontiguousarray(gap))

    @property
    def moving(self) -> np.ndarray:
        """The same (l, c) of the coordinates that contact moves."""
        return self.coordinates[:, : self.coordinates.shape[1] - self.modes]

    def gap_of(self, operator: ContactOperator) -> np.ndarray:
        """Gaps (n,) as nothing moves."""
        if self.offset is None or not self.offset.any():
            return operator.gap
        return operator.gap - operator.jacobian[: operator.nodes] @ self.offset


@dataclass(frozen=True)
class JoinedPosition(Position):
    """All meshes at a step; `of_meshes`: the position of each, and the number of its first contact node among all."""

    of_meshes: tuple[tuple[Position, int], ...] = ()

    @property
    def of_wheels(self) -> tuple[slice, ...]:
        return tuple(slice(first, first + own.operator.nodes) for own, first in self.of_meshes)

    @property
    def bytes(self) -> int:
        # Without friction over the face meshes are solved one by one: factors between the nodes whose rows are formed.
        alone = self.operator.rigid_slip is None and self.operator.stored.address
        return int(SHARE_FORMED * sum(each.bytes for each, _ in self.of_meshes)) if alone else super().bytes


class RowCycle(Cycle):
    """Contact equations of all `meshes` of a train, whose steps are of one length in time. `points`: what differs from
    mesh cycle to mesh cycle where a wheel of several meshes stands on points."""

    def __init__(self, meshes: Sequence[MeshOfRow], compliance: RowCompliance, points: WheelOnPoints | None = None):
        first = meshes[0].cycle
        alike = len({each.cycle.steps for each in meshes}) == 1
        # After so many steps all of them are where they were.
        steps = lcm(*(each.cycle.steps for each in meshes))
        super().__init__(first.mesh, steps, [], any(each.cycle.tangential for each in meshes))
        # Of several lengths, a cycle of all is so long that the last step is nearer.
        self.traits = replace(self.traits, repeats=all(each.cycle.traits.repeats for each in meshes) and alike)
        self.meshes = list(meshes)
        self._compliance = compliance
        self._points = points
        self._joined: dict[float, JoinedPosition] = {}
        # Of the steps that were built last, for which there may be no room.
        self._around: dict[int, JoinedPosition] = {}

    def with_gaps_of(self, offsets: Sequence[np.ndarray | None], gaps_of: Sequence[GapsOf]) -> RowCycle:
        """The same operators, which both have in common, with other offsets and gaps of all meshes."""
        other = copy(self)
        other.meshes = [mesh.with_gaps_of(*own) for mesh, *own in zip(self.meshes, offsets, gaps_of)]
        other._joined = {
            step: _with_gaps_of(_opened(position, other.meshes), other.meshes)
            for step, position in self._joined.items()
        }
        other._around = {}
        # What is shared has addresses of gaps.
        other._shared = {}
        return other

    @property
    def longest_lever(self) -> float:
        return max(mesh.friction * mesh.cycle.longest_lever for mesh in self.meshes)

    def share(self, memory: float, once: bool = False) -> None:
        """Let operators take so many bytes, those of single meshes among them; those of all meshes are held
        for a block of steps alone where each position of them is passed `once`. Meshes pass theirs more often."""
        # Operators grow with the square of their nodes, and those of all meshes have count times as many; how these
        # feel each other takes as much as each by itself. Meshes that are solved one by one have only factors together.
        alone = not self.tangential and len(self.face.widths) > 1
        count = 1 if alone else len(self.meshes)
        self.kept = Kept(memory * count / (count + 2), needed=not once)
        self._compliance.kept = Kept(memory / (count + 2))
        origins = {id(each.cycle.true_place(0)[0].mesh) for each in self.meshes}
        of_meshes = memory * (2 if alone else 1) / (count + 2)
        for each in self.meshes:
            # Meshes that are like others hold no operators of their own.
            own = each.cycle.true_place(0)[0].mesh is each.cycle.mesh
            each.cycle.kept = Kept(of_meshes / len(origins)) if own else Kept()

    def alike_nodes(self, step: int) -> list[tuple[tuple, slice]]:
        there = [mesh.cycle.true_place(step) for mesh in self.meshes]
        of_meshes = self._alike(step).of_meshes
        return [
            ((cycle.mesh, place), slice(first, first + position.operator.nodes))
            for (cycle, place), (position, first) in zip(there, of_meshes)
        ]

    @property
    def steps_until_alike(self) -> int:
        there = [mesh.cycle.true_place(0) for mesh in self.meshes]
        apart = {
            int(one - other) % cycle.steps for cycle, one in there for like, other in there if like.mesh is cycle.mesh
        }
        return min(apart - {0}, default=self.steps)

    def position(self, step: int) -> JoinedPosition:
        return self._deviated(step, self._alike(step))

    def build(self, steps: Sequence[int]) -> None:
        for each in self.meshes:
            each.cycle.build(steps)
        missing = dict.fromkeys(step % self.steps for step in steps if step % self.steps not in self._joined)
        self._around = {step: self._joined_at(step) for step in missing}

    def between(self, step: float, before: float) -> JoinedPosition:
        if step == int(step) and before == step - 1:
            return self.position(int(step))
        return self._deviated(step, self._at(step, before))

    def give_up(self) -> bool:
        given_up = [each.cycle.give_up() for each in self.meshes]
        there = bool(self._joined) or any(given_up)
        self.kept.most = 0.5 * self.kept.taken
        self.kept.taken = 0.0
        self._joined.clear()
        self._shared.clear()
        self._around = {}
        self._compliance.give_up()
        return there

    def solve(
        self, position: Position, problem: StepEquations, status: np.ndarray, last: StepSolution | None
    ) -> StepSolution:
        return solve_step(problem, status)

    def _alike(self, step: int) -> JoinedPosition:
        """All meshes at a step, without what differs from mesh cycle to mesh cycle."""
        key = step % self.steps
        found = self._joined.get(key) or self._around.get(key)
        return found or self._joined_at(key)

    def _deviated(self, step: float, position: JoinedPosition) -> JoinedPosition:
        if any(mesh.deviations for mesh in self.meshes):
            both = zip(self.meshes, position.of_meshes)
            of_meshes = tuple((mesh.deviating(step, own), first) for mesh, (own, first) in both)
            position = _with_gaps_of(replace(position, of_meshes=of_meshes), self.meshes)
        if self._points is None:
            return position
        operator = position.operator
        cycles = [mesh.cycle for mesh in self.meshes]
        compliance = self._points.put_in(step, cycles, position.of_meshes, operator.compliance)
        return replace(position, operator=operator.changed(compliance=compliance))

    def _joined_at(self, step: int) -> JoinedPosition:
        """All meshes at a step of the mesh cycle, kept if there is room."""
        position = self._at(step, step - 1)
        if self.kept.takes(position.bytes):
            self._joined[step] = position
        return position

    def _at(self, step: float, before: float) -> JoinedPosition:
        """All meshes at a step, after the one before it."""
        parts = []
        first = 0
        first_before = 0
        for each in self.meshes:
            own = each.cycle.between(step, before), _before(each.cycle, step, before)
            parts.append(Part(*own, first, first_before, each.friction))
            first += parts[-1].nodes
            first_before += parts[-1].nodes_before
        cycles = [each.cycle for each in self.meshes]
        compliance, compliance_before = self._compliance.of(cycles, parts, (first, first_before), step - before)
        operators = [part.position.operator for part in parts]
        moved = [each.stored_jacobians[0] @ mesh.moving for each, mesh in zip(operators, self.meshes)]
        rigid_slip = None
        jacobian_before = None
        if self.tangential:
            bare = [not mesh.cycle.tangential for mesh in self.meshes]
            # A mesh without friction has rows of zeros.
            moved = [np.pad(own, [(0, len(own) * none), (0, 0)]) for own, none in zip(moved, bare)]
            slip = [np.zeros(each.nodes) if none else each.rigid_slip for each, none in zip(operators, bare)]
            stood = [
                0.0 * own[: each.nodes] if none else each.stored_jacobians[1] @ mesh.moving
                for own, each, none, mesh in zip(moved, operators, bare, self.meshes)
            ]
            rigid_slip = np.concatenate(slip)
            jacobian_before = np.concatenate(stood)
        jacobian = _stacked(moved, operators)
        units = units_of(parts) if self.tangential else None
        if units is not None:
            jacobian *= units[0][:, None]
            rigid_slip *= units[0][first:]
            jacobian_before *= units[0][first:, None]
        operator = ContactOperator(
            pairs=tuple(pair for each in operators for pair in each.pairs),
            sides=operators[0].sides,
            normal_lever_arms=np.concatenate([each.normal_lever_arms for each in operators], axis=1),
            compliance=compliance,
            jacobian=jacobian,
            gap=np.concatenate([mesh.gap_of(each) for each, mesh in zip(operators, self.meshes)]),
            rigid_slip=rigid_slip,
            previous_compliance=compliance_before,
            previous_jacobian=jacobian_before,
            dependent_rows=sum(each.dependent_rows for each in operators),
            face=operators[0].face,
            coordinates=self.meshes[0].coordinates.shape[1],
        )
        before_now = np.concatenate([_moved(part.position.node_before, part.first_before) for part in parts])
        of_meshes = tuple((part.position, part.first) for part in parts)
        return JoinedPosition(operator, before_now, step % self.steps, of_meshes=of_meshes)


def _opened(position: JoinedPosition, meshes: Sequence[MeshOfRow]) -> JoinedPosition:
    """A position whose parts have the gaps of these meshes."""
    of_meshes = tuple(
        (mesh.cycle.opened(own.as_built), first) for mesh, (own, first) in zip(meshes, position.of_meshes)
    )
    return replace(position, of_meshes=of_meshes)


def _with_gaps_of(position: JoinedPosition, meshes: Sequence[MeshOfRow]) -> JoinedPosition:
    """A position with the gaps of these meshes as nothing moves."""
    gaps = [mesh.gap_of(own.operator) for mesh, (own, _) in zip(meshes, position.of_meshes)]
    return replace(position, operator=position.with_gap(np.concatenate(gaps)).operator)


def _before(cycle: Cycle, step: float, before: float) -> tuple[PairNodes, ...]:
    """Pairs a step before, their index counted from the mesh cycle of the step."""
    return counted_from(int(step // cycle.steps - before // cycle.steps), cycle.pairs_at(before % cycle.steps))


def _moved(node_before: np.ndarray, first: int) -> np.ndarray:
    """Numbers of nodes a step before among those of all meshes; -1 stays."""
    return np.where(node_before >= 0, node_before + first, node_before)


def _stacked(rows: list[np.ndarray], operators: Sequence[ContactOperator]) -> np.ndarray:
    """Rows of all normals, then of all tangents."""
    parts = zip(rows, operators)
    kinds = [[own[: each.nodes], own[each.nodes :]] for own, each in parts]
    return np.concatenate([own[kind] for kind in range(2) for own in kinds])
