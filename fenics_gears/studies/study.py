"""A study as a frozen dataclass: the swept fields and one run for each combination of their values."""

from dataclasses import dataclass

from fenics_gears.runs.run import Run

from .axis import Axis


@dataclass(frozen=True)
class Study:
    """A validated study: all its scenes are right.

    `combine`: "product" (one dimension for each axis) or "zip" (one dimension, `case`). `cases`: its runs, the last
    swept field changes fastest. `text` and `scene_text`: the files it was read from. `base_key`: the base scene's hash.
    """

    name: str
    title: str
    combine: str
    axes: tuple[Axis, ...]
    cases: tuple[Run, ...]
    text: str
    scene_text: str
    base_key: str

    @property
    def dimensions(self) -> tuple[str, ...]:
        return tuple(axis.name for axis in self.axes) if self.combine == "product" else ("case",)

    @property
    def shape(self) -> tuple[int, ...]:
        return tuple(len(axis.values) for axis in self.axes) if self.combine == "product" else (len(self.cases),)
