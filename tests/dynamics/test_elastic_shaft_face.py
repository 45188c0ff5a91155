"""Gaps that elastic shafts open over the face."""

import numpy as np
import pytest
from tests.elastic_shaft_scenes import ELASTIC, FEW
from tests.hard_cases.invariants import run_of
from tests.helical import helical_scene, on_stand_in_bodies

from fenics_gears import model_of
from fenics_gears.dynamics.elastic_shaft_face import face_compliance_of_shafts, middles_of_slices


def finished(more, helix):
    model = model_of(helical_scene(more, helix=helix, offset=2.0, accuracy=FEW.replace("5", "10")))
    found = run_of(model, on_stand_in_bodies(model))
    assert found.failure is None
    return model, found.result


def test_the_straight_part_is_the_inclination_of_the_axes():
    """Identity: an even line load opens a straight gap; a helix slope that closes it makes the line load even."""
    model, bent = finished(ELASTIC, 0.0)
    z, pair = middles_of_slices(model.pair), model.pair
    compliance = face_compliance_of_shafts(model.drivetrain.elastic, pair, z)
    gap = compliance.mean(axis=1) * model.scene.load.wheel_torque / pair.wheel.base_radius
    slope, middle = np.polyfit(z, gap, 1)
    assert gap == pytest.approx(middle + slope * z, abs=1e-12)
    amount = -1e3 * slope * pair.face_widths[0]
    _, straight = finished(ELASTIC + f'[lead_modifications.pinion]\nhelix_slope = "{float(amount)!r} um"\n', 0.0)
    assert straight.attrs["mean_axis_inclination_in_plane"] == pytest.approx(
        1e3 * slope * model.pair.face_width, rel=1e-3
    )
    # Bodies load the face unevenly by themselves.
    _, even = finished('[misalignment]\nin_plane = "0 um"\n', 0.0)
    assert straight.attrs["face_load_factor"] == pytest.approx(even.attrs["face_load_factor"], rel=5e-3)
    assert bent.attrs["face_load_factor"] > 1.02 * even.attrs["face_load_factor"]
