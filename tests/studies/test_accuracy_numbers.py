"""Orders, limits, fronts and charged errors of `gears accuracy` on numbers known exactly."""

import itertools
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

from fenics_gears.runs.settings import measures
from fenics_gears.runs.settings.convergence import largest_part, last_of, observed_order, richardson, together
from fenics_gears.runs.settings.measures import CURVE, PEAK, PRESSURE, SPAN, STIFFNESS
from fenics_gears.runs.settings.setting import Setting
from fenics_gears.studies.accuracy import whole
from fenics_gears.studies.accuracy.refinement import Level, Refinement

SHAPE = np.sin(np.linspace(0.0, 6.0, 50)) + 2.0
ERROR = np.cos(np.linspace(0.0, 2.0, 50))
BASE = Setting("P2", 0.04, 0.04, 3.2, 0.5, 80)


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


def brute_front(points):
    def beaten(mine, other):
        return other[0] <= mine[0] and other[1] <= mine[1] and other != mine

    return {mine for mine in points if not any(beaten(mine, other) for other in points)}


@pytest.mark.parametrize("seed", range(20))
def test_the_front_is_that_of_comparing_each_with_each(seed):
    """Definition, with ties and equal points."""
    random = np.random.default_rng(seed)
    points = [tuple(map(float, point)) for point in random.integers(1, 9, size=(25, 2))]
    front = whole.pareto_front(points)
    assert {points[place] for place in front} == brute_front(points)
    assert len({points[place] for place in front}) == len(front)
    assert [points[place][0] for place in front] == sorted(points[place][0] for place in front)


def test_errors_that_cancel_are_no_accuracy():
    """+5 % and -5 % give the right answer and are charged 10 %."""

    def span(h, k):
        return np.array([10.0 * (1.0 + 0.05 * h**2 - 0.05 * k**2)])

    exact = {SPAN: span(0.0, 0.0)}
    direct = measures.distance({SPAN: span(1.0, 1.0)}, exact, SPAN)
    parts = {
        "h": measures.distance({SPAN: span(1.0, 0.0)}, exact, SPAN),
        "k": measures.distance({SPAN: span(0.0, 1.0)}, exact, SPAN),
    }
    assert direct == 0.0
    assert whole.total_error(direct, parts) == pytest.approx(0.10)
    honest = whole.total_error(
        measures.distance({SPAN: span(0.5, 0.5)}, exact, SPAN), {name: 0.25 * part for name, part in parts.items()}
    )
    assert honest == pytest.approx(0.025)
    assert whole.pareto_front([(1.0, whole.total_error(direct, parts)), (1.5, honest)]) == [0, 1]


def refinement(name, field, values, expected=2.0):
    levels = tuple(Level(str(value), replace(BASE, **{field: value}), float(value)) for value in values)
    return Refinement(name, (field,), levels, expected, "made up", BASE)


FLANK, STEPS = refinement("flank", "flank", (0.16, 0.08, 0.04)), refinement("steps", "steps", (20, 40, 80, 160))
ERRORS = {("flank", 0): 0.08, ("flank", 1): 0.02, ("flank", 2): 0.005}
ERRORS |= {("steps", place): error for place, error in enumerate((0.2, 0.05, 0.012, 0.003))}


def test_the_path_refines_what_limits_it():
    """By hand; 0.28, 0.13, 0.07, 0.032, 0.017 by turns of the larger error."""
    found = [(setting.flank, setting.steps) for setting in whole.path(BASE, [FLANK, STEPS], ERRORS)]
    assert found == [(0.16, 20), (0.16, 40), (0.08, 40), (0.08, 80), (0.04, 80), (0.04, 160)]


def test_parts_are_those_of_the_settings_own_levels():
    """Identity."""
    for (i, flank), (j, steps) in itertools.product(enumerate((0.16, 0.08, 0.04)), enumerate((20, 40, 80, 160))):
        parts = whole.parts_of(replace(BASE, flank=flank, steps=steps), [FLANK, STEPS], ERRORS)
        assert parts == {"flank": ERRORS["flank", i], "steps": ERRORS["steps", j]}
        assert ERRORS[largest_part(parts), {"flank": i, "steps": j}[largest_part(parts)]] == max(parts.values())


def run(steps, amplitude=1.0, nodes=41, first_pair=0):
    """A made-up result: a sine for a transmission error, a parabola of pressure on two pairs."""
    phase = np.arange(2 * steps + 1) / steps
    offsets = np.broadcast_to(np.linspace(-1.0, 1.0, nodes), (len(phase), 2, nodes))
    pressure = amplitude * 100.0 * (1.0 - offsets**2)
    error = amplitude * 1e-3 * np.sin(2 * np.pi * phase) + 7.0
    data = {
        "transmission_error": ("time", error),
        "mesh_phase": ("time", phase),
        "normal_force": ("time", np.full(len(phase), 100.0)),
        "energy_teeth": ("time", np.full(len(phase), 2.0)),
        "work_input": ("time", 50.0 * phase),
        "energy_defect": ("time", 0.1 * phase),
        "contact_pressure": (("contact_time", "slot", "contact_node"), pressure),
        "contact_offset": (("contact_time", "slot", "contact_node"), offsets),
        "contact_mesh_phase": ("contact_time", phase),
        "contact_pair_number": (
            ("contact_time", "slot"),
            np.tile([first_pair + 1, first_pair + 2], (len(phase), 1)),
            {"number_at_phase_0": 1},
        ),
    }
    attributes = {
        "peak_to_peak_transmission_error": float(np.ptp(error)), "base_radius_wheel": 50.0,
        "peak_contact_pressure": 100.0 * amplitude,
    }  # fmt: skip
    return xr.Dataset(data, attrs=attributes)


def test_measures_of_a_sine_and_a_parabola():
    """Exact: 2 a rb peak to peak, rms a rb/sqrt 2 without the mean, F^2/(2U) = 2500, defect 0.2/100."""
    found = measures.answer(run(640), window=2.0)
    assert found[SPAN][0] == pytest.approx(0.1, rel=1e-4)
    assert np.sqrt(np.mean(found[CURVE] ** 2)) == pytest.approx(0.05 / np.sqrt(2.0), rel=1e-4)
    assert abs(found[CURVE].mean()) < 1e-12
    assert found[STIFFNESS][0] == pytest.approx(2500.0)
    assert measures.distance(found, found, measures.DEFECT) == pytest.approx(0.002)


def test_distances_are_relative_and_do_not_see_the_grid():
    """Linearity; the same parabola on other nodes and steps but for h^2."""
    one, more = measures.answer(run(640), 2.0), measures.answer(run(640, 1.1), 2.0)
    for name in (CURVE, SPAN, PRESSURE, PEAK):
        assert measures.distance(more, one, name) == pytest.approx(0.1, rel=1e-6)
    assert measures.judged(measures.distances(more, one)) == pytest.approx(0.1)
    other = measures.answer(run(160, nodes=61), 2.0)
    assert measures.distance(other, one, PRESSURE) < 1e-3
    assert measures.distance(other, one, CURVE) < 1e-12


@pytest.mark.parametrize(
    "counts, common", [((40, 80, 160), 40), ((100, 80), 20), ((200, 1280), 40), ((30, 40), 30), ((10, 20), 10)]
)
def test_curves_of_other_steps_are_compared_at_phases_that_both_have(counts, common):
    """By hand: the greatest common divisor from 20 on, else the phases of the fewest steps."""
    curves = [np.arange(1, count + 1) / count for count in counts]
    phases = np.arange(1, common + 1) / common
    for found in measures.comparable(curves, CURVE):
        assert np.allclose(found, phases - phases.mean(), atol=1e-14)


def test_a_kink_between_steps_adds_no_error_to_exact_values():
    """Identity, however few the steps; straight lines between them lost 1.5 per cent."""

    def exact(count):
        return {CURVE: np.abs(np.arange(1, count + 1) / count - 0.51)}

    assert measures.distance(exact(20), exact(640), CURVE) < 1e-14
