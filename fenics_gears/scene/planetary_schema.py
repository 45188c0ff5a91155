"""What ``[stages.NAME]`` with ``kind = "planetary"`` has beside the fields of gears."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from fenics_gears.geometry.planetary import MEMBERS, RING, SUN
from fenics_gears.inputs.allowed import Allowed, Refused
from fenics_gears.inputs.fields import choice, declared, quantities, quantity, whole_number
from fenics_gears.inputs.problem import did_you_mean
from fenics_gears.inputs.section import Section

PLANETARY = "planetary"
SUN_MESH = "sun_mesh"
RING_MESH = "ring_mesh"
MESHES = (SUN_MESH, RING_MESH)
GEARS_OF_SET = ("sun", "planet", "ring")
MOST_PLANETS = 10
# Effects of a pair that the meshes of a set may have of their own.
OF_A_MESH = ("tip_relief", "root_relief", "profile_modifications", "corner_contact")
PIN_ERRORS = "-10 mm to 10 mm"


@dataclass(frozen=True, kw_only=True)
class AllowedMembers(Allowed):
    """A list of members of a set, each once."""

    names: tuple[str, ...]

    def convert(self, value: Any) -> tuple[str, ...]:
        if not isinstance(value, list) or not all(isinstance(each, str) for each in value):
            raise Refused("is no list of members.")
        for each in value:
            if each not in self.names:
                raise Refused(f'has "{each}", which is none of them.{did_you_mean(each, self.names)}')
        if len({*value}) < len(value):
            raise Refused("names a member twice.")
        return tuple(value)


@dataclass(frozen=True, kw_only=True)
class CarrierText(Section):
    """``[stages.NAME.carrier]``: the pins of the planets."""

    pin_stiffness: float | None = quantity(
        "1e-3 N/mm to 1e15 N/mm",
        "3e5 N/mm",
        meaning="stiffness of each pin and its bearing, alike in all directions",
        otherwise="pins do not give way",
    )
    pin_errors: tuple[float, ...] | None = quantities(
        PIN_ERRORS,
        "20 um",
        "0 um",
        meaning="by how much each pin stands beside its place along the circle of the planets, in the order of the"
        " planets; positive against the force of its planet, which then carries more",
        otherwise="0 mm",
    )
    radial_pin_errors: tuple[float, ...] | None = quantities(
        PIN_ERRORS, "20 um", "0 um", meaning="by how much each pin stands further out than its place", otherwise="0 mm"
    )


@dataclass(frozen=True, kw_only=True)
class PlanetaryText(Section):
    """A planetary set, whose planets are alike: their places, which member is fixed, and between which the power
    goes."""

    alternatives = (("planets", "planet_angles"),)

    planets: int | None = whole_number(
        2,
        MOST_PLANETS,
        3,
        meaning="number of planets, equally spaced, the first one in direction 0",
        otherwise="`planet_angles`",
    )
    planet_angles: tuple[float, ...] | None = quantities(
        "-360 deg to 360 deg",
        "0 deg",
        "91.43 deg",
        meaning="directions of the planets from the centre, counter-clockwise; each at a multiple of 360 deg/(z_s +"
        " z_r) from the first, within a thousandth of it",
        otherwise="from `planets`",
    )
    fixed: str | None = choice(*MEMBERS, meaning="the member that does not turn", otherwise="required")
    input: str | None = choice(*MEMBERS, meaning="the member that is driven", otherwise="required")
    output: str | None = choice(*MEMBERS, meaning="the member with the load", otherwise="the third one")
    floating: tuple[str, ...] | None = declared(
        AllowedMembers(
            description='a list of "sun" and "ring", such as ["sun"]',
            meaning="members whose centre nothing holds but their meshes; three planets or more centre them",
            otherwise="centres are held",
            names=(SUN, RING),
        )
    )
    carrier: CarrierText | None = None
