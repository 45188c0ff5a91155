"""Flank tolerances of ISO 1328-1:2013, formulas (5) to (12), not rounded as the standard prints them.

Taken from published programs that cite the formulas by number. Checked against the test values of another such program:
for module 3 mm, 40 teeth and class 6 a single pitch of 8.94 um and a total cumulative pitch of 28.80 um.
"""

from dataclasses import dataclass
from math import hypot, sqrt

MICROMETRE = 1e-3


@dataclass(frozen=True)
class FlankTolerance:
    """Tolerances of one gear, mm: single pitch f_p, total cumulative pitch F_p, profile slope f_Ha, profile form
    f_fa."""

    single_pitch: float
    cumulative_pitch: float
    profile_slope: float
    profile_form: float

    @property
    def profile(self) -> float:
        """Total profile tolerance F_a, mm."""
        return hypot(self.profile_slope, self.profile_form)


@dataclass(frozen=True)
class HelixTolerance:
    """Tolerances of one gear along its face, mm: helix slope f_Hb, helix form f_fb."""

    slope: float
    form: float

    @property
    def total(self) -> float:
        """Total helix tolerance F_b, mm."""
        return hypot(self.slope, self.form)


def helix_tolerance(reference_diameter: float, face_width: float, tolerance_class: int) -> HelixTolerance:
    """Tolerances of a gear, diameter d (5 mm to 15 m) and face width b (4 mm to 1.2 m), in a class A from 1 to 11.

    >>> tolerance = helix_tolerance(100.0, 25.0, 5)
    >>> round(1e3 * tolerance.slope, 3), round(1e3 * tolerance.form, 3)  # um
    (6.25, 6.95)
    """
    d = reference_diameter
    b = face_width
    step = MICROMETRE * sqrt(2.0) ** (tolerance_class - 5)
    return HelixTolerance(
        step * (0.05 * sqrt(d) + 0.35 * sqrt(b) + 4.0), step * (0.07 * sqrt(d) + 0.45 * sqrt(b) + 4.0)
    )


def flank_tolerance(reference_diameter: float, module: float, tolerance_class: int) -> FlankTolerance:
    """Tolerances of a gear (diameter d and module m in mm) in a class A from 1 to 11; from class to class a factor
    sqrt(2).

    >>> [round(1e3 * flank_tolerance(100.0, 4.0, each).single_pitch, 3) for each in (5, 7)]  # um
    [6.7, 13.4]
    """
    d = reference_diameter
    m = module
    step = MICROMETRE * sqrt(2.0) ** (tolerance_class - 5)
    return FlankTolerance(
        single_pitch=step * (0.001 * d + 0.4 * m + 5.0),
        cumulative_pitch=step * (0.002 * d + 0.55 * sqrt(d) + 0.7 * m + 12.0),
        profile_slope=step * (0.4 * m + 0.001 * d + 4.0),
        profile_form=step * (0.55 * m + 5.0),
    )
