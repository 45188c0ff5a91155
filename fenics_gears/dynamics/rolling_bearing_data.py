"""``[[bearings.pinion]] rolling``: a ball or roller bearing by its inner geometry (``dynamics.rolling_bearing``)."""

from collections.abc import Iterator
from dataclasses import dataclass
from math import pi

from fenics_gears.inputs.fields import choice, number, quantity, whole_number
from fenics_gears.inputs.section import Section

BALLS = "balls"
ROLLERS = "rollers"
OF_ROLLERS = ("length",)
OF_BALLS = ("inner_groove", "outer_groove")
# Radii of grooves over the ball's diameter to which ISO 281 and ISO/TS 16281 refer.
INNER_GROOVE = 0.52
OUTER_GROOVE = 0.53


def _length(example: str, meaning: str, limits: str = "0.1 mm to 10 m", **otherwise: str):
    return quantity(limits, example, meaning=meaning, **otherwise)


def _groove(meaning: str, otherwise: float):
    return number(
        otherwise, above=0.5, highest=1.0, meaning=f"radius of the {meaning} over the ball's diameter",
        otherwise=f"{otherwise:g}",
    )  # fmt: skip


@dataclass(frozen=True)
class RollingBearing(Section):
    """One row of balls or rollers between two rings."""

    number: int = whole_number(3, 500, 9, meaning="how many of them")
    diameter: float = _length("12.7 mm", "their diameter, of tapered rollers in the middle")
    pitch_diameter: float = _length("65 mm", "diameter of the circle through their middles")
    elements: str = choice(BALLS, ROLLERS, meaning="what rolls", default=BALLS)
    length: float | None = _length("14 mm", "effective length of a roller", otherwise="required of rollers")
    contact_angle: float = quantity(
        "-80 deg to 80 deg",
        "15 deg",
        meaning="nominal contact angle; positive where the bearing holds the shaft against moving to the right",
        default="0 deg",
    )
    clearance: float = _length(
        "10 um", "radial clearance in operation, negative for an interference", "-1 mm to 1 mm", default="0 mm"
    )
    preload: float = quantity(
        "0 N to 1e9 N",
        "200 N",
        meaning="axial force by which bearings with contact angles brace each other",
        default="0 N",
    )
    inner_groove: float | None = _groove("inner ring's groove", INNER_GROOVE)
    outer_groove: float | None = _groove("outer ring's groove", OUTER_GROOVE)

    @property
    def rollers(self) -> bool:
        return self.elements == ROLLERS

    @property
    def grooves(self) -> tuple[float, float]:
        return self.diameter * (self.inner_groove or INNER_GROOVE), self.diameter * (self.outer_groove or OUTER_GROOVE)

    @property
    def bracing(self) -> float:
        """Axial force, N, of the shaft on the bearing by its preload: positive towards the right."""
        return self.preload if self.contact_angle > 0.0 else -self.preload


def wrong_with(rolling: RollingBearing) -> Iterator[str]:
    """What does not fit within a rolling bearing, to be read after its name."""
    for names, without in ((OF_ROLLERS, BALLS), (OF_BALLS, ROLLERS)):
        found = [name for name in names if getattr(rolling, name) is not None]
        if rolling.elements == without and found:
            yield f"has {found[0]}, which {without} do not have; leave it out"
    if rolling.rollers and rolling.length is None:
        yield 'has rollers without length; allowed is such as "14 mm"'
    needed = rolling.number * rolling.diameter / pi
    if needed > rolling.pitch_diameter:
        yield (
            f"has {rolling.number} {rolling.elements} of {rolling.diameter:g} mm, which do not fit on a pitch_diameter"
            f" of {rolling.pitch_diameter:g} mm; allowed are {needed:.4g} mm and more"
        )
    if rolling.preload and not rolling.contact_angle:
        yield "has a preload without contact_angle; give one, or a negative clearance for an interference"
