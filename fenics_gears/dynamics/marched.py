"""What is known of marches: of each its last steps and what is counted of all; and static positions between their
steps, each solved by itself, where extrema are looked for."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable
from contextlib import suppress
from dataclasses import dataclass, field
from functools import cached_property
from itertools import compress
from math import ceil

import numpy as np

from fenics_gears.contact.errors import ContactNotConverged
from fenics_gears.contact.step_solver import METHODS
from fenics_gears.contact.tooth_pair import DRIVE

from .batch import Batch
from .steps import Record, Steps, drive_flanks_touch, smallest_openings

# The first attempt begins so many mesh cycles before the place: flanks that turn back at the pitch point slip again
# after some per cent of one.
FIRST_REACH = 0.1
# A run and a place after its step 0, in steps.
Place = tuple[int, float]


@dataclass
class March:
    """A march so far.

    `kept`: how many of the last steps are kept; `period`, in steps: solutions of the last two periods are `held`;
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


class BetweenSteps:
    """Solves the static motion of the runs of a `batch` between two steps, apart from their marches; its cycle is
    divisible.

    Without friction a solution does not depend on the step before it. With friction it does. The march still has that
    step (`held`, by run and number), or it is solved again from static equilibrium some steps earlier. The start is
    moved back, twice as far each time, until the step agrees with the march (`marched` says so of a record); at most
    two mesh cycles.
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
            before = {each: last for each in places if (last := self._record_before(*each)) is not None}
            places = list(before)
            lasts = list(before.values())
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
