"""Hertz's elliptic point contact: Johnson, Contact Mechanics, 1985, 4.2 (b), equations 4.25 to 4.28."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

from scipy.special import ellipe, ellipk


@dataclass(frozen=True)
class PointContact:
    """Half-axes long_axis > short_axis (mm), relative radius (mm) across the long axis; modulus: E*, MPa."""

    long_axis: float
    short_axis: float
    radius: float
    modulus: float

    @property
    def _integrals(self) -> tuple[float, float, float]:
        square = 1.0 - (self.short_axis / self.long_axis) ** 2
        return float(ellipk(square)), float(ellipe(square)), square

    @property
    def peak_pressure(self) -> float:
        """MPa, eq. 4.26b."""
        first, second, square = self._integrals
        a, b = self.long_axis, self.short_axis
        return self.modulus * square * a**2 / (2.0 * self.radius * b * ((a / b) ** 2 * second - first))

    @property
    def load(self) -> float:
        """N."""
        return 2.0 * pi * self.long_axis * self.short_axis * self.peak_pressure / 3.0

    @property
    def radius_along(self) -> float:
        """Relative radius (mm) along the long axis, eq. 4.26a."""
        first, second, square = self._integrals
        a, b = self.long_axis, self.short_axis
        return self.modulus * square * a**2 / (2.0 * self.peak_pressure * b * (first - second))

    @property
    def approach(self) -> float:
        """mm, eq. 4.26c."""
        return self.peak_pressure * self.short_axis * self._integrals[0] / self.modulus

    def under(self, part: float) -> PointContact:
        """Under a part of the load both axes go with its cube root."""
        return PointContact(
            part ** (1 / 3) * self.long_axis, part ** (1 / 3) * self.short_axis, self.radius, self.modulus
        )
