"""Static positions between the steps of a march, each solved by itself: where extrema are looked for."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from contextlib import suppress
from math import ceil

import numpy as np

from fenics_gears.contact.errors import ContactNotConverged

from .batch import Batch
from .steps import Record

# The first attempt begins so many mesh cycles before the place: flanks that turn back at the pitch point slip again
# after some per cent of one.
FIRST_REACH = 0.1
# A run and a place after its step 0, in steps.
Place = tuple[int, float]


class BetweenSteps:
    """Solves the static motion of the runs of a `batch` between two steps, apart from their marches; its cycle is
    divisible.

    Without friction a solution does not depend on the step before it. With friction that step is one of the march's
    `held` records, by run and number, or else is solved on the way from a start some steps earlier: from further back,
    at most a mesh cycle, until it is what was `marched`, which says so of a record.
    """

    def __init__(
        self,
        batch: Batch,
        marched: Callable[[Record], bool] = lambda record: True,
        held: Callable[[int, int], Record | None] = lambda run, step: None,
    ):
        self._batch = batch
        self._marched = marched
        self._held = held
        self._before: dict[tuple[int, int], Record | None] = {}
        self._solved: dict[Place, Record | None] = {}
        # From the sets that the marches left.
        batch.common.begin_anew()

    def at(self, asked: Iterable[Place]) -> dict[Place, Record | None]:
        """The motion at places; None where it has no solution, or the step before is not found again."""
        every = list(dict.fromkeys(asked))
        if new := [each for each in every if each not in self._solved]:
            self._solve_each(new)
        return {each: self._solved[each] for each in every}

    def _solve_each(self, places: list[Place]) -> None:
        """Solve the motion at places, each after the whole step before it."""
        self._solved.update(dict.fromkeys(places))
        friction = self._batch.common.friction
        lasts = []
        if friction:
            found = {each: last for each in places if (last := self._record_before(*each)) is not None}
            places = list(found)
            lasts = list(found.values())
        if not places:
            return
        block = self._batch.between(places, lasts)
        sets: dict[float, np.ndarray] = {}
        # Runs that ask for the same place take turns at it, each from the sets of the one before.
        for number in sorted(range(len(places)), key=lambda number: places[number][1]):
            _, place = places[number]
            if place in sets and not friction:
                block.begin(number, 1, sets[place])
            with suppress(ContactNotConverged):
                block.solve(number, 2)
                self._solved[places[number]] = block.record(number, 1)
                sets[place] = block.sets(number, 1)
                self._batch.common.sets.remember(place, sets[place])

    def _record_before(self, run: int, place: float) -> Record | None:
        step = ceil(place) - 1
        if (run, step) not in self._before:
            self._before[run, step] = self._held(run, step) or self._step_before(run, step)
        return self._before[run, step]

    def _step_before(self, run: int, step: int) -> Record | None:
        cycle = self._batch.cycle.steps
        reach = ceil(FIRST_REACH * cycle)
        while reach < 2 * cycle:
            # A march starts at step -1.
            record = self._on_the_way(run, max(step - reach, -1), step)
            if record is not None and self._marched(record):
                return record
            reach *= 2
        return None

    def _on_the_way(self, run: int, first: int, step: int) -> Record | None:
        """A step solved from static equilibrium at the step `first`; None where one of them has no solution."""
        stepper = self._batch.alone(run)
        try:
            record = stepper.in_balance(first, stepper.cycle.position(first))
            for passed in range(first + 1, step + 1):
                record = stepper.step(stepper.static, record, passed)
        except ContactNotConverged:
            return None
        return record
