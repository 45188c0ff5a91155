"""What a row of the page says before anything is measured, and the parts in which rows are measured."""

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
    """A row: `band` is the least and the largest difference that is agreement, in parts of the authority's number, or
    in the unit of the row where that number is 0."""

    quantity: str
    authority: str
    unit: str
    band: tuple[float, float]
    made_of: str

    def difference(self, value: float, ours: float) -> float:
        """Of the program's number, as the band counts it."""
        return ours / value - 1.0 if value else ours

    def holds(self, value: float, ours: float) -> bool:
        """Whether the row is within its band."""
        return self.band[0] <= self.difference(value, ours) <= self.band[1]


def within(part: float) -> tuple[float, float]:
    """The band of that size to either side."""
    return -part, part


@dataclass(frozen=True)
class Part:
    """Rows that one call measures.

    `measure` is given a Python that has other programs. `read`: takes the numbers from the file in which a benchmark
    keeps them. `minutes`: of processor time on one core; 0 for seconds. `needs`: the other program.
    """

    name: str
    group: str
    story: str
    claims: dict[str, Claim]
    measure: Callable[[str], Numbers]
    read: Callable[[], Numbers] | None = None
    minutes: float = 0.0
    needs: str = ""
