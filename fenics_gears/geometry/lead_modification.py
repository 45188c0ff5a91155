"""What is removed from a gear's flanks along its face: crowning, helix slope and end relief."""

from dataclasses import dataclass

from fenics_gears.inputs.fields import choice, quantity
from fenics_gears.inputs.section import Section
from fenics_gears.inputs.tree import PerGear

from .relief import LINEAR, PARABOLIC, POWERS

BOTH = "both"
LEFT = "left"
RIGHT = "right"


@dataclass(frozen=True)
class EndRelief(Section):
    """``[lead_modifications.pinion.end_relief]`` and the wheel's: also written ``end_relief = { depth = "10 um", length
    = "4 mm" }``."""

    depth: float = quantity(
        "0 um to 100 mm", "10 um", meaning="depth at the end of the face, along the line of action", small=True
    )
    length: float = quantity(
        "1e-3 um to 100 m", "4 mm", meaning="length of the relief along the axis, from its start to the end of the face"
    )
    sides: str = choice(BOTH, LEFT, RIGHT, meaning="ends of the face that are relieved", default=BOTH)
    shape: str = choice(
        LINEAR,
        PARABOLIC,
        meaning=(
            "growth of the relief with the distance from its start: `linear` starts with a kink, `parabolic` without"
        ),
        default=LINEAR,
    )

    @property
    def ends(self) -> tuple[float, ...]:
        """The relieved ends of the face: -1 for the left one, 1 for the right one."""
        return {LEFT: (-1.0,), RIGHT: (1.0,), BOTH: (-1.0, 1.0)}[self.sides]

    @property
    def power(self) -> int:
        return POWERS[self.shape]


@dataclass(frozen=True)
class LeadModification(Section):
    """``[lead_modifications.pinion]`` and ``[lead_modifications.wheel]``: over the gear's own face width; each field
    alone is enough."""

    empty = "names no modification. Add crowning, helix_slope or end_relief, or leave the section out."

    crowning: float = quantity(
        "0 um to 100 mm",
        "6 um",
        meaning="height of the crowning, a parabola: removed at both ends of the face, nothing in its middle",
        default="0 um",
        otherwise="no crowning",
        small=True,
    )
    helix_slope: float = quantity(
        "-100 mm to 100 mm",
        "8 um",
        meaning="helix slope modification: material removed in proportion to the distance from the left end of the"
        " gear's own face, nothing there and so much at the right end; a negative one removes nothing at the right"
        " end. Unlike a misalignment it removes half its amount on average, which shows in the mean transmission error",
        default="0 um",
        otherwise="no helix slope modification",
        small=True,
    )
    end_relief: EndRelief | None = None


@dataclass(frozen=True)
class LeadModifications(Section, PerGear):
    """``[lead_modifications]``: amounts along the line of action in the transverse section. Viewed from the right end
    of the face the pinion turns counter-clockwise."""

    empty = (
        "modifies neither gear. Add [lead_modifications.pinion] or [lead_modifications.wheel], or leave the section"
        " out."
    )

    pinion: LeadModification | None = None
    wheel: LeadModification | None = None
