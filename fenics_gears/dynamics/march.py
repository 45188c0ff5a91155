"""The march through time: one contact step after another, from static equilibrium at the start."""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from functools import cache, cached_property
from math import ceil
from typing import TYPE_CHECKING

import numpy as np
from threadpoolctl import ThreadpoolController

from fenics_gears.contact.errors import ContactNotConverged, NoStaticEquilibrium
from fenics_gears.contact.existence import locked_nodes, working
from fenics_gears.contact.laws import Tolerance
from fenics_gears.contact.mesh_cycle import SHARE_OF_A_BLOCK, Cycle, Position
from fenics_gears.contact.step_solver import HALVED, METHODS, NEWTON, StepProblem, StepSolution, cold_start
from fenics_gears.contact.tooth_pair import DRIVE
from fenics_gears.dynamics.average_acceleration import AverageAcceleration, State
from fenics_gears.dynamics.clock import Clock, SteadyClock
from fenics_gears.dynamics.compiled_march import AVERAGE_ACCELERATION, BACKWARD_EULER, STATIC, Motion, slip_at_start, solve_steps
from fenics_gears.dynamics.drivetrain import Drivetrain
from fenics_gears.dynamics.steps import Record, Steps, drive_flanks_touch, smallest_openings
from fenics_gears.dynamics.time_scales import FOLLOWING, TimeScales

if TYPE_CHECKING:
    from fenics_gears.dynamics.backward_euler import BackwardEuler

SECONDS_BETWEEN_REPORTS = 0.1
NO_SLIP = np.empty(0)
# The start assumes long sliding before it, by this many steps.
STEPS_SLID_BEFORE_START = 1e6
# What acts on the centre coordinates besides the constant load: forces (k,), N, at a step.
VaryingLoad = Callable[[float], np.ndarray]
# A step is divided in two at most this often: the shortest part is 1/64 of a step.
MOST_HALVINGS = 6
# Steps are handed on in blocks of at most so many.
LONGEST_BLOCK = 512


@dataclass(frozen=True)
class EquationsOfMotion:
    """The motion that a march solves for: a drivetrain in steps of `time_step` (s), the longest; `friction` 0 where the scene has none.

    `time_scales`: how mesh and step compare with the drivetrain's vibrations; they decide on the method in time and on the start.
    `clock`: when a step is, every `time_step` unless given; `loads`: forces that vary, besides the drivetrain's own.
    """

    drivetrain: Drivetrain
    time_step: float
    friction: float = 0.0
    time_scales: TimeScales = FOLLOWING
    clock: Clock | None = None
    loads: tuple[VaryingLoad, ...] = ()


@dataclass
class March:
    """A march so far.

    `kept`: the last steps; `newton_iterations`: of every step from 1 on; `steps_by_method`: how many steps each of `METHODS` solved;
    `separations`: step and smallest opening (mm) of every step without contact of drive flanks; `locked`: steps at which friction
    locks a closed node (`contact.existence`); `uncertified`: how many of the `judged` last steps may have more than one solution
    (`contact.uniqueness`); `interrupted`: stopped by the user. `friction` and `stiffness`, the effective one (k, k), N/mm: of every step.
    """

    friction: float
    stiffness: np.ndarray

    kept: int = 0
    newton_iterations: int = 0
    steps: int = 0
    steps_by_method: dict[str, int] = field(default_factory=lambda: dict.fromkeys(METHODS, 0))
    separations: list[tuple[int, float]] = field(default_factory=list)
    locked: list[int] = field(default_factory=list)
    judged: int = 0
    uncertified: int = 0
    interrupted: bool = False
    seconds: float = 0.0
    _last: list[Steps] = field(default_factory=list)

    def take(self, solved: Steps) -> None:
        """Count the next steps, and keep them if they are among the last `kept`."""
        self._last.append(solved)
        while sum(map(len, self._last[1:])) >= self.kept:
            del self._last[0]
        moved = solved.numbers > 0
        self.steps, self.newton_iterations = int(solved.numbers[-1]), self.newton_iterations + int(solved.iterations[moved].sum())
        for method, count in Counter(method for method, counts in zip(solved.methods, moved) if counts).items():
            self.steps_by_method[method] += count
        apart = np.flatnonzero(~drive_flanks_touch(solved) & moved)
        if len(apart):
            openings = smallest_openings(solved)[apart, DRIVE]
            self.separations += list(zip(solved.numbers[apart].astype(int).tolist(), openings.tolist()))

    @cached_property
    def records(self) -> list[Record]:
        """The last steps, as many as are kept."""
        return [record for steps in self._last for record in steps.records][-self.kept :]


def _method(time_scales: TimeScales) -> type[AverageAcceleration] | type[BackwardEuler]:
    """The method in time; quasi-static scenes, which average acceleration, do not import the other."""
    if time_scales.averages_acceleration:
        return AverageAcceleration
    from fenics_gears.dynamics.backward_euler import BackwardEuler

    return BackwardEuler


@cache
def _thread_pools() -> ThreadpoolController:
    """The libraries with threads that are loaded as the first march begins: to find them takes milliseconds."""
    return ThreadpoolController()


class Marcher:
    """Steps the equations of motion with the contact of a `cycle` through time; `plain`: every step by itself, in Python."""

    def __init__(self, cycle: Cycle, equations: EquationsOfMotion, plain: bool = False):
        drivetrain, time_step, friction = equations.drivetrain, equations.time_step, equations.friction
        self.cycle, self.drivetrain, self.time_step, self.friction = cycle, drivetrain, time_step, friction
        self.clock, self.loads = equations.clock or SteadyClock(time_step), equations.loads
        self.dynamic = _method(equations.time_scales)(drivetrain, time_step)
        self._static_drivetrain = replace(drivetrain, mass=None, damping=None)
        self.static = AverageAcceleration(self._static_drivetrain, time_step)
        varying = [load(step) for load in self.loads for step in range(cycle.steps)]
        self.tolerance = Tolerance.of_load(float(np.abs([drivetrain.load, *varying]).max()))
        self._free_motion, self._free_words = drivetrain.free_motion, drivetrain.free_words
        # Friction's lever arm is longest at the wheel's tip; with a smaller coefficient it never outweighs the normal force there.
        self._may_lock = friction > 0.0 and friction * cycle.pair.wheel.tip_roll_angle >= 1.0
        self._time_scales, self.plain = equations.time_scales, plain
        method = AVERAGE_ACCELERATION if isinstance(self.dynamic, AverageAcceleration) else BACKWARD_EULER
        self._motion = Motion.of(drivetrain, method if self.dynamic.inert else STATIC, friction, self.tolerance)
        # Steps in a call of compiled code, which lasts until the next report as soon as it is known how long a step takes.
        self._at_once, self._reported = 1, 0.0

    def run(
        self,
        steps: int,
        kept: int,
        report: Callable[[int, int], None] | None = None,
        observe: Callable[[Steps], None] | None = None,
        judged: int = 0,
    ) -> March:
        """March `steps` steps from step 0 and keep the last `kept` records, wherever the march ends; `observe` is called with blocks of steps.

        `judged`: of so many last steps it is judged whether friction leaves more than one solution.

        Ctrl-C ends the march and keeps what was done. Raises ContactNotConverged, whose `partial` is the March so far.
        """
        with _thread_pools().limit(limits=1):
            # Systems of a few dozen unknowns: threads that wait for one another cost up to forty times what they save.
            return self._run(steps, kept, report or (lambda step, steps: None), observe or (lambda solved: None), judged)

    def _run(self, steps: int, kept: int, report: Callable[[int, int], None], observe: Callable[[Steps], None], judged: int) -> March:
        march, begun = March(self.friction, self.dynamic.stiffness, kept), time.perf_counter()

        def take(solved: Steps) -> None:
            march.take(solved)
            if self._may_lock:
                march.locked += [int(record.step) for record in solved.records if record.step > 0 and self._locks(record)]
            if self.friction and solved.numbers[-1] > steps - judged:
                self._judge(march, solved.between(int(np.searchsorted(solved.numbers, steps - judged, side="right")), len(solved)))
            observe(solved)

        try:
            last = self.start()
            take(Steps.of([last]))
            blocks = self._plain_block if self.plain or self.cycle.traits.own_solver else self._compiled_block
            for first, end in self._blocks(steps):
                last = blocks(last, range(first, end), take, lambda step: report(step, steps))
        except KeyboardInterrupt:
            march.interrupted = True
        except ContactNotConverged as failure:
            failure.partial = march
            raise
        finally:
            march.seconds = time.perf_counter() - begun
        return march

    def _blocks(self, steps: int) -> Iterator[tuple[int, int]]:
        """Numbers of the first step of each block and of the one after its last: whole mesh cycles, or equal parts of one, but at the end."""
        cycle = self.cycle.steps
        # Positions of a block are held together, also those that are not kept.
        longest = int(min(LONGEST_BLOCK, max(SHARE_OF_A_BLOCK * self.cycle.kept.most / self.cycle.position(0).bytes, 1.0)))
        length = cycle * (longest // cycle) or ceil(cycle / ceil(cycle / longest))
        first = 1
        while first <= steps:
            left_of_cycle = cycle - (first - 1) % cycle
            end = min(first + (length if length >= cycle else min(length, left_of_cycle)), steps + 1)
            yield first, end
            first = end

    def _plain_block(self, last: Record, numbers: range, take: Callable[[Steps], None], report: Callable[[int], None]) -> Record:
        """Solve the steps `numbers` from the record `last` one by one; `take` gets them, also those before a failure or Ctrl-C."""
        records: list[Record] = []
        try:
            for step in numbers:
                last = self.step(self.scheme(step), last, step)
                records.append(last)
                self._report(report, step)
        finally:
            if records:
                take(Steps.of(records))
        return last

    def _compiled_block(self, last: Record, numbers: range, take: Callable[[Steps], None], report: Callable[[int], None]) -> Record:
        """As `_plain_block`, many steps in each call of compiled code; steps that Newton's method does not solve at once are plain ones."""
        positions = [last.position, *(self.cycle.position(step) for step in numbers)]
        steps = Steps.to_solve([last.step, *numbers], positions, len(self.drivetrain.coordinates), NEWTON)
        steps.put(0, last)
        durations = np.array([self.clock.duration(step - 1, step) for step in (numbers[0], *numbers)])
        loads = np.array([self.load(step) for step in (numbers[0], *numbers)]) if self.loads else np.tile(self.drivetrain.load, (len(steps), 1))
        done = 1
        try:
            while done < len(steps):
                begun, end = time.perf_counter(), min(done + self._at_once, len(steps))
                solved = solve_steps(steps, done, end, self._motion, durations, loads)
                seconds = time.perf_counter() - begun
                if solved == end:
                    # Ctrl-C is heard between two calls.
                    self._at_once = max(int((end - done) * SECONDS_BETWEEN_REPORTS / max(seconds, 1e-6)), 1)
                done = solved
                if done < end:
                    step = numbers[done - 1]
                    steps.put(done, self.step(self.scheme(step), steps.record(done - 1), step))
                    done += 1
                self._report(report, numbers[done - 2])
        finally:
            if done > 1:
                take(steps.between(1, done))
        return steps.record(done - 1)

    def _report(self, report: Callable[[int], None], step: int) -> None:
        now = time.perf_counter()
        if now - self._reported > SECONDS_BETWEEN_REPORTS:
            report(step)
            self._reported = now

    def scheme(self, step: int) -> AverageAcceleration | BackwardEuler:
        """The method over the step that ends at `step`; made anew where that step is not as long as the one before."""
        duration = self.clock.duration(step - 1, step)
        if duration != self.dynamic.step:
            self.dynamic = type(self.dynamic)(self.drivetrain, duration)
        return self.dynamic

    def load(self, step: float) -> np.ndarray:
        """All forces (k,), N, on the centre coordinates at `step`."""
        return sum((load(step) for load in self.loads), self.drivetrain.load)

    def start(self) -> Record:
        """Static equilibrium at step 0; velocity from the static solutions on either side; acceleration from the equations of motion.

        With a mesh frequency above the lowest of the drivetrain the gears cannot follow: they start at rest in the frame of the nominal
        motion, so as not to part at once. Above the highest they start where the forces of a whole cycle balance.
        """
        neighbours = [self._static_start(-1)]
        for step in (0, 1) if self.dynamic.inert else (0,):
            neighbours.append(self.step(self.static, neighbours[-1], step))
        middle = neighbours[1]
        if not self.dynamic.inert:
            return middle
        if self._time_scales.outruns_vibration:
            return self._mean_start(middle)
        velocity = np.zeros(len(self.drivetrain.coordinates))
        if self._time_scales.follows_statics:
            velocity = (neighbours[2].state.position - neighbours[0].state.position) / self.clock.duration(-1, 1)
        # At static equilibrium the springs, the load and the contact balance; damping alone is left to accelerate.
        damping = self.drivetrain.damping
        acceleration = np.zeros_like(velocity)
        if damping is not None:
            acceleration = -np.linalg.solve(self.drivetrain.mass, damping @ velocity)
        return Record(0, State(middle.state.position, velocity, acceleration), middle.position, middle.solution)

    def _mean_start(self, static: Record) -> Record:
        from fenics_gears.dynamics.mean_equilibrium import mean_equilibrium

        mean = mean_equilibrium(
            self.cycle, self.drivetrain, self.clock.duration(0, 1), self.friction, self.tolerance, static.state.position,
            STEPS_SLID_BEFORE_START, self.load,
        )  # fmt: skip
        drivetrain, jacobian = self.drivetrain, static.position.operator.jacobian
        left = self.load(0) - drivetrain.stiffness @ mean.position - jacobian.T @ mean.solution.forces
        if drivetrain.damping is not None:
            left = left - drivetrain.damping @ mean.velocity
        state = State(mean.position, mean.velocity, np.linalg.solve(drivetrain.mass, left))
        return Record(0, state, static.position, mean.solution)

    def step(self, scheme: AverageAcceleration | BackwardEuler, last: Record, step: int) -> Record:
        """One step of `scheme` from `last`, divided where the whole step has no solution."""
        try:
            return self._part(scheme, last, step, self.cycle.position(step))
        except ContactNotConverged as failure:
            # Without friction a static solution does not depend on the way to it.
            depends_on_way = scheme.inert or self.friction > 0.0
            if not (depends_on_way and self.cycle.traits.divisible) or isinstance(failure, NoStaticEquilibrium):
                raise
            try:
                return self._divided(scheme, last, step, failure, 1)
            except ContactNotConverged as last_failure:
                _, _, history, sets = last_failure.attempts[-1]
                words = f"no solution at {last_failure.step:.6g} with a step {2**MOST_HALVINGS} times as short"
                failure.attempts.append((HALVED, words, history, sets))
                raise failure from last_failure

    def _divided(self, scheme: AverageAcceleration, last: Record, step: float, failure, halvings: int) -> Record:
        """From `last` to `step` in two halves, either divided again where it fails; raises the `failure` of the shortest."""
        if halvings > MOST_HALVINGS:
            raise failure
        record, parts = last, ()
        drivetrain = self.drivetrain if scheme.inert else self._static_drivetrain
        for end in (0.5 * (last.step + step), step):
            finer = type(scheme)(drivetrain, self.clock.duration(record.step, end))
            try:
                record = self._part(finer, record, end, self.cycle.between(end, record.step))
            except ContactNotConverged as failed:
                record = self._divided(finer, record, end, failed, halvings + 1)
            parts += record.parts or (record,)
        iterations = sum(part.solution.iterations for part in parts)
        return replace(record, solution=replace(record.solution, iterations=iterations, method=HALVED), parts=parts)

    def _part(self, scheme: AverageAcceleration, last: Record, step: float, position: Position) -> Record:
        """From `last` to `position` without dividing."""
        operator = position.operator
        slip_before = NO_SLIP
        if operator.rigid_slip is not None:
            # Rigid flanks have no compliance: zeros that are no array in one piece.
            compliance = np.ascontiguousarray(operator.previous_compliance)
            slip_before = slip_at_start(operator.rigid_slip, operator.previous_jacobian, compliance, last.state.position, last.solution.forces)
        carried = position.carried_from
        status = np.zeros(operator.nodes, dtype=np.int8)
        known = carried >= 0
        status[known] = last.solution.status[carried[known]]
        solution = self._solve(scheme, last.state, position, slip_before, status, step, last.solution)
        return Record(step, scheme.advance(last.state, solution.coordinates), position, solution)

    def _locks(self, record: Record) -> bool:
        """Whether friction at a closed node cancels more of the load than its normal force holds."""
        motion = np.zeros(len(self.drivetrain.coordinates))
        wheel = self.drivetrain.coordinates.index("rotation_2")
        motion[wheel] = np.sign(self.load(record.step)[wheel])
        return bool(locked_nodes(working(record.position.operator.jacobian, motion, record.solution.forces)).any())

    def _judge(self, march: March, steps: Steps) -> None:
        from fenics_gears.contact.uniqueness import uncertified

        found = uncertified(march.stiffness, march.friction, steps.solved)
        march.judged, march.uncertified = march.judged + len(steps), march.uncertified + found

    def _static_start(self, step: int) -> Record:
        position = self.cycle.position(step)
        operator = position.operator
        slip_before = NO_SLIP if operator.rigid_slip is None else STEPS_SLID_BEFORE_START * operator.rigid_slip
        rest = np.zeros(len(self.drivetrain.coordinates))
        status = cold_start(operator.gap, operator.node_pair)
        solution = self._solve(self.static, State(rest, rest, rest), position, slip_before, status, step)
        return Record(step, State(solution.coordinates, rest, rest), position, solution)

    def _solve(self, scheme, state: State, position: Position, slip_before, status, step: float, last=None) -> StepSolution:
        """The step of `scheme` from `state`, solved from the sets `status` (n,); `last`: the solution before, if there is one."""
        operator, load = position.operator, scheme.load(state, self.load(step))
        problem = StepProblem(
            scheme.stiffness, load, operator.compliance, operator.jacobian, operator.gap, slip_before,
            self.friction, self._moved_freely(scheme, load), self.tolerance, self._free_words,
        )  # fmt: skip
        try:
            return self.cycle.solve(position, problem, status, last)
        except ContactNotConverged as failure:
            failure.time, failure.step = self.clock.time(step), step
            raise

    def _moved_freely(self, scheme, load: np.ndarray) -> np.ndarray:
        """How a load (k,) moves the drivetrain where only contact holds it; a varying load may change its sign."""
        if scheme.inert or not len(self._free_motion):
            return np.empty(0)
        return -self._free_motion if self._free_motion @ load < 0.0 else self._free_motion
