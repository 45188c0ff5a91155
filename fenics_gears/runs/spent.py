"""What computing runs took: how many a second, and what limits them."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from fenics_gears.results.dataset import RunResult

if TYPE_CHECKING:
    from .train import RunOfTrain


def seconds_of(result: RunResult | RunOfTrain) -> tuple[float, float, float]:
    """Seconds that a run took, in all, in the march, and for its numbers."""
    return result.attrs["wall_time"], result.attrs["time_march"], result.seconds


@dataclass
class Spent:
    """How many runs were `computed`, in how many `seconds` by the clock on so many `processes`; `of_runs`: seconds of
    all, as in `seconds_of`."""

    processes: int = 1
    computed: int = 0
    seconds: float = 0.0
    of_runs: tuple[float, ...] = (0.0, 0.0, 0.0)

    def count(self, of_run: Iterable[float]) -> None:
        """One run more, with its seconds where it has a result."""
        self.computed += 1
        if of_run := tuple(of_run):
            self.of_runs = tuple(map(sum, zip(self.of_runs, of_run)))

    def rows(self, kept: int) -> list[tuple[str, str, str]]:
        """Rows of label, value, unit; `kept`: runs that were there before."""
        rate = f", {self.computed / self.seconds:.3g} per second" if self.computed and self.seconds else ""
        rows = [("runs", f"{self.computed} computed{rate}, {kept} kept from before", "")]
        whole, march, numbers = self.of_runs
        if whole and self.seconds:
            beside = max(1.0 - whole / (self.processes * self.seconds), 0.0)
            words = (
                f"{1e3 * whole / self.computed:.3g} ms: march {march / whole:.0%}, numbers {numbers / whole:.0%},"
                f" contact equations and bearings the rest; {beside:.0%} of the time is outside runs"
            )
            rows.append(("a run", words, ""))
        return rows
