"""Static positions between the steps of a march, each solved by itself: where extrema are looked for."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace
from math import ceil
from typing import Any, NamedTuple

import numpy as np

from fenics_gears.contact.addresses import Arrays, row_of
from fenics_gears.contact.errors import ContactNotConverged
from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.contact.operator import Position
from fenics_gears.contact.step_solver import NEWTON

from .compiled_march import NO_SETS, STATIC, Course, Motion, solve_steps
from .stepping import EquationsOfMotion, Stepper
from .steps import Record, Steps

# The first attempt begins so many mesh cycles before the place: flanks that turn back at the pitch point slip again
# after some per cent of one.
FIRST_REACH = 0.1


class _StepBefore(NamedTuple):
    """In place of the position of a step that is solved: compiled code reads nothing of it but how many nodes it
    has."""

    in_memory: tuple[np.ndarray, list[np.ndarray]]

    @classmethod
    def of(cls, nodes: int) -> Any:
        """With so many nodes."""
        return cls(row_of(nodes, [None] * len(Arrays._fields)))


class BetweenSteps(Stepper):
    """Solves the static motion between two steps apart from the march; the `cycle` is divisible.

    Without friction a solution does not depend on the step before it. With friction that step is one of the march's
    `held` records, by its number, or else is solved on the way from a start some steps earlier: from further back, at
    most a mesh cycle, until it is what was `marched`, which says so of a record.
    """

    def __init__(
        self,
        cycle: Cycle,
        equations: EquationsOfMotion,
        marched: Callable[[Record], bool],
        held: Callable[[int], Record | None] = lambda step: None,
    ):
        super().__init__(cycle, equations)
        self._marched, self._held = marched, held
        self._before: dict[int, Record | None] = {}
        self._solved: dict[float, Record | None] = {}
        self._motion = Motion.of(self._static_drivetrain, STATIC, self.friction, self.tolerance, cycle.traits.rigid)

    def at(self, places: Iterable[float]) -> dict[float, Record | None]:
        """The motion at places after step 0, counted in steps; None where it has no solution, or the step before is not
        found again."""
        asked = list(dict.fromkeys(places))
        if new := [place for place in asked if place not in self._solved]:
            self._solve_each(new)
        return {place: self._solved[place] for place in asked}

    def _solve_each(self, places: list[float]) -> None:
        """Solve the motion at places, each after the whole step before it: by Newton's method in compiled code, where
        that ends without a solution as a march does."""
        self._solved.update(dict.fromkeys(places))
        asked = []
        for place in places:
            last = self._record_before(place) if self.friction else None
            if last is not None or not self.friction:
                asked.append((place, self.cycle.between(place, ceil(place) - 1), last))
        if not asked:
            return
        steps, course = self._block(asked)
        for number, (place, position, last) in enumerate(asked):
            at = 2 * number + 1
            compiled = not self.cycle.traits.own_solver and self.drivetrain.rolling is None
            if compiled and solve_steps(steps, at, at + 1, self._motion, course) > at:
                record = steps.record(at)
            else:
                try:
                    record = (
                        self.in_balance(place, position, self.sets_near(place, position))
                        if last is None
                        else self.part(self.static, last, place, position)
                    )
                except ContactNotConverged:
                    continue
            self._solved[place] = record
            self.remember(place, record.solution.status)

    def _block(self, asked: list[tuple[float, Position, Record | None]]) -> tuple[Steps, Course]:
        """Room for the solutions at places, each after the step before it, and what differs between them."""
        numbers, positions, sets = [], [], []
        for place, position, last in asked:
            nodes = position.node_before.max(initial=-1) + 1 if last is None else len(last.solution.status)
            numbers += [ceil(place) - 1, place]
            positions += [_StepBefore.of(nodes), position]
            sets += [np.zeros(nodes, dtype=np.int8), self.sets_near(place, position)] if last is None else []
        steps = Steps.to_solve(numbers, positions, len(self.drivetrain.coordinates), NEWTON)
        for number, (_, _, last) in enumerate(asked):
            if last is not None:
                steps.put(2 * number, replace(last, position=positions[2 * number]))
        loads, known = np.array([self.load(number) for number in numbers]), np.concatenate(sets) if sets else NO_SETS
        # Without friction a position has its sets whatever the step before it.
        return steps, Course(np.zeros(len(steps)), loads, known, at_rest=True)

    def _record_before(self, place: float) -> Record | None:
        before = ceil(place) - 1
        if before not in self._before:
            self._before[before] = self._held(before) or self._step_before(before)
        return self._before[before]

    def _step_before(self, step: int) -> Record | None:
        reach = ceil(FIRST_REACH * self.cycle.steps)
        while reach < 2 * self.cycle.steps:
            # A march starts at step -1.
            record = self._on_the_way(max(step - reach, -1), step)
            if record is not None and self._marched(record):
                return record
            reach *= 2
        return None

    def _on_the_way(self, first: int, step: int) -> Record | None:
        """A step solved from static equilibrium at the step `first`; None where one of them has no solution."""
        try:
            record = self._static_start(first)
            for passed in range(first + 1, step + 1):
                record = self.step(self.static, record, passed)
        except ContactNotConverged:
            return None
        return record
