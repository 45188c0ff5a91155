"""How much too stiff plane strain makes a narrow pair: its ends are nearer to plane stress."""

from __future__ import annotations

from collections.abc import Sequence
from math import log

import numpy as np

from fenics_gears.geometry.gear_data import Material

# By how many per cent the mean transmission error in three dimensions is larger, over the face width in modules:
# docs/third_dimension.md, plane limits, of steel.
SOFTER = {0.5: 6.03, 1.0: 5.68, 2.0: 4.97, 4.0: 3.87, 8.0: 2.67, 15.0: 1.75, 30.0: 0.95, 60.0: 0.45}
STEEL = 0.3
# Per cent from which `gears check` speaks of it.
NOTABLE = 2.0


def too_stiff(widths: float, materials: Sequence[Material]) -> float:
    """Per cent by which the transmission error of a spur pair in plane strain is too small; `widths`: its common face
    width in modules.

    Plane strain and plane stress differ by nu^2.
    """
    known = np.log(list(SOFTER))
    squares = sum(each.poissons_ratio**2 for each in materials) / len(materials)
    return float(np.interp(log(widths), known, list(SOFTER.values()))) * squares / STEEL**2
