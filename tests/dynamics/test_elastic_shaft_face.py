"""Gaps that elastic shafts open over the face, and the corrections for them."""

import numpy as np
import pytest
from tests.effects.test_elastic_shafts import CUT, ELASTIC, FEW
from tests.hard_cases.invariants import run_of
from tests.helical import helical_scene, on_stand_in_bodies

from fenics_gears import model_of
from fenics_gears.dynamics.elastic_shaft_face import correction, middles_of_slices, opened_by_even_load


def finished(more, helix):
    model = model_of(helical_scene(more, helix=helix, offset=2.0, accuracy=FEW.replace("5", "10")))
    found = run_of(model, on_stand_in_bodies(model))
    assert found.failure is None
    return model, found.result


def opened(model):
    z = middles_of_slices(model.pair)
    return z, opened_by_even_load(model.drivetrain.elastic, model.pair, model.scene.load.wheel_torque, z)


def test_the_straight_part_is_the_inclination_of_the_axes():
    """Identity: on rigid seats the gap is straight, and its slope is the run's inclination of the axes where the line
    load is even: with the correction that is proposed."""
    model, bent = finished(ELASTIC, 0.0)
    z, gap = opened(model)
    slope, middle = np.polyfit(z, gap, 1)
    assert gap == pytest.approx(middle + slope * z, abs=1e-12)
    slopes = f'[lead_modifications.pinion]\nhelix_slope = "{bent.attrs["proposed_helix_slope"]!r} um"\n'
    _, straight = finished(ELASTIC + slopes, 0.0)
    assert bent.attrs["proposed_crowning"] == 0.0
    assert straight.attrs["mean_axis_inclination_in_plane"] == pytest.approx(
        1e3 * slope * model.pair.face_width, rel=1e-3
    )
    # Bodies load the face unevenly by themselves.
    _, even = finished('[misalignment]\nin_plane = "0 um"\n', 0.0)
    assert straight.attrs["face_load_factor"] == pytest.approx(even.attrs["face_load_factor"], rel=5e-3)
    assert bent.attrs["face_load_factor"] > 1.02 * even.attrs["face_load_factor"]


@pytest.mark.parametrize("helix", [0.0, 15.0])
def test_the_proposed_corrections_make_the_line_load_even(helix):
    """By definition, teeth cut into their shafts: with what is proposed the face load factor loses four fifths of what
    it has above one that rigid shafts have, and beside a misalignment the proposal takes that away too."""
    misaligned = '[misalignment]\nin_plane = "10 um"\n'
    model, bent = finished(CUT + misaligned, helix)
    amounts = "".join(f'{name} = "{bent.attrs[f"proposed_{name}"]!r} um"\n' for name in ("helix_slope", "crowning"))
    _, corrected = finished(CUT + misaligned + f"[lead_modifications.pinion]\n{amounts}", helix)
    _, even = finished('[misalignment]\nin_plane = "0 um"\n', helix)
    before, after, least = (each.attrs["face_load_factor"] for each in (bent, corrected, even))
    assert after - least < 0.2 * (before - least)
    # The proposal is in place of what is there, not beside it.
    for name in ("helix_slope", "crowning"):
        assert corrected.attrs[f"proposed_{name}"] == pytest.approx(bent.attrs[f"proposed_{name}"], abs=1e-9)


def test_a_correction_is_the_parabola_that_was_asked_for():
    """Exact: a gap of a slope and of a crest in the middle of the pinion's own face, which is wider than the common
    one and off its middle."""
    pair = model_of(helical_scene(accuracy="", offset=3.0)).pair
    z = middles_of_slices(pair)
    share = (z - pair.gear_middles[0]) / pair.face_widths[0]
    found = correction(pair, z, 0.01 - 0.007 * share - 0.003 * (2.0 * share) ** 2)
    assert found == pytest.approx((0.007, 0.003), rel=1e-9)
    assert correction(pair, z, 0.004 * share**2).crowning == 0.0
