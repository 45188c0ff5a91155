"""The march through time: one contact step after another, in blocks, from static equilibrium at the start."""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Callable
from contextlib import nullcontext
from dataclasses import dataclass, field
from functools import cache, cached_property
from itertools import compress
from math import ceil

import numpy as np
from threadpoolctl import ThreadpoolController

from fenics_gears.contact.addresses import march_with_inertia
from fenics_gears.contact.errors import ContactNotConverged
from fenics_gears.contact.mesh_cycle import SHARE_OF_A_BLOCK, Cycle
from fenics_gears.contact.step_solver import METHODS, NEWTON
from fenics_gears.contact.tooth_pair import DRIVE
from fenics_gears.errors import MemoryEnded

from .average_acceleration import AverageAcceleration
from .compiled_march import AVERAGE_ACCELERATION, BACKWARD_EULER, STATIC, Course, Motion, solve_steps
from .stepping import EquationsOfMotion, Stepper
from .steps import Record, Steps, drive_flanks_touch, smallest_openings

SECONDS_BETWEEN_REPORTS = 0.1
# Steps are handed on in blocks of at most so many; those of a cycle's own solver can take a tenth of a second each.
LONGEST_BLOCK, LONGEST_BLOCK_OF_OWN_SOLVER = 512, 32


@dataclass
class March:
    """A march so far.

    `kept`: the last steps; `period`: of the last two times as many steps the solutions are held (`held`);
    `newton_iterations`: of every step from 1 on; `steps_by_method`: how many steps each of `METHODS` solved;
    `separations`: step and smallest opening (mm) of every step without contact of drive flanks; `locked`: steps at
    which friction locks a closed node (`contact.existence`); `uncertified`: how many of the `judged` last steps may
    have more than one solution (`contact.uniqueness`); `interrupted`: stopped by the user. `friction` and `stiffness`,
    the effective one (k, k), N/mm: of every step.
    """

    friction: float
    stiffness: np.ndarray

    kept: int = 0
    period: int = 0
    newton_iterations: int = 0
    steps: int = 0
    steps_by_method: dict[str, int] = field(default_factory=lambda: dict.fromkeys(METHODS, 0))
    separations: list[tuple[int, float]] = field(default_factory=list)
    locked: list[int] = field(default_factory=list)
    judged: int = 0
    uncertified: int = 0
    interrupted: bool = False
    seconds: float = 0.0
    _held: list[Steps] = field(default_factory=list)
    _last: list[Steps] = field(default_factory=list)

    def take(self, solved: Steps) -> None:
        """Count the next steps, and keep them if they are among the last `kept`."""
        self._last.append(solved)
        while sum(map(len, self._last[1:])) >= self.kept:
            del self._last[0]
        moved = solved.numbers > 0
        self.steps, self.newton_iterations = (
            int(solved.numbers[-1]),
            self.newton_iterations + int(solved.iterations[moved].sum()),
        )
        for method, count in Counter(compress(solved.methods, moved)).items():
            self.steps_by_method[method] += count
        if self.period:
            self._hold(solved)
        apart = np.flatnonzero(~drive_flanks_touch(solved) & moved)
        if len(apart):
            openings = smallest_openings(solved)[apart, DRIVE]
            self.separations += list(zip(solved.numbers[apart].astype(int).tolist(), openings.tolist()))

    def _hold(self, solved: Steps) -> None:
        self._held = [steps for steps in self._held if steps.numbers[-1] > self.steps - 2 * self.period]
        # Contact operators take a hundred times the memory.
        self._held.append(solved.without_operators())

    def held(self, step: int) -> Record | None:
        """A step without its position, where its solution is held."""
        for steps in self._held:
            place = int(np.searchsorted(steps.numbers, step))
            if place < len(steps) and steps.numbers[place] == step:
                return steps.record(place)
        return None

    @property
    def latest(self) -> Steps | None:
        """The steps taken last."""
        return self._last[-1] if self._last else None

    @cached_property
    def records(self) -> list[Record]:
        """The last steps, as many as are kept."""
        return [record for steps in self._last for record in steps.records][-self.kept :]


@cache
def thread_pools() -> ThreadpoolController:
    """The libraries with threads that are loaded as the first march begins: to find them takes milliseconds."""
    return ThreadpoolController()


class Marcher(Stepper):
    """Steps the equations of motion with the contact of a `cycle` through time; `plain`: every step by itself, in
    Python."""

    def __init__(self, cycle: Cycle, equations: EquationsOfMotion, plain: bool = False):
        super().__init__(cycle, equations)
        self.plain = plain or self.drivetrain.rolling is not None
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
        last, first = self.with_room(self.start, lambda: march.latest), 1
        if not steps:
            take(Steps.of([last]))
        blocks = self._plain_block if self.plain or self.cycle.traits.own_solver else self._compiled_block

        def block() -> tuple[Record, int]:
            end = self._end_of_block(first, steps)
            return blocks(last, range(first, end), take, report), end

        while first <= steps:
            last, first = self.with_room(block, lambda: march.latest)
        report(steps)

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
        durations, known = np.zeros(len(steps)), self.all_known_before(steps.numbers.tolist(), np.diff(steps.starts))
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

    def _report(self, report: Callable[[int], None], step: int) -> None:
        now = time.perf_counter()
        if now - self._reported > SECONDS_BETWEEN_REPORTS:
            report(step)
            self._reported = now

    def _locks(self, record: Record) -> bool:
        """Whether friction at a closed node cancels more of the load than its normal force holds."""
        from fenics_gears.contact.existence import locks

        wheel = self.drivetrain.coordinates.index("rotation_2")
        return locks(record.position.operator, record.solution.forces, wheel, self.load(record.step)[wheel])

    def _judge(self, march: March, steps: Steps) -> None:
        from fenics_gears.contact.uniqueness import uncertified

        found = uncertified(march.stiffness, march.friction, steps.solved)
        march.judged, march.uncertified = march.judged + len(steps), march.uncertified + found
