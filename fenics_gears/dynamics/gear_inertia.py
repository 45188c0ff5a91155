"""Mass and moment of inertia of each gear: as given, or from its cross-section by a density."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from fenics_gears.geometry.pair import GearPair

if TYPE_CHECKING:
    from fenics_gears.effects.inertia import Inertia
    from fenics_gears.geometry.section import CrossSection

GEARS = ("pinion", "wheel")


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


def lumped(inertia: Inertia, pair: GearPair, section: Callable[[str], CrossSection]) -> dict[str, LumpedGear]:
    """Lumped masses of "pinion" and "wheel"; `section`: a gear's cross-section, called only where a density is
    given."""
    return {name: _lumped(inertia, name, pair.face_widths[number], section) for number, name in enumerate(GEARS)}


def _lumped(inertia: Inertia, name: str, width: float, section: Callable[[str], CrossSection]) -> LumpedGear:
    given = inertia.of(name)
    if None not in (given.mass, given.moment_of_inertia):
        return LumpedGear(given.mass, given.moment_of_inertia, width, given.tilting_moment_of_inertia)
    body, per_area = section(name), given.density * width
    mass = per_area * body.area if given.mass is None else given.mass
    moment = per_area * body.polar_moment if given.moment_of_inertia is None else given.moment_of_inertia
    return LumpedGear(mass, moment, width, given.tilting_moment_of_inertia)
