"""A pair with a contact ratio above 2."""

from dataclasses import replace

import numpy as np
import pytest
from tests.coarse import teeth_alone

from fenics_gears import gear_pair, simulate
from fenics_gears.scene.data import Accuracy, GearData, GearPairData, Material, Motion


def test_two_to_three_pairs_carry_the_load(paper_scene):
    """Definition of the contact ratio; T/rb2; hand-over from 3 to 2 pairs disturbs less than from 2 to 1."""
    teeth = ((40, 128.1, 110.4), (60, 188.1, 170.4))
    gears = GearPairData(
        3.0, np.radians(20.0), 150.1, 15.0, *(GearData(z, 0.0, tip, root, 0.7 * root, 0.2) for z, tip, root in teeth),
        Material(206e3, 0.3),
    )  # fmt: skip
    pair = gear_pair(gears)
    assert 2.0 < pair.contact_ratio < 2.5
    scene = replace(
        teeth_alone(paper_scene), friction=None, gears=gears, accuracy=Accuracy(), motion=Motion(200.0, 1, 1)
    )
    force = 300.0 * 15.0
    result = simulate(replace(scene, load=replace(scene.load, wheel_torque=force * pair.wheel.base_radius)))
    assert set((result.pair_normal_force.values > 0.0).sum(axis=1)) == {2, 3}
    assert result.pair_normal_force.sum("slot").values == pytest.approx(force, rel=1e-9)
    error = result.transmission_error.values
    assert np.abs(np.diff(error)).max() < 0.05 * error.mean()
    assert np.ptp(error) / error.mean() < 0.25
