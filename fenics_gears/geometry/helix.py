"""The helix of a pair."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Helix:
    """`angle`, rad, at the reference cylinders, positive; `pinion_hand`: "right" or "left", the wheel has the other."""

    angle: float
    pinion_hand: str = "right"

    @property
    def sign(self) -> float:
        """1 for a right-hand pinion, -1 for a left-hand one."""
        return 1.0 if self.pinion_hand == "right" else -1.0
