"""A gear as a lumped mass."""

from dataclasses import dataclass


@dataclass(frozen=True)
class LumpedGear:
    """`mass`, N s^2/mm, and `moment_of_inertia`, N mm s^2, at a gear's centre; `width`, mm, of its face;
    `given_tilting`: about a diameter, where given."""

    mass: float
    moment_of_inertia: float
    width: float
    given_tilting: float | None = None

    @property
    def tilting_inertia(self) -> float:
        """Moment of inertia, N mm s^2, about a diameter at mid-width: as given, or J/2 + m b^2/12.

        That is a disc's; exact for any body whose sections along the width are alike, on the average over a turn, and
        with three teeth or more at any time.
        """
        if self.given_tilting is not None:
            return self.given_tilting
        return 0.5 * self.moment_of_inertia + self.mass * self.width**2 / 12.0
