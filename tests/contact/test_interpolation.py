"""Hat-averaged interpolation."""

import numpy as np
import pytest

from fenics_gears.contact.flank_at_height import roll_angle_at_height
from fenics_gears.contact.interpolation import (
    GearContacts,
    flank_interpolations,
    hat_integrals,
    node_average,
    quadrature_offsets,
)
from fenics_gears.contact.window import ContactGrid, contact_roll_angles, flank_ends, node_offsets


def interpolation_at(pair, xi, order, grid=ContactGrid(2.0, 21), elements=50):
    pinion = pair.pinion
    offsets, contact_roll = node_offsets(flank_ends(pair, contact_roll_angles(pair, xi)), grid), xi / pinion.base_radius
    rolls = roll_angle_at_height(pinion.base_radius, contact_roll, pinion.base_radius - offsets)
    arc = np.linspace(pinion.form_roll_angle**2, pinion.tip_roll_angle**2, order * elements + 1)
    flank_rolls = np.sqrt(arc)
    ends, contact = np.array([0, len(offsets)]), np.array([contact_roll])
    nodes = GearContacts(offsets, ends, rolls, contact, [flank_rolls], pinion.base_radius, 1, order)
    return offsets, contact_roll, flank_rolls, flank_interpolations(nodes)[0]


@pytest.mark.parametrize("order", [1, 2])
def test_polynomials_of_the_arc_length_are_averaged_exactly(paper_pair, order):
    """Exact: polynomials of the element's order; brute force is 400-point quadrature a cell."""
    offsets, contact_roll, flank_rolls, result = interpolation_at(paper_pair, 12.0, order)
    radius = paper_pair.pinion.base_radius
    for power in range(order + 1):
        nodal = (0.5 * radius * flank_rolls**2) ** power
        averaged = result.weights @ nodal
        local, weight = np.polynomial.legendre.leggauss(400)
        y = offsets[:-1, None] + np.diff(offsets)[:, None] * 0.5 * (local + 1.0)
        arc = 0.5 * radius * roll_angle_at_height(radius, contact_roll, radius - y) ** 2
        integrand = arc**power * 0.5 * weight * np.diff(offsets)[:, None]
        expected = np.zeros(len(offsets))
        expected[:-1] += (integrand * (0.5 - local)).sum(axis=1)
        expected[1:] += (integrand * (0.5 + local)).sum(axis=1)
        assert averaged == pytest.approx(expected / hat_integrals(offsets), rel=1e-9)


def test_interpolation_of_a_smooth_function_is_of_fourth_order(paper_pair):
    """Known order: O(h^4) from the point value."""
    errors = []
    for nodes in (11, 21):
        offsets, _, flank_rolls, result = interpolation_at(paper_pair, 12.0, 2, ContactGrid(2.0, nodes), 400)
        radius = paper_pair.pinion.base_radius
        rolls = roll_angle_at_height(radius, 12.0 / radius, radius - offsets)
        inside = np.abs(offsets) < 0.65
        errors.append(np.abs(result.weights @ np.cos(5.0 * flank_rolls) - np.cos(5.0 * rolls))[inside].max())
    assert np.log2(errors[0] / errors[1]) == pytest.approx(4.0, abs=0.1)


def test_averages_of_parabolas_are_exact():
    """Exact: on an even grid averages of y and y^2 are the values at the node; of a constant on any grid."""
    offsets = np.linspace(-1.0, 1.0, 9)
    places = quadrature_offsets(offsets)
    for power in (1, 2):
        assert node_average(offsets, places**power)[1:-1] == pytest.approx(offsets[1:-1] ** power, abs=1e-14)
    uneven = np.array([0.0, 0.1, 0.3, 1.0])
    assert node_average(uneven, np.ones((3, 4))) == pytest.approx(1.0, abs=1e-14)
    assert hat_integrals(offsets).sum() == pytest.approx(2.0)
