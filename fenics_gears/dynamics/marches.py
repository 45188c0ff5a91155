"""Quasi-static marches of runs that have all contact operators in common and differ in their load and in what opens the
contact nodes: side by side in one block of steps, where the runs of a search would take longer to prepare one by one
than to solve."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from math import ceil
from typing import Protocol

import numpy as np

from fenics_gears.contact.addresses import GAP, NODES, ROW
from fenics_gears.contact.errors import ContactNotConverged
from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.contact.operator import Position
from fenics_gears.contact.step_solver import NEWTON

from .compiled_march import NO_SETS, STATIC, Course, Motion, solve_steps
from .stepping import STEPS_SLID_BEFORE_START, EquationsOfMotion, Stepper
from .steps import Record, Steps, table_of

RIGID_SLIP = ROW.names.index("rigid_slip")


class OpenedNodes(Protocol):
    """What opens the contact nodes of each run."""

    def of_steps(self, positions: Sequence[Position]) -> np.ndarray:
        """Gaps (runs, n), mm, at all steps of a mesh cycle, one after the other."""

    def at(self, asked: Sequence[tuple[int, Position]]) -> np.ndarray:
        """Gaps (n,), mm, of runs at a position each, one after the other."""

    def of(self, run: int) -> Cycle:
        """The cycle with the gaps of a run."""


class Marches:
    """The marches of runs over `steps` steps from step 0 on a `cycle` without gaps of its own; `equations` by run,
    alike but for the load; `opened`: their gaps.

    Steps that Newton's method does not solve at once are solved as a march by itself does. `block`: the steps of all
    runs, one run's after the other's, at positions whose operators have other gaps; `solved` (runs,): those with a
    solution at all steps, none of them divided. `first`: from which step on places between steps are counted (`at`).
    """

    def __init__(self, cycle: Cycle, equations: Sequence[EquationsOfMotion], opened: OpenedNodes, steps: int):
        self.cycle, self._opened, self._count = cycle, opened, len(equations)
        self._stepper, self._motions, self._loads = Stepper(cycle, equations[0]), [], []
        self._take(equations)
        self._equations: Sequence[EquationsOfMotion] = equations
        self._alone: dict[int, Stepper] = {}
        self.friction, self.solved, self.first = self._stepper.friction, np.ones(len(equations), dtype=bool), 0
        self._numbers = np.arange(steps + 1)
        cycle.build(range(cycle.steps))
        positions = [cycle.position(step) for step in range(cycle.steps)]
        self._gaps, table = opened.of_steps(positions), table_of(positions)
        ends = np.cumsum(table[:, NODES])
        self._starts = np.concatenate(([0], ends))
        self._rows, at = np.tile(table, (self._count, 1, 1)), self._numbers % cycle.steps
        own = self._gaps.ctypes.data + np.arange(self._count)[:, None] * self._gaps.strides[0]
        self._rows[:, :, GAP] = own + self._gaps.itemsize * self._starts[:-1]
        self.block = self._room(self._numbers, [positions[step] for step in at], self._rows[:, at])
        self._start()
        self._march()
        # From here on places between steps begin with the sets of a run of these.
        self._stepper = Stepper(cycle, equations[0])
        self._between: dict[tuple[int, float], Record | None] = {}

    def _take(self, equations: Sequence[EquationsOfMotion]) -> None:
        """The motion and the load (k,) of each run; those of runs with the same equations are made once."""
        known: dict[int, tuple[Motion, np.ndarray]] = {}
        for each in equations:
            if id(each) not in known:
                own = self._stepper if each is equations[0] else Stepper(self.cycle, each)
                known[id(each)] = Motion.of(own.drivetrain, STATIC, own.friction, own.tolerance), own.drivetrain.load
            motion, load = known[id(each)]
            self._motions.append(motion)
            self._loads.append(load)

    def _room(self, numbers: Sequence[float], positions: list[Position], table: np.ndarray) -> Steps:
        """Room for as many steps of each run; `table` (runs, s, r) of their rows."""
        count, coordinates = self._count, len(self._stepper.drivetrain.coordinates)
        return Steps.to_solve(
            np.tile(numbers, count), positions * count, coordinates, NEWTON, table.reshape(-1, table.shape[2])
        )

    def _gap(self, run: int, step: int) -> np.ndarray:
        step %= self.cycle.steps
        return self._gaps[run, self._starts[step] : self._starts[step + 1]]

    def _solve(self, steps: Steps, sets: np.ndarray, at_rest: bool) -> None:
        """Solve all steps of each run but its first; `sets`, `at_rest`: as of a Course."""
        own, turns = len(steps) // self._count, self.cycle.traits.repeats
        course = Course(np.zeros(len(steps)), np.repeat(self._loads, own, axis=0), sets, at_rest)
        # Over a face the operator of a position is larger than all else: runs take turns at it.
        ends = range(2, own + 1) if turns else (own,)
        for first, end in zip((1, *ends), ends):
            before = None
            for run in np.flatnonzero(self.solved).tolist():
                if turns:
                    self._put_known(steps, sets, (before, run), first)
                self._solve_part(run, steps, (run * own + first, run * own + end), course)
                before = run

    def _put_known(self, steps: Steps, sets: np.ndarray, runs: tuple[int | None, int], at: int) -> None:
        """Put those `sets` into place that a run begins a step with: its own a mesh cycle before or, without friction,
        those of the run before."""
        (before, run), own, starts = runs, len(steps) // self._count, steps.starts
        if at >= self.cycle.steps:
            then = run * own + at - self.cycle.steps
        elif before is not None and not self.friction:
            then = before * own + at
        else:
            return
        now = run * own + at
        sets[starts[now] : starts[now + 1]] = steps.status[starts[then] : starts[then + 1]]

    def _solve_part(self, run: int, steps: Steps, part: tuple[int, int], course: Course) -> None:
        """Solve the steps of a run at places from a first to before an end."""
        done, end = part
        while self.solved[run] and (done := solve_steps(steps, done, end, self._motions[run], course)) < end:
            in_balance = course.at_rest and done % (len(steps) // self._count) == 1
            record = self._by_itself(run, steps, done, in_balance)
            self.solved[run] = record is not None
            if record is not None:
                steps.put(done, record)
                done += 1

    def _by_itself(self, run: int, steps: Steps, place: int, in_balance: bool) -> Record | None:
        """A step of a run as a march by itself solves it, after the step before it or in balance; None where it has no
        solution, or was divided."""
        stepper, number = self._stepper_of(run), int(steps.numbers[place])
        try:
            if in_balance:
                position = stepper.cycle.position(number)
                record = stepper.in_balance(number, position, stepper.sets_near(number, position))
            else:
                last = replace(steps.record(place - 1), position=stepper.cycle.position(number - 1))
                record = stepper.step(stepper.static, last, number)
        except ContactNotConverged:
            return None
        # Its position has gaps of its own; the block has these in its table.
        return None if record.parts else replace(record, position=steps.positions[place])

    def _stepper_of(self, run: int) -> Stepper:
        if run not in self._alone:
            self._alone[run] = Stepper(self._opened.of(run), self._equations[run])
        return self._alone[run]

    def _start(self) -> None:
        """Step 0 as `Stepper.start` has it: in balance, with friction after a step that is in balance after long
        sliding."""
        first = -1 if self.friction else 0
        before, *positions = (self.cycle.position(step) for step in range(first - 1, 1))
        rows = self._rows[:, [*range(first - 1, 1)]]
        if self.friction:
            slid = np.asarray(STEPS_SLID_BEFORE_START * positions[0].operator.rigid_slip)
            rows[:, 1, RIGID_SLIP] = slid.ctypes.data
        steps, sets = self._room(range(first - 1, 1), [before, *positions], rows), []
        # Of all but the first position in balance the sets are those of the step before.
        others = [np.full(each.operator.nodes, -1, dtype=np.int8) for each in positions[1:]]
        for run in range(self._count):
            near = self._stepper.sets_near(first, positions[0].with_gap(self._gap(run, first)))
            sets += [np.zeros(before.operator.nodes, dtype=np.int8), near, *others]
        self._solve(steps, np.concatenate(sets), True)
        nodes, kinds, count = positions[-1].operator.nodes, steps.kinds, self._count
        for name, own in (("status", nodes), ("forces", kinds * nodes), ("displacement", kinds * nodes)):
            theirs = getattr(steps, name).reshape(count, -1)
            getattr(self.block, name).reshape(count, -1)[:, :own] = theirs[:, theirs.shape[1] - own :]
        for name in ("states", "iterations"):
            theirs, whole = getattr(steps, name), getattr(self.block, name)
            whole[:: len(self._numbers)] = theirs[len(steps) // count - 1 :: len(steps) // count]

    def _march(self) -> None:
        stepper, starts = self._stepper, self.block.starts
        own = [stepper.known_before(step) for step in self._numbers.tolist()] if stepper.remembers else []
        known = NO_SETS
        if any(map(len, own)) or self.cycle.traits.repeats:
            own = own or [NO_SETS] * len(self._numbers)
            counts = np.diff(starts[: len(self._numbers) + 1])
            sets = [of if len(of) else np.full(nodes, -1, dtype=np.int8) for of, nodes in zip(own, counts)]
            known = np.tile(np.concatenate(sets), self._count)
        self._solve(self.block, known, stepper.at_rest)
        if stepper.remembers and self.solved.any():
            first = int(np.flatnonzero(self.solved)[-1]) * len(self._numbers)
            for step in self._numbers.tolist():
                place = first + step
                # A copy: the block is large.
                stepper.remember(step, self.block.status[starts[place] : starts[place + 1]].copy())

    def of(self, run: int) -> Steps:
        """The steps of one run."""
        return self.block.between(run * len(self._numbers), (run + 1) * len(self._numbers))

    def at(self, asked: Iterable[tuple[int, float]]) -> dict[tuple[int, float], Record | None]:
        """The motion of runs at places after the step `first`, counted from it in steps; None where it has no
        solution."""
        every = list(dict.fromkeys(asked))
        if new := [each for each in every if each not in self._between]:
            self._solve_each(new)
        return {each: self._between[each] for each in every}

    def _solve_each(self, asked: list[tuple[int, float]]) -> None:
        stepper = self._stepper
        positions = [self.cycle.between(place, ceil(place) - 1) for _, place in asked]
        gaps = self._opened.at([(run, position) for (run, _), position in zip(asked, positions)])
        table = table_of(positions)
        table[:, GAP] = gaps.ctypes.data + gaps.itemsize * (np.cumsum(table[:, NODES]) - table[:, NODES])
        # In place of the step before: compiled code reads nothing of it but how many nodes it has.
        before, sets = np.zeros_like(table), []
        before[:, NODES] = np.diff(self._starts)[[(ceil(place) - 1) % self.cycle.steps for _, place in asked]]
        rows = np.concatenate((before, table), axis=1).reshape(-1, table.shape[1])
        numbers = [number for _, place in asked for number in (ceil(place) - 1, place)]
        both = [position for position in positions for _ in range(2)]
        steps = Steps.to_solve(numbers, both, len(stepper.drivetrain.coordinates), NEWTON, rows)
        for at, ((run, place), position) in enumerate(zip(asked, positions)):
            if self.friction:
                self._copy(run, ceil(place) - 1 + self.first, steps, 2 * at)
            else:
                sets += [np.zeros(before[at, NODES], dtype=np.int8), stepper.sets_near(place, position)]
        loads = np.repeat([self._loads[run] for run, _ in asked], 2, axis=0)
        known, last = np.concatenate(sets) if sets else NO_SETS, {}
        course = Course(np.zeros(len(steps)), loads, known, at_rest=True)
        # Runs that ask for the same place take turns at it, each from the sets of the one before.
        for at in sorted(range(len(asked)), key=lambda at: asked[at][1]):
            (run, place), now = asked[at], slice(*steps.starts[2 * at + 1 : 2 * at + 3])
            if place in last and not self.friction:
                known[now] = last[place]
            if solve_steps(steps, 2 * at + 1, 2 * at + 2, self._motions[run], course) > 2 * at + 1:
                record: Record | None = steps.record(2 * at + 1)
            else:
                record = self._between_by_itself(run, place, steps.record(2 * at))
            self._between[run, place] = record
            if record is not None:
                last[place] = record.solution.status
                stepper.remember(place, last[place])

    def _between_by_itself(self, run: int, place: float, last: Record) -> Record | None:
        """As `BetweenSteps` solves it after the step `last`."""
        stepper = self._stepper_of(run)
        position = stepper.cycle.between(place, ceil(place) - 1)
        try:
            if not self.friction:
                return stepper.in_balance(place, position, stepper.sets_near(place, position))
            return stepper.part(stepper.static, last, place, position)
        except ContactNotConverged:
            return None

    def _copy(self, run: int, step: int, steps: Steps, at: int) -> None:
        """Take over the solution of a run's step as that at a place of other steps."""
        place, kinds = run * len(self._numbers) + step, self.block.kinds
        theirs = slice(self.block.starts[place], self.block.starts[place + 1])
        own = slice(steps.starts[at], steps.starts[at + 1])
        steps.states[at], steps.status[own] = self.block.states[place], self.block.status[theirs]
        for name in ("forces", "displacement"):
            both = getattr(self.block, name)[kinds * theirs.start : kinds * theirs.stop]
            getattr(steps, name)[kinds * own.start : kinds * own.stop] = both
