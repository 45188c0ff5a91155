"""Runs that are marched side by side on the contact operators of one mesh cycle, and blocks of their steps: compiled
code solves a block without leaving it. A single run is a batch of one."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from math import ceil
from threading import Event
from typing import Protocol

import numpy as np

from fenics_gears.contact.addresses import GAP, NODES, ROW
from fenics_gears.contact.errors import ContactNotConverged
from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.contact.operator import Position
from fenics_gears.contact.step_solver import NEWTON
from fenics_gears.system.environment import threads

from .compiled_march import NO_SETS, Course, Motion, begin, solve_steps
from .stepping import STEPS_SLID_BEFORE_START, EquationsOfMotion, Stepper
from .steps import Record, Steps, table_of

RIGID_SLIP = ROW.names.index("rigid_slip")


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


class Block:
    """The `steps` of courses, one course's after the other's, of equally many (`length`) steps, each to be solved after
    the one before it; `runs` of a `batch` that the courses are of.

    `course`: what differs between the steps. Their first steps are there if they have `begun`; else nothing is, and the
    second is in balance. `done`: how many are there of each course. `held`: arrays whose addresses the steps have.
    """

    held: np.ndarray | None = None

    def __init__(self, batch: Batch, runs: Sequence[int], steps: Steps, course: Course, begun: bool):
        self._batch = batch
        self._runs = runs
        self._begun = begun
        self.steps = steps
        self.course = course
        self.length = len(steps) // len(runs)
        self.done = [1] * len(runs)

    def solve(self, number: int, end: int) -> None:
        """Solve the steps of a course to before its place `end`: by Newton's method in compiled code, and by itself
        where that does not solve a step at once. Raises ContactNotConverged."""
        first = number * self.length
        motion = self._motion(number)
        while self.done[number] < end:
            if not self._batch.plain:
                places = first + self.done[number], first + end
                self.done[number] = solve_steps(self.steps, *places, motion, self.course) - first
            if self.done[number] < end:
                self.steps.put(first + self.done[number], self._by_itself(number, self.done[number]))
                self.done[number] += 1

    def solve_on(self, number: int, first: int, end: int, ended: Event) -> int:
        """Solve the steps of a course that stand still from its place `first` to before `end`, those before them being
        solved by another thread; returns the first place that is not solved. Ends early where a step has no solution,
        and when `ended` is set."""
        at = first
        while at < end and not ended.is_set():
            place = number * self.length + at
            if self._batch.plain:
                try:
                    self.steps.put(place, self._by_itself(number, at, alone=at == first))
                except ContactNotConverged:
                    break
            else:
                if at == first and at > self.done[number]:
                    self.begin(number, at, self._sets_ahead(number, at))
                if solve_steps(self.steps, place, place + 1, self._motion(number), self.course) == place:
                    break
            at += 1
        return at

    def _sets_ahead(self, number: int, at: int) -> np.ndarray:
        """Sets (n,) to begin with at a place of a course before the step before it is solved: those of the last one
        that is, as its nodes go on."""
        place = number * self.length + at
        known = self.course.cycle_before[self.steps.starts[place] : self.steps.starts[place + 1]]
        if len(known) and known.min() >= 0:
            return known.copy()
        if not self._begun:
            return self._batch.common.sets.near(float(self.steps.numbers[place]), self.steps.positions[place])
        sets = self.sets(number, self.done[number] - 1)
        for position in self.steps.positions[number * self.length + self.done[number] : place + 1]:
            before = sets
            sets = np.empty(position.operator.nodes, dtype=np.int8)
            begin(sets, before, position.node_before, NO_SETS, NO_SETS)
        return sets

    def _motion(self, number: int) -> Motion:
        """That of a course."""
        stepper = self._batch.steppers[self._runs[number]]
        return stepper.static_motion if self.course.at_rest else stepper.motion

    def _by_itself(self, number: int, at: int, alone: bool = False) -> Record:
        """A step of a course, solved in Python with all fallbacks; `alone`: not after the step before it."""
        stepper = self._batch.alone(self._runs[number])
        place = number * self.length + at
        step = self.steps.record(place).step
        if alone or at == 1 and not self._begun:
            record = stepper.in_balance(step, stepper.cycle.position(step))
        else:
            scheme = stepper.static if self.course.at_rest else stepper.scheme(step)
            record = stepper.step(scheme, self.steps.record(place - 1), step)
        # A divided step ends at a position of its own, after a part of a step.
        return record if record.parts else replace(record, position=self.steps.positions[place])

    def middle(self, number: int, end: int) -> int:
        """From which place on a second thread may solve the steps of a course that are left before `end`: this where
        each follows from the one before it."""
        left = end - self.done[number]
        batch = self._batch
        if left < 2 or threads() == 1 or self.steps.table[:, RIGID_SLIP].any():
            return end
        # In a plane a step takes less time than to begin a thread.
        compiled = self.course.at_rest and batch.cycle.traits.repeats and not batch.plain
        by_itself = batch.plain and not batch.common.dynamic.inert and batch.cycle.face.slices > 1
        return end - left // 2 if compiled or by_itself else end

    def sets(self, number: int, at: int) -> np.ndarray:
        """The sets (n,) of a step of a course that is there."""
        place = number * self.length + at
        return self.steps.status[self.steps.starts[place] : self.steps.starts[place + 1]]

    def begin(self, number: int, at: int, sets: np.ndarray) -> None:
        """Have a step of a course begin with sets (n,) of the same position."""
        place = number * self.length + at
        self.course.cycle_before[self.steps.starts[place] : self.steps.starts[place + 1]] = sets

    def remember(self, number: int) -> None:
        """Keep the sets of a course for steps to come, and for other runs."""
        known = self._batch.common.sets
        for at in range(1, self.done[number]) if known.remembers else ():
            step = int(self.steps.numbers[at])
            if step >= 0:
                # A copy: the block is large.
                known.remember(step, self.sets(number, at).copy())

    def of(self, number: int, first: int = 0) -> Steps:
        """The steps of a course that are there, from its place `first` on."""
        begun = number * self.length
        return self.steps.between(begun + first, begun + self.done[number])

    def record(self, number: int, at: int) -> Record:
        """A step of a course."""
        return self.steps.record(number * self.length + at)
