"""The body's element size: a family of meshes of known order."""

import numpy as np
import pytest

from fenics_gears.elasticity.compliance import Reach
from fenics_gears.elasticity.element_sizes import DEFAULT_SIZES, Discretisation
from fenics_gears.elasticity.elements import Element, element_named
from fenics_gears.elasticity.gear_compliance import flank_compliance

FLANK = 0.3


def stretched(gear, steel, element, factor):
    """Mean displacement along x under a force spread over the whole flank, mm per N/mm."""
    order = element_named(element).order
    body = gear.module * DEFAULT_SIZES[order].body * factor
    found = flank_compliance(gear, steel, Discretisation(element, FLANK, body), Reach(0))
    elements = (found.nodes - 1) // order
    shares = np.zeros(found.nodes)
    for first in range(elements):
        shares[order * first : order * (first + 1) + 1] += (
            np.array([1.0, 4.0, 1.0]) / 6.0 if order == 2 else 0.5
        ) / elements
    return shares @ found.blocks[0][::2, ::2] @ shares


@pytest.mark.parametrize("element, factors", [("P2", (2.0, 1.0, 0.5, 0.25)), ("Q2", (2.0, 1.0, 0.5))])
def test_the_error_falls_with_the_square_of_the_size(pinion, steel, element, factors):
    """Strang and Berger 1973: straight sides along a curved outline leave h^2."""
    changes = np.diff([stretched(pinion, steel, element, factor) for factor in factors])
    assert (changes > 0.0).all()
    orders = np.log2(changes[:-1] / changes[1:])
    assert np.abs(orders - 2.0).max() < 0.5


def test_an_element_of_third_order_is_refused():
    """House rule 7: nodes are numbered at corners and middles of sides only."""
    with pytest.raises(ValueError, match="order = 3.*Allowed: 1 or 2"):
        Element("P3", 3, 3, 4)
