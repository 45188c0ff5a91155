"""Planetary sets beside other stages: what power on one path gives by hand, and the parts by themselves."""

import numpy as np
import pytest
from tests.planets import COARSE, RELIEF, SHARED, planetary_text

from fenics_gears import SceneError, simulate_train, train_from_text
from fenics_gears.results.mesh_of_train import mesh_run
from fenics_gears.results.overall_orders import overall_orders
from fenics_gears.results.sets_in_train import LAG_OF_SET, set_run
from fenics_gears.results.train_rows import train_rows

PAIR = f"""
[stages.last]
{SHARED}
pinion = {{ teeth = 23, profile_shift = 0, bore_diameter = "20 mm" }}
wheel = {{ teeth = 47, profile_shift = 0, bore_diameter = "30 mm" }}
tip_relief = {RELIEF}
"""
SET = planetary_text().split("[load]")[0]
LOAD = f'[load]\ninput_torque = "600 N m"\n[motion]\ninput_speed = "900 rpm"\n[accuracy]\n{COARSE}\n'
TWO_SETS = SET + SET.replace("stages.set", "stages.other").replace("planets = 2", "planets = 5")
RATIO = 1.0 + 53.0 / 17.0
STIFF = '[shafts.middle]\ncarries = ["set.carrier", "last.pinion"]\ntorsional_stiffness = "1e9 N mm/rad"\n'


@pytest.fixture(scope="module")
def beside():
    return train_from_text(SET + PAIR + LOAD)


@pytest.fixture(scope="module")
def found(beside):
    return simulate_train(beside)


def test_speeds_and_torques_are_those_of_willis(beside):
    """Ring fixed, sun driven: the carrier turns 1 + z_r/z_s times slower, under as many times the torque. The sun meets
    z_s teeth in a turn against the carrier, and f = z_r n_carrier too."""
    of_set, of_pair = beside.parts
    assert of_set.output_torque == pytest.approx(600e3 * RATIO)
    assert beside.output_torque == pytest.approx(600e3 * RATIO * 47 / 23)
    assert beside.ratio == pytest.approx(RATIO * 47 / 23)
    assert of_set.meshes[0].scene.motion.mesh_frequency == pytest.approx(53 * 15.0 / RATIO)
    assert of_pair.meshes[0].scene.motion.mesh_frequency == pytest.approx(23 * 15.0 / RATIO)
    assert of_pair.meshes[0].scene.load.wheel_torque == pytest.approx(600e3 * RATIO * 47 / 23)
    assert beside.rows == [[0, 1, 2, 3], [4]]
    assert beside.alone == [4]


def test_loads_of_both_ends_and_power_are_one(beside):
    """The same train by the torque of its last shaft, and by its power."""
    for load in (f'output_torque = "{1e-3 * beside.output_torque!r} N m"', f'power = "{0.6 * 30 * np.pi!r} kW"'):
        other = train_from_text(SET + PAIR + LOAD.replace('input_torque = "600 N m"', load))
        assert other.input_torque == pytest.approx(600e3)


def test_parts_are_as_by_themselves(beside, found):
    """A set and a pair, each alone under the torque and at the speed by hand, to 1e-9."""
    alone = simulate_train(train_from_text(SET + LOAD))
    own = set_run(found, "set")
    for name in ("planet_load_share", "pin_force", "member_torque", "member_rotation", "overall_transmission_error"):
        np.testing.assert_allclose(own[name], alone[name], rtol=1e-9, atol=1e-15, err_msg=name)
    for name in ("load_sharing_factor", "largest_pin_force", "peak_to_peak_overall_transmission_error"):
        assert own.attrs[name] == pytest.approx(alone.attrs[name], rel=1e-9)
    load = f'[load]\ninput_torque = "{600.0 * RATIO!r} N m"\n[accuracy]\n{COARSE}\n'
    pair = simulate_train(train_from_text(PAIR + load))
    error = mesh_run(found, beside, 4)["transmission_error"]
    np.testing.assert_allclose(error, pair["transmission_error"][:, 0], rtol=1e-9)


def test_the_whole_lags_by_the_sum_of_its_parts(beside, found):
    """Of the last shaft: the lag of the carrier over the ratio behind it, and that of the wheel, each on its own clock:
    at whole cycles of the set, where the other is between its steps."""
    carrier = found[LAG_OF_SET].values[:13, 0]
    wheel = found["transmission_error"].values[:, 4]
    wheel = wheel[np.isfinite(wheel)]
    times = found["time"].values
    ratio = 23 / 47
    (of_set, of_pair) = (part.meshes[0].scene.motion.mesh_frequency for part in beside.parts)
    by_hand = ratio * np.interp(12 * (times * of_set % 1.0), np.arange(13), carrier)
    by_hand += np.interp(12 * (times * of_pair % 1.0), np.arange(13), wheel)
    np.testing.assert_allclose(found["overall_transmission_error"], by_hand, rtol=1e-9)
    assert times[-1] * of_pair == pytest.approx(1.0, abs=0.1)
    orders = {round(each.order, 6): each for each in overall_orders(found, beside)}
    harmonics = np.abs(np.fft.rfft(ratio * carrier[:-1])) / 6.0
    # Meshes in a turn of the sun: the set's 53/RATIO; its second harmonic.
    assert orders[round(2 * 53 / RATIO, 6)].amplitude == pytest.approx(harmonics[2], rel=1e-9)
    assert orders[round(23 / RATIO, 6)].meshes == "last"


def test_several_cycles_are_one_repeated(beside, found):
    """Without run-out and friction a mesh cycle is like the next: spans and orders are those of one."""
    longer = train_from_text(SET + PAIR + LOAD.replace('900 rpm"', '900 rpm"\nmesh_cycles = 3'))
    several = simulate_train(longer)
    name = "peak_to_peak_overall_transmission_error"
    assert several.attrs[name] == pytest.approx(found.attrs[name], rel=1e-9)
    amplitudes = [each.amplitude for each in overall_orders(several, longer)]
    assert amplitudes == pytest.approx([each.amplitude for each in overall_orders(found, beside)], abs=1e-12)


def test_a_shaft_between_parts_twists(found):
    """By torque over stiffness, over the ratio behind it: a constant."""
    twisted = simulate_train(train_from_text(SET + PAIR + STIFF + LOAD))
    name = "mean_overall_transmission_error"
    by_hand = 600e3 * RATIO / 1e9 * 23 / 47
    assert twisted.attrs[name] - found.attrs[name] == pytest.approx(by_hand, rel=1e-9)
    span = f"peak_to_peak_{name[5:]}"
    assert twisted.attrs[span] == pytest.approx(found.attrs[span], rel=1e-9)


def test_efficiencies_multiply():
    """The whole has the product of the efficiencies of its parts, and that of the set is Willis': with the carrier at
    rest each turn of the sun loses 1 - basic, of which z_r/(z_s + z_r) is left by the turning carrier."""
    rubbing = "[friction]\ncoefficient = 0.05\n"
    whole = simulate_train(train_from_text(SET + PAIR + LOAD + rubbing))
    own = set_run(whole, "set").attrs
    of_pair = 1.0 - float(whole["friction_loss"][4])
    assert whole.attrs["efficiency"] == pytest.approx(own["efficiency"] * of_pair, rel=1e-12)
    assert own["efficiency"] == pytest.approx((1.0 + own["basic_efficiency"] * 53 / 17) / (1.0 + 53 / 17), rel=1e-9)
    assert 0.97 < whole.attrs["efficiency"] < 0.999


def test_two_sets_stand_side_by_side_by_their_names():
    """Two and five planets: each has its own shares, whose sum is their number, and torques that add up to zero."""
    train = train_from_text(TWO_SETS + LOAD)
    found = simulate_train(train)
    assert train.ratio == pytest.approx(RATIO**2)
    assert found["set"].values.tolist() == ["set", "other"]
    assert found["member"].values.tolist()[3:] == ["other.sun", "other.ring", "other.carrier"]
    assert found["planet"].values.tolist()[2] == "other.planet 1"
    for name, planets, torque in (("set", 2, 600e3), ("other", 5, 600e3 * RATIO)):
        own = set_run(found, name)
        np.testing.assert_allclose(own["planet_load_share"].sum("planet"), planets, rtol=1e-12)
        by_hand = torque * np.array([1.0, RATIO - 1.0, -RATIO])
        np.testing.assert_allclose(own["member_torque"], np.tile(by_hand, (own.sizes["time"], 1)), rtol=1e-10)
    assert found.attrs["load_sharing_factor"] == found["load_sharing_factor"].values.max()
    labels = [row[0] for row in train_rows(found)]
    assert sum(label.endswith("load sharing factor K_gamma, of the sun's meshes") for label in labels) == 2


def test_joins_say_what_the_order_does():
    """The set written behind the pair and joined before it; its ring joined to the housing; and the order alone."""
    joins = 'joins = [["set.carrier", "last.pinion"], ["set.ring", "housing"]]\n'
    joined = train_from_text(joins + PAIR + SET.replace('fixed = "ring"', "") + LOAD)
    ordered = train_from_text(SET + PAIR + LOAD)
    assert [mesh.name for mesh in joined.meshes] == [mesh.name for mesh in ordered.meshes]
    assert joined.output_torque == ordered.output_torque
    behind = train_from_text(PAIR + SET + LOAD)
    assert behind.parts[1].input_torque == pytest.approx(600e3 * 47 / 23)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ('joins = [["set.sun", "last.pinion"]]' + SET + PAIR, 'does not join the output .* out "set.carrier"'),
        ('joins = [["set.carier", "last.pinion"]]' + SET + PAIR, '"set.carier"\n.*does not join'),
        ('joins = [["set.carrier", "last.pinion"], ["last.wheel", "set.sun"]]' + SET + PAIR, "would go in a circle"),
        ('joins = [["last.ring", "housing"]]' + SET + PAIR, "no member of a planetary set.*Known: set.sun"),
        ('joins = [["set.sun", "housing"]]' + SET + PAIR, "set.ring is fixed"),
        ("joins = [3]" + SET + PAIR, "is no list of pairs"),
        (SET + PAIR + STIFF + 'clocking = "1e-3 rad"\n', "clocking.*\n.*not computed beside planetary sets"),
        (SET + PAIR + "[inertia]\n", "inertia.*\n.*not beside other stages"),
        (SET + PAIR + PAIR.replace("last", "more").replace('"20 mm" }', '"20 mm" }\ninertia = {}'), "inertia"),
        (
            SET + PAIR + PAIR.replace("last", "more").replace("pinion = {", 'pinion = "last.pinion"\n#'),
            "the shafts of .last.wheel. and .more.wheel. drive no gear|move together",
        ),
    ],
)  # fmt: skip
def test_what_is_not_one_path_is_refused(text, said):
    """Each mistake says where it is and what is allowed."""
    with pytest.raises(SceneError, match=f"(?s){said}"):
        train_from_text(text + LOAD)
