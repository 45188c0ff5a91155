"""How flanks give way beside a free end: wedges of finite elements, and quadrature."""

import numpy as np
import pytest
from scipy.integrate import quad
from tests.wedge import softening

from fenics_gears import Material
from fenics_gears.contact.face_ends import displacement_beside
from fenics_gears.elasticity.face.free_end import ANGLES, POISSON, free_ends, wedge_softening


@pytest.mark.parametrize(("poissons_ratio", "angle"), [(0.3, 0.0), (0.0, 20.0)])
def test_an_edge_is_as_soft_as_one_of_finite_elements(poissons_ratio, angle):
    """A wedge of finite elements, coarse: within 2 % of what the edge moves in all."""
    expected = softening(angle, poissons_ratio, least=0.05, largest=12.0)
    assert 1.0 + wedge_softening(angle, poissons_ratio) == pytest.approx(1.0 + expected, rel=0.02)


@pytest.mark.nightly
@pytest.mark.parametrize("poissons_ratio", POISSON)
@pytest.mark.parametrize("angle", ANGLES)
def test_all_edges_are_as_soft_as_those_of_finite_elements(poissons_ratio, angle):
    """A wedge of finite elements: the table is made of these."""
    expected = softening(angle, poissons_ratio)
    assert 1.0 + wedge_softening(angle, poissons_ratio) == pytest.approx(1.0 + expected, rel=0.01)


def test_a_right_edge_of_a_material_that_does_not_contract_is_as_soft_as_elsewhere():
    """Exact: plane strain has no stress on the end face then."""
    assert wedge_softening(0.0, 0.0) == pytest.approx(0.0, abs=1e-12)


def test_coast_flanks_lean_the_other_way():
    """Identity: half a turn about a tooth's centreline takes one flank to the other, and z to -z."""
    ends = free_ends(0.3, Material(206000.0, 0.3), 1.0)
    assert ends.of_flank(1) == ends.of_flank(0)[::-1]
    assert ends.softness[0] < 0.0 < ends.softness[1]


@pytest.mark.parametrize(("near", "far", "apart"), [(0.0, 0.4, 0.0), (0.0, 0.4, 0.05), (0.4, 0.8, 0.02)])
def test_the_average_over_a_slice_is_that_of_quadrature(near, far, apart):
    """The law of `free_end`, integrated by quadrature."""
    softness, reach = 3e-6, 0.2

    def law(place: float) -> float:
        return 0.5 * softness * np.log1p(reach**2 / (place**2 + apart**2))

    expected = quad(law, near, far, epsrel=1e-10, limit=200)[0] / (far - near)
    assert displacement_beside.py_func(np.array([softness, near, far, reach]), apart) == pytest.approx(
        expected, rel=1e-7
    )
