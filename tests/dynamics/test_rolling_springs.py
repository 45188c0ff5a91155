"""Rolling bearings as nonlinear springs of a drivetrain."""

import numpy as np
import pytest

from fenics_gears.dynamics.bearings import RollingBearing
from fenics_gears.dynamics.rolling_bearing import MOTIONS, reaction
from fenics_gears.dynamics.rolling_springs import RollingSpring, RollingSprings

# mm: without load no element touches.
CLEARANCE = 0.02


def test_a_bearing_none_of_whose_elements_touches_moves_until_they_carry():
    """Statics: the elements give back the load. The stiffness where it begins is zero."""
    rolling = RollingBearing(9, 12.7, 65.0, clearance=CLEARANCE)
    nothing = np.zeros((MOTIONS, MOTIONS))
    centred = np.array([1e-6, 0.0, 0.0, 0.0, 0.0])
    assert not reaction(rolling, centred).stiffness.any()
    spring = RollingSpring(np.arange(MOTIONS), rolling, nothing, 0)
    springs = RollingSprings((spring,), centred, MOTIONS)
    load = np.array([1500.0, 0.0, 0.0, 0.0, 0.0])
    # Axially and in tilt it is held, as by the shaft's other bearing.
    held = np.diag([0.0, 0.0, 1e5, 1e8, 1e8])
    place = springs.settled(held, load, centred)
    assert place[0] > 0.5 * CLEARANCE
    assert reaction(rolling, place).loads + held @ place == pytest.approx(load, abs=1e-6 * load[0])
