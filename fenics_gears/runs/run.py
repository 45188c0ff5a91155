"""A study as frozen dataclasses: the swept fields and one case for each combination of their values."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

from fenics_gears.elasticity.cache import content_key
from fenics_gears.numbers_version import NUMBERS_VERSION
from fenics_gears.scene.data import Scene
from fenics_gears.studies.axis import Axis


@dataclass(frozen=True)
class Case:
    """One run of a study.

    `index`: its place, the last swept field changes fastest; `values`: of the swept fields, in words; `key`: hash of
        all that its result
    depends on.
    """

    index: int
    values: dict[str, str]
    scene: Scene
    key: str

    @property
    def name(self) -> str:
        """What its files are called, without the ending."""
        return f"{self.index:04d}-{self.key[:16]}"

    def __str__(self) -> str:
        """The case in words."""
        return f"case {self.index} ({', '.join(f'{name} = {value}' for name, value in self.values.items())})"


@dataclass(frozen=True)
class Study:
    """A validated study: all its scenes are right.

    `combine`: "product" (one dimension for each axis) or "zip" (one dimension, `case`); `text` and `scene_text`: the
        files it was
    read from; `base_key`: the base scene's hash.
    """

    name: str
    title: str
    combine: str
    axes: tuple[Axis, ...]
    cases: tuple[Case, ...]
    text: str
    scene_text: str
    base_key: str

    @property
    def dimensions(self) -> tuple[str, ...]:
        """Names of the study's dimensions."""
        return tuple(axis.name for axis in self.axes) if self.combine == "product" else ("case",)

    @property
    def shape(self) -> tuple[int, ...]:
        """Lengths of the study's dimensions."""
        return tuple(len(axis.values) for axis in self.axes) if self.combine == "product" else (len(self.cases),)


def scene_key(scene: Scene) -> str:
    """Hash of all that a scene's result depends on: its values, however they are written, and the version of the
    program's numbers."""
    said: dict[str, Any] = asdict(scene)
    for words in ("title", "name", "derived", "written", "folder"):
        del said[words]
    return content_key({"scene": said, "numbers": NUMBERS_VERSION})
