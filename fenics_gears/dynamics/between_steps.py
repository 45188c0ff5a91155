"""Static positions between the steps of a march, each solved by itself: where extrema are looked for."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from math import ceil

from fenics_gears.contact.mesh_cycle import Cycle, Position
from fenics_gears.dynamics.march import thread_pools
from fenics_gears.dynamics.stepping import EquationsOfMotion, Stepper
from fenics_gears.dynamics.steps import Record

# The first attempt begins so many mesh cycles before the place: flanks that turn back at the pitch point slip again
# after some per cent of one.
FIRST_REACH = 0.1


class BetweenSteps(Stepper):
    """Solves the static motion between two steps apart from the march; the `cycle` is divisible.

    Without friction a solution does not depend on the step before it. With friction that step is one of the march's
    `records`, by their numbers, or else is solved on the way from a start some steps earlier: from further back, at
    most a mesh cycle, until it is what was `marched`, which says so of a record.
    """

    def __init__(
        self,
        cycle: Cycle,
        equations: EquationsOfMotion,
        marched: Callable[[Record], bool],
        records: Mapping[int, Record] | None = None,
    ):
        super().__init__(cycle, equations)
        self._marched = marched
        self._before: dict[int, Record | None] = dict(records or {})
        self._solved: dict[float, Record | None] = {}

    def at(self, step: float) -> Record | None:
        """The motion at a place after step 0, counted in steps; None where the step before it is not found again.
        Raises ContactNotConverged."""
        if step not in self._solved:
            with thread_pools().limit(limits=1):
                position = self.cycle.between(step, ceil(step) - 1)
                self._solved[step] = self._after(step, position) if self.friction else self._alone(step, position)
        return self._solved[step]

    def _alone(self, step: float, position: Position) -> Record:
        status = self.sets_near(step, position)
        record = self.in_balance(step, position, status)
        self.remember(step, record.solution.status)
        return record

    def _after(self, step: float, position: Position) -> Record | None:
        before = ceil(step) - 1
        if before not in self._before:
            self._before[before] = self._step_before(before)
        last = self._before[before]
        return None if last is None else self._part(self.static, last, step, position)

    def _step_before(self, step: int) -> Record | None:
        reach = ceil(FIRST_REACH * self.cycle.steps)
        while reach < 2 * self.cycle.steps:
            # A march starts at step -1.
            first = max(step - reach, -1)
            record = self._static_start(first)
            for passed in range(first + 1, step + 1):
                record = self.step(self.static, record, passed)
            if self._marched(record):
                return record
            reach *= 2
        return None
