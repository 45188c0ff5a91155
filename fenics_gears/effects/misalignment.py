"""``[misalignment]``: axes that are not parallel (``geometry.face``)."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Optional

from fenics_gears.effects.effect import Effect
from fenics_gears.geometry.face_data import Misalignment
from fenics_gears.inputs.fields import Section, quantity
from fenics_gears.inputs.problem import Problem
from fenics_gears.inputs.tree import Tree, table, too_large_for_the_module


def _deviation(example: str, meaning: str):
    return quantity("-100 mm", "100 mm", example, meaning=meaning, otherwise="0 um")


class MisalignmentText(Section):
    """``[misalignment]``: departure of the wheel's axis from parallel, as lengths over the common face width: it turns
    about the pitch point in the middle of the common face, so that half an amount opens one end and half closes the
    other. ISO/TR 10064-3 has such deviations in the plane of both axes and perpendicular to it; these are in the plane
    of action and perpendicular to it. The right end is the one from which the pinion is seen to
    turn counter-clockwise."""

    in_plane: Optional[float] = _deviation(
        "12 um",
        "in the plane of action: positive where the right end of the wheel's axis moves away from the pinion along the"
        " line of action",
    )
    out_of_plane: Optional[float] = _deviation(
        "0 um",
        "perpendicular to the plane of action: positive where the right end of the wheel's axis moves towards the side"
        " of the pinion's axis; opens nothing between drive flanks, whose contact points it moves in the plane of the"
        " flanks, but something between coast flanks",
    )


def misalignment_is_small_and_given(tree: Tree) -> Iterator[Problem]:
    """Some deviation is given, zero included, and is small against the teeth."""
    section = table(tree, "misalignment")
    if section is None:
        return
    if not section:
        yield Problem(
            ("misalignment",),
            "",
            'names no deviation. Add in_plane or out_of_plane, such as "12 um", or leave the section out.',
        )
    for name in MisalignmentText.model_fields:
        yield from too_large_for_the_module(tree, ("misalignment", name), section.get(name))


EFFECT = Effect(
    section="misalignment",
    description="axes that are not parallel",
    absent="parallel axes",
    text=MisalignmentText,
    data=Misalignment,
    terms=("gaps between the flanks that vary along the face",),
    needs=("tooth_elasticity",),
    excludes=("body_meshes",),
    rules=misalignment_is_small_and_given,
)
