import numpy as np
import pytest
from tests.manufactured import l2_error

from fenics_gears.elasticity.elements import ELEMENTS

ORDERS = {"P1": 2, "P2": 3, "Q1": 2, "Q1 incompatible": 2, "Q2": 3}


@pytest.mark.parametrize("name", ELEMENTS)
def test_order_of_the_displacement_error(name):
    """Known order (Brenner & Scott, ch. 5): the L2 error falls as h^(p + 1)."""
    errors = [l2_error(name, cells, 0.3) for cells in (6, 12, 24)]
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert abs(orders[-1] - ORDERS[name]) < 0.15
