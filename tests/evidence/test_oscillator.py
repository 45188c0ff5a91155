"""The closed form beside which contact loss stands."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from tests.evidence.contact_loss import Oscillator

FREE = Oscillator(mass=7.6e-4, stiffness=3.6e5, load=2800.0)


@pytest.mark.parametrize("part", [0.5, 1.5, 3.0])
def test_period_and_swing_are_those_of_the_equation_of_motion(part):
    """Brute force: integration from one greatest pressure to the next."""
    pressed = FREE.load / FREE.stiffness

    def motion(_, state):
        return state[1], (FREE.load - FREE.stiffness * max(state[0], 0.0)) / FREE.mass

    def turns(_, state):
        return state[1]

    turns.direction = -1.0
    period, swing = FREE.period_and_swing(part * pressed)
    start = (1.0 + part) * pressed
    found = solve_ivp(motion, (0.0, 1.5 * period), (start, 0.0), events=turns, rtol=1e-10, atol=1e-14, max_step=1e-6)
    assert found.t_events[0][-1] == pytest.approx(period, rel=1e-6)
    assert np.ptp(found.y[0]) == pytest.approx(swing, rel=1e-5)
    assert FREE.frequency(swing) == pytest.approx(1.0 / period, rel=1e-9)
