"""What a run costs as a product of powers of its knobs' sizes, one for each stage, fitted to the rungs' times."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

# Meshing and condensing go together; the march is the rest.
STAGES = ("gears", "march")
# No stage grows faster than this with a knob; a larger exponent is a disturbed time.
MOST = 4.0

Seconds = Mapping[str, float]


@dataclass(frozen=True)
class Cost:
    """Seconds of each stage at the base, whose sizes are `base`, and how each falls with each knob's size."""

    base: dict[str, float]
    seconds: dict[str, float]
    exponents: dict[str, dict[str, float]]

    def at(self, sizes: Mapping[str, float | np.ndarray]) -> np.ndarray:
        """Seconds of a run of the given sizes, by knob; arrays are broadcast."""
        total = 0.0
        for stage in STAGES:
            part = self.seconds[stage]
            for name, size in sizes.items():
                part = part * (np.asarray(size, dtype=float) / self.base[name]) ** -self.exponents[stage][name]
            total = total + part
        return np.asarray(total)


def cost_exponent(sizes: Sequence[float], seconds: Sequence[float]) -> float:
    """Exponent q of seconds ~ h^-q through the times of a knob's rungs, by least squares in logarithms; not below 0."""
    if len(sizes) < 2 or min(seconds) <= 0.0:
        return 0.0
    slope = np.polyfit(np.log(sizes), np.log(seconds), 1)[0]
    return float(np.clip(-slope, 0.0, MOST))
