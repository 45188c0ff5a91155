"""Flank tolerances of ISO 1328-1:2013.

Formulas (5) to (9) of the standard, taken from published programs that cite them by number, not from the standard itself; values are not
rounded as it prints them. Check: the values that another such program is tested by (module 3 mm, 40 teeth, class 6: single pitch 8.94 um,
total cumulative pitch 28.80 um).
"""

from __future__ import annotations

from dataclasses import dataclass
from math import hypot, sqrt

MICROMETRE = 1e-3


@dataclass(frozen=True)
class FlankTolerance:
    """Tolerances of one gear, mm: single pitch f_p, total cumulative pitch F_p, profile slope f_Ha, profile form f_fa."""

    single_pitch: float
    cumulative_pitch: float
    profile_slope: float
    profile_form: float

    @property
    def profile(self) -> float:
        """Total profile tolerance F_a, mm."""
        return hypot(self.profile_slope, self.profile_form)


def flank_tolerance(reference_diameter: float, module: float, tolerance_class: int) -> FlankTolerance:
    """Tolerances of a gear (diameter d and module m in mm) in a class A from 1 to 11; from class to class a factor sqrt(2).

    Class 5 of a gear of 100 mm and module 4 mm, and two classes on:

    >>> round(1e3 * flank_tolerance(100.0, 4.0, 5).single_pitch, 3), round(1e3 * flank_tolerance(100.0, 4.0, 7).single_pitch, 3)  # um
    (6.7, 13.4)
    """
    d, m, step = reference_diameter, module, MICROMETRE * sqrt(2.0) ** (tolerance_class - 5)
    return FlankTolerance(
        single_pitch=step * (0.001 * d + 0.4 * m + 5.0),
        cumulative_pitch=step * (0.002 * d + 0.55 * sqrt(d) + 0.7 * m + 12.0),
        profile_slope=step * (0.4 * m + 0.001 * d + 4.0),
        profile_form=step * (0.55 * m + 5.0),
    )
