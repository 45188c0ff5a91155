"""``[lead_modifications]``: crowning, helix slope and end relief of either gear (``geometry.face``)."""

from __future__ import annotations

from typing import Literal, Optional

from fenics_gears.effects.effect import Effect
from fenics_gears.geometry.face_data import BOTH, LEFT, RIGHT, LeadModifications
from fenics_gears.inputs.fields import Section, choice, quantity

FIELDS = ("crowning", "helix_slope", "end_relief")


def _amount(lowest: str, example: str, meaning: str, otherwise: str):
    return quantity(lowest, "100 mm", example, meaning=meaning, otherwise=otherwise)


class EndReliefText(Section):
    """``end_relief`` of ``[lead_modifications.pinion]`` and ``[lead_modifications.wheel]``: parabolic, without a kink at its start."""

    depth: float = quantity("0 um", "100 mm", "10 um", meaning="depth at the end of the face, along the line of action")
    length: float = quantity("1e-3 um", "100 m", "4 mm", meaning="length of the relief, along the axis from the end of the face")
    sides: Optional[Literal["both", "left", "right"]] = choice(
        BOTH, LEFT, RIGHT, meaning="ends of the face that are relieved; the right one is in the direction of the axes", otherwise="`both`"
    )


class LeadModificationText(Section):
    """``[lead_modifications.pinion]`` and ``[lead_modifications.wheel]``, over the gear's own face width; each field alone is enough."""

    crowning: Optional[float] = _amount("0 um", "6 um", "crowning: height of a parabola, removed at both ends of the face, nothing in its middle", "no crowning")
    helix_slope: Optional[float] = _amount(
        "-100 mm", "8 um", "helix slope: removed in proportion to the distance from the left end, so much at the right end; negative: so much at the left end", "none"
    )
    end_relief: Optional[EndReliefText] = None


class LeadModificationsText(Section):
    """``[lead_modifications]``; amounts along the line of action in the transverse section."""

    pinion: Optional[LeadModificationText] = None
    wheel: Optional[LeadModificationText] = None


EFFECT = Effect(
    section="lead_modifications",
    description="crowning, helix slope and end relief of the flanks",
    absent="flanks without lead modifications",
    text=LeadModificationsText,
    data=LeadModifications,
    terms=("gaps between the flanks that vary along the face",),
)
