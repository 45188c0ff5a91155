"""``[profile_modifications]``: crowning and slope of the profile of either gear (``geometry.profile_modification``)."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Optional

from fenics_gears.effects.effect import Effect
from fenics_gears.geometry.profile_modification_data import ProfileModifications
from fenics_gears.inputs.fields import Section, quantity
from fenics_gears.inputs.problem import Problem
from fenics_gears.inputs.tree import GEARS, Tree, table, too_large_for_the_module


class ProfileModificationText(Section):
    """``[profile_modifications.pinion]`` and ``[profile_modifications.wheel]``: over the flank's used part, from the
    start of active profile to the tip;
    each field alone is enough."""

    crowning: Optional[float] = quantity(
        "-100 mm",
        "100 mm",
        "4 um",
        meaning=(
            "height of the crowning, a parabola over the roll angle: removed at both ends, nothing in the middle; where"
            " it is negative, in the middle and nothing at the ends"
        ),
        otherwise="no crowning",
    )
    slope: Optional[float] = quantity(
        "-100 mm",
        "100 mm",
        "5 um",
        meaning=(
            "slope, removed in proportion to the roll angle: so much at the tip; where it is negative, so much at the"
            " start of active profile and nothing at the tip"
        ),
        otherwise="no slope",
    )


class ProfileModificationsText(Section):
    """``[profile_modifications]``: amounts normal to the flank in the transverse section, which is along the line of
    action there, the same on all teeth of a gear."""

    pinion: Optional[ProfileModificationText] = None
    wheel: Optional[ProfileModificationText] = None


def modifications_are_small_and_given(tree: Tree) -> Iterator[Problem]:
    """Some gear has some modification, small against its teeth."""
    section = table(tree, "profile_modifications")
    if section is None:
        return
    if not section:
        message = (
            "modifies neither gear. Add [profile_modifications.pinion] or [profile_modifications.wheel], or leave the"
            " section out."
        )
        yield Problem(("profile_modifications",), "", message)
    for gear in GEARS:
        own = table(section, gear)
        if own is not None and not own:
            yield Problem(
                ("profile_modifications", gear),
                "",
                "names no modification. Add crowning or slope, or leave the section out.",
            )
        for name in ProfileModificationText.model_fields:
            yield from too_large_for_the_module(tree, ("profile_modifications", gear, name), (own or {}).get(name))


def removal(modifications: ProfileModifications, pair):
    """Material removed from pinion and wheel."""
    from fenics_gears.geometry.profile_modification import profile_curves

    return profile_curves(pair, modifications)


EFFECT = Effect(
    section="profile_modifications",
    description="crowning and slope of the profiles",
    absent="profiles without crowning and slope",
    text=ProfileModificationsText,
    data=ProfileModifications,
    terms=("gaps between the flanks",),
    rules=modifications_are_small_and_given,
    removal=removal,
)
