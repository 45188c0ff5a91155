"""What a march is so far: its last steps, and what is counted of all."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from functools import cached_property
from itertools import compress

import numpy as np

from fenics_gears.contact.step_solver import METHODS
from fenics_gears.contact.tooth_pair import DRIVE

from .steps import Record, Steps, drive_flanks_touch, smallest_openings


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
