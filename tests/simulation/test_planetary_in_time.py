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


RAMP = """
[speed_ramp]
end_speed = "{} rpm"
hold_cycles = {}
"""


def test_a_ramp_that_hardly_rises_is_a_steady_run():
    """Limit, with all terms of the frame."""
    text = {"more": 'floating = ["sun"]', "sections": DAMPED.format(0.05)}
    steady = simulate_train(in_time(7000, 2, **text))
    text["sections"] += RAMP.format(7000.0000001, 0)
    found = simulate_train(in_time(7000, 2, **text))
    for name in COMPARED:
        wanted = steady[name].values
        assert found[name].values == pytest.approx(wanted, abs=1e-6 * np.abs(wanted).max()), name


def test_a_ramp_takes_the_power_of_what_it_accelerates():
    """Willis and the energy of rigid members: over mesh cycles in which vibrations have died down, what the sun does
    more than the carrier gives is the gain of kinetic energy. Pins carry m r Omega^2 of each step's speed."""
    load = '[inertia.load]\nmoment_of_inertia = "2 kg m^2"\n'
    text = {"teeth": IN_PHASE, "more": 'floating = ["sun"]', "sections": DAMPED.format(0.3) + RAMP.format(3000, 1)}
    found = simulate_train(in_time(1000, 30, inertia=f"[inertia]\n{load}", **text))
    sun = 2.0 * np.pi * found["mesh_frequency"].values[:, 0] / 18
    speeds = {"carrier": sun * 18 / 54, "planet": -sun}
    speeds["sun"] = sun + speeds["carrier"]
    speeds["planet"] = speeds["planet"] + speeds["carrier"]
    radius = 0.5 * 4.0 * (18 + 18)
    moments = {"planet": 3 * 2.0, "sun": 0.0, "carrier": 2000.0 + 90.0 + 3 * 2e-3 * radius**2}
    kinetic = sum(0.5 * moments[name] * speed**2 for name, speed in speeds.items())
    torques = dict(zip(found["member"].values.tolist(), found["member_torque"].values.T))
    # Pins push the planets on, and these what they carry.
    on_teeth = torques["sun"] * speeds["sun"]
    on_load = 600e3 * 4 * speeds["carrier"]
    cycle = slice(20 * 12, 29 * 12 + 1)
    time = found["time"].values[cycle]
    gained = kinetic[cycle][-1] - kinetic[cycle][0]
    given = on_teeth[cycle] - on_load[cycle]
    assert np.sum(0.5 * (given[1:] + given[:-1]) * np.diff(time)) == pytest.approx(gained, rel=2e-3)
    pins = found["pin_force"].values[cycle, :, 1]
    # The sun pushes its planet outwards, the ring inwards; what they differ by spins the planet up.
    forces = found["normal_force"].values[cycle]
    wanted = 2e-3 * speeds["carrier"][cycle, None] ** 2 * (radius + pins / 3e5)
    wanted = wanted + (forces[:, 0::2] - forces[:, 1::2]) * np.sin(np.deg2rad(20.0))
    assert pins.mean() == pytest.approx(wanted.mean(), rel=1e-3)


def test_a_set_that_is_braked_through_its_backlash_has_no_meaning():
    """Masses whose own turning needs more than the load: all flanks part, and gears without coast flanks turn on
    through a backlash of zero, as an opening of any size then says."""
    braked = in_time(9000, 3, sections=DAMPED.format(0.05) + '[speed_ramp]\nend_speed = "1 rpm"\nhold_cycles = 2\n')
    said = simulate_train(braked).attrs["warnings"].splitlines()
    assert "no meaning: no flanks touch in any mesh" in said[0] and "more than the backlash" in said[0]
