"""``[profile_modifications]``: crowning and slope of the profile of either gear (``geometry.profile_modification``)."""

from dataclasses import dataclass

from fenics_gears.inputs.fields import quantity
from fenics_gears.inputs.section import Section

from .effect import Effect


@dataclass(frozen=True)
class ProfileModification(Section):
    """``[profile_modifications.pinion]`` and ``[profile_modifications.wheel]``: over the flank's used part, from the
    start of active profile to the tip;
    each field alone is enough."""

    empty = "names no modification. Add crowning or slope, or leave the section out."

    crowning: float = quantity(
        "-100 mm to 100 mm",
        "4 um",
        meaning="height of the crowning, a parabola over the roll angle: removed at both ends, nothing in the"
        " middle; where it is negative, in the middle and nothing at the ends",
        default="0 um",
        otherwise="no crowning",
        small=True,
    )
    slope: float = quantity(
        "-100 mm to 100 mm",
        "5 um",
        meaning="slope, removed in proportion to the roll angle: so much at the tip; where it is negative, so much"
        " at the start of active profile and nothing at the tip",
        default="0 um",
        otherwise="no slope",
        small=True,
    )


@dataclass(frozen=True)
class ProfileModifications(Section):
    """``[profile_modifications]``: amounts normal to the flank in the transverse section, which is along the line of
    action there, the same on all teeth of a gear."""

    empty = (
        "modifies neither gear. Add [profile_modifications.pinion] or [profile_modifications.wheel], or leave the"
        " section out."
    )

    pinion: ProfileModification | None = None
    wheel: ProfileModification | None = None


def removal(modifications: ProfileModifications, pair):
    from fenics_gears.geometry.profile_modification import profile_curves

    return profile_curves(pair, modifications)


EFFECT = Effect(
    section="profile_modifications",
    description="crowning and slope of the profiles",
    absent="profiles without crowning and slope",
    fields=ProfileModifications,
    terms=("gaps between the flanks",),
    removal=removal,
)
