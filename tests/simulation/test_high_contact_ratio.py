"""A pair with a contact ratio above 2: two or three tooth pairs carry at any time."""

from dataclasses import replace

import numpy as np
import pytest

from fenics_gears import gear_pair, simulate
from fenics_gears.scene.data import Accuracy, GearData, GearPairData, Material


@pytest.fixture(scope="module")
def result(paper_scene):
    module, teeth = 3.0, (40, 60)
    pinion, wheel = (
        GearData(z, 0.0, module * (z + 2.7), module * (z - 3.2), 0.7 * module * (z - 3.2), 0.2) for z in teeth
    )
    gears = GearPairData(
        module, np.radians(20.0), 0.5 * module * sum(teeth) + 0.1, 15.0, pinion, wheel, Material(206e3, 0.3)
    )
    pair = gear_pair(gears)
    assert 2.0 < pair.contact_ratio < 2.5
    scene = replace(
        paper_scene, gears=gears, accuracy=Accuracy(), inertia=None, damping=None, friction=None, shafts=None,
        bearings=None,
        motion=replace(paper_scene.motion, mesh_cycles=1, recorded_cycles=1),
        load=replace(paper_scene.load, wheel_torque=300.0 * 15.0 * pair.wheel.base_radius),
    )  # fmt: skip
    return simulate(scene)


def test_two_to_three_pairs_carry(result):
    """Definition of the contact ratio; load lets teeth touch a little earlier and later than rigid gears would."""
    carrying = (result.pair_normal_force.values > 0.0).sum(axis=1)
    assert set(carrying) == {2, 3}


def test_pairs_share_the_whole_load(result):
    """Equilibrium: the pairs' forces sum to T/rb2."""
    assert result.pair_normal_force.sum("slot").values == pytest.approx(300.0 * 15.0, rel=1e-9)


def test_error_is_continuous_and_varies_less_than_that_of_the_papers_pair(result):
    """Known of high contact ratio gears: hand-over from 3 to 2 pairs disturbs less than from 2 to 1."""
    error = result.transmission_error.values
    assert np.abs(np.diff(error)).max() < 0.05 * error.mean()
    assert np.ptp(error) / error.mean() < 0.25
