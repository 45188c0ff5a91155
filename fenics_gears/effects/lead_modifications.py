"""``[lead_modifications]``: crowning, helix slope and end relief of either gear (``geometry.face``)."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Literal, Optional

from fenics_gears.effects.effect import Effect
from fenics_gears.geometry.face_data import BOTH, LEFT, RIGHT, LeadModifications
from fenics_gears.geometry.relief_data import LINEAR, PARABOLIC
from fenics_gears.inputs.fields import Section, choice, quantity
from fenics_gears.inputs.problem import Problem
from fenics_gears.inputs.tree import GEARS, Tree, quantity_at, table, too_large_for_the_module, value_at
from fenics_gears.inputs.written import as_written

FIELDS = ("crowning", "helix_slope", "end_relief")


class EndReliefText(Section):
    """``[lead_modifications.pinion.end_relief]`` and the wheel's: also written ``end_relief = { depth = "10 um", length
    = "4 mm" }``."""

    depth: float = quantity("0 um", "100 mm", "10 um", meaning="depth at the end of the face, along the line of action")
    length: float = quantity(
        "1e-3 um", "100 m", "4 mm", meaning="length of the relief along the axis, from its start to the end of the face"
    )
    sides: Optional[Literal["both", "left", "right"]] = choice(
        BOTH, LEFT, RIGHT, meaning="ends of the face that are relieved", otherwise="`both`"
    )
    shape: Optional[Literal["linear", "parabolic"]] = choice(
        LINEAR,
        PARABOLIC,
        meaning=(
            "growth of the relief with the distance from its start: `linear` starts with a kink, `parabolic` without"
        ),
        otherwise="`linear`",
    )


class LeadModificationText(Section):
    """``[lead_modifications.pinion]`` and ``[lead_modifications.wheel]``: over the gear's own face width; each field
    alone is enough."""

    crowning: Optional[float] = quantity(
        "0 um",
        "100 mm",
        "6 um",
        meaning="height of the crowning, a parabola: removed at both ends of the face, nothing in its middle",
        otherwise="no crowning",
    )
    helix_slope: Optional[float] = quantity(
        "-100 mm",
        "100 mm",
        "8 um",
        meaning=(
            "helix slope modification: material removed in proportion to the distance from the left end of the gear's"
            " own face, nothing there and so much at the right end; a negative one removes nothing at the right end."
            " Unlike a misalignment it removes half its amount on average, which shows in the mean transmission error"
        ),
        otherwise="no helix slope modification",
    )
    end_relief: Optional[EndReliefText] = None


class LeadModificationsText(Section):
    """``[lead_modifications]``: amounts along the line of action in the transverse section. The right end of the face
    is the one from which the pinion
    is seen to turn counter-clockwise."""

    pinion: Optional[LeadModificationText] = None
    wheel: Optional[LeadModificationText] = None


def modifications_fit_the_face(tree: Tree) -> Iterator[Problem]:
    """Some gear has some modification, small against its teeth, and end reliefs have room on the face."""
    section = table(tree, "lead_modifications")
    if section is None:
        return
    if not section:
        message = (
            "modifies neither gear. Add [lead_modifications.pinion] or [lead_modifications.wheel], or leave the section"
            " out."
        )
        yield Problem(("lead_modifications",), "", message)
    for gear in GEARS:
        own = table(section, gear)
        if own is None:
            continue
        if not own:
            yield Problem(
                ("lead_modifications", gear),
                "",
                f"names no modification. Add {', '.join(FIELDS[:2])} or {FIELDS[2]}, or leave the section out.",
            )
        for path in (("crowning",), ("helix_slope",), ("end_relief", "depth")):
            place = ("lead_modifications", gear, *path)
            yield from too_large_for_the_module(tree, place, value_at(tree, *place))
        yield from _end_relief_has_room(tree, gear)


def _end_relief_has_room(tree: Tree, gear: str) -> Iterator[Problem]:
    home = ("lead_modifications", gear, "end_relief")
    length, sides = quantity_at(tree, *home, "length"), value_at(tree, *home, "sides")
    width = quantity_at(tree, "gears", gear, "face_width") or quantity_at(tree, "gears", "face_width")
    if length is None or width is None or not width > 0.0:
        return
    room = width if sides in (LEFT, RIGHT) else 0.5 * width
    if length > room:
        ends = f"the {sides} end" if sides in (LEFT, RIGHT) else "both ends"
        message = f"is too long for {ends} of a face of {width:g} mm. Allowed: up to {room:g} mm."
        yield Problem((*home, "length"), as_written(value_at(tree, *home, "length")), message)


EFFECT = Effect(
    section="lead_modifications",
    description="crowning, helix slope and end relief of the flanks",
    absent="flanks without lead modifications",
    text=LeadModificationsText,
    data=LeadModifications,
    terms=("gaps between the flanks that vary along the face",),
    needs=("tooth_elasticity",),
    excludes=("body_meshes",),
    rules=modifications_fit_the_face,
)
