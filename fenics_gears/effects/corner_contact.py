"""``[corner_contact]``: tips touch before and after the theoretical path of contact (``contact.corner``)."""

from dataclasses import dataclass

from fenics_gears.inputs.fields import quantity
from fenics_gears.inputs.problem import Broken
from fenics_gears.inputs.section import Section
from fenics_gears.inputs.tree import PerGear, Tree, value_at

from .effect import Effect, own_or_shared


@dataclass(frozen=True)
class Edge(Section):
    """``[corner_contact.pinion]`` and ``[corner_contact.wheel]``: an edge radius of the gear's own, in place of that in
    ``[corner_contact]``."""

    edge_radius: float | None = quantity(
        "0 mm to 1 m",
        "0.1 mm",
        meaning="radius of the edge between flank and tip circle",
        otherwise="0 mm, a sharp edge",
    )


@dataclass(frozen=True)
class EdgeRadii(Edge, PerGear):
    """``[corner_contact]``: the edge radius of both gears."""

    pinion: Edge | None = None
    wheel: Edge | None = None

    @property
    def edge_radii(self) -> tuple[float, float]:
        """Radius of the edge of pinion and wheel, mm; 0 for a sharp edge."""
        first, second = (own_or_shared(own, self, "edge_radius") or 0.0 for own in self.of_gears)
        return first, second


def route_has_corners(tree: Tree) -> Broken:
    """Remeshing at every step has no nodes off the path of contact."""
    if "corner_contact" in tree and value_at(tree, "accuracy", "condensation") == "every step":
        message = (
            'has no contact of tips off the line of action. Take "once", or leave the section [corner_contact] out.'
        )
        yield ("accuracy", "condensation"), message


EFFECT = Effect(
    section="corner_contact",
    description="contact of tip edges before and after the path of contact, along the normal of the mating flank",
    absent="tip edges touch along the line of action only",
    fields=EdgeRadii,
    terms=("contact of tip edges off the line of action",),
    needs=("tooth_elasticity",),
    rules=route_has_corners,
)
