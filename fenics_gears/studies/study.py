"""A study as a frozen dataclass: the swept fields and one run for each combination of their values."""

from dataclasses import dataclass

from fenics_gears.runs.run import Run

from .axis import SAMPLE, Axis


@dataclass(frozen=True)
class Study:
    """A validated study: all its scenes are right.

    `combine`: "product" (one dimension for each axis, and one, `sample`, for all that are random) or "zip" (one
    dimension, `case`). `cases`: its runs, the last swept field changes fastest, samples before others. `text` and
    `scene_text`: the files it was read from. `base_key`: the base scene's hash. `asked`: the
    numbers that are kept of each run; None for whole results.
    """

    name: str
    title: str
    combine: str
    axes: tuple[Axis, ...]
    cases: tuple[Run, ...]
    text: str
    scene_text: str
    base_key: str
    asked: tuple[str, ...] | None = None

    def file_of(self, case: int) -> str:
        """The file of a case's run, from the study's folder on; empty where numbers alone are kept."""
        return f"cases/{self.cases[case].name}.nc" if self.asked is None else ""

    @property
    def dimensions(self) -> tuple[str, ...]:
        if self.combine != "product":
            return ("case",)
        return (*(axis.name for axis in self.axes if not axis.random), *([SAMPLE] if self.samples else ()))

    @property
    def shape(self) -> tuple[int, ...]:
        if self.combine != "product":
            return (len(self.cases),)
        lengths = (len(axis.values) for axis in self.axes if not axis.random)
        return (*lengths, *([self.samples] if self.samples else ()))

    @property
    def samples(self) -> int:
        """Samples of the random fields, each with all values of the others; 0 where none is random."""
        return max((len(axis.values) for axis in self.axes if axis.random), default=0)

    def dimension(self, axis: Axis) -> str:
        """The dimension over which the values of an axis are."""
        if self.combine != "product":
            return "case"
        return SAMPLE if axis.random else axis.name
