"""Planetary sets: laws that hold to round-off whatever the contact."""

import numpy as np
import pytest
from matplotlib.path import Path as Polygon
from tests.planets import COARSE, RELIEF, RINGED, TWO_SUNS, planetary, written_out

from fenics_gears import carried_train, overall_orders, simulate_train
from fenics_gears.scene.train_layout import centres
from fenics_gears.show.gears_of_train import outline_of

FOUR = (20, 16, 52)
FINER = 'steps_per_mesh_cycle = 40\nflank_element_size = "0.3 mm"'
ERRORS = 'carrier = { pin_stiffness = "3e5 N/mm", pin_errors = ["15 um", "0 um", "-5 um"'
RELIEVED = f"[stages.set.sun_mesh]\ntip_relief = {RELIEF}\n[stages.set.ring_mesh]\ntip_relief = {RELIEF}"


def forces(found) -> tuple[np.ndarray, np.ndarray]:
    """Of the sun's and the ring's meshes (steps, planets)."""
    every = found["normal_force"].values
    return every[:, 0::2], every[:, 1::2]


def apart(values: np.ndarray) -> float:
    """Largest difference between planets, over the largest value."""
    return float(np.ptp(values, axis=1).max() / values.max())


@pytest.fixture(scope="module")
def floating():
    """Three planets whose meshes are not in phase, a floating sun and pins beside their places."""
    more = f'floating = ["sun"]\n{ERRORS}] }}'
    return simulate_train(planetary(teeth=(17, 19, 55), planets="planets = 3", more=more))


def test_a_floating_sun_shares_evenly_between_three(floating):
    """Three forces along lines at 120 degrees with equal arms balance on a sun that nothing else holds if, and only if,
    they are equal: at every instant, whatever the errors, phases and elasticity."""
    sun, ring = forces(floating)
    assert apart(sun) < 1e-12
    # All meshes have one frequency, which is named once of each kind.
    (named,) = {each.meshes for each in overall_orders(floating, carried_train(floating))}
    assert named == "set: sun and planets, set: planets and ring"
    np.testing.assert_allclose(sun, ring, rtol=1e-12)
    assert floating.attrs["load_sharing_factor"] == pytest.approx(1.0, abs=1e-12)
    assert np.hypot(floating["member_x"], floating["member_y"])[:, 0].min() > 1e-3


def test_torques_of_members_balance(floating):
    """Without friction as numbers of teeth, and with that of the carrier zero in all, at every instant."""
    torques = floating["member_torque"].values
    np.testing.assert_allclose(
        torques, np.tile(600e3 * np.array([1.0, 55 / 17, -72 / 17]), (len(torques), 1)), rtol=1e-11
    )


def test_a_pin_carries_both_meshes_of_its_planet(floating):
    """Both forces on a planet have the same pressure angle: their tangential parts add, their radial parts cancel."""
    pins = floating["pin_force"].values
    sun, _ = forces(floating)
    np.testing.assert_allclose(pins[..., 0], 2.0 * np.cos(np.radians(20.0)) * sun, rtol=1e-11)
    assert np.abs(pins[..., 1]).max() < 1e-9 * sun.max()


def test_opposite_planets_of_four_share_evenly_on_a_floating_sun():
    """Four forces at right angles balance where opposite ones are equal."""
    more = f'floating = ["sun"]\n{ERRORS}, "3 um"] }}'
    sun, _ = forces(simulate_train(planetary(teeth=FOUR, planets="planets = 4", more=more)))
    assert np.abs(sun[:, :2] - sun[:, 2:]).max() < 1e-12 * sun.max()
    assert apart(sun) > 1e-3


def test_planets_in_phase_share_evenly():
    """z_s/N and z_r/N whole: all planets are in the same state at every instant, and a floating sun stays where it
    is."""
    found = simulate_train(planetary(teeth=(18, 18, 54), planets="planets = 3", more='floating = ["sun"]'))
    assert apart(forces(found)[0]) < 1e-12
    assert np.abs(found["member_x"]).max() < 1e-12
    held = simulate_train(planetary(teeth=(18, 18, 54), planets="planets = 3"))
    assert apart(forces(held)[0]) < 1e-12
    np.testing.assert_allclose(held["overall_transmission_error"], found["overall_transmission_error"], rtol=1e-9)


def test_a_set_repeats_turned_by_a_planet():
    """Planets at 120 degrees, z_s = 17 = -1 modulo 3: after a third of a mesh cycle the state is that of now with the
    planets exchanged. So the rotation has harmonics 3, 6, ... alone, the sun's centre none of them (Parker 2000)."""
    found = simulate_train(
        planetary(teeth=(17, 19, 55), planets="planets = 3", more='floating = ["sun"]', sections=RELIEVED)
    )
    steps = len(found["time"]) - 1
    third = steps // 3
    lag = found["overall_transmission_error"].values[:-1]
    np.testing.assert_allclose(np.roll(lag, third), lag, rtol=1e-12)
    harmonics = np.abs(np.fft.rfft(lag))[1:]
    forbidden = [place for place in range(len(harmonics)) if (place + 1) % 3]
    assert harmonics[forbidden].max() < 1e-12 * np.abs(lag).sum()
    centre = (found["member_x"] + 1j * found["member_y"]).values[:-1, 0]
    spectrum = np.abs(np.fft.fft(centre))
    assert spectrum[::3].max() < 1e-12 * spectrum.max()
    turned = centre * np.exp(2j * np.pi / 3.0)
    assert min(np.abs(np.roll(centre, sign * third) - turned).max() for sign in (1, -1)) < 1e-12 * np.abs(centre).max()


def test_a_pin_error_moves_load_as_its_spring_says():
    """All members held, springs alone (soft pins, k): planet 1 carries 1/N + k e (N - 1)/(N F) of all, the others less
    by k e/(N F)."""
    stiffness, error = 10.0, 0.1
    pins = f'carrier = {{ pin_stiffness = "{stiffness} N/mm", pin_errors = ["{error} mm", "0 mm", "0 mm"] }}'
    found = simulate_train(
        planetary(teeth=(18, 18, 54), planets="planets = 3", more=pins, load='input_torque = "0.5 N m"')
    )
    pin = found["pin_force"].values[..., 0]
    share = pin / pin.sum(axis=1, keepdims=True) - 1.0 / 3.0
    by_spring = stiffness * error / (3.0 * pin.sum(axis=1))
    np.testing.assert_allclose(share[:, 0], 2.0 * by_spring, rtol=1e-3)
    np.testing.assert_allclose(share[:, 1:], -np.stack([by_spring, by_spring], axis=1), rtol=1e-3)


def test_radial_errors_shift_no_load():
    """With one pressure angle in both meshes a planet further out is as much further from the sun's flank as it is
    nearer to the ring's, and turns by it."""
    free = simulate_train(planetary())
    moved = simulate_train(planetary(more='carrier = { radial_pin_errors = ["20 um", "0 um"] }'))
    np.testing.assert_allclose(moved["normal_force"], free["normal_force"], rtol=1e-10)


def test_a_set_with_its_carrier_at_rest_is_a_train_of_pairs():
    """The same planets written out, under the same torque on the ring and in the same windows: forces, and the ring's
    lag."""
    same = f'{COARSE}\ncontact_length = "4 mm"\ncontact_nodes = 20'
    own = planetary(parts=("carrier", "sun", "ring"), load='output_torque = "2 kN m"', accuracy=same)
    of_set = simulate_train(own)
    of_pairs = simulate_train(written_out((17, 18, 53), [0.0, 180.0], same))
    np.testing.assert_allclose(of_set["normal_force"], of_pairs["normal_force"], rtol=1e-9)
    np.testing.assert_allclose(of_set["overall_transmission_error"], of_pairs["overall_transmission_error"], rtol=1e-9)


def test_the_lag_of_the_output_follows_from_its_teeth():
    """One state of deformation, by which member is fixed: the lag of the output is that of the ring with the carrier at
    rest, over the teeth of both (z_s + z_r of the carrier). The ring has the same torque in all."""
    torques = {("carrier", "sun", "ring"): 53.0, ("ring", "sun", "carrier"): 70.0, ("sun", "carrier", "ring"): 53.0}
    lags = {}
    for parts, teeth in torques.items():
        own = planetary(parts=parts, load=f'output_torque = "{teeth * 40.0} N m"')
        lags[parts] = teeth * simulate_train(own)["overall_transmission_error"].values
    first, *others = lags.values()
    for each in others:
        np.testing.assert_allclose(each, first, rtol=1e-9)


def test_efficiency_follows_willis():
    """Ring fixed, sun driving: (1 + eta_0 z_r/z_s)/(1 + z_r/z_s), eta_0 of the same set with the carrier at rest; there
    the loss is the work of friction over that of the drive, by the energy account."""
    friction = "[friction]\ncoefficient = 0.05"
    moving = simulate_train(planetary(load='input_torque = "600 N m"', sections=friction, accuracy=FINER))
    resting = simulate_train(
        planetary(parts=("carrier", "sun", "ring"), load='input_torque = "600 N m"', sections=friction, accuracy=FINER)
    )
    basic = resting.attrs["efficiency"]
    assert basic == pytest.approx(resting.attrs["basic_efficiency"], rel=1e-12)
    assert moving.attrs["efficiency"] == pytest.approx((1.0 + basic * 53 / 17) / (1.0 + 53 / 17), rel=1e-12)
    assert 1.0 - basic == pytest.approx(float(np.nanmax(resting["friction_loss"])), rel=0.03)


@pytest.mark.parametrize("own", [{"teeth": (17, 19, 55), "planets": "planets = 3"}, RINGED, TWO_SUNS])
def test_teeth_of_all_gears_stand_clear_of_each_other(own):
    """Brute force, the whole outlines as chords: nothing of sun or ring is deeper within a planet than chords leave out
    of their arcs, and there their flanks touch."""
    scene = planetary(**own)
    layout = scene.layout
    at = centres(layout)
    outlines = [
        outline_of(layout.gear(each), layout.tooth_angle(each), at[layout.graph.shafts[each]])
        for each in range(len(layout.graph.shafts))
    ]
    for gears, kind in zip(layout.graph.gears, (mesh.of_set.gears for mesh in scene.meshes)):
        number, other = gears if kind[0] != "sun" else gears[::-1]
        planet = outlines[number]
        points = outlines[other]
        points = points[np.linalg.norm(points - planet.mean(axis=0), axis=1) < layout.gear(number).tip_radius + 3.0]
        beside = distances(points, planet)
        within = Polygon(planet).contains_points(points)
        assert beside[within].max(initial=0.0) < 0.01
        assert beside.min() < 0.02


def distances(points: np.ndarray, line: np.ndarray) -> np.ndarray:
    """Distances (n,) of points (n, 2) from a line of chords."""
    begins, along = line[:-1], np.diff(line, axis=0)
    lengths = np.maximum(np.sum(along**2, axis=1), 1e-30)
    places = np.clip(np.einsum("nsd,sd->ns", points[:, None] - begins, along) / lengths, 0.0, 1.0)
    feet = begins + places[..., None] * along
    return np.linalg.norm(points[:, None] - feet, axis=-1).min(axis=1)
