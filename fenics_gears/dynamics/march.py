"""The march through time: one contact step after another, in blocks, from static equilibrium at the start."""

from __future__ import annotations

import time
from collections.abc import Callable
from contextlib import nullcontext
from functools import cache
from math import ceil
from typing import TypeVar

import numpy as np
from threadpoolctl import ThreadpoolController

from fenics_gears.contact.addresses import march_with_inertia
from fenics_gears.contact.errors import ContactNotConverged
from fenics_gears.contact.mesh_cycle import SHARE_OF_A_BLOCK, Cycle
from fenics_gears.contact.step_solver import NEWTON
from fenics_gears.errors import MemoryEnded

from .average_acceleration import AverageAcceleration
from .compiled_march import AVERAGE_ACCELERATION, BACKWARD_EULER, NO_SETS, STATIC, Course, Motion, solve_steps
from .march_so_far import March
from .stepping import EquationsOfMotion, Stepper
from .steps import Record, Steps

SECONDS_BETWEEN_REPORTS = 0.1
Solved = TypeVar("Solved")
# Steps are handed on in blocks of at most so many; those of a cycle's own solver can take a tenth of a second each.
LONGEST_BLOCK, LONGEST_BLOCK_OF_OWN_SOLVER = 512, 32


@cache
def thread_pools() -> ThreadpoolController:
    """The libraries with threads that are loaded as the first march begins: to find them takes milliseconds."""
    return ThreadpoolController()


class Marcher(Stepper):
    """Steps the equations of motion with the contact of a `cycle` through time; `plain`: every step by itself, in
    Python."""

    def __init__(self, cycle: Cycle, equations: EquationsOfMotion, plain: bool = False):
        super().__init__(cycle, equations)
        self.plain = plain
        # Friction's lever arm is longest at the wheel's tip; with a smaller coefficient it never outweighs the normal
        # force there.
        self._may_lock = self.friction > 0.0 and self.friction * cycle.pair.wheel.tip_roll_angle >= 1.0
        method = AVERAGE_ACCELERATION if isinstance(self.dynamic, AverageAcceleration) else BACKWARD_EULER
        self._motion = Motion.of(
            self.drivetrain, method if self.dynamic.inert else STATIC, self.friction, self.tolerance, cycle.traits.rigid
        )
        # Steps in a call of compiled code, which lasts until the next report as soon as it is known how long a step
        # takes.
        self._at_once, self._reported = 1, 0.0

    def run(
        self,
        steps: int,
        kept: int,
        report: Callable[[int, int], None] | None = None,
        observe: Callable[[Steps, March], None] | None = None,
        judged: int = 0,
        period: int = 0,
    ) -> March:
        """March `steps` steps from step 0 and keep the last `kept` records, wherever the march ends; `observe` is
        called with blocks of steps and the march so far.

        `judged`: of so many last steps it is judged whether friction leaves more than one solution. `period`: steps
        after which they repeat, of which the solutions are kept.

        Ctrl-C ends the march and keeps what was done. Raises ContactNotConverged and MemoryEnded, whose `partial` is
        the March so far.
        """
        inert = march_with_inertia() if self.dynamic.inert and self.friction else nullcontext()
        with inert, thread_pools().limit(limits=1):
            # Systems of a few dozen unknowns: threads that wait for one another cost up to forty times what they save.
            march = March(self.friction, self.dynamic.stiffness, kept, period)
            return self._run(
                steps, march, report or (lambda step, steps: None), observe or (lambda solved, march: None), judged
            )

    def _run(
        self,
        steps: int,
        march: March,
        report: Callable[[int, int], None],
        observe: Callable[[Steps, March], None],
        judged: int,
    ) -> March:
        begun = time.perf_counter()

        def take(solved: Steps) -> None:
            march.take(solved)
            if self._may_lock:
                march.locked += [
                    int(record.step) for record in solved.records if record.step > 0 and self._locks(record)
                ]
            if self.friction and solved.numbers[-1] > steps - judged:
                self._judge(
                    march,
                    solved.between(int(np.searchsorted(solved.numbers, steps - judged, side="right")), len(solved)),
                )
            observe(solved, march)

        ended = False
        try:
            self._go_through(steps, march, take, lambda step: report(step, steps))
        except KeyboardInterrupt:
            march.interrupted = True
        except ContactNotConverged as failure:
            failure.partial = march
            raise
        except MemoryError:
            # Raised below, where nothing holds what the failed call held.
            ended = True
        finally:
            march.seconds = time.perf_counter() - begun
        if ended:
            raise MemoryEnded(f"at step {march.steps + 1} of {steps}", march)
        return march

    def _go_through(
        self, steps: int, march: March, take: Callable[[Steps], None], report: Callable[[int], None]
    ) -> None:
        """Solve all steps, block by block."""
        last, first = self._with_room(self.start, march), 1
        if not steps:
            take(Steps.of([last]))
        blocks = self._plain_block if self.plain or self.cycle.traits.own_solver else self._compiled_block

        def block() -> tuple[Record, int]:
            end = self._end_of_block(first, steps)
            return blocks(last, range(first, end), take, report), end

        while first <= steps:
            last, first = self._with_room(block, march)

    def _with_room(self, solve: Callable[[], Solved], march: March) -> Solved:
        """What `solve` returns; where memory ends before a step of it is taken, with fewer operators kept. Raises
        MemoryError where there are none."""
        while True:
            latest = march.latest
            try:
                return solve()
            except MemoryError:
                if march.latest is not latest:
                    raise
            # Not within the handler, which would hold what the failed call held.
            if not self.cycle.give_up():
                raise MemoryError

    def _end_of_block(self, first: int, steps: int) -> int:
        """Number of the step after the last of the block that begins with `first`: whole mesh cycles, or equal parts of
        one, but at the end."""
        cycle = self.cycle.steps
        # Positions of a block are held together, also those that are not kept.
        most = LONGEST_BLOCK_OF_OWN_SOLVER if self.cycle.traits.own_solver else LONGEST_BLOCK
        if self.cycle.traits.repeats:
            # The sets of the mesh cycle before are known when a block begins.
            most = min(most, cycle)
        longest = int(min(most, max(SHARE_OF_A_BLOCK * self.cycle.kept.most / self.cycle.position(0).bytes, 1.0)))
        length = cycle * (longest // cycle) or ceil(cycle / ceil(cycle / longest))
        left_of_cycle = cycle - (first - 1) % cycle
        return min(first + (length if length >= cycle else min(length, left_of_cycle)), steps + 1)

    def _plain_block(
        self, last: Record, numbers: range, take: Callable[[Steps], None], report: Callable[[int], None]
    ) -> Record:
        """Solve the steps `numbers` from the record `last` one by one; `take` gets them, also those before a failure or
        Ctrl-C. With the first of all it gets the start of the march."""
        records = [last] if numbers[0] == 1 else []
        try:
            for step in numbers:
                last = self.step(self.scheme(step), last, step)
                records.append(last)
                self._report(report, step)
        finally:
            if records:
                take(Steps.of(records))
        return last

    def _compiled_block(
        self, last: Record, numbers: range, take: Callable[[Steps], None], report: Callable[[int], None]
    ) -> Record:
        """As `_plain_block`, many steps in each call of compiled code; steps that Newton's method does not solve at
        once are plain ones."""
        self.cycle.build(numbers)
        positions = [last.position, *map(self.cycle.position, numbers)]
        steps = Steps.to_solve([last.step, *numbers], positions, len(self.drivetrain.coordinates), NEWTON)
        steps.put(0, last)
        durations, known = np.zeros(len(steps)), self._all_known_before(steps)
        if self._motion.method != STATIC:
            durations[1:] = self.clock.durations(np.arange(numbers[0] - 1, numbers[-1] + 1))
        loads = (
            np.array([self.load(step) for step in (numbers[0], *numbers)])
            if self.loads
            else np.tile(self.drivetrain.load, (len(steps), 1))
        )
        course, done = Course(durations, loads, known, self.at_rest), 1
        try:
            while done < len(steps):
                begun, end = time.perf_counter(), min(done + self._at_once, len(steps))
                solved = solve_steps(steps, done, end, self._motion, course)
                seconds = time.perf_counter() - begun
                if solved == end:
                    # Ctrl-C is heard between two calls.
                    self._at_once = max(int((end - done) * SECONDS_BETWEEN_REPORTS / max(seconds, 1e-6)), 1)
                for place in range(done, solved) if self.remembers else ():
                    self.remember(numbers[place - 1], steps.status[steps.starts[place] : steps.starts[place + 1]])
                done = solved
                if done < end:
                    step = numbers[done - 1]
                    steps.put(done, self.step(self.scheme(step), steps.record(done - 1), step))
                    done += 1
                self._report(report, numbers[done - 2])
        finally:
            taken = 0 if numbers[0] == 1 else 1
            if done > taken:
                take(steps.between(taken, done))
        return steps.record(done - 1)

    def _all_known_before(self, steps: Steps) -> np.ndarray:
        """The sets (N,) that are known of the positions of some steps, -1 where they are not; none where all are
        unknown."""
        known = [self.known_before(step) for step in steps.numbers.tolist()] if self.remembers else []
        if not any(map(len, known)):
            return NO_SETS
        counts = np.diff(steps.starts)
        return np.concatenate(
            [sets if len(sets) else np.full(nodes, -1, dtype=np.int8) for sets, nodes in zip(known, counts)]
        )

    def _report(self, report: Callable[[int], None], step: int) -> None:
        now = time.perf_counter()
        if now - self._reported > SECONDS_BETWEEN_REPORTS:
            report(step)
            self._reported = now

    def _locks(self, record: Record) -> bool:
        """Whether friction at a closed node cancels more of the load than its normal force holds."""
        motion = np.zeros(len(self.drivetrain.coordinates))
        wheel = self.drivetrain.coordinates.index("rotation_2")
        motion[wheel] = np.sign(self.load(record.step)[wheel])
        from fenics_gears.contact.existence import locked_nodes, working

        return bool(locked_nodes(working(record.position.operator.jacobian, motion, record.solution.forces)).any())

    def _judge(self, march: March, steps: Steps) -> None:
        from fenics_gears.contact.uniqueness import uncertified

        found = uncertified(march.stiffness, march.friction, steps.solved)
        march.judged, march.uncertified = march.judged + len(steps), march.uncertified + found
