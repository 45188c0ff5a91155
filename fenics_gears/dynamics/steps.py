"""Consecutive steps of a march as arrays, one step's contact nodes after the other's: all are treated at once."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numba import carray, njit

from fenics_gears.contact.addresses import NODES, ROW, arrays_of, to_integer, to_number, to_row, to_set
from fenics_gears.contact.laws import OPEN
from fenics_gears.contact.operator import ContactOperator, Position
from fenics_gears.contact.step_solver import StepSolution
from fenics_gears.contact.tooth_pair import COAST, DRIVE

from .time_integration import State

ARRAYS = ("numbers", "states", "forces", "displacement", "status", "iterations")


@dataclass(frozen=True)
class Record:
    """One step: its number, the state and the contact solution.

    `parts`: where the step was divided, all of its parts in order; their numbers lie between whole ones, the last is
    the step itself.
    """

    step: float
    state: State
    position: Position
    solution: StepSolution
    parts: tuple[Record, ...] = ()


class InMemory(NamedTuple):
    """Arrays of consecutive steps (s,), named as of `Steps`; `rows` (s,) of their contact operators."""

    rows: np.ndarray
    starts: np.ndarray
    kinds: int
    states: np.ndarray
    forces: np.ndarray
    displacement: np.ndarray
    status: np.ndarray
    iterations: np.ndarray


def table_of(positions: Sequence[Position]) -> np.ndarray:
    """The numbers (s, r) of the row of each position's contact operator, as of `contact.addresses`; the positions hold
    what they point to."""
    rows = [position.in_memory[0] for position in positions]
    return np.concatenate(rows).reshape(len(rows), -1) if rows else np.empty((0, len(ROW)), dtype=np.int64)


# One number instead of each array, since to find the types of many arrays takes numba longer than to go through a step.
BLOCK = np.dtype([(name, np.int64) for name in ("steps", "kinds", "coordinates", "rows", "starts", *ARRAYS[1:])])


@dataclass
class Steps:
    """Steps (s,) of a march: their `numbers`, `positions` and the `methods` that solved them; n contact nodes at each,
    N at all. `states` (s, 3, k): centre coordinates, mm, velocities and accelerations; `forces` and `displacement` (N,)
    or, with friction, (2 N,): a step's as in StepSolution, then the next step's; `status` (N,); `iterations` (s,) of
    Newton's method. `parts`: by place, those of steps that were divided.
    """

    numbers: np.ndarray
    positions: list[Position]
    states: np.ndarray
    forces: np.ndarray
    displacement: np.ndarray
    status: np.ndarray
    iterations: np.ndarray
    methods: list[str]
    parts: dict[int, tuple[Record, ...]] = field(default_factory=dict)

    @classmethod
    def to_solve(
        cls, numbers: Sequence[float], positions: list[Position], coordinates: int, method: str, table: Any = None
    ) -> Steps:
        """Room for the solutions at these positions, whose rows are those of a `table` (s, r) where it is given."""
        count, table = len(positions), table_of(positions) if table is None else table
        nodes = int(table[:, NODES].sum())
        forces = nodes * (1 if not count or positions[-1].operator.rigid_slip is None else 2)
        steps = cls(
            np.array(numbers, dtype=float), positions, np.zeros((count, 3, coordinates)), np.zeros(forces),
            np.zeros(forces),
            np.zeros(nodes, dtype=np.int8), np.zeros(count, dtype=np.int64), [method] * count,
        )  # fmt: skip
        steps.__dict__["table"] = table
        return steps

    @classmethod
    def of(cls, records: Sequence[Record]) -> Steps:
        """The steps of some records."""
        coordinates = len(records[0].state.position) if records else 0
        numbers, positions = [record.step for record in records], [record.position for record in records]
        steps = cls.to_solve(numbers, positions, coordinates, "")
        for place, record in enumerate(records):
            steps.put(place, record)
        return steps

    def put(self, place: int, record: Record) -> None:
        """Take the solution of one step from its record."""
        state, solution, (nodes, forces) = record.state, record.solution, self._slices(place)
        if record.position is not self.positions[place]:
            self.positions[place] = record.position
            self.table[place] = record.position.in_memory[0]
        self.methods[place] = solution.method
        self.states[place] = state
        self.forces[forces], self.displacement[forces] = solution.forces, solution.displacement
        self.status[nodes] = solution.status
        self.iterations[place] = solution.iterations
        if record.parts:
            self.parts[place] = record.parts

    def record(self, place: int) -> Record:
        """One step by itself; its arrays are parts of these."""
        nodes, forces = self._slices(place)
        solution = StepSolution(
            self.forces[forces],
            self.states[place, 0],
            self.displacement[forces],
            self.status[nodes],
            int(self.iterations[place]),
            self.methods[place],
        )
        number = float(self.numbers[place])
        return Record(
            int(number) if number.is_integer() else number,
            State(*self.states[place]),
            self.positions[place],
            solution,
            self.parts.get(place, ()),
        )

    def __len__(self) -> int:
        return len(self.positions)

    def between(self, first: int, end: int) -> Steps:
        """The steps from place `first` to before `end`; arrays are parts of these."""
        nodes, forces = (
            slice(self.starts[first], self.starts[end]),
            slice(self.kinds * self.starts[first], self.kinds * self.starts[end]),
        )
        parts = {place - first: parts for place, parts in self.parts.items() if first <= place < end}
        steps = Steps(
            self.numbers[first:end], self.positions[first:end], self.states[first:end], self.forces[forces],
            self.displacement[forces],
            self.status[nodes], self.iterations[first:end], self.methods[first:end], parts,
        )  # fmt: skip
        steps.__dict__["table"] = self.table[first:end]
        return steps

    def without_operators(self) -> Steps:
        """These steps without positions and parts."""
        steps = replace(self, positions=[None] * len(self), parts={})  # type: ignore[list-item]
        steps.__dict__["starts"] = self.starts
        return steps

    def followed_by(self, other: Steps) -> Steps:
        """These steps and others after them."""
        parts = self.parts | {len(self) + place: parts for place, parts in other.parts.items()}
        arrays = {name: np.concatenate([getattr(self, name), getattr(other, name)]) for name in ARRAYS}
        steps = Steps(
            **arrays, positions=self.positions + other.positions, methods=self.methods + other.methods, parts=parts
        )
        steps.__dict__["table"] = np.concatenate([self.table, other.table])
        return steps

    def with_parts(self) -> tuple[Steps, np.ndarray]:
        """All steps with the parts of those that were divided; and the places (s,) of the whole steps among them."""
        if not self.parts:
            return self, np.arange(len(self))
        passed, whole = [], []
        for place in range(len(self)):
            # The first step's own parts lie before it.
            passed += (self.parts.get(place) if place else None) or [self.record(place)]
            whole.append(len(passed) - 1)
        return Steps.of(passed), np.array(whole)

    @property
    def records(self) -> list[Record]:
        """The steps one by one."""
        return [self.record(place) for place in range(len(self))]

    @property
    def solved(self) -> Iterator[tuple[ContactOperator, np.ndarray, np.ndarray]]:
        """Contact operator, status (n,) and forces (n,) or (2 n,), N, of each step."""
        starts, kinds = self.starts.tolist(), self.kinds
        for position, first, end in zip(self.positions, starts, starts[1:]):
            yield position.operator, self.status[first:end], self.forces[kinds * first : kinds * end]

    @property
    def kinds(self) -> int:
        """Forces of a contact node: 2 with friction, else 1."""
        return 2 if len(self.forces) > len(self.status) else 1

    @cached_property
    def starts(self) -> np.ndarray:
        """Where the contact nodes of each step begin, and where they end (s + 1,)."""
        return np.concatenate(([0], np.cumsum(self.table[:, NODES])))

    @cached_property
    def table(self) -> np.ndarray:
        """The numbers (s, r) of the row of each step's contact operator."""
        return table_of(self.positions)

    @cached_property
    def in_memory(self) -> np.ndarray:
        """For compiled code, which makes an InMemory `in_block` of it and may write into the arrays: where they lie
        (1,); to be used as long as these steps are held."""
        arrays = (
            self.table, self.starts, self.states, self.forces, self.displacement, self.status, self.iterations,
        )  # fmt: skip
        addresses = [array.ctypes.data for array in arrays]
        return np.array([(len(self), self.kinds, self.states.shape[2], *addresses)], dtype=BLOCK)

    def _slices(self, place: int) -> tuple[slice, slice]:
        first, end = int(self.starts[place]), int(self.starts[place + 1])
        return slice(first, end), slice(self.kinds * first, self.kinds * end)


@njit(cache=True)
def in_block(block):
    """The arrays of steps that are `in_memory`."""
    at = block[0]
    count, kinds = at.steps, at.kinds
    starts = carray(to_integer(at.starts), count + 1)
    nodes = starts[count]
    return InMemory(
        carray(to_row(at.rows), count),
        starts,
        kinds,
        carray(to_number(at.states), (count, 3, at.coordinates)),
        carray(to_number(at.forces), kinds * nodes),
        carray(to_number(at.displacement), kinds * nodes),
        carray(to_set(at.status), nodes),
        carray(to_integer(at.iterations), count),
    )


@njit(cache=True)
def operator_at(steps, s):
    """The arrays of the contact operator at a step of those `in_memory`."""
    before = steps.starts[s] - steps.starts[s - 1] if s else 0
    return arrays_of(steps.rows[s], steps.kinds, before)


@njit(cache=True)
def nodes_at(steps, s):
    """Where the contact nodes of a step of those `in_memory` stand among all."""
    return slice(steps.starts[s], steps.starts[s + 1])


@njit(cache=True)
def forces_at(steps, s):
    """Where the forces of a step of those `in_memory` stand among all."""
    return slice(steps.kinds * steps.starts[s], steps.kinds * steps.starts[s + 1])


def smallest_openings(steps: Steps) -> np.ndarray:
    """Distance (s, 2), mm, of the drive and of the coast flanks at the contact node nearest to contact; infinite where
    there is no such node."""
    return _openings(steps.in_memory)


def drive_flanks_touch(steps: Steps) -> np.ndarray:
    """Whether any node on the drive flanks is closed (s,)."""
    return _touching(steps.in_memory)


@njit(cache=True)
def _openings(block):
    steps = in_block(block)
    smallest = np.full((len(steps.rows), 2), np.inf)
    for s in range(len(steps.rows)):
        contact, displacement = operator_at(steps, s), steps.displacement[forces_at(steps, s)]
        gap, drive = contact.gap, contact.on_drive_flanks
        for node in range(len(gap)):
            side = DRIVE if drive[node] else COAST
            smallest[s, side] = min(smallest[s, side], gap[node] - displacement[node])
    return smallest


@njit(cache=True)
def _touching(block):
    steps = in_block(block)
    touching = np.zeros(len(steps.rows), dtype=np.bool_)
    for s in range(len(steps.rows)):
        drive, status = operator_at(steps, s).on_drive_flanks, steps.status[nodes_at(steps, s)]
        for node in range(len(drive)):
            touching[s] |= drive[node] and status[node] != OPEN
    return touching
