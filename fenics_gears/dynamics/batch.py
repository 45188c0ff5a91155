"""Runs that are marched side by side on the contact operators of one mesh cycle. A single run is a batch of one."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from math import ceil
from typing import Protocol

import numpy as np

from fenics_gears.contact.addresses import GAP, NODES, ROW
from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.contact.operator import Position
from fenics_gears.contact.step_solver import NEWTON

from .block import RIGID_SLIP, Block
from .compiled_march import NO_SETS, Course
from .stepping import STEPS_SLID_BEFORE_START, EquationsOfMotion, Stepper
from .steps import Record, Steps, table_of


class OpenedNodes(Protocol):
    """What opens the contact nodes of each run."""

    @property
    def steps(self) -> int:
        """After how many steps they repeat: a mesh cycle, or all of a run."""

    def of_steps(self, positions: Sequence[Position]) -> np.ndarray:
        """Gaps (runs, n), mm, at all of these steps, one after the other."""

    def at(self, asked: Sequence[tuple[int, Position]]) -> np.ndarray:
        """Gaps (n,), mm, of runs at a position each, one after the other."""

    def of(self, run: int) -> Cycle:
        """The cycle with the gaps of a run."""


class Batch:
    """Runs on the contact operators of a `cycle`; `equations` by run, alike but for the load. `opened`: the gaps of
    each, of a cycle without gaps of its own; None for a single run with those of its cycle.

    `steppers` by run, for what is the same whatever its gaps; `common`: one of them, for what is the same of all runs.
    `plain`: every step by itself, in Python.
    """

    def __init__(
        self,
        cycle: Cycle,
        equations: Sequence[EquationsOfMotion],
        opened: OpenedNodes | None = None,
        plain: bool = False,
    ):
        self.cycle = cycle
        self.opened = opened
        self._equations = equations
        distinct = {id(each): each for each in equations}
        known = {key: Stepper(cycle, each) for key, each in distinct.items()}
        self.steppers = [known[id(each)] for each in equations]
        self.common = self.steppers[0]
        self.plain = plain or self.common.drivetrain.rolling is not None or cycle.traits.own_solver
        self._alone: dict[int, Stepper] = {}
        if opened is not None:
            self._open(opened)

    def _open(self, opened: OpenedNodes) -> None:
        """The positions until gaps repeat, and the rows (runs, steps, r) of their operators with each run's gaps."""
        self._positions = self._at(range(opened.steps))
        self._gaps = opened.of_steps(self._positions)
        table = table_of(self._positions)
        self._ends = np.cumsum(table[:, NODES])
        self._rows = np.tile(table, (len(self.steppers), 1, 1))
        of_runs = self._gaps.ctypes.data + np.arange(len(self.steppers))[:, None] * self._gaps.strides[0]
        self._rows[:, :, GAP] = of_runs + self._gaps.itemsize * (self._ends - table[:, NODES])

    def alone(self, run: int) -> Stepper:
        """What solves single steps of a run, with its gaps."""
        if self.opened is None:
            return self.common
        if run not in self._alone:
            self._alone[run] = Stepper(self.opened.of(run), self._equations[run])
        return self._alone[run]

    def at_rest(self, first: int, end: int) -> Block:
        """The steps of all runs from `first` to before `end` without inertia, of which the first is in balance after
        long sliding."""
        positions = self._at(range(first, end))
        rows = self._rows_of(range(first, end), positions)
        before = np.repeat(nothing_before(positions[:1])[None], len(rows), axis=0)
        rows = np.concatenate((before, rows), axis=1)
        slip = positions[0].operator.rigid_slip
        slid = None if slip is None else np.ascontiguousarray(STEPS_SLID_BEFORE_START * slip)
        if slid is not None:
            rows[:, 1, RIGID_SLIP] = slid.ctypes.data
        # Of all but the position in balance the sets are those of the step before.
        others = [np.full(each.operator.nodes, -1, dtype=np.int8) for each in positions[1:]]
        sets = []
        for run in range(len(rows)):
            near = self.common.sets.near(first, self._opened(run, first, positions[0]))
            sets += [np.zeros(before[0, 0, NODES], dtype=np.int8), near, *others]
        numbers = [*range(first - 1, end)] * len(rows)
        positions = [positions[0], *positions] * len(rows)
        block = self._block(range(len(rows)), numbers, positions, rows, sets)
        block.held = slid
        return block

    def after(self, lasts: Mapping[int, Record], numbers: range) -> Block:
        """Consecutive steps of those runs that have a last one, after it."""
        count = len(lasts)
        numbers = range(numbers[0] - 1, numbers[-1] + 1)
        positions = self._at(numbers)
        (last, *_) = lasts.values()
        if self.opened is None and not last.parts:
            # If it is not kept it was built once more, without the rows that the last step has formed.
            positions[0] = last.position
        rows = self._rows_of(numbers, positions)[list(lasts)]
        sets = [self.common.sets.before_all(numbers, rows[0, :, NODES])] * count
        before = list(lasts.values())
        at_rest = self.common.at_rest
        block = self._block(list(lasts), [*numbers] * count, positions * count, rows, sets, before, at_rest)
        if self.common.dynamic.inert:
            durations = block.course.durations.reshape(count, -1)
            durations[:, 1:] = self.common.clock.durations(np.array(numbers))
        return block

    def without_friction(self, block: Block) -> Block | None:
        """The steps of a block of a single run at rest without friction; None where it has none, and where friction has
        been solved for at these positions."""
        new = [place for place in range(1, block.length) if block.steps.positions[place].operator.untouched]
        if not new or not self.common.friction or self.opened is not None or self.plain:
            return None
        first, end = new[0] - 1, new[-1] + 1
        rows = block.steps.table[first:end].copy()
        rows[:, RIGID_SLIP] = 0
        numbers, positions = block.steps.numbers[first:end], block.steps.positions[first:end]
        sets = [np.full(nodes, -1, dtype=np.int8) for nodes in rows[:, NODES]]
        before = [block.record(0, 0)] if first == 0 else ()
        return self._block([0], [*numbers.tolist()], positions, rows[None], sets, before)

    def between(self, asked: Sequence[tuple[int, float]], lasts: Sequence[Record]) -> Block:
        """Runs at a place between steps each, without inertia, after the last whole step before it; without friction no
        step is needed."""
        positions = [self.cycle.between(place, ceil(place) - 1) for _, place in asked]
        rows = np.stack((nothing_before(positions), table_of(positions)), axis=1)
        gaps = None
        if self.opened is not None:
            gaps = self.opened.at([(run, position) for (run, _), position in zip(asked, positions)])
            rows[:, 1, GAP] = gaps.ctypes.data + gaps.itemsize * (np.cumsum(rows[:, 1, NODES]) - rows[:, 1, NODES])
        if lasts:
            rows[:, 0, NODES] = [len(last.solution.status) for last in lasts]
        sets = []
        for (_, place), position, nodes in zip(asked, positions, rows[:, 0, NODES]) if not lasts else ():
            sets += [np.zeros(nodes, dtype=np.int8), self.common.sets.near(place, position)]
        numbers = [number for _, place in asked for number in (ceil(place) - 1, place)]
        both = [position for position in positions for _ in range(2)]
        block = self._block([run for run, _ in asked], numbers, both, rows, sets, lasts)
        block.held = gaps
        return block

    def _block(
        self, runs: Sequence[int], numbers: Sequence[float], positions: list[Position], rows: np.ndarray,
        sets: list[np.ndarray], lasts: Sequence[Record] = (), at_rest: bool = True,
    ) -> Block:  # fmt: skip
        """Courses of steps, as many (c) as `runs`, one after the other; rows (c, s, r) of their operators; `sets`: to
        begin with; `lasts`: the first steps, if these are there."""
        length = rows.shape[1]
        coordinates = len(self.common.drivetrain.coordinates)
        steps = Steps.to_solve(numbers, positions, coordinates, NEWTON, rows.reshape(-1, rows.shape[2]))
        for place, last in enumerate(lasts):
            steps.put(place * length, replace(last, position=positions[place * length]))
        loads = np.repeat([self.steppers[run].drivetrain.load for run in runs], length, axis=0)
        if self.common.loads:
            solved = [place for place in range(len(steps)) if place % length]
            loads[solved] = [self.steppers[runs[place // length]].load(numbers[place]) for place in solved]
        known = np.concatenate(sets) if sets else NO_SETS
        return Block(self, runs, steps, Course(np.zeros(len(steps)), loads, known, at_rest), bool(lasts))

    @property
    def takes_turns(self) -> bool:
        """Whether runs take turns at each step: over a face its operator is larger than all else."""
        return self.opened is not None and self.cycle.traits.repeats

    def _at(self, steps: Sequence[int]) -> list[Position]:
        """The positions at consecutive steps."""
        self.cycle.build(steps)
        return [self.cycle.position(step) for step in steps]

    def _rows_of(self, steps: Sequence[int], positions: list[Position]) -> np.ndarray:
        """The rows (runs, s, r) of the operators at the positions of some steps, with the gaps of each run."""
        return table_of(positions)[None] if self.opened is None else self._rows[:, np.array(steps) % self.opened.steps]

    def _opened(self, run: int, step: int, position: Position) -> Position:
        """The position at a step with the gaps of a run."""
        if self.opened is None:
            return position
        end = self._ends[step % self.opened.steps]
        return position.with_gap(self._gaps[run, end - position.operator.nodes : end])


def nothing_before(positions: Sequence[Position]) -> np.ndarray:
    """Rows (p, r) in place of those of the steps before positions: compiled code reads nothing of them but how many
    nodes they have."""
    rows = np.zeros((len(positions), len(ROW)), dtype=np.int64)
    rows[:, NODES] = [position.node_before.max(initial=-1) + 1 for position in positions]
    return rows
