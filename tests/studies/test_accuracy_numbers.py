"""Measures and distances of `runs.settings` on numbers known exactly."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from tests.helical import wide_pair

from fenics_gears import model_of
from fenics_gears.model.face_resolution import face_discretisation
from fenics_gears.runs.settings import measures
from fenics_gears.runs.settings.measures import (
    CURVE,
    DEFECT,
    FACE_LOAD,
    LARGEST_LOAD,
    LINE_LOAD,
    PEAK,
    PRESSURE,
    SPAN,
    STIFFNESS,
    distances,
    judged,
)
from fenics_gears.runs.settings.setting import Setting, own_setting

TILTING = '[bearings]\nstiffness = "1e6 N/mm"\naxial_stiffness = "1e5 N/mm"\nplaces = { wheel = ["-40 mm", "40 mm"] }\n'
BASE = Setting("P2", 0.04, 0.04, 3.2, 0.5, 80)


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


def test_errors_over_the_face_are_judged_and_the_plane_is_not_charged_for_them():
    """Definition: the worst of all counts; a run in the plane has no line load along the face."""
    one = {
        CURVE: np.ones(4),
        SPAN: np.ones(1),
        DEFECT: np.zeros(1),
        LINE_LOAD: np.full(3, 100.0),
        FACE_LOAD: np.array([1.2]),
        LARGEST_LOAD: np.array([1.5]),
    }
    other = one | {
        LINE_LOAD: np.array([100.0, 100.0, 103.0]),
        FACE_LOAD: np.array([1.206]),
        LARGEST_LOAD: np.array([1.53]),
    }
    errors = distances(other, one)
    assert (
        errors[FACE_LOAD] == pytest.approx(0.005)
        and errors[LINE_LOAD] == pytest.approx(0.03 / np.sqrt(3.0))
        and judged(errors) == pytest.approx(0.02)
    )
    assert judged(distances({CURVE: one[CURVE], SPAN: np.array([1.001]), DEFECT: np.zeros(1)}, one)) == pytest.approx(
        0.001
    )


def test_a_setting_gives_the_face_that_it_says():
    """Identity."""
    scene = wide_pair(TILTING)
    own, model = own_setting(scene), model_of(scene)
    assert (own.slices, own.layers, own.body) == (model.face.evenly, face_discretisation(model, 0).layers, 1.0)
    again = model_of(own.of(scene))
    assert again.face.evenly == own.slices and face_discretisation(again, 1) == face_discretisation(model, 1)
    other = model_of(replace(own, slices=9, layers=3, body=2.0).of(scene))
    assert other.face.evenly == 9 and face_discretisation(other, 0).layers == 3
    assert face_discretisation(other, 0).section_size == pytest.approx(2.0 * face_discretisation(model, 0).section_size)
