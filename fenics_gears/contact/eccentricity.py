"""How gears sit on their shafts: off their axes, or leaning."""

from dataclasses import dataclass

from fenics_gears.inputs.fields import quantity
from fenics_gears.inputs.section import Section
from fenics_gears.inputs.tree import PerGear


def _angle(of: str, field: str):
    meaning = (
        f"{of} at the start of the first mesh cycle: angle from the line of action (pinion to wheel), in the gear's"
        " sense of rotation"
    )
    otherwise = f"0 deg; has no meaning without {field}"
    return quantity("-360 deg to 360 deg", "90 deg", meaning=meaning, default="0 deg", otherwise=otherwise)


@dataclass(frozen=True)
class Offset(Section):
    """``[eccentricity.pinion]`` and ``[eccentricity.wheel]``: a distance, or in three-dimensional scenes a wobble, or
    both."""

    distance: float = quantity(
        "0 um to 100 mm",
        "10 um",
        meaning="eccentricity: distance of the base circle's centre from the axis of rotation, at mid-width",
        default="0 um",
        otherwise="no eccentricity, for `wobble` alone",
        small=True,
    )
    phase: float = _angle("direction of the base circle's centre", "`distance`")
    wobble: float = quantity(
        "0 um to 100 mm",
        "10 um",
        meaning=("wobble: how far the axis of the teeth departs from the axis of rotation over the gear's face width"),
        default="0 um",
        otherwise="no wobble; not allowed in a plane scene",
        small=True,
        over_face=True,
    )
    wobble_phase: float = _angle("direction in which the axis of the teeth leans towards the right end", "`wobble`")


@dataclass(frozen=True)
class Eccentricity(Section, PerGear):
    """``[eccentricity]``."""

    empty = (
        "says of neither gear that it runs out. Add [eccentricity.pinion] or [eccentricity.wheel], or leave the section"
        " out."
    )

    pinion: Offset | None = None
    wheel: Offset | None = None
