"""One step of the motion in time: what `compiled_march` does for many steps, written to be read."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from math import ceil

import numpy as np

from fenics_gears.contact.errors import MOVES_FREELY, ContactNotConverged, NoStaticEquilibrium
from fenics_gears.contact.laws import Tolerance
from fenics_gears.contact.mesh_cycle import Cycle, in_common
from fenics_gears.contact.mixed_form import StepEquations
from fenics_gears.contact.operator import Position
from fenics_gears.contact.step_solver import HALVED, StepSolution, cold_start

from .clock import FOLLOWING, Clock, SteadyClock, TimeScales
from .compiled_march import (
    NO_SETS,
    Eliminated,
    Motion,
    begin,
    eliminated,
    left_load,
    moved_by_contact,
    slip_at_start,
    turned,
    with_modes,
)
from .drivetrain import Drivetrain
from .steps import Record
from .time_integration import AVERAGE_ACCELERATION, BACKWARD_EULER, Scheme, State

NO_SLIP = np.empty(0)
# The start assumes long sliding before it, by this many steps.
STEPS_SLID_BEFORE_START = 1e6
# What acts on the centre coordinates besides the constant load: forces (k,), N, at a step.
VaryingLoad = Callable[[float], np.ndarray]
# A step is divided in two at most this often: the shortest part is 1/64 of a step.
MOST_HALVINGS = 6


@dataclass(frozen=True)
class EquationsOfMotion:
    """The motion that a march solves for: a drivetrain in steps of `time_step` (s), the longest; `friction` 0 where the
    scene has none.

    `time_scales`: how mesh and step compare with the drivetrain's vibrations; they decide on the method in time and on
    the start.
    `clock`: when a step is, every `time_step` unless given; `loads`: forces that vary, besides the drivetrain's own.
    """

    drivetrain: Drivetrain
    time_step: float
    friction: float = 0.0
    time_scales: TimeScales = FOLLOWING
    clock: Clock | None = None
    loads: tuple[VaryingLoad, ...] = ()


class KnownSets(dict[float, np.ndarray]):
    """By place in the mesh cycle, in steps, the sets (n,) that a run without friction had there last."""


class FirstSets:
    """Sets of a run's steps on a `cycle`, for its own next mesh cycle and for other runs.

    Over a face they are nearly those of the same position a mesh cycle before. In a plane, with a tenth of the nodes, a
    step before is as near. Without friction there is one solution, whatever the sets to begin with: those of runs
    before do as well. `remembers`: whether any are kept.
    """

    def __init__(self, cycle: Cycle, friction: float):
        self._cycle = cycle
        self._steps = cycle.steps
        self._repeats = cycle.traits.repeats
        self._friction = friction
        # By step, those of the last mesh cycle and a little more.
        self._own: dict[float, np.ndarray] = {}
        self._shared = cycle.shared(KnownSets) if not friction and cycle.alike else KnownSets()
        self._others = dict(self._shared)
        # By place in a mesh cycle, those of meshes that others follow.
        self._of_meshes: dict[tuple, np.ndarray] = {}
        self._alike = cycle.traits.repeats and not friction
        self.period = cycle.steps_until_alike if self._alike else cycle.steps
        self.remembers = self._repeats or not friction

    def remember(self, step: float, status: np.ndarray) -> None:
        """Keep the sets (n,) of a step."""
        if in_common(step) and not self._friction:
            self._shared[step % self._steps] = status
        if self._repeats:
            self._own[step] = status
            self._own.pop(step - self._steps - 2, None)
        if self._alike:
            self._of_meshes |= {place: status[nodes] for place, nodes in self._cycle.alike_nodes(int(step))}

    def before(self, step: float) -> np.ndarray:
        """The sets (n,) of a mesh cycle before `step`, or of another run there; empty where none are known."""
        own = self._own.get(step - self._steps)
        return self._others.get(step % self._steps, NO_SETS) if own is None else own

    def before_all(self, steps: Sequence[float], nodes: np.ndarray) -> np.ndarray:
        """The sets (N,) before some steps with so many `nodes`, -1 where they are not known; none where none are
        kept."""
        known = np.full(nodes.sum() if self.remembers else 0, -1, dtype=np.int8)
        ends = np.cumsum(nodes).tolist()
        for step, end, count in zip(steps, ends, nodes) if self.remembers else ():
            sets = self.before(step)
            known[end - len(sets) : end] = sets
            if not len(sets) and self._of_meshes:
                for place, own in self._cycle.alike_nodes(int(step)):
                    known[end - count : end][own] = self._of_meshes.get(place, -1)
        return known

    def near(self, step: float, position: Position) -> np.ndarray:
        """The sets (n,) to begin with at a position where the step before is not solved: those that another run had
        there, or at the whole step before it."""
        then = self._others.get(step % self._steps)
        if then is not None:
            return then.copy()
        before = self._others.get((ceil(step) - 1) % self._steps)
        if before is None:
            return cold_start(position.operator.gap, position.operator.node_pair)
        status = np.empty(position.operator.nodes, dtype=np.int8)
        begin(status, before, position.node_before, NO_SETS, NO_SETS)
        return status


class Stepper:
    """Solves single steps of the equations of motion with the contact of a `cycle`."""

    def __init__(self, cycle: Cycle, equations: EquationsOfMotion):
        drivetrain, time_step, friction = equations.drivetrain, equations.time_step, equations.friction
        self.cycle, self.drivetrain, self.time_step, self.friction = cycle, drivetrain, time_step, friction
        self.clock, self.loads = equations.clock or SteadyClock(time_step), equations.loads
        method = AVERAGE_ACCELERATION if equations.time_scales.averages_acceleration else BACKWARD_EULER
        self.dynamic = Scheme(drivetrain, time_step, method)
        self.static = Scheme(replace(drivetrain, mass=None, damping=None), time_step)
        varying = [load(step) for load in self.loads for step in range(cycle.steps)]
        self.tolerance = Tolerance.of_load(float(np.abs([drivetrain.load, *varying]).max()))
        self._free_motion = drivetrain.free_motion
        self._time_scales = equations.time_scales
        self.begin_anew()
        # Over a face a position at rest is nearer to itself in another run than to the step before.
        self.at_rest = cycle.traits.repeats and not friction and not self.dynamic.inert

    def begin_anew(self) -> None:
        """Begin with what other runs have left."""
        self.sets = FirstSets(self.cycle, self.friction)

    @cached_property
    def static_motion(self) -> Motion:
        """The motion without inertia, for compiled code."""
        return self._motion(self.static)

    @cached_property
    def motion(self) -> Motion:
        """The motion for compiled code."""
        return self._motion(self.dynamic)

    def _motion(self, scheme: Scheme) -> Motion:
        return Motion.of(scheme, self.friction, self.tolerance, self.cycle.traits.rigid)

    def scheme(self, step: int) -> Scheme:
        """The method over the step that ends at `step`; made anew where that step is not as long as the one before."""
        duration = self.clock.duration(step - 1, step)
        if duration != self.dynamic.step:
            self.dynamic = self.dynamic.lasting(duration, self.clock.speed(step - 1, step))
        return self.dynamic

    def load(self, step: float) -> np.ndarray:
        """All forces (k,), N, on the centre coordinates at `step`."""
        return sum((load(step) for load in self.loads), self.drivetrain.load)

    def started(self, before: Record, at: Record, after: Record) -> Record:
        """The start of a motion with inertia, of static equilibrium at step 0 and on either side: velocity from these,
        acceleration from the equations of motion.

        With a mesh frequency above the lowest of the drivetrain the gears cannot follow: they start at rest in the
        frame of the nominal motion, so as not to part at once. Above the highest they start where the forces of a whole
        cycle balance. Raises ContactNotConverged.
        """
        if self._time_scales.outruns_vibration:
            from .mean_equilibrium import mean_start

            return mean_start(self, at, STEPS_SLID_BEFORE_START)
        velocity = np.zeros(len(self.drivetrain.coordinates))
        if self._time_scales.follows_statics:
            velocity = (after.state.position - before.state.position) / self.clock.duration(-1, 1)
        # At static equilibrium the springs, the load and the contact balance; damping alone is left to accelerate.
        damping = self.drivetrain.damping
        acceleration = np.zeros_like(velocity)
        if damping is not None:
            acceleration = -np.linalg.solve(self.drivetrain.mass, damping @ velocity)
        return Record(0, State(at.state.position, velocity, acceleration), at.position, at.solution)

    def step(self, scheme: Scheme, last: Record, step: float) -> Record:
        """One step of `scheme` from `last`; a whole one is divided where it has no solution."""
        record = self._step(scheme, last, step)
        self.sets.remember(step, record.solution.status)
        return record

    def _step(self, scheme: Scheme, last: Record, step: float) -> Record:
        try:
            return self.part(scheme, last, step, self.cycle.position(step))
        except ContactNotConverged as failure:
            # Without friction a static solution does not depend on the way to it.
            depends_on_way = scheme.inert or self.friction > 0.0
            divisible = self.cycle.traits.divisible and step % 1.0 == 0.0
            if not (depends_on_way and divisible) or isinstance(failure, NoStaticEquilibrium):
                raise
            try:
                return self._divided(scheme, last, step, failure, 1)
            except ContactNotConverged as last_failure:
                _, _, history, sets = last_failure.attempts[-1]
                words = f"no solution at {last_failure.step:.6g} with a step {2**MOST_HALVINGS} times as short"
                failure.attempts.append((HALVED, words, history, sets))
                raise failure from last_failure

    def _divided(self, scheme: Scheme, last: Record, step: float, failure, halvings: int) -> Record:
        """From `last` to `step` in two halves, either divided again where it fails; raises the `failure` of the
        shortest."""
        if halvings > MOST_HALVINGS:
            raise failure
        record, parts = last, ()
        for end in (0.5 * (last.step + step), step):
            first = record.step
            finer = scheme.lasting(self.clock.duration(first, end), self.clock.speed(first, end))
            try:
                record = self.part(finer, record, end, self.cycle.between(end, record.step))
            except ContactNotConverged as failed:
                record = self._divided(finer, record, end, failed, halvings + 1)
            parts += record.parts or (record,)
        iterations = sum(part.solution.iterations for part in parts)
        return replace(record, solution=replace(record.solution, iterations=iterations, method=HALVED), parts=parts)

    def part(self, scheme: Scheme, last: Record, step: float, position: Position) -> Record:
        """From `last` to `position` without dividing."""
        operator = position.operator
        slip_before = NO_SLIP
        if operator.rigid_slip is not None:
            slip_before = slip_at_start(
                operator.rigid_slip, operator.previous_jacobian, *operator.stored_before, last.state.position,
                last.solution.forces,
            )  # fmt: skip
        status = np.empty(operator.nodes, dtype=np.int8)
        before = last.solution.status
        then = before if self.at_rest else self.sets.before(last.step)
        begin(status, before, position.node_before, self.sets.before(step), then)
        solution = self._solve(scheme, last.state, position, slip_before, status, step, last.solution)
        return Record(step, scheme.advance(last.state, solution.coordinates), position, solution)

    def in_balance(self, step: float, position: Position) -> Record:
        """Static equilibrium at a position after long sliding."""
        status = self.sets.near(step, position)
        operator = position.operator
        slip_before = NO_SLIP if operator.rigid_slip is None else STEPS_SLID_BEFORE_START * operator.rigid_slip
        rest = np.zeros(len(self.drivetrain.coordinates))
        solution = self._solve(self.static, State(rest, rest, rest), position, slip_before, status, step)
        return Record(step, State(solution.coordinates, rest, rest), position, solution)

    def _solve(
        self, scheme, state: State, position: Position, slip_before, status, step: float, last=None
    ) -> StepSolution:
        """The step of `scheme` from `state`, solved from the sets `status` (n,); `last`: the solution before, if there
        is one."""
        load, rolling = scheme.load(state, self.load(step)), self.drivetrain.rolling
        sets = status.copy()

        def linear(stiffness: np.ndarray, load: np.ndarray) -> StepSolution:
            modes = eliminated(stiffness, self.drivetrain.modes)
            problem = self._problem(scheme, position.operator, modes, load, slip_before)
            # On rolling bearings again and again: from the sets that were found last.
            solution = self.cycle.solve(position, problem, sets.copy(), last)
            sets[:] = solution.status
            return replace(solution, coordinates=with_modes(solution.coordinates, load, modes))

        try:
            if rolling is None:
                return linear(scheme.stiffness, load)
            return rolling.solved(scheme.stiffness, load, rolling.reference if last is None else state.position, linear)
        except ContactNotConverged as failure:
            failure.time, failure.step = self.clock.time(step), step
            failure.reason = failure.reason.replace(MOVES_FREELY, self.drivetrain.free_words)
            raise

    def _problem(self, scheme, operator, modes: Eliminated, load: np.ndarray, slip_before) -> StepEquations:
        """The contact problem under a load (k,) of coordinates of which modes are eliminated."""
        (compliance, rows), (jacobian, _) = operator.stored, operator.stored_jacobians
        free = self._moved_freely(scheme, load)
        if self.drivetrain.modes:
            free = moved_by_contact(free, len(load), len(modes.stiffness))
        return StepEquations(
            modes.stiffness, left_load(load, modes), compliance, jacobian, operator.gap, slip_before,
            self.friction, free, self.tolerance, rows,
        )  # fmt: skip

    def _moved_freely(self, scheme, load: np.ndarray) -> np.ndarray:
        """How a load (k,) moves the drivetrain where only contact holds it; a varying load may change its sign."""
        if scheme.inert or not len(self._free_motion):
            return np.empty(0)
        return turned(self._free_motion, load)
