"""Speeds, torques, places and phases of planetary sets."""

from fractions import Fraction
from itertools import permutations
from math import pi

import numpy as np
import pytest

from fenics_gears.geometry.planetary import CARRIER, RING, SUN, PlanetarySet, planets_that_assemble


def of_equal_planets(sun: int, planet: int, ring: int, planets: int) -> PlanetarySet:
    places = tuple(number * (sun + ring) // planets for number in range(planets))
    return PlanetarySet((sun, planet, ring), places, "ring", "sun", "carrier")


@pytest.mark.parametrize(
    ("teeth", "planets", "law"),
    [
        ((27, 35, 99), 3, "rrrrrrrrrrrr"),
        ((30, 20, 70), 4, "prprprprprpr"),
        ((19, 17, 56), 3, "ttrttrttrttr"),
        ((18, 36, 93), 3, "rrrrrrrrrrrr"),
        ((21, 39, 99), 3, "rrrrrrrrrrrr"),
        ((17, 22, 61), 3, "ttrttrttrttr"),
    ],
)
def test_phase_law_of_known_sets(teeth, planets, law):
    """Parker (2000): z_s l modulo N is 0 for rotation, 1 or N - 1 for translation; OH-58, Chaari, NREL's 5 MW and GRC,
    FVA's set."""
    own = of_equal_planets(*teeth, planets)
    assert own.phase_law(12) == law
    rule = {0: "r", 1: "t", planets - 1: "t"}
    assert law == "".join(rule.get(teeth[0] * harmonic % planets, "p") for harmonic in range(1, 13))


def test_diametrically_opposed_planets_leave_force_or_torque():
    """OH-58D, four planets in opposed pairs: an odd z_s l leaves no torque, an even one no force."""
    own = PlanetarySet((27, 35, 99), (0, 32, 63, 95), "ring", "sun", "carrier")
    assert np.degrees(own.angles) == pytest.approx([0.0, 91.43, 180.0, 271.43], abs=0.01)
    assert {*own.phase_law(12)[1::2]} == {"r"}
    assert {*own.phase_law(12)[0::2]} <= {"t", "p"}
    assert own.denominator == 14
    assert not own.equally_spaced


@pytest.mark.parametrize(("fixed", "driven", "loaded"), list(permutations((SUN, RING, CARRIER))))
def test_speeds_and_torques_balance(fixed, driven, loaded):
    """Willis: as the carrier sees it, sun and ring turn by their teeth against each other. Torques add up to zero, and
    so does the power."""
    own = PlanetarySet((17, 22, 61), (0, 26, 52), fixed, driven, loaded)
    speeds = own.speeds
    seen = {each: speeds[each] - speeds["carrier"] for each in own.members}
    assert seen["sun"] / seen["ring"] == Fraction(-61, 17)
    assert (speeds[fixed], speeds[driven]) == (0, 1)
    torques = own.torques(100.0)
    assert torques[driven] == 100.0
    assert sum(torques.values()) == pytest.approx(0.0, abs=1e-12)
    assert sum(torques[each] * float(speeds[each]) for each in own.members) == pytest.approx(0.0, abs=1e-12)
    # Power that the sun takes in, as the carrier sees it.
    assert own.sun_drives == (torques["sun"] * float(seen["sun"]) > 0.0)


def test_ratio_with_the_ring_fixed():
    """1 + z_r/z_s."""
    assert of_equal_planets(17, 22, 61, 3).ratio == 1 + Fraction(61, 17)


def test_phases_follow_from_rolling_round_the_sun():
    """A planet that swings by an angle round the held sun rolls over z_s times its part of a turn; over the ring
    likewise: both phases differ by whole cycles alone where it can be assembled."""
    own = of_equal_planets(17, 22, 61, 3)
    for angle, phase in zip(own.angles, own.phases):
        assert float(phase) == pytest.approx(-17 * angle / (2.0 * pi) % 1.0)
        by_ring = 61 * angle / (2.0 * pi) - float(phase)
        assert by_ring == pytest.approx(round(by_ring), abs=1e-12)


def test_room_for_planets():
    """Tip circles of 96 mm on a circle of 78 mm radius: chords of 156 sin(pi/N) leave room up to N = 4, and 78 places
    are shared evenly by 2, 3, 6."""
    assert planets_that_assemble(17 + 61, 78.0, 96.0) == [2, 3]
    clear = of_equal_planets(17, 22, 61, 3).clearances(78.0, 96.0)
    assert [each for *_, each in clear] == pytest.approx(3 * [156.0 * np.sin(pi / 3) - 96.0])


def of_steps(sun: int, planet: int, step: int, second: int, kind: str = RING) -> PlanetarySet:
    return PlanetarySet((sun, planet, second), (0, 111, 222), kind, SUN, CARRIER, step, kind)


def test_steps_follow_willis():
    """(w_s - w_c)/(w_r - w_c) = -z_planet z_ring/(z_sun z_step), with a second sun of the other sign; torques and power
    add up to zero."""
    for kind, sign in ((RING, -1), ("second_sun", 1)):
        own = of_steps(17, 20, 16, 53, kind)
        speeds = {each: own.speeds[each] - own.speeds[CARRIER] for each in own.members}
        assert speeds[SUN] / speeds[kind] == sign * Fraction(20 * 53, 17 * 16)
        torques = own.torques(100.0)
        assert sum(torques.values()) == pytest.approx(0.0, abs=1e-12)
        assert sum(torques[each] * float(own.speeds[each]) for each in own.members) == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize(("second", "sign"), [(RING, -1), ("second_sun", 1)])
def test_steps_assemble_where_teeth_of_both_gears_meet(second, sign):
    """Brute force: a planet that rolls round the held sun by an angle turns by 1 + z_s/z_p of it, round a held ring by
    1 - z_r/z_step, round a second sun by 1 + z_2/z_step. It fits where both turns differ by pitches of its gears."""
    own = of_steps(17, 20, 16, 53, second)
    for place in range(1, own.turn + 1):
        for part, fits in ((place, True), (place - 0.5, False)):
            swung = part / own.turn
            between = swung * (17 / 20 - sign * 53 / 16)
            apart = min(abs((between - tooth / 20) * 16 - round((between - tooth / 20) * 16)) for tooth in range(20))
            assert (apart < 1e-9) == fits


def test_equal_steps_are_the_simple_set():
    """Weights, phases and places."""
    simple = of_equal_planets(17, 18, 52, 3)
    stepped = PlanetarySet((17, 18, 52), simple.places, "ring", "sun", "carrier", 18)
    assert stepped.weights == simple.weights
    assert stepped.turn == simple.turn
    assert stepped.phases == stepped.phases_of_second == simple.phases
