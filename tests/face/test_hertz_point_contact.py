"""The closed form that the benchmark of crowned flanks compares with, at its two ends."""

from math import pi

import pytest
from tests.hertz_point_contact import PointContact

MODULUS, RADIUS = 113e3, 6.0


def test_near_a_circle_it_is_the_contact_of_spheres():
    """Exact: a^3 = 3 F R/(4 E*), approach a^2/R, p0 = 3 F/(2 pi a^2) (Johnson, 1985, eq. 4.22 to 4.24)."""
    contact = PointContact(1.0, 0.9999, RADIUS, MODULUS)
    assert contact.load == pytest.approx(4.0 * MODULUS / (3.0 * RADIUS), rel=1e-3)
    assert contact.radius_along == pytest.approx(RADIUS, rel=1e-3)
    assert contact.approach == pytest.approx(1.0 / RADIUS, rel=1e-3)


def test_a_long_ellipse_has_the_pressure_of_a_line_contact():
    """Limit: b^2 = 4 F' R/(pi E*) under its largest line load F' = pi b p0/2 (Johnson, eq. 4.43 and 4.45), the sooner
    the longer it is."""
    errors = []
    for ratio in (10.0, 100.0):
        contact = PointContact(ratio, 1.0, RADIUS, MODULUS)
        line_load = 0.5 * pi * contact.peak_pressure
        errors.append(4.0 * line_load * RADIUS / (pi * MODULUS) - 1.0)
    assert abs(errors[1]) < 1e-3 < abs(errors[0]) < 0.05


def test_of_the_same_surfaces_load_and_approach_go_together():
    """Exact: approach as the load's power of 2/3, and the same relative radii."""
    contact = PointContact(2.0, 0.1, RADIUS, MODULUS)
    smaller = contact.under(0.125)
    assert smaller.load == pytest.approx(0.125 * contact.load)
    assert smaller.approach == pytest.approx(0.25 * contact.approach)
    assert smaller.radius_along == pytest.approx(contact.radius_along)
