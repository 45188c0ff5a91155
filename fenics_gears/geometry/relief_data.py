"""Tip and root relief as a scene gives them."""

from __future__ import annotations

from dataclasses import dataclass

LINEAR, PARABOLIC = "linear", "parabolic"
POWERS = {LINEAR: 1, PARABOLIC: 2}


@dataclass(frozen=True)
class Relief:
    """Relief of one gear: depth at its end, mm; start as a roll angle in rad, a diameter or a length in mm, none for
    the usual place.

    ``shape``: "linear" or "parabolic" in the roll angle, from the start to the end. ``length_on_path``: from the start
        to the end, on
    the path of contact (ISO 21771, where profile charts have it); ``length_on_flank``: the same along the involute.
    ``exponent``: the power in place of the shape's.
    """

    depth: float
    start_roll_angle: float | None
    shape: str = LINEAR
    start_diameter: float | None = None
    length_on_path: float | None = None
    length_on_flank: float | None = None
    exponent: float | None = None

    @property
    def power(self) -> float:
        """Power of the roll angle with which the relief grows."""
        return POWERS[self.shape] if self.exponent is None else self.exponent


@dataclass(frozen=True)
class TipRelief:
    """Tip relief of the pair; a gear without relief has None."""

    pinion: Relief | None
    wheel: Relief | None


@dataclass(frozen=True)
class RootRelief:
    """Root relief of the pair; a gear without relief has None."""

    pinion: Relief | None
    wheel: Relief | None
