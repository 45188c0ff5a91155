"""Planetary sets with masses: limits and laws of their march."""

import numpy as np
import pytest
from tests.planets import in_time

from fenics_gears import simulate_train

DAMPED = "[damping]\nratio = {}\n"
ERRORS = ', pin_errors = ["10 um", "0 um", "0 um"]'
COMPARED = ("overall_transmission_error", "pin_force", "member_torque", "member_rotation", "member_x", "normal_force")
IN_PHASE = (18, 18, 54)


@pytest.mark.parametrize("parts", [("ring", "sun", "carrier"), ("carrier", "sun", "ring"), ("sun", "carrier", "ring")])
def test_it_moves_as_at_rest_where_it_is_slow(parts):
    """Limit: masses, dampers and the turning frame change nothing then. Pins are beside their places, the sun
    floats."""
    given = {"more": 'floating = ["sun"]', "pins": ERRORS, "parts": parts}
    found = simulate_train(in_time(0.001, sections=DAMPED.format(0.05), **given))
    at_rest = simulate_train(in_time(0.001, inertia="", **given))
    for name in COMPARED:
        wanted = at_rest[name].values
        assert found[name].values == pytest.approx(wanted, abs=1e-7 * np.abs(wanted).max()), name


@pytest.fixture(scope="module")
def fast():
    """Planets in phase and a floating sun, near a resonance."""
    text = {"teeth": IN_PHASE, "more": 'floating = ["sun"]', "sections": DAMPED.format(0.05)}
    return simulate_train(in_time(7000, 4, **text))


def test_planets_in_phase_share_evenly_at_speed(fast):
    """By symmetry, at every instant: the sun stays where it is, while the forces change by inertia."""
    forces = fast["normal_force"].values[:, 0::2]
    assert np.ptp(forces, axis=1).max() < 1e-10 * forces.max()
    assert np.hypot(fast["member_x"], fast["member_y"]).max() < 1e-12
    torque = fast["member_torque"].values[:, 0]
    assert np.ptp(torque) > 0.05 * torque.mean()


def test_pins_carry_what_turns(fast):
    """m r Omega^2, exactly, where planets turn with the carrier: the radial forces of both meshes of a planet cancel.
    The run begins so."""
    speed = 7000.0 * np.pi / 30.0 * 18 / 72
    radius = 0.5 * 4.0 * (18 + 18)
    pins = fast["pin_force"].values[0]
    wanted = 2e-3 * speed**2 * (radius + pins[:, 1] / 3e5)
    assert pins[:, 1] == pytest.approx(wanted, rel=1e-9)


def test_a_settled_set_turns_into_itself():
    """Parker's law is one of symmetry, which masses and the turning frame keep: with z_s/3 a third beside a whole
    number, a third of a mesh cycle later the next planet is in the state of the one before, the floating sun a third of
    a turn further, and the output as it was."""
    springs = {"ring_springs": ', support_stiffness = "1e5 N/mm"', "more": 'floating = ["sun"]'}
    set_of_three = {"teeth": (17, 19, 55), "sections": DAMPED.format(0.3)}
    found = simulate_train(in_time(6000, 45, **springs, **set_of_three)).isel(time=slice(-25, None))
    third = 4
    for member in range(2):
        orbit = found["member_x"].values[:, member] + 1j * found["member_y"].values[:, member]
        assert np.abs(orbit).max() > 1e-4
        turned = orbit[:-third] * np.exp(2j * np.pi * 17 / 3)
        assert orbit[third:] == pytest.approx(turned, abs=1e-9 * np.abs(orbit).max())
    lag = found["overall_transmission_error"].values
    assert lag[third:] == pytest.approx(lag[:-third], abs=1e-9 * np.ptp(lag))
