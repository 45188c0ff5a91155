"""Sets of stepped planets, with a ring or with a second sun: laws that hold to round-off whatever the contact."""

import numpy as np
import pytest
from tests.planets import COARSE, RINGED, SHARED, TWO_SUNS, planetary, planetary_text

from fenics_gears import simulate_train, train_from_text
from fenics_gears.contact.row_in_plane import RowInPlane
from fenics_gears.scene.train_mesh import gear_names
from fenics_gears.simulation import train

ERRORS = '[stages.set.carrier]\npin_stiffness = "3e5 N/mm"\npin_errors = ["15 um", "0 um", "-5 um"'


def forces(found) -> tuple[np.ndarray, np.ndarray]:
    """Of the sun's and the second meshes (steps, planets)."""
    every = found["normal_force"].values
    half = every.shape[1] // 2
    return every[:, :half], every[:, half:]


@pytest.fixture(scope="module")
def floating():
    """Three planets of 20 and 16 teeth whose meshes are not in phase, on a floating sun, pins beside their places."""
    scene = planetary(**RINGED, more='floating = ["sun"]', sections=f"{ERRORS}]")
    return simulate_train(scene)


def test_torques_follow_willis(floating):
    """Without friction 1, (z_planet z_ring)/(z_sun z_step) and less than none of both, at every instant."""
    torques = floating["member_torque"].values
    ring = 20.0 * 53.0 / (17.0 * 16.0)
    np.testing.assert_allclose(
        torques, np.tile(600e3 * np.array([1.0, ring, -1.0 - ring]), (len(torques), 1)), rtol=1e-10
    )


def test_planets_hand_on_their_torque(floating):
    """Base radii of both gears of each planet balance; three planets share evenly on a floating sun."""
    sun, ring = forces(floating)
    np.testing.assert_allclose(20.0 * sun, 16.0 * ring, rtol=1e-11)
    assert np.ptp(sun, axis=1).max() < 1e-11 * sun.max()
    assert np.hypot(floating["member_x"], floating["member_y"])[:, 0].min() > 1e-3


def test_a_pin_carries_both_gears(floating):
    """The pressure angle of both is 20 degrees: tangential parts add, radial parts oppose each other."""
    sun, ring = forces(floating)
    pins = floating["pin_force"].values
    np.testing.assert_allclose(pins[..., 0], np.cos(np.radians(20.0)) * (sun + ring), rtol=1e-10)
    np.testing.assert_allclose(pins[..., 1], np.sin(np.radians(20.0)) * (sun - ring), rtol=1e-10, atol=1e-9 * sun.max())


def test_a_set_of_steps_repeats_turned_by_a_planet():
    """Planets at 120 degrees: the state some steps later is that of now with the planets exchanged, over the period of
    both meshes. So the lag repeats three times in it, and is not the same all the time (Parker 2000)."""
    found = simulate_train(planetary(**RINGED))
    # 5 cycles with the sun of 4 n steps are 4 with the ring of 5 n.
    lag = found["overall_transmission_error"].values[:-1]
    third = len(lag) // 3
    np.testing.assert_allclose(np.roll(lag, third), lag, rtol=1e-12)
    assert np.ptp(lag) > 0.01 * lag.mean()
    sun, _ = forces(found)
    exchanged = [np.abs(np.roll(sun[:-1, [1, 2, 0]], shift * third, axis=0) - sun[:-1]).max() for shift in (1, 2)]
    assert min(exchanged) < 1e-11 * sun.max()


def test_equal_steps_are_a_simple_set(monkeypatch):
    """Steps as large as their planets, their teeth in line, are one gear, but for what its two flanks feel of each
    other: without that in the simple set, and of the very same elements, forces, lag and pins are the same."""
    through = RowInPlane._through
    shared_body = train.shared_body
    gear_body = train.gear_body
    planets = []

    def without_planets(self, gear, *others):
        found = through(self, gear, *others)
        return found._replace(now=0.0 * found.now) if gear.teeth == 18 else found

    def kept(row, gear, cache):
        body = shared_body(row, gear, cache)
        planets.extend([body] if row.gear(gear).teeth == 18 else [])
        return body

    monkeypatch.setattr(RowInPlane, "_through", without_planets)
    monkeypatch.setattr(train, "shared_body", kept)
    monkeypatch.setattr(
        train,
        "gear_body",
        lambda model, gear, *of: planets[0] if getattr(model.pair, gear).teeth == 18 else gear_body(model, gear, *of),
    )
    pins = 'carrier = { pin_stiffness = "3e5 N/mm", pin_errors = ["9 um", "0 um"] }'
    same = f'{COARSE}\ncontact_length = "4 mm"\ncontact_nodes = 20'
    simple, stepped = (
        simulate_train(planetary(teeth=(17, 18, 53), more=pins, accuracy=same, step=step)) for step in (None, 18)
    )
    for name in ("overall_transmission_error", "pin_force", "planet_load_share"):
        size = float(np.abs(simple[name]).max())
        np.testing.assert_allclose(stepped[name], simple[name], rtol=1e-10, atol=1e-10 * size)
    np.testing.assert_allclose(forces(stepped)[1], simple["normal_force"].values[:, 1::2], rtol=1e-10)


def test_two_suns_balance():
    """The planets push the second sun the way the first turns: torques 1, -z_planet z_second/(z_sun z_step), the rest;
    floating, opposite planets of four carry the same."""
    found = simulate_train(planetary(**TWO_SUNS, more='floating = ["sun"]', sections=f'{ERRORS}, "3 um"]'))
    second = 24.0 * 26.0 / (20.0 * 18.0)
    torques = found["member_torque"].values
    expected = 600e3 * np.array([1.0, -second, second - 1.0])
    np.testing.assert_allclose(torques, np.tile(expected, (len(torques), 1)), rtol=1e-10)
    sun, _ = forces(found)
    assert np.abs(sun[:, :2] - sun[:, 2:]).max() < 1e-11 * sun.max()
    assert list(found["member"].values) == ["sun", "second_sun", "carrier"]


def test_efficiency_of_steps_follows_willis():
    """Ring fixed, sun driving: (1 + eta_0 i)/(1 + i), i = z_planet z_ring/(z_sun z_step), eta_0 of the same set with
    the carrier at rest."""
    own = RINGED | {"sections": "[friction]\ncoefficient = 0.05"}
    moving = simulate_train(planetary(**own))
    resting = simulate_train(planetary(**(own | {"parts": ("carrier", "sun", "ring")})))
    ratio = 20.0 * 53.0 / (17.0 * 16.0)
    basic = resting.attrs["efficiency"]
    assert 0.9 < basic < 0.999
    assert moving.attrs["efficiency"] == pytest.approx((1.0 + basic * ratio) / (1.0 + ratio), rel=1e-11)


@pytest.mark.parametrize("own", [RINGED, TWO_SUNS])
def test_planets_are_alike(own):
    """In all planets a tooth of the second gear stands by the angle asked for from one of the first, though each gear
    stands where its own mates' teeth let it."""
    scene = planetary(**own, more='step_angle = "1 deg"')
    names = gear_names(scene.meshes)
    carrier = scene.shafts.carrier
    teeth = carrier.set.teeth[1], carrier.set.step
    alike = 2.0 * np.pi / np.lcm(*teeth)
    for one, other in zip(carrier.planets, carrier.steps):
        stand = [scene.layout.tooth_angle(names.index(each)) for each in (one, other)]
        apart = (stand[1] - stand[0] - np.radians(1.0)) / alike
        assert apart == pytest.approx(round(apart), abs=1e-9)


def test_a_set_of_steps_beside_a_pair_is_that_set():
    """Rigid shafts hand on torque and rotation alone: the lag of the set is that of the set by itself over the period
    of both its meshes, and the mean lag of the whole that of the set through the pair's ratio, and the pair's."""
    alone = planetary_text(**RINGED)
    pair = f"""[stages.pair]
{SHARED}
pinion = {{ teeth = 24, profile_shift = 0, bore_diameter = "30 mm" }}
wheel = {{ teeth = 40, profile_shift = 0, bore_diameter = "40 mm" }}
"""
    of_set = simulate_train(train_from_text(alone))
    both = simulate_train(train_from_text(alone.replace("[load]", f"{pair}\n[load]")))
    lag = of_set["overall_transmission_error"]
    np.testing.assert_allclose(both["overall_transmission_error_of_set"][:, 0], lag, rtol=1e-10)
    mean = float(lag[:-1].mean()) * 24 / 40 + float(both["mean_transmission_error"][-1])
    assert both.attrs["mean_overall_transmission_error"] == pytest.approx(mean, rel=1e-10)
