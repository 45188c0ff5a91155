"""Gears of trains that run out or have errors of their teeth: as in their pair, and by their shafts."""

import numpy as np
import pytest
from tests.planets import COARSE as COARSE_SET
from tests.planets import planetary, written_out
from tests.trains import COARSE, gear_text, mate, row_section, stage, two_stages

from fenics_gears import (
    SceneError,
    load_scene,
    load_train,
    overall_orders,
    scene_from_text,
    simulate,
    simulate_train,
    train_from_text,
)
from fenics_gears.contact.flank_gaps import _amounts
from fenics_gears.geometry.flank_deviations import flank_deviations
from fenics_gears.geometry.flank_errors import LISTS, FlankErrors, GearErrors, Waviness, counted_from
from fenics_gears.inputs.tree import GEARS

DISTANCE = 0.012
ANGLE = 0.7
RUN_OUT = f'{{ distance = "{DISTANCE} mm", phase = "{ANGLE} rad" }}'
BEARINGS = '\n[bearings]\nstiffness = "2e5 N/mm"\n'
PITCHES = [4, -3, 2, 5, -6, 1, -3, 0, 2, -2, 6, -5, 3, -4, 1, -1, 2, -2, 4, -4]


def with_errors(section: str) -> str:
    pitches = ", ".join(f'"{each} um"' for each in PITCHES)
    return f"""
        [{section}eccentricity]
        pinion = {RUN_OUT}
        wheel = {{ distance = "8 um", phase = "-2 rad" }}
        [{section}flank_errors.pinion]
        pitch = [{pitches}]
        """


@pytest.mark.parametrize("together", ["", BEARINGS], ids=["by itself", "together"])
def test_a_train_of_one_stage_with_errors_is_the_pair(together):
    """Identity: with friction, at every step of a turn of the pinion, and so are the numbers of the run."""
    motion = "[motion]\nmesh_cycles = 20\n"
    both = f"[friction]\ncoefficient = 0.08\n[accuracy]\n{COARSE}\n{together}{motion}"
    gears = stage("one", 3.0, (20, 40))
    pair = f'{gears.replace("stages.one", "gears")}{with_errors("")}[load]\nwheel_torque = "400 N m"\n{both}'
    train = f'{gears}{with_errors("stages.one.")}[load]\noutput_torque = "400 N m"\n{both}'
    expected = simulate(scene_from_text(pair))
    found = simulate_train(train_from_text(train))
    for name in ("transmission_error", "normal_force", "pair_normal_force", "rotation", "pinion_index_deviation"):
        size = np.nanmax(np.abs(expected[name].values))
        own = found.isel(mesh=0)[name].values
        assert own == pytest.approx(expected[name].values, rel=1e-10, abs=1e-10 * size, nan_ok=True), name
    # Pairs also know extrema between steps.
    numbers = ("friction_loss", *(() if together else ("peak_to_peak_transmission_error", "largest_pair_force")))
    for name in numbers:
        assert float(found[name][0]) == pytest.approx(expected.attrs[name], rel=1e-10), name
    of_steps = np.ptp(expected["transmission_error"].values)
    assert found.attrs["peak_to_peak_overall_transmission_error"] == pytest.approx(of_steps, rel=1e-10)
    assert "only 20 of the 40 mesh cycles" in found.attrs["warnings"]


@pytest.mark.parametrize("together", ["", BEARINGS], ids=["each by itself", "together"])
def test_a_gear_that_runs_out_shows_the_order_of_its_shaft(together):
    """Exact: forces are the torque's, so that teeth yield as before, and the run-out along the line of action is lag of
    the wheel; the last shaft lags by it through the ratio behind. The intermediate shaft turns 2/3 as often as the
    first one."""
    true = simulate_train(two_stages(more=f"{together}[motion]\nmesh_cycles = 20\n"))
    train = two_stages(f"[stages.first.eccentricity]\nwheel = {RUN_OUT}\n", together)
    found = simulate_train(train)
    steps = found["steps_per_mesh_cycle"].values.astype(int)
    # In the train that moves together cycles are of the slower mesh, of 20 teeth on that shaft.
    assert len(found["time"]) == 1 + (20 * steps.max() if together else 30 * steps[0])
    lag = found["overall_transmission_error"].values
    radius = train.meshes[0].pair.wheel.base_radius
    turned = 2.0 * np.pi * np.arange(len(lag) - 1) / (len(lag) - 1)
    expected = DISTANCE / radius * np.cos(turned + ANGLE) * 0.5
    known = true["overall_transmission_error"].values
    shifted = lag[: len(known)] - known[: len(lag)]
    assert shifted[:-1] == pytest.approx(expected, abs=1e-10 * np.ptp(known) + 1e-9 * DISTANCE / radius)
    orders = {each.meshes: each for each in overall_orders(found, train, turns=True) if each.harmonic == 1}
    own = orders["first.wheel"]
    assert own.order == pytest.approx(2.0 / 3.0, rel=1e-12)
    assert own.amplitude == pytest.approx(0.5 * DISTANCE / radius, rel=1e-6)


def test_an_idler_that_runs_out_moves_both_of_its_mates():
    """Exact, as before: along the two lines of action it stands off by the parts of one displacement in space. The
    idler turns clockwise; so does its mark, from the angle of the first line on."""
    stages = mate("one", gear_text(20, 2.0), gear_text(25, 2.0), 15.0, more="# here")
    stages += mate("two", '"one.wheel"', gear_text(30, 2.0), 70.0)
    rest = f'[load]\noutput_torque = "200 N m"\n[accuracy]\n{COARSE}\n[motion]\nmesh_cycles = 25\n'
    run_out = f"[stages.one.eccentricity]\nwheel = {RUN_OUT}\n"
    true = simulate_train(train_from_text(stages + rest))
    train = train_from_text(stages.replace("# here", run_out) + rest)
    found = simulate_train(train)
    first, second = (mesh.pair for mesh in train.meshes)
    line = np.deg2rad(15.0) + 0.5 * np.pi - first.operating_pressure_angle
    lines = line, np.deg2rad(70.0) - 0.5 * np.pi + second.operating_pressure_angle
    turned = lines[0] - ANGLE - 2.0 * np.pi * np.arange(500) / 500
    for mesh, (pair, line, sign) in enumerate(zip((first, second), lines, (1.0, -1.0))):
        moved = sign * DISTANCE * np.cos(turned - line) / pair.wheel.base_radius
        shift = (found["transmission_error"] - true["transmission_error"]).values[:500, mesh]
        assert shift == pytest.approx(moved, abs=1e-9 * DISTANCE), mesh


def test_a_row_has_errors_of_its_gears_by_their_numbers():
    """Identity with the same gears as pairs that name each other's: an idler that runs out and has pitch errors, and
    gears at both ends."""
    pitches = ", ".join(f'"{each} um"' for each in (*PITCHES, 3, -3, 1, -2, 1))
    rest = f'[load]\noutput_torque = "200 N m"\n[accuracy]\n{COARSE}\n[motion]\nmesh_cycles = 25\n'
    idler = f"eccentricity.GEAR = {RUN_OUT}\nflank_errors.GEAR.pitch = [{pitches}]\n"
    ends = 'eccentricity.GEAR = { distance = "5 um" }\n'
    stages = mate(
        "one",
        gear_text(20, 2.0),
        gear_text(25, 2.0),
        15.0,
        more=idler.replace("GEAR", "wheel") + ends.replace("GEAR", "pinion"),
    )
    stages += mate("two", '"one.wheel"', gear_text(30, 2.0), 70.0, more=ends.replace("GEAR", "wheel"))
    gears = ", ".join(gear_text(each, 2.0) for each in (20, 25, 30))
    row = mate(
        "row", "", "", 0.0, more=idler.replace("GEAR", "2") + ends.replace("GEAR", "1") + ends.replace("GEAR", "3")
    )
    kept = [each for each in row.splitlines() if each.split("=")[0].strip() not in ("pinion", "wheel", "direction")]
    kept += ['kind = "row"', f"gears = [{gears}]", 'directions = ["15 deg", "70 deg"]']
    of_row = simulate_train(train_from_text("\n".join(kept) + "\n" + rest))
    of_pairs = simulate_train(train_from_text(stages + rest))
    for name in ("transmission_error", "normal_force", "pinion_index_deviation"):
        assert np.array_equal(of_row[name].values, of_pairs[name].values, equal_nan=True), name


def test_pitches_of_gears_with_several_mates_are_those_of_a_set():
    """Identity with a planetary set whose carrier is at rest: of a planet, which is an idler, and of the sun, which has
    two mates on one flank."""
    same = f'{COARSE_SET}\ncontact_length = "4 mm"\ncontact_nodes = 20'
    sun, planet = ([f"{each} um" for each in (*PITCHES[:count], -sum(PITCHES[:count]))] for count in (16, 17))
    of_planets = [*["0 um"] * 18, *planet]
    own = planetary(
        parts=("carrier", "sun", "ring"), load='output_torque = "2 kN m"', accuracy=same,
        more=f"pitch_errors = {{ sun = {sun}, planets = {of_planets} }}", sections="[motion]\nmesh_cycles = 6\n",
    )  # fmt: skip
    written = written_out((17, 18, 53), [0.0, 180.0], same).text + "[motion]\nmesh_cycles = 6\n"
    written = written.replace("[stages.sun0]", f"[stages.sun0.flank_errors]\npinion.pitch = {sun}\n[stages.sun0]")
    written = written.replace("[stages.sun1]", f"[stages.sun1.flank_errors]\nwheel.pitch = {planet}\n[stages.sun1]")
    of_set = simulate_train(own)
    of_pairs = simulate_train(train_from_text(written))
    np.testing.assert_allclose(of_set["normal_force"], of_pairs["normal_force"], rtol=1e-9)


# Of the teeth of a gear that has 21.
OF_TEETH = [4, -3, 2, 5, -6, 1, -3, 0, 2, -2, 6, -5, 3, -4, 1, -1, 2, -2, 4, -4, 0]


def of_each_tooth(gear: str, folder) -> str:
    """Measured profiles of some teeth, waves and pitches."""
    points = [
        (tooth, place, 0.02 * tooth * (place - 1.0) * (place - 8.0))
        for tooth in (2, 3, 9, 20)
        for place in (0.5, 5.0, 12.0)
    ]
    lines = [f"{tooth},{place},{deviation}" for tooth, place, deviation in points]
    (folder / "profile.csv").write_text("\n".join(["tooth,roll_length (mm),deviation (um)", *lines, ""]))
    pitches = ", ".join(f'"{each} um"' for each in OF_TEETH)
    waves = 'waviness = { amplitude = "2 um", waves = 32, phase = "40 deg" }'
    return f'[{gear}]\npitch = [{pitches}]\nprofile_curves = "profile.csv"\n{waves}\n'


def slope_and_form(gear: str, _) -> str:
    slopes = ", ".join(f'"{each} um"' for each in OF_TEETH)
    forms = ", ".join(f'"{each} um"' for each in OF_TEETH[::-1])
    return f"[{gear}]\nprofile_slope = [{slopes}]\nprofile_form = [{forms}]\n"


@pytest.mark.parametrize("errors", [of_each_tooth, slope_and_form])
def test_each_of_three_mates_meets_the_same_teeth_one_after_the_other(tmp_path, errors):
    """Symmetry: mates that stand at three times 120 degrees around a gear of 21 teeth meet each of its teeth seven mesh
    cycles after the mate before, and yield as that did; the gear turns counter-clockwise."""
    hub, other = gear_text(21, 2.0), gear_text(30, 2.0)
    text = mate("one", hub, other, 0.0) + errors("stages.one.flank_errors.pinion", tmp_path)
    text += mate("two", '"one.pinion"', other, 120.0) + mate("three", '"one.pinion"', other, 240.0)
    outputs = ", ".join(f'{{ on = "{name}.wheel", torque = "100 N m" }}' for name in ("one", "two", "three"))
    text += f"[load]\ntorques = [{outputs}]\n[accuracy]\n{COARSE}\n[motion]\nmesh_cycles = 21\n"
    file = tmp_path / "hub.toml"
    file.write_text(text)
    found = simulate_train(load_train(file))["transmission_error"].values[:420]
    assert np.ptp(found[:, 0]) > 1e-5
    for mesh in (1, 2):
        assert found[:, mesh] == pytest.approx(np.roll(found[:, 0], 140 * mesh), abs=1e-9 * np.ptp(found[:, 0]))


@pytest.mark.parametrize("errors", [of_each_tooth, slope_and_form])
def test_an_idler_with_a_hardly_loaded_second_mate_has_the_errors_of_its_pair(tmp_path, errors):
    """Identity of the first mesh with the pair under its torque, which is so small that the idler's own elements do not
    matter; and exact: on its other flanks the idler is true but for its pitches."""
    gears = gear_text(20, 2.0), gear_text(21, 2.0)
    rest = f"[accuracy]\n{COARSE}\n[motion]\nmesh_cycles = 21\n"
    own = mate("one", *gears, 0.0)
    pair = own.replace("stages.one", "gears").replace('direction = "0.0 deg"', "")
    (tmp_path / "pair.toml").write_text(
        f'{pair}{errors("flank_errors.wheel", tmp_path)}[load]\nwheel_torque = "{1e-5 + 1e-6 * 21 / 30!r} N m"\n{rest}'
    )
    expected = simulate(load_scene(tmp_path / "pair.toml"))["transmission_error"].values
    loads = '{ on = "one.wheel", torque = "1e-5 N m" }, { on = "two.wheel", torque = "1e-6 N m" }'
    own += errors("stages.one.flank_errors.wheel", tmp_path) + mate("two", '"one.wheel"', gear_text(30, 2.0), 70.0)
    (tmp_path / "train.toml").write_text(f"{own}[load]\ntorques = [{loads}]\n{rest}")
    train = load_train(tmp_path / "train.toml")
    found = simulate_train(train)["transmission_error"].values[: len(expected)]
    assert found[:, 0] == pytest.approx(expected, abs=1e-8 * np.ptp(expected))
    second = train.meshes[1].scene.flank_errors.pinion
    assert second == GearErrors(pitch=second.pitch, first=second.first)


@pytest.mark.parametrize("number", [0, 1], ids=["pinion", "wheel"])
def test_counting_from_another_tooth_turns_all_deviations_round(number):
    """Identity at every tooth, with helices and waves, of the driving and of the driven gear: but for pitches, whose
    sum begins at one tooth, tooth t is what tooth t + 5 was."""
    pair = two_stages().meshes[0].pair
    side = pair.sides[number]
    teeth = side.gear.tooth_count
    lists = {name: tuple(np.sin(k * np.arange(teeth)).tolist()) for k, name in enumerate(LISTS[1:], start=1)}
    own = GearErrors(**lists, waviness=Waviness(amplitude=0.002, waves=37, phase=0.4))

    def amounts(of_gear: GearErrors) -> np.ndarray:
        errors = FlankErrors(**{GEARS[number]: of_gear})
        return _amounts(flank_deviations(errors, pair, (0.0, 0.0))[number], side)

    found = amounts(counted_from(own, 5, teeth, side.turn))
    assert found == pytest.approx(np.roll(amounts(own), -5, axis=0), abs=1e-12)


@pytest.mark.parametrize(
    ("teeth", "said"),
    [("30", ""), ("34", "begins elsewhere with another mate"), ("30 again", "flank errors in two stages")],
)
def test_profiles_of_flanks_that_two_mates_load_are_said_once(teeth, said):
    """A slope goes from the start of the active profile, which two mates have to have in common; the tooth that the
    second one meets first is a quarter of a turn on. Pitches may be said in the other stage."""
    slopes = ", ".join(f'"{each} um"' for each in (*range(19), 0))
    errors = f"flank_errors.pinion.profile_slope = [{slopes}]\n"
    text = mate("one", gear_text(20, 2.0), gear_text(30, 2.0), 0.0, more=errors)
    pitches = "flank_errors.pinion.pitch = [" + '"1 um", "-1 um", ' * 10 + "]\n"
    again = errors if "again" in teeth else pitches
    text += mate("two", '"one.pinion"', gear_text(int(teeth[:2]), 2.0), 90.0, more=again)
    loads = ", ".join(f'{{ on = "{name}.wheel", torque = "100 N m" }}' for name in ("one", "two"))
    text += f"[load]\ntorques = [{loads}]\n"
    if said:
        with pytest.raises(SceneError, match=said):
            train_from_text(text)
        return
    first, second = (mesh.scene.flank_errors.pinion for mesh in train_from_text(text).meshes)
    assert [round(1e3 * each) for each in first.profile_slope] == [*range(19), 0]
    assert [round(1e3 * each) for each in second.profile_slope] == [*range(15, 19), 0, *range(15)]
    assert (first.pitch, first.first, second.first) == (second.pitch, 5, 0)


@pytest.mark.parametrize(
    ("one", "two", "said"),
    [
        ("wheel = {0}", "pinion = {0}", "runs out in two stages"),
        ('wheel = {{ wobble = "9 um" }}', "", "wobbles, which is not yet computed"),
        ("flank_errors.tolerance_class", "", "drawn, which is not yet computed there"),
        ("flank_errors.wheel.pitch", "flank_errors.pinion.pitch", "flank errors in two stages"),
    ],
)
def test_a_gear_with_several_mates_has_its_errors_once(one, two, said):
    """What would be meant twice is refused."""

    def more(stage: str, own: str) -> str:
        if own.startswith("flank_errors"):
            return f"{own} = {7 if 'class' in own else ['1 um', '-1 um', *['0 um'] * 23]}\n"
        return f"[stages.{stage}.eccentricity]\n{own.format(RUN_OUT)}\n" if own else ""

    text = mate("one", gear_text(20, 2.0), gear_text(25, 2.0), 15.0, more=more("one", one))
    text += mate("two", '"one.wheel"', gear_text(30, 2.0), 70.0, more=more("two", two))
    text = text.replace("face_width", 'helix_angle = "15 deg"\nface_width')
    with pytest.raises(SceneError, match=said):
        train_from_text(f'{text}[load]\noutput_torque = "200 N m"\n')


@pytest.mark.parametrize(
    ("own", "said"),
    [
        ('eccentricity.pinion = { distance = "5 um" }', r"row\.eccentricity\.pinion.*\n.*is no gear of this row"),
        ('eccentricity.4 = { distance = "5 um" }', "numbers, 1 to 3"),
        ("flank_errors = 3", r"row\.flank_errors = 3.*\n.*of no gear"),
        ('eccentricity.2 = { distance = "5 kg" }', r"stages\.row\.eccentricity\.2\.distance"),
    ],
)
def test_errors_of_a_row_are_told_at_their_places(own, said):
    """Numbers of gears that the row has not, and fields within those that it has."""
    text = row_section((20, 24, 24), (0, 0)) + own
    with pytest.raises(SceneError, match=said):
        train_from_text(f'{text}\n[load]\noutput_torque = "200 N m"\n')
