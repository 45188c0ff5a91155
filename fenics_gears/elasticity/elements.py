"""The finite elements that a body can be made of."""

from dataclasses import dataclass
from difflib import get_close_matches

from fenics_gears.errors import SceneError


@dataclass(frozen=True)
class Element:
    """A Lagrange element: its name, corners of its cell, polynomial order, order its products are integrated to.

    ``incompatible_modes``: with Wilson's modes within each cell (``elasticity.incompatible_modes``).
    """

    name: str
    corners: int
    order: int
    quadrature_degree: int
    incompatible_modes: bool = False

    def __post_init__(self):
        if self.order not in (1, 2):
            raise ValueError(
                f"element {self.name}: order = {self.order}: a mesh has nodes at corners and middles of sides only."
                " Allowed: 1 or 2."
            )

    @property
    def quadrilateral(self) -> bool:
        """Whether the cell has four corners."""
        return self.corners == 4


# Triangles are affine and integrated exactly; quadrilaterals get the full Gauss rule, (order + 1)^2 points.
ELEMENTS = {
    element.name: element
    for element in (
        Element("P1", 3, 1, 0),
        Element("P2", 3, 2, 2),
        Element("Q1", 4, 1, 3),
        Element("Q1 incompatible", 4, 1, 3, incompatible_modes=True),
        Element("Q2", 4, 2, 5),
    )
}


def element_named(name: str) -> Element:
    """The element of that name; raises SceneError that names the nearest known one."""
    if name in ELEMENTS:
        return ELEMENTS[name]
    in_capitals = {known.upper(): known for known in ELEMENTS}
    near = get_close_matches(str(name).upper(), in_capitals, n=1, cutoff=0.3)
    hint = f"; did you mean '{in_capitals[near[0]]}'?" if near else ""
    raise SceneError(f"element '{name}' is not known, there are {', '.join(ELEMENTS)}{hint}")
