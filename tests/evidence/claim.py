"""What a row of the page says before anything is measured, and the parts that measure rows."""

from collections.abc import Callable
from dataclasses import dataclass

EXACT, RESOLVED, PROGRAMS, STANDARDS, TABLES, EXPERIMENTS, LAWS = GROUPS = (
    "Exact solutions",
    "Resolved models",
    "Other programs",
    "Standards",
    "Published tables",
    "Experiments",
    "Laws",
)

# By claim: the authority's number and the program's.
Numbers = dict[str, tuple[float, float]]


@dataclass(frozen=True)
class Claim:
    """`band`: least and largest difference that is agreement, in parts of the authority's number, or in the row's
    unit where that is 0."""

    quantity: str
    authority: str
    unit: str
    band: tuple[float, float]
    made_of: str

    def difference(self, value: float, ours: float) -> float:
        return ours / value - 1.0 if value else ours

    def holds(self, value: float, ours: float) -> bool:
        return self.band[0] <= self.difference(value, ours) <= self.band[1]


def within(part: float) -> tuple[float, float]:
    return -part, part


@dataclass(frozen=True)
class Part:
    """Rows that one call measures. `measure` is given a Python that has other programs; `read` takes numbers from a
    benchmark's file; `minutes`: processor time, 0 for seconds; `needs`: the other program."""

    name: str
    group: str
    story: str
    claims: dict[str, Claim]
    measure: Callable[[str], Numbers]
    read: Callable[[], Numbers] | None = None
    minutes: float = 0.0
    needs: str = ""
