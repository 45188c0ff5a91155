"""Contact of meshes that move together: the contact nodes of all one after the other, over the coordinates of the
train. Compliance is summed over bodies, so that meshes in which the same gear stands feel each other.

A mesh is described in a frame in which its pinion turns counter-clockwise. From one mesh to the next along a row the
frame is the mirror image, in which the other flanks of the gear between them are its drive flanks.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from math import floor, lcm, prod

import numpy as np

from fenics_gears.elasticity.compliance import BothFlanksCompliance
from fenics_gears.geometry.gear_train import SecondMesh

from .kinematics import IN_THE_PLANE
from .mesh import Mesh
from .mesh_cycle import Cycle, Kept
from .operator import ContactOperator, Position
from .pairing import Flank, FlankTable, Numbered, add_products, matched
from .step_solver import StepProblem, StepSolution, solve_step
from .tooth_pair import PairNodes, count_of


def at_phase(mesh: Mesh, phase: float) -> Mesh:
    """A mesh whose pairs are so many mesh cycles (0 to 1) further on their way."""

    def nodes(phases: Sequence[float]) -> list[tuple[PairNodes, ...]]:
        passed = [floor(each + phase) for each in phases]
        found = mesh.nodes([each + phase - whole for each, whole in zip(phases, passed)])
        return [_earlier_by(whole, pairs) for whole, pairs in zip(passed, found)]

    return replace(mesh, nodes=nodes) if phase else mesh


def _earlier_by(cycles: int, pairs: tuple[PairNodes, ...]) -> tuple[PairNodes, ...]:
    """Pairs whose index counts from so many mesh cycles before."""
    if not cycles:
        return pairs
    return tuple(replace(each, place=replace(each.place, index=each.place.index - cycles)) for each in pairs)


def begun_at(idlers: Sequence[SecondMesh | None]) -> list[tuple[float, int]]:
    """Of each mesh the mesh cycles (0 to 1) by which it is past a start of contact as the run begins; and by how many
    whole ones its pairs are counted later, so that this is below 1. `idlers`: of its pinion, where this is one."""
    found = [(0.0, 0)]
    for idler in idlers[1:]:
        ahead = 0.0 if idler is None else found[-1][0] + idler.phase
        found.append((ahead - floor(ahead), floor(ahead)))
    return found


@dataclass(frozen=True)
class MeshOfRow:
    """A mesh of a train: its `cycle` over the coordinates (l,) of its own two gears, and how these follow (l, k) from
    those of the train."""

    cycle: Cycle
    coordinates: np.ndarray


@dataclass(frozen=True)
class Idler:
    """A gear of so many `teeth` that is driven in one mesh, by its number, and drives in the next one: the `body` that
    both load, where the `second` mesh is as the first starts, and the face width (mm) of both."""

    mesh: int
    teeth: int
    body: BothFlanksCompliance
    second: SecondMesh
    face_width: float

    @property
    def meshes(self) -> tuple[int, int]:
        return self.mesh, self.mesh + 1

    def flank(self, gear: int, flank: Flank) -> Flank:
        """A flank of the idler as the first mesh counts teeth and flanks, from how the mesh in which it is the driven
        (1) or the driving gear (0) counts them."""
        tooth, side = flank
        return flank if gear == 1 else (self.second.teeth - tooth, 1 - side)

    def block(self, responding: Flank, loaded: Flank) -> np.ndarray:
        """Compliance of one flank under forces on one of the other mesh, mm per N/mm: from one side of a tooth to the
        other side of another, round the gear either way."""
        (tooth, side), (other, other_side) = responding, loaded
        sense = 1 if side == 0 else -1
        first = self.body.first_across
        ahead = first + (sense * (tooth - other) - first) % self.teeth
        return self.body.between(sense * ahead, 0, (side, other_side))


@dataclass(frozen=True)
class JoinedPosition(Position):
    """All meshes at a step; `of_meshes`: the position of each, and the number of its first contact node among all."""

    of_meshes: tuple[tuple[Position, int], ...] = ()


@dataclass(frozen=True)
class _Part:
    """A mesh at a position: now, and how its pairs were a step before; its first node among all, then and now."""

    position: Position
    before: tuple[PairNodes, ...]
    first: int
    first_before: int

    @property
    def nodes(self) -> int:
        return self.position.operator.nodes

    @property
    def nodes_before(self) -> int:
        return count_of(self.before)

    def put(self, compliance: np.ndarray, before: np.ndarray | None) -> None:
        """Put its own compliance (k, n, k, n) and, with friction, the previous one (2, n before, n) among those of
        all."""
        nodes = self.nodes
        own = slice(self.first, self.first + nodes)
        kinds = len(compliance)
        stored = self.position.operator.compliance.reshape(kinds, nodes, kinds, nodes)
        compliance[:, own, :, own] = stored
        if before is not None:
            then = slice(self.first_before, self.first_before + self.nodes_before)
            before[:, then, own] = self.position.operator.previous_compliance.T.reshape(2, self.nodes_before, nodes)


class _Room:
    """Memory for matrices of positions that are not kept, used again after two blocks of steps: a march needs the last
    step of the block before, and to get new memory takes longer than to fill it."""

    def __init__(self) -> None:
        self._turns: tuple[list[np.ndarray], list[np.ndarray]] = ([], [])
        self._taken = 0

    def begin_block(self) -> None:
        self._turns = self._turns[1], self._turns[0]
        self._taken = 0

    def zeros(self, *shape: int) -> np.ndarray:
        own = self._turns[0]
        size = prod(shape)
        if self._taken == len(own):
            own.append(np.empty(0))
        if len(own[self._taken]) < size:
            # Others have up to twice as many nodes; what is never touched takes no memory.
            own[self._taken] = np.empty(4 * size)
        found = own[self._taken][:size].reshape(shape)
        found[:] = 0.0
        self._taken += 1
        return found


def _zeros(*shape: int) -> np.ndarray:
    return np.zeros(shape)


class RowCycle(Cycle):
    """Contact equations of all meshes of a train, whose steps are of one length in time; the cycles of those that an
    idler couples have as many steps as one another."""

    def __init__(self, meshes: Sequence[MeshOfRow], idlers: Sequence[Idler]):
        first = meshes[0].cycle
        # After so many steps all of them are where they were.
        steps = lcm(*(each.cycle.steps for each in meshes))
        super().__init__(first.mesh, steps, [], first.tangential)
        self.meshes = meshes
        self._blocks: dict[tuple[int, Flank, Flank], tuple[tuple[int, int, int], np.ndarray]] = {}
        self._idlers = idlers
        self._joined: dict[float, Position] = {}
        # Of the steps that were built last, for which there may be no room.
        self._around: dict[int, Position] = {}
        self._room = _Room()

    def share(self, memory: float) -> None:
        """Let operators take so many bytes, those of single meshes among them."""
        self.kept = Kept(memory)
        for each in self.meshes:
            each.cycle.kept = Kept(memory / (2 + len(self.meshes)))

    def position(self, step: int) -> Position:
        key = step % self.steps
        found = self._joined.get(key) or self._around.get(key)
        return found or self._joined_at(key)

    def build(self, steps: Sequence[int]) -> None:
        for each in self.meshes:
            each.cycle.build(steps)
        missing = list(dict.fromkeys(step % self.steps for step in steps if step % self.steps not in self._joined))
        if not missing:
            return
        first = self._joined_at(missing[0])
        if self.kept.takes((self.steps - len(self._joined) - 1) * first.bytes):
            self.kept.taken -= (self.steps - len(self._joined) - 1) * first.bytes
            self._around = {step: self._joined_at(step) for step in missing}
            return
        # There is no room for all, whose turn comes again after many mesh cycles.
        self._room.begin_block()
        self._around = {step: self._at(step, step - 1, self._room.zeros) for step in missing}

    def between(self, step: float, before: float) -> Position:
        if step == int(step) and before == step - 1:
            return self.position(int(step))
        return self._at(step, before)

    def give_up(self) -> bool:
        given_up = [each.cycle.give_up() for each in self.meshes]
        there = bool(self._joined) or any(given_up)
        self.kept.most = 0.5 * self.kept.taken
        self.kept.taken = 0.0
        self._joined.clear()
        self._shared.clear()
        self._around = {}
        return there

    def solve(
        self, position: Position, problem: StepProblem, status: np.ndarray, last: StepSolution | None
    ) -> StepSolution:
        return solve_step(problem, status)

    def _joined_at(self, step: int) -> Position:
        """All meshes at a step of the mesh cycle, kept if there is room."""
        position = self._at(step, step - 1)
        if self.kept.takes(position.bytes):
            self._joined[step] = position
        return position

    def _at(self, step: float, before: float, zeros: Callable[..., np.ndarray] = _zeros) -> Position:
        """All meshes at a step, after the one before it; `zeros` gives room for matrices."""
        parts = []
        first = 0
        first_before = 0
        for each in self.meshes:
            earlier = _pairs_before(each.cycle, step, before)
            parts.append(_Part(_part(each.cycle, step, before), earlier, first, first_before))
            first += parts[-1].nodes
            first_before += parts[-1].nodes_before
        compliance, compliance_before = self._compliance(parts, (first, first_before), step - before, zeros)
        operators = [part.position.operator for part in parts]
        jacobian = _stacked([each.jacobian @ mesh.coordinates for each, mesh in zip(operators, self.meshes)], operators)
        rigid_slip = None
        jacobian_before = None
        if self.tangential:
            rigid_slip = np.concatenate([each.rigid_slip for each in operators])
            stood = [each.previous_jacobian @ mesh.coordinates for each, mesh in zip(operators, self.meshes)]
            jacobian_before = np.concatenate(stood)
        operator = ContactOperator(
            pairs=tuple(pair for each in operators for pair in each.pairs),
            sides=operators[0].sides,
            normal_lever_arms=np.concatenate([each.normal_lever_arms for each in operators], axis=1),
            compliance=compliance,
            jacobian=jacobian,
            gap=np.concatenate([each.gap for each in operators]),
            rigid_slip=rigid_slip,
            previous_compliance=compliance_before,
            previous_jacobian=jacobian_before,
            dependent_rows=sum(each.dependent_rows for each in operators),
            face=IN_THE_PLANE,
            coordinates=jacobian.shape[1],
        )
        before_now = np.concatenate([_moved(part.position.node_before, part.first_before) for part in parts])
        of_meshes = tuple((part.position, part.first) for part in parts)
        return JoinedPosition(operator, before_now, step % self.steps, of_meshes=of_meshes)

    def _compliance(
        self, parts: list[_Part], counts: tuple[int, int], steps: float, zeros: Callable[..., np.ndarray]
    ) -> tuple[np.ndarray, np.ndarray | None]:
        """C (m, m) of all meshes, and with friction E (n, m before), mm/N, after so many steps."""
        nodes, nodes_before = counts
        kinds = 2 if self.tangential else 1
        compliance = zeros(kinds * nodes, kinds * nodes)
        # By columns, as compiled code reads it.
        before = zeros(2 * nodes_before, nodes) if self.tangential else np.zeros((0, 0))
        for part in parts:
            by_kind = compliance.reshape(kinds, nodes, kinds, nodes)
            part.put(by_kind, before.reshape(2, nodes_before, nodes) if self.tangential else None)
        for idler in self._idlers:
            at = compliance.ctypes.data, before.ctypes.data, nodes, nodes_before
            self._add_through(idler, [parts[mesh] for mesh in idler.meshes], at, steps)
        return compliance, before.T if self.tangential else None

    def _add_through(self, idler: Idler, parts: list[_Part], at: tuple[int, ...], steps: float) -> None:
        """Add how both meshes of an idler feel each other through it."""
        flanks = FlankTable()
        now = []
        earlier = []
        for gear, part in zip((1, 0), parts):
            own = flanks.of(part.position.operator.pairs, gear)
            now.append([_shifted(idler.flank(gear, each[0]), each, part.first) for each in own])
            own = flanks.of(part.before, gear) if self.tangential else []
            earlier.append([_shifted(idler.flank(gear, each[0]), each, part.first_before) for each in own])
        products = []
        back = []
        for responding, other in ((0, 1), (1, 0)):
            # Nodes of the first mesh stand before those of the second: the other half follows by symmetry.
            loads = matched(now[other] if responding == 1 else [], earlier[other])
            cycle = self.meshes[idler.meshes[responding]].cycle
            side = cycle.pair.sides[1 - responding]
            for flank, number, place in now[responding]:
                for loaded, *numbers in loads:
                    block = self._block(idler, flank, loaded)
                    products.append((0, *block, number, numbers[0], numbers[2], place, numbers[1], numbers[3]))
                    back.append(side.turn * steps / cycle.steps)
        add_products([at], flanks, (products, back), self.tangential, idler.face_width)

    def _block(self, idler: Idler, responding: Flank, loaded: Flank) -> tuple[int, int, int]:
        """Address, size and columns of the compliance between two flanks of an idler."""
        key = idler.mesh, responding, loaded
        if key not in self._blocks:
            block = np.ascontiguousarray(idler.block(responding, loaded))
            # With the block itself, which holds the memory.
            self._blocks[key] = (block.ctypes.data, block.size, block.shape[1]), block
        return self._blocks[key][0]


def _shifted(flank: Flank, numbered: Numbered, first: int) -> Numbered:
    return flank, numbered[1], numbered[2] + first


def _part(cycle: Cycle, step: float, before: float) -> Position:
    if step == int(step) and before == step - 1:
        return cycle.position(int(step))
    return cycle.between(step, before)


def _pairs_before(cycle: Cycle, step: float, before: float) -> tuple[PairNodes, ...]:
    """Pairs a step before, their index counted from the mesh cycle of the step."""
    pairs = cycle.pairs_at(before % cycle.steps)
    return _earlier_by(-int(step // cycle.steps - before // cycle.steps), pairs)


def _moved(node_before: np.ndarray, first: int) -> np.ndarray:
    """Numbers of nodes a step before among those of all meshes; -1 stays."""
    return np.where(node_before >= 0, node_before + first, node_before)


def _stacked(rows: list[np.ndarray], operators: Sequence[ContactOperator]) -> np.ndarray:
    """Rows of all normals, then of all tangents."""
    parts = zip(rows, operators)
    kinds = [[own[: each.nodes], own[each.nodes :]] for own, each in parts]
    return np.concatenate([own[kind] for kind in range(2) for own in kinds])
