"""A block of steps, of one run or of several one after the other: compiled code solves it without leaving it, and a
second thread may go on with a part of it."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import replace
from threading import Event
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from fenics_gears.contact.addresses import ROW
from fenics_gears.contact.errors import ContactNotConverged
from fenics_gears.system.environment import threads

from .compiled_march import NO_SETS, Course, Motion, begin, solve_steps
from .steps import Record, Steps

if TYPE_CHECKING:
    from .batch import Batch

RIGID_SLIP = ROW.names.index("rigid_slip")
Value = TypeVar("Value")


@contextmanager
def at_once(work: Callable[..., Value], *arguments: Any) -> Iterator[Callable[[], Value]]:
    """Meanwhile a second thread does `work(*arguments, ended)`, which ends early when `ended` is set; waits for what it
    returns."""
    ended = Event()
    with ThreadPoolExecutor(1) as second:
        try:
            yield second.submit(work, *arguments, ended).result
        finally:
            ended.set()


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
