"""A gear's side of a mesh."""

from dataclasses import dataclass

from .gear import Gear


@dataclass(frozen=True)
class Side:
    """One of the two gears of a mesh; arrays over both have a row for each, in the order of `number`, 0 and 1.

    `sense`: 1 of the gear that pushes and turns counter-clockwise, -1 of the one that is pushed and turns clockwise.
    Flanks approach by `sense` times what the gear moves along the contact normal. Offsets from the line of action are
    positive towards the centre of the first gear. `foot` (mm): position on the line of action of the foot of the gear's
    centre, T1 or T2.
    """

    number: int
    sense: int
    gear: Gear
    foot: float

    @property
    def turn(self) -> float:
        """Angle (rad), positive counter-clockwise, by which the gear turns in a mesh cycle."""
        return self.sense * self.gear.angular_pitch

    @property
    def turning(self) -> float:
        """1 of a gear that turns counter-clockwise, as an internal wheel does like its pinion; else -1."""
        return self.sense * self.gear.sign

    def arm(self, position):
        """Distances (mm) of positions (mm, any shape) on the line of action from the foot."""
        return self.sense * (position - self.foot)

    def position(self, roll: float) -> float:
        """Position (mm) on the line of action of the flank point at a roll angle (rad)."""
        return self.foot + self.sense * self.gear.base_radius * roll
