"""Condensed bodies against exact solutions of plane strain elasticity; nearly incompressible ones: hard case 14."""

from math import pi

import numpy as np
import pytest
from tests.annulus import BORE, TOLERANCE, condensed_annulus, error_under_pressure, forces

from fenics_gears.elasticity.elements import ELEMENTS
from fenics_gears.elasticity.ring import centre_motion


@pytest.mark.parametrize("name", ELEMENTS)
def test_annulus_under_torque(name):
    """Exact solution: u_theta = T r/(4 pi G) (1/r_i^2 - 1/r^2), hub held, torque T per thickness (Timoshenko &
    Goodier)."""
    torque, poissons_ratio = 7.0, 0.3
    shear_modulus = 1.0 / (2.0 * (1.0 + poissons_ratio))

    def field(points):
        twist = torque / (4.0 * pi * shear_modulus) * (1.0 / BORE**2 - 1.0 / (points**2).sum(axis=1))
        return twist[:, None] * np.stack([-points[:, 1], points[:, 0]], axis=-1)

    body = condensed_annulus(name, poissons_ratio)
    reaction = centre_motion(body.points["rim"])[:, 2] @ forces(body, field).ravel()
    assert reaction == pytest.approx(torque, rel=TOLERANCE[name])


@pytest.mark.parametrize("name", ELEMENTS)
def test_annulus_under_pressure(name):
    """Lame's exact solution in plane strain; forces converge with twice the element's order."""
    assert error_under_pressure(name, 0.3) <= TOLERANCE[name]
