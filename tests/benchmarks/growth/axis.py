"""An axis of growth: what grows along it, and what theory expects of every stage."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from fenics_gears.scene.data import Scene

CONDENSING = ("assemble", "schur", "ring", "fourier", "clock", "factor")


@dataclass(frozen=True)
class Theory:
    """Exponent that is expected of what grows; and why."""

    exponent: float
    why: str


@dataclass(frozen=True)
class Axis:
    """Something that grows: `values` are asked for, what a point then has is its x (`counted` by the point's run).

    `theory`: of seconds of stages, of bytes of their arrays ("condense arrays"), of the process's peak above its idle
        ("condense peak") and of operations.
    `measured`: the "pair" of plane gears, over the face the "body" of the wheel or the "contact" of the pair. `also`:
        further counts of a point, in words.
    """

    name: str
    words: str
    values: tuple[float, ...]
    scene: Callable[[float], Scene]
    counted: str
    theory: dict[str, Theory]
    measured: str = "pair"
    also: dict[str, str] = field(default_factory=lambda: {"unknowns": "unknowns of both gears"})

    @property
    def stages(self) -> set[str]:
        """Stages that theory says something about, which are run several times."""
        within = (*CONDENSING, "mesh") if self.measured == "body" else CONDENSING
        return {"condense" if name.split()[0] in within else name.split()[0] for name in self.theory}


def logarithmic(first: float, last: float, points: int = 7) -> tuple[float, ...]:
    """Whole numbers, even in their logarithm."""
    return tuple(float(round(value)) for value in np.geomspace(first, last, points))
