"""What is said about time steps that do not resolve the vibrations."""

from fenics_gears.dynamics.clock import FOLLOWING
from fenics_gears.dynamics.frequencies import Vibration
from fenics_gears.dynamics.guidance import time_step_warnings


def test_a_frequency_of_several_vibrations_is_told_once():
    """Count: three modes of like bearings have one frequency."""
    modes = [Vibration(frequency, 1e-3, True) for frequency in (1592.0, 1592.0, 1592.0, 1800.0)]
    (said,) = time_step_warnings(modes, 400.0, 20, FOLLOWING)
    assert "about 3 vibrations at 1592 Hz (5.03 steps per period), 1800 Hz (4.44 steps per period);" in said
    assert said.count("1592 Hz") == 1


def test_a_vibration_that_tilts_a_gear_is_told_as_one():
    """The words of `gears check`; what moves stands beside the frequency."""
    modes = [Vibration(1592.0, 1e-3, True), Vibration(1800.0, 1e-3, True, "pinion tilts")]
    (said,) = time_step_warnings(modes, 400.0, 20, FOLLOWING)
    assert "about 1592 Hz (5.03 steps per period), 1800 Hz (4.44 steps per period; pinion tilts);" in said
