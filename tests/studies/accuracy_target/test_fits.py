"""What a choice of settings rests on: fitted errors and the cheapest sizes, on errors and costs that are known."""

import numpy as np
import pytest

from fenics_gears.studies.accuracy.convergence import EXTRAPOLATED, SAFETY, error_curve, total_error
from fenics_gears.studies.accuracy.measures import CURVE, SPAN
from fenics_gears.studies.accuracy_target.choose import RATIO, _error_together, cheapest

SIZES = (1.0, 0.5, 0.25, 0.125)
LIMIT = np.array([3.0, 4.0, 0.0])
ALONG, ACROSS = np.array([0.0, 0.0, 1.0]), np.array([0.8, -0.6, 0.0])


def answers(constant: float, order: float, direction=ALONG, sizes=SIZES):
    """u(h) = u(0) + C h^p in a direction; the height errs by as much."""
    return [{CURVE: LIMIT + constant * size**order * direction, SPAN: np.array([5.0 + constant * size**order])} for size in sizes]


@pytest.mark.parametrize("order", [1.0, 1.5, 2.0, 3.0])
def test_an_error_with_an_order_is_found_with_its_factor_of_safety(order):
    """Exact: Richardson's extrapolation of C h^p; beyond the finest size by p, up to the expected order."""
    curve = error_curve("size", SIZES, answers(0.4, order), order)
    assert curve.trusted and curve.leading.order == pytest.approx(order)
    for size in (1.0, 0.25, 0.125, 0.07):
        assert curve.error(size, SPAN) == pytest.approx(SAFETY * 0.4 * size**order / (5.0 + 0.4 * SIZES[-1] ** order), rel=1e-6)
    assert curve.finest == pytest.approx(SIZES[-1] / EXTRAPOLATED)


def test_a_lower_order_is_used_and_a_higher_one_is_not():
    """The safe side: errors that fall faster than expected are not promised to go on so."""
    slow, fast = error_curve("size", SIZES, answers(0.4, 0.8), 2.0), error_curve("size", SIZES, answers(0.4, 3.0), 2.0)
    assert not slow.trusted and slow.leading.used == pytest.approx(0.8)
    assert fast.trusted and fast.leading.used == pytest.approx(2.0)
    for curve, order in ((slow, 0.8), (fast, 3.0)):
        true = 0.4 * np.array(SIZES) ** order / 5.0
        assert np.all(curve.error(np.array(SIZES), SPAN) >= true)


def test_errors_without_an_order_count_threefold_and_nothing_finer_is_promised():
    """Roache: three times the last change. Changes that grow have no order."""
    values = [LIMIT + shift * ALONG for shift in (0.0, 0.1, 0.3)]
    curve = error_curve("size", SIZES[:3], [{CURVE: value, SPAN: value[:1] * 0.0 + 5.0} for value in values], 2.0)
    assert not curve.trusted and curve.finest == SIZES[2]
    assert curve.error(SIZES[2], CURVE) == pytest.approx(3.0 * 0.2 / np.linalg.norm(values[-1]), rel=0.01)


def test_the_height_takes_the_order_of_its_curve():
    """A height read at a step jumps about; it is as exact as the curve that it belongs to."""
    found = answers(0.4, 1.5)
    heights = (5.0, 5.02, 5.0, 5.01)
    curve = error_curve("size", SIZES, [{**each, SPAN: np.array([height])} for each, height in zip(found, heights)], 1.5)
    assert curve.fits[SPAN].order is None and curve.fits[SPAN].used == pytest.approx(1.5)


def test_errors_add_by_the_angle_between_them_and_never_cancel():
    """Geometry: along each other they add, at right angles by Pythagoras, and against each other no better than at right angles."""
    first, second = error_curve("one", SIZES, answers(0.4, 2.0), 2.0), error_curve("two", SIZES, answers(0.4, 2.0, ACROSS), 2.0)
    against = error_curve("three", SIZES, answers(-0.4, 2.0), 2.0)
    one = first.error(0.25, CURVE)
    assert total_error([first, first], [0.25, 0.25]) == pytest.approx(2.0 * first.largest(0.25))
    separate = [np.hypot(one, second.error(0.25, CURVE)), 2.0 * first.error(0.25, SPAN)]
    assert total_error([first, second], [0.25, 0.25]) == pytest.approx(max(separate))
    assert total_error([first, against], [0.25, 0.25]) == pytest.approx(
        max(np.hypot(one, against.error(0.25, CURVE)), np.hypot(first.error(0.25, SPAN), against.error(0.25, SPAN)))
    )


def test_a_direction_without_an_order_counts_along_all_others():
    """Nothing is known of it."""
    aligned = [LIMIT + shift * ACROSS for shift in (0.0, 0.1, 0.3)]
    unsure = error_curve("unsure", SIZES[:3], [{CURVE: value, SPAN: np.array([5.0])} for value in aligned], 2.0)
    sure = error_curve("sure", SIZES[:3], answers(0.4, 2.0, sizes=SIZES[:3]), 2.0)
    assert total_error([unsure, sure], [0.25, 0.25]) >= unsure.error(0.25, CURVE) + sure.error(0.25, CURVE) - 1e-12


@pytest.mark.parametrize("allowance", [0.2, 0.03, 0.006])
def test_the_cheapest_sizes_are_lagranges(allowance):
    """Another method: a product of powers has its least cost where q_i / p_i shares out the error, E_i ~ q_i / p_i (Lagrange's multiplier).

    Errors at right angles: the squares are shared out so.
    """
    curves = [error_curve("a", SIZES, answers(0.4, 2.0), 2.0), error_curve("b", SIZES, answers(0.9, 1.0, ACROSS), 1.0)]
    curves = [curve.__class__(curve.name, curve.sizes, {CURVE: curve.fits[CURVE], SPAN: curve.fits[CURVE]}, curve.expected) for curve in curves]

    def cost(sizes):
        return 2.0 / (sizes["a"] * sizes["b"] ** 0.5)

    found = cheapest(curves, cost, allowance, lambda sizes: np.array(True))
    constants = [float(curve.error(1.0, CURVE)) for curve in curves]
    if found is None:
        assert _error_together(curves, {curve.name: curve.finest for curve in curves}) > allowance
        return
    shares = np.array([1.0 / 2.0, 0.5 / 1.0])
    errors = allowance * np.sqrt(shares / shares.sum())
    best = {"a": (errors[0] / constants[0]) ** 0.5, "b": errors[1] / constants[1]}
    assert _error_together(curves, found) <= allowance
    if all(curve.finest <= best[curve.name] <= 1.0 for curve in curves):
        # Either size is met within a step of the grid.
        assert cost(found) <= cost(best) * RATIO**1.5
        assert cost(found) >= cost(best) * 0.95


def test_sizes_that_do_not_fit_are_not_chosen():
    """By construction: what `allowed` forbids is left out, and nothing is left where it forbids all."""
    curves = [error_curve("a", SIZES, answers(0.4, 2.0), 2.0)]

    def cost(sizes):
        return 1.0 / sizes["a"]

    assert cheapest(curves, cost, 0.05, lambda sizes: sizes["a"] >= 0.05)["a"] >= 0.05
    assert cheapest(curves, cost, 1e-4, lambda sizes: sizes["a"] >= 0.5) is None
