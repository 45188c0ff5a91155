"""Orders and limits of `gears accuracy` on numbers known exactly."""

import numpy as np
import pytest

from fenics_gears.extensions.measuring.accuracy.convergence import last_of, observed_order, richardson, together
from fenics_gears.runs.settings.measures import SPAN

SHAPE = np.sin(np.linspace(0.0, 6.0, 50)) + 2.0
ERROR = np.cos(np.linspace(0.0, 2.0, 50))


def sequence(sizes, order, constant=0.3):
    """u(h) = u(0) + C h^p, a curve."""
    return [SHAPE + constant * ERROR * size**order for size in sizes]


@pytest.mark.parametrize("order", [0.7, 1.0, 2.0, 3.0, 4.0])
@pytest.mark.parametrize("sizes", [(0.8, 0.4, 0.2), (1.0, 0.7, 0.3), (1.0 / 100, 1.0 / 160, 1.0 / 320)])
def test_the_order_of_an_exact_power_is_found(sizes, order):
    """Manufactured sequence; sizes need not halve."""
    assert observed_order(sequence(sizes, order), sizes) == pytest.approx(order, rel=1e-6)


def test_richardson_on_archimedes_polygons():
    """N sin(pi/n) goes to pi as 1/n^2."""
    counts = (24, 48, 96)
    values = [np.array([n * np.sin(np.pi / n)]) for n in counts]
    limit = richardson(values, [1.0 / n for n in counts], expected=2.0)
    assert limit.order == pytest.approx(2.0, abs=2e-3)
    assert abs(limit.value[0] - np.pi) < 1e-3 * abs(values[-1][0] - np.pi)
    assert abs(limit.value[0] - np.pi) <= limit.uncertainty


@pytest.mark.parametrize("values", [(1.0, 0.9, 0.95), (1.0, 0.9, 0.7), (1.0, 1.0, 1.0)])
def test_without_an_order_nothing_is_extrapolated(values):
    """Roache: where a sequence turns back, diverges or stands still, three times its last difference is uncertain."""
    terms = [np.array([value]) for value in values]
    limit = richardson(terms, (0.4, 0.2, 0.1), expected=2.0)
    assert limit.order is None
    assert limit.value[0] == values[-1]
    assert limit.uncertainty == pytest.approx(3.0 * abs(values[-1] - values[-2]))
    assert limit.least_error == pytest.approx(abs(values[-1] - values[-2]))


def test_differences_that_point_anywhere_have_an_order_and_are_not_extrapolated():
    """Errors of size h at right angles: norms of order 1, no one direction."""
    directions, sizes = np.eye(3), (4.0, 2.0, 1.0)
    steps = [directions[0] * 2.0, directions[1] * 1.0]
    values = [np.full(3, 9.0) - steps[0] - steps[1], np.full(3, 9.0) - steps[1], np.full(3, 9.0)]
    limit = richardson(values, sizes, expected=1.0)
    assert limit.order == pytest.approx(1.0)
    assert np.array_equal(limit.value, values[-1])
    assert limit.least_error == pytest.approx(1.0) and limit.uncertainty == pytest.approx(3.0)


def test_limits_of_several_settings_add_and_so_do_their_uncertainties():
    """U = c + a h^2 + b k; both extrapolated from one base give c."""

    def u(h, k):
        return np.array([5.0 + 0.7 * h**2 - 0.4 * k])

    sizes, base = (0.4, 0.2, 0.1), u(0.2, 0.2)
    limits = [richardson([u(h, 0.2) for h in sizes], sizes, 2.0), richardson([u(0.2, k) for k in sizes], sizes, 1.0)]
    found = together(base, [(limit, base) for limit in limits], SPAN)
    assert found.value[0] == pytest.approx(5.0)
    assert found.uncertainty / 5.0 == pytest.approx(sum(limit.uncertainty / limit.value[0] for limit in limits))
    assert together(base, [(last_of([base]), base)], SPAN).value[0] == base[0]
