"""The mesh stiffness at a step."""

from types import SimpleNamespace

import numpy as np
import pytest
from tests.contact.problems import pressed

from fenics_gears.contact.addresses import Arrays
from fenics_gears.contact.mesh import elastic_mesh
from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.contact.window import ContactGrid
from fenics_gears.results.mesh_curves import NO_FACES, mesh_stiffness

ROTATION_OF_THE_WHEEL = 5
LOAD = 7e3


def stiffness(operator, solution):
    nothing, none = np.empty(0), np.empty((0, 0))
    contact = Arrays(
        operator.compliance, operator.jacobian, operator.gap, operator.on_drive_flanks, operator.node_pair,
        operator.node_pair, nothing, none, none, nothing,
    )  # fmt: skip
    secant, tangent, pairs = mesh_stiffness(contact, solution.status, solution.forces, solution.coordinates, NO_FACES)
    return SimpleNamespace(secant=secant, tangent=tangent, pairs=pairs)


@pytest.fixture(scope="module")
def cycle(stand_in_flanks):
    """Frictionless contact of elastic stand-in teeth, of which only the wheel turns."""
    return Cycle(elastic_mesh(stand_in_flanks, ContactGrid(1.5, 31)), 20, [ROTATION_OF_THE_WHEEL], tangential=False)


@pytest.mark.parametrize("step", [0, 6, 11, 17])
def test_tangent_is_the_finite_difference_of_load_over_rotation(cycle, step):
    """Brute force: two static solutions, dF over the difference of rb2 phi2."""
    operator = cycle.position(step).operator
    softer, harder = (pressed(operator, LOAD * (1.0 + part)) for part in (-1e-6, 1e-6))
    assert np.array_equal(softer.status, harder.status)
    difference = 2e-6 * LOAD / float(harder.coordinates[0] - softer.coordinates[0])
    assert stiffness(operator, pressed(operator, LOAD)).tangent == pytest.approx(difference, rel=1e-6)


@pytest.mark.parametrize("step", [0, 11])
def test_secant_is_the_mean_of_the_tangents_from_no_load_on(cycle, step):
    """Identity: F/delta is the harmonic mean of dF/ddelta over the load (midpoint rule)."""
    operator, parts = cycle.position(step).operator, 400
    found = [stiffness(operator, pressed(operator, LOAD * (i + 0.5) / parts)) for i in range(parts)]
    softness = np.mean([1.0 / each.tangent for each in found])
    assert stiffness(operator, pressed(operator, LOAD)).secant == pytest.approx(1.0 / softness, rel=2e-3)
    assert found[-1].secant < found[-1].tangent


def test_pairs_that_carry(cycle):
    """Contact ratio 1.47: half of the mesh cycle two pairs carry, then one."""
    found = [stiffness(cycle.position(step).operator, pressed(cycle.position(step).operator, LOAD)) for step in (4, 15)]
    assert [each.pairs for each in found] == [2, 1]
    assert found[0].secant > 1.2 * found[1].secant and found[0].tangent > 1.2 * found[1].tangent
