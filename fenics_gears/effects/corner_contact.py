"""``[corner_contact]``: tips touch before and after the theoretical path of contact (``contact.corner``)."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Optional

from fenics_gears.effects.effect import Effect, own_or_shared
from fenics_gears.inputs.fields import Section, quantity
from fenics_gears.inputs.problem import Problem
from fenics_gears.inputs.spelling import field_of
from fenics_gears.inputs.tree import GEARS, Tree, value_at


@dataclass(frozen=True)
class CornerContact:
    """Radius of the edge between flank and tip circle, of pinion and wheel, mm; 0 for a sharp edge."""

    edge_radii: tuple[float, float]


class EdgeText(Section):
    """``[corner_contact.pinion]`` and ``[corner_contact.wheel]``: an edge radius of the gear's own, in place of that in
    ``[corner_contact]``."""

    edge_radius: Optional[float] = quantity(
        "0 mm",
        "1 m",
        "0.1 mm",
        meaning="radius of the edge between flank and tip circle",
        otherwise="0 mm, a sharp edge",
    )


class CornerContactText(EdgeText):
    """``[corner_contact]``: the edge radius of both gears."""

    pinion: Optional[EdgeText] = None
    wheel: Optional[EdgeText] = None


def read(text: CornerContactText) -> CornerContact:
    """Each gear's own radius before that of both."""
    return CornerContact(
        tuple(float(own_or_shared(own, text, "edge_radius") or 0.0) for own in (text.pinion, text.wheel))
    )


def write(corner: CornerContact) -> dict:
    """The section, with a radius for each gear."""
    return {
        name: {"edge_radius": field_of(EdgeText, "edge_radius", radius)}
        for name, radius in zip(GEARS, corner.edge_radii)
    }


def route_has_corners(tree: Tree) -> Iterator[Problem]:
    """Remeshing at every step has no nodes beside the path of contact."""
    if "corner_contact" in tree and value_at(tree, "accuracy", "condensation") == "every step":
        message = (
            'has no contact of tips off the line of action. Take "once", or leave the section [corner_contact] out.'
        )
        yield Problem(("accuracy", "condensation"), '"every step"', message)


EFFECT = Effect(
    section="corner_contact",
    description="contact of tip edges before and after the path of contact, along the normal of the mating flank",
    absent="tip edges touch along the line of action only",
    text=CornerContactText,
    data=CornerContact,
    terms=("contact of tip edges off the line of action",),
    needs=("tooth_elasticity",),
    read=read,
    write=write,
    rules=route_has_corners,
)
