"""The march of runs through time: one contact step after another, in blocks, from static equilibrium at the start."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from contextlib import nullcontext
from functools import cache, cached_property
from math import ceil
from threading import Event
from typing import TypeVar

import numpy as np
from threadpoolctl import ThreadpoolController

from fenics_gears.contact.addresses import march_with_inertia
from fenics_gears.contact.errors import ContactNotConverged
from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.errors import MemoryEnded
from fenics_gears.system.memory import SHARE_OF_A_BLOCK

from .batch import Batch, OpenedNodes
from .block import Block, at_once
from .marched import March
from .stepping import EquationsOfMotion
from .steps import Record, Steps

SECONDS_BETWEEN_REPORTS = 0.1
# Steps are handed on in blocks of at most so many.
LONGEST_BLOCK = 512

Solved = TypeVar("Solved")
Report = Callable[[int], None]
# Takes the next steps of a run.
Take = Callable[[int, Steps], None]


@cache
def thread_pools() -> ThreadpoolController:
    """The libraries with threads that are loaded as the first march begins: to find them takes milliseconds."""
    return ThreadpoolController()


class Marcher:
    """Steps the equations of motion of runs with the contact of a `cycle` through time; `equations` of each run, alike
    but for the load. One run has the gaps of the cycle, several have theirs `opened`. `plain`: every step by itself, in
    Python.
    """

    def __init__(
        self, cycle: Cycle, *equations: EquationsOfMotion, opened: OpenedNodes | None = None, plain: bool = False
    ):
        self.batch = Batch(cycle, equations, opened, plain)
        self.cycle = cycle
        self.stepper = self.batch.common
        friction = self.stepper.friction
        # With a smaller coefficient friction never outweighs the normal force.
        self._may_lock = friction > 0.0 and friction * cycle.longest_lever >= 1.0
        # By run, why it has no solution at a step; without frames, which would hold the march until Python looks for
        # garbage.
        self.failures: dict[int, ContactNotConverged] = {}
        # Steps in a call of compiled code, which lasts until the next report as soon as it is known how long a step
        # takes.
        self._at_once = 1
        self._reported = 0.0

    def run(
        self,
        steps: int,
        kept: int,
        report: Callable[[int, int], None] = lambda step, steps: None,
        observe: Callable[[Steps, March], None] = lambda solved, march: None,
        judged: int = 0,
        period: int = 0,
    ) -> March:
        """March a single run: `steps` steps from step 0, and keep the last `kept` records, wherever the march ends;
        `observe` is called with blocks of steps and the march so far.

        `judged`: of so many last steps it is judged whether friction leaves more than one solution. `period`: steps
        after which they repeat, of which the solutions are kept.

        Ctrl-C ends the march and keeps what was done. Raises ContactNotConverged and MemoryEnded, whose `partial` is
        the March so far.
        """
        march = March(self.stepper.friction, self.stepper.dynamic.stiffness, kept, period)

        def take(run: int, solved: Steps) -> None:
            march.take(solved)
            if self._may_lock:
                march.locked += self._locked(solved)
            if self.stepper.friction and solved.numbers[-1] > steps - judged:
                first = int(np.searchsorted(solved.numbers, steps - judged, side="right"))
                self._judge(march, solved.between(first, len(solved)))
            observe(solved, march)

        self._run(steps, [march], take, lambda step: report(step, steps))
        if self.failures:
            failure = self.failures.pop(0)
            failure.partial = march
            raise failure
        return march

    def together(self, steps: int, period: int = 0) -> list[March]:
        """March all runs, `steps` steps from step 0, all of which are kept; those in `failures` end before a step
        without solution. `period`, Ctrl-C and MemoryEnded: as of `run`."""
        marches = [March(each.friction, each.dynamic.stiffness, steps + 1, period) for each in self.batch.steppers]
        self._run(steps, marches, lambda run, solved: marches[run].take(solved), lambda step: None)
        return marches

    def _run(self, steps: int, marches: list[March], take: Take, report: Report) -> None:
        begun = time.perf_counter()
        ended = False
        inert = self.stepper.dynamic.inert and self.stepper.friction
        try:
            # Systems of a few dozen unknowns: threads that wait for one another cost up to forty times what they save.
            with march_with_inertia() if inert else nullcontext(), thread_pools().limit(limits=1):
                self._go_through(steps, marches, take, report)
        except KeyboardInterrupt:
            for march in marches:
                march.interrupted = True
        except MemoryError:
            # Raised below, where nothing holds what the failed call held.
            ended = True
        finally:
            for march in marches:
                march.seconds = (time.perf_counter() - begun) / len(marches)
        if ended:
            raise MemoryEnded(f"at step {marches[0].steps + 1} of {steps}", marches[0])

    def _go_through(self, steps: int, marches: list[March], take: Take, report: Report) -> None:
        """Solve all steps, block by block."""
        lasts = self._with_room(self.start, marches)
        first = 1
        if not steps:
            for run, last in lasts.items():
                take(run, Steps.of([last]))

        def block() -> tuple[dict[int, Record], int]:
            end = self._end_of_block(first, steps)
            return self._block(lasts, range(first, end), take, report), end

        while lasts and first <= steps:
            lasts, first = self._with_room(block, marches)
        if lasts:
            report(steps)

    def _with_room(self, solve: Callable[[], Solved], marches: list[March]) -> Solved:
        """What `solve` returns; where memory ends before the march takes a step of it, with fewer operators kept.
        Raises MemoryError where there are none, or for several marches."""
        while True:
            before = marches[0].latest
            try:
                return solve()
            except MemoryError:
                if len(marches) > 1 or marches[0].latest is not before:
                    raise
            # Not within the handler, which would hold what the failed call held.
            if not self.cycle.give_up():
                raise MemoryError

    def start(self) -> dict[int, Record]:
        """The first step of each run that has one: static equilibrium at step 0, with friction after a step in balance
        after long sliding; with inertia as of `Stepper.started`."""
        stepper = self.stepper
        inert = stepper.dynamic.inert
        runs = range(len(self.batch.steppers))
        self.failures.clear()
        stepper.begin_anew()
        # Without friction a position at rest depends on no other.
        block = self.batch.at_rest(-1 if inert or stepper.friction else 0, 2 if inert else 1)
        self._solve(block, runs, lambda step: None)
        first_records: dict[int, Record] = {}
        for run in [run for run in runs if run not in self.failures]:
            records = [block.record(run, at) for at in range(1, block.length)]
            try:
                first_records[run] = self.batch.alone(run).started(*records) if inert else records[-1]
            except ContactNotConverged as failure:
                self.failures[run] = failure.with_traceback(None)
        return first_records

    def _end_of_block(self, first: int, steps: int) -> int:
        """Number of the step after the last of the block that begins with `first`: whole mesh cycles, or equal parts of
        one, but at the end; of several runs all steps are in a block."""
        if self.batch.opened is not None:
            return steps + 1
        cycle = self.cycle.steps
        # Positions of a block are held together, also those that are not kept; the sets of the mesh cycle before, or of
        # meshes that others follow, are known when it begins.
        most = min(LONGEST_BLOCK, self.stepper.sets.period) if self.cycle.traits.repeats else LONGEST_BLOCK
        longest = int(min(most, max(SHARE_OF_A_BLOCK * self.cycle.kept.most / self._bytes, 1.0)))
        length = cycle * (longest // cycle) or ceil(cycle / ceil(cycle / longest))
        left_of_cycle = cycle - (first - 1) % cycle
        return min(first + (length if length >= cycle else min(length, left_of_cycle)), steps + 1)

    @cached_property
    def _bytes(self) -> int:
        """Of a position, which may have to be built for this."""
        return self.cycle.position(0).bytes

    def _block(self, lasts: dict[int, Record], numbers: range, take: Take, report: Report) -> dict[int, Record]:
        """Solve the steps `numbers` of each run from its last one; those before a failure or Ctrl-C are taken too. With
        the first of all the start is taken."""
        block = self.batch.after(lasts, numbers)
        taken = 0 if numbers[0] == 1 else 1
        try:
            self._begin(block)
            self._solve(block, list(lasts), report)
        finally:
            for number, run in enumerate(lasts):
                if block.done[number] > taken:
                    take(run, block.of(number, taken))
        ends = {run: block.record(number, block.length - 1) for number, run in enumerate(lasts)}
        return {run: end for run, end in ends.items() if run not in self.failures}

    def _solve(self, block: Block, runs: Sequence[int], report: Report) -> None:
        """Solve a block, whose courses are those of runs, as far as there are solutions."""
        last = None
        for end in range(2, block.length + 1) if self.batch.takes_turns else (block.length,):
            last = None
            for number, run in enumerate(runs):
                if run in self.failures:
                    continue
                if self.batch.takes_turns:
                    self._begin_as_before(block, number, last, end - 1)
                try:
                    self._solve_course(block, number, end, report)
                except ContactNotConverged as failure:
                    self.failures[run] = failure.with_traceback(None)
                else:
                    last = number
        if last is not None:
            block.remember(last)

    def _begin_as_before(self, block: Block, number: int, last: int | None, at: int) -> None:
        """Have a step begin with the sets of its run a mesh cycle before or, without friction, with those of the `last`
        run there."""
        if at >= self.cycle.steps:
            block.begin(number, at, block.sets(number, at - self.cycle.steps))
        elif last is not None and not self.stepper.friction:
            block.begin(number, at, block.sets(last, at))

    def _solve_course(self, block: Block, number: int, end: int, report: Report) -> None:
        """Solve a course to before its place `end`; the later half of steps at rest by a second thread."""
        middle = block.middle(number, end)
        if middle < end:
            with at_once(block.solve_on, number, middle, end) as later:
                self._solve_until(block, number, middle, report)
                block.done[number] = later()
        self._solve_until(block, number, end, report)

    def _begin(self, block: Block) -> None:
        """Solve steps with friction at new positions without it, by two threads: rows of the compliance are formed, and
        sets near theirs are known."""
        smooth = self.batch.without_friction(block)
        middle = 0 if smooth is None else smooth.middle(0, smooth.length)
        if smooth is not None and middle < smooth.length:
            with at_once(smooth.solve_on, 0, middle, smooth.length) as later:
                smooth.solve_on(0, 1, middle, Event())
                later()

    def _solve_until(self, block: Block, number: int, end: int, report: Report) -> None:
        while block.done[number] < end:
            begun = time.perf_counter()
            first = block.done[number]
            block.solve(number, min(first + self._at_once, end))
            # Ctrl-C is heard between two calls.
            seconds = max(time.perf_counter() - begun, 1e-6)
            self._at_once = max(int((block.done[number] - first) * SECONDS_BETWEEN_REPORTS / seconds), 1)
            self._report(report, int(block.steps.numbers[number * block.length + block.done[number] - 1]))

    def _report(self, report: Report, step: int) -> None:
        now = time.perf_counter()
        if now - self._reported > SECONDS_BETWEEN_REPORTS:
            report(step)
            self._reported = now

    def _locked(self, solved: Steps) -> list[int]:
        """The steps at which friction at a closed node cancels more of the load than its normal force holds."""
        # Of few runs.
        from fenics_gears.contact.existence import locks

        wheels = np.array(self.stepper.drivetrain.ends)

        def is_locked(record: Record) -> bool:
            # Within a train torque reaches a wheel through those behind it; power goes from pinions to wheels.
            senses = np.sign(wheels @ self.stepper.load(record.step)) if len(wheels) == 1 else np.ones(len(wheels))
            motions = senses[:, None] * wheels
            return locks(record.position.operator, record.solution.forces, motions, record.position.of_wheels)

        return [int(record.step) for record in solved.records if record.step > 0 and is_locked(record)]

    def _judge(self, march: March, steps: Steps) -> None:
        # Imported here: runs without friction have none of it.
        from fenics_gears.contact.uniqueness import uncertified

        march.judged += len(steps)
        march.uncertified += uncertified(march.stiffness, march.friction, steps.solved)
