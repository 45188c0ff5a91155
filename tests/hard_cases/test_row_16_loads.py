"""Row 16: loads from nothing to ten times nominal, and a contact too narrow for the contact nodes."""

from dataclasses import replace
from itertools import product

import numpy as np
import pytest
from tests.coarse import frictionless, quasi_static, teeth_alone

from fenics_gears import model_of, simulate

TORQUES = [0.0, 1e-12, 1.0, 4370e3]
ABSENT = [(), ("bearings",), ("shafts",), ("shafts", "bearings")]


def combinations():
    """By day every torque with friction and without, and either with every drivetrain; by night all with all."""
    for (i, torque), friction, (j, absent) in product(enumerate(TORQUES), (True, False), enumerate(ABSENT)):
        by_day = (i + 2 * friction) % 4 == j
        yield pytest.param(torque, friction, absent, marks=() if by_day else pytest.mark.nightly)


@pytest.mark.parametrize(("torque", "friction", "absent"), combinations())
def test_any_torque_is_carried(absent, friction, torque, coarse, measured):
    """Exact identity (equilibrium): the wheel's couple is the load, nothing is added, no step fails."""
    scene = replace(quasi_static(coarse), load=replace(coarse.load, wheel_torque=torque), **dict.fromkeys(absent))
    scene = scene if friction else frictionless(scene)
    result = simulate(scene)
    difference = np.abs(result.reaction_couple.sel(gear="wheel").values + torque).max()
    measured(
        f"torque {torque:g} N mm: largest spurious torque", difference, "1e-9 of the torque, at least 1e-9 N mm", "N mm"
    )
    assert result.attrs["complete"]
    assert np.all(np.isfinite(result.transmission_error.values))
    # Without load the touching node's force is the round-off of zero, of either sign.
    assert result.contact_pressure.fillna(0.0).values.min() >= -1e-9
    assert difference <= 1e-9 * max(torque, 1.0)


def test_contact_narrower_than_a_node_spacing_carries_the_load(coarse, measured):
    """Exact identity: T = rb2 sum p with one closed node a pair or two; a warning says that contact is not resolved."""
    scene = frictionless(teeth_alone(replace(coarse, load=replace(coarse.load, wheel_torque=10.0))))
    resolution, result = model_of(scene).resolution, simulate(scene)
    force = 10.0 / result.attrs["base_radius_wheel"]
    difference = np.abs(result.normal_force.values / force - 1.0).max()
    closed = int(result.closed_nodes.max())
    ratio = resolution.half_width / resolution.contact_grid.spacing
    measured("narrow contact: half-width / node spacing", ratio, "below 0.5")
    measured("narrow contact: error of the total force", difference, 1e-11)
    measured("narrow contact: most closed nodes", float(closed), "1 or 2 for each pair")
    assert ratio < 0.5
    assert 1 <= closed <= 4
    assert "contact is not resolved" in result.attrs["warnings"]
