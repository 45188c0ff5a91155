"""The sections within a gear's section: rack, web, cutter and support."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from fenics_gears.geometry.gear_data import RACKS, SUPPORTS, Web
from fenics_gears.inputs.fields import choice, number, quantity, whole_number
from fenics_gears.inputs.section import Section

if TYPE_CHECKING:
    from .gear_schema import Gears, GearText


def length(example: str, meaning: str, otherwise: str):
    return quantity("0.01 mm to 100 m", example, meaning=meaning, otherwise=otherwise)


def diameter(example: str, meaning: str, otherwise: str = ""):
    return quantity("0.1 mm to 100 m", example, meaning=meaning, otherwise=otherwise)


@dataclass(frozen=True)
class RackText(Section):
    """``[gears.rack]``: the generating rack of both gears, or within a gear's section its own. A figure that is given
    replaces that of the profile, and one of a gear's own that of both."""

    profile: str | None = choice(
        *RACKS,
        meaning=(
            "addendum, dedendum and tip radius by ISO 53:1998, Annex A: A 1/1.25/0.38, B 1/1.25/0.3, C 1/1.25/0.25, D"
            " 1/1.4/0.39; GOST 13755-2015 has the same, and DIN 867 A"
        ),
        otherwise="`ISO 53 A`",
    )
    addendum: float | None = number(
        1.0, meaning="addendum h_aP of the basic rack, in modules", above=0, highest=3, otherwise="that of the profile"
    )
    dedendum: float | None = number(
        1.25, meaning="dedendum h_fP of the basic rack, in modules", above=0, highest=3, otherwise="that of the profile"
    )
    tip_radius: float | None = number(
        0.38,
        meaning="tip radius of the rack's tooth, in modules; it shapes the fillet",
        lowest=0,
        highest=2,
        otherwise="that of the profile, or what has room on the rack's tip",
    )
    protuberance: float | None = quantity(
        "0 mm to 1 m",
        "0.15 mm",
        meaning=(
            "amount pr_P0 by which the rounding of the rack's tip stands out beyond its flank, normal to it, so that"
            " the root is cut free"
        ),
        otherwise="0 mm",
    )
    protuberance_angle: float | None = quantity(
        "1 deg to 34 deg",
        "10 deg",
        meaning="pressure angle alpha_prP0 of the short flank between protuberance and flank",
        otherwise="half the pressure angle; has no meaning without `protuberance`",
    )
    finishing_stock: float | None = quantity(
        "0 mm to 1 m",
        "0.1 mm",
        meaning="stock q, normal to the flanks, that finishing takes off these alone; no more than `protuberance`",
        otherwise="0 mm",
    )


@dataclass(frozen=True)
class WebText(Section):
    """``[gears.pinion.web]`` and ``[gears.wheel.web]``: a web between hub and rim that is less wide than the face. In
    the plane it counts by its share of the face width; over the face it is a body of its own, and the rim bends on
    it."""

    rim_inner_diameter: float = diameter("100 mm", "inner diameter of the rim, where the web ends")
    width: float = length("8 mm", "width of the web, at most the gear's face width", "")
    hub_diameter: float | None = diameter(
        "50 mm", "outer diameter of the hub, where the web begins", "the bore diameter"
    )
    axial_offset: float | None = quantity(
        "-100 m to 100 m",
        "2 mm",
        meaning="middle of the web from the gear's mid-width, positive as the gear's own `axial_offset`",
        otherwise="0 mm",
        over_face=True,
    )

    def data(self, bore_diameter: float, face_width: float) -> Web:
        """The web of a gear, in parts of its face width."""
        return Web(
            0.5 * (self.hub_diameter or bore_diameter),
            0.5 * self.rim_inner_diameter,
            self.width / face_width,
            offset=(self.axial_offset or 0.0) / face_width,
        )


@dataclass(frozen=True, kw_only=True)
class CutterText(Section):
    """``[gears.wheel.cutter]``: the shaper cutter of an internal gear, whose tip shapes the fillets; its tip diameter
    follows from the root diameter."""

    teeth: int = whole_number(5, 1000, 23, meaning="number of teeth z_0 of the cutter")
    profile_shift: float | None = number(
        0.1,
        meaning="profile shift x_0 of the cutter, as it is ground at present, in modules",
        lowest=-2,
        highest=2,
        otherwise="0",
    )


@dataclass(frozen=True, kw_only=True)
class SupportText(Section):
    """``[gears.wheel.support]``: what holds the outer circle of an internal gear; `support = "held"` is short for the
    kind alone."""

    kind: str = choice(
        *SUPPORTS,
        meaning="`held`: the outer circle is rigid; `foundation`: springs evenly over the outer circle, as of a soft"
        " housing, whose other end is rigid. Bolts, pins and splines of a pair in the plane are `[wheel_points]`",
        otherwise="`held`",
    )
    radial_stiffness: float | None = quantity(
        "1e-6 N/mm^3 to 1e12 N/mm^3",
        "500 N/mm^3",
        meaning="radial stiffness of the foundation per area of the outer circle",
        otherwise="required of a foundation",
    )
    tangential_stiffness: float | None = quantity(
        "1e-6 N/mm^3 to 1e12 N/mm^3",
        "200 N/mm^3",
        meaning="its tangential stiffness per area, over the face along the axis too",
        otherwise="required of a foundation",
    )


def of_rack(pair: Gears, drawn: GearText, figure: str) -> Any:
    """A figure of the gear's own rack, else of both; None where a profile has precedence, or there is none."""
    for section in (drawn.rack, pair.rack):
        if section is not None and (getattr(section, figure) is not None or section.profile is not None):
            return getattr(section, figure)
    return None


def protuberance(pair: Gears, own: GearText) -> tuple[float, float]:
    """Protuberance left beyond the finished flank, mm, and its angle, rad; of the gear's own rack, else of both."""

    def given(figure: str, otherwise: float) -> float:
        amounts = (getattr(each, figure) for each in (own.rack, pair.rack) if each is not None)
        return float(next((each for each in amounts if each is not None), otherwise))

    beyond = given("protuberance", 0.0) - given("finishing_stock", 0.0)
    return beyond, given("protuberance_angle", 0.5 * pair.pressure_angle) if beyond else 0.0
