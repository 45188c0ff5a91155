"""Gears of trains that run out or have errors of their teeth: as in their pair, and by their shafts."""

import numpy as np
import pytest
from tests.trains import COARSE, gear_text, mate, stage, two_stages

from fenics_gears import SceneError, overall_orders, scene_from_text, simulate, simulate_train, train_from_text

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


@pytest.mark.parametrize(
    ("one", "two", "said"),
    [
        ("wheel = {0}", "pinion = {0}", "runs out in two stages"),
        ('wheel = {{ wobble = "9 um" }}', "", "wobbles, which is not yet computed"),
    ],
)
def test_a_gear_with_several_mates_runs_out_in_one_way(one, two, said):
    """What would be meant twice is refused."""

    def more(stage: str, own: str) -> str:
        return f"[stages.{stage}.eccentricity]\n{own.format(RUN_OUT)}\n" if own else ""

    text = mate("one", gear_text(20, 2.0), gear_text(25, 2.0), 15.0, more=more("one", one))
    text += mate("two", '"one.wheel"', gear_text(30, 2.0), 70.0, more=more("two", two))
    text = text.replace("face_width", 'helix_angle = "15 deg"\nface_width')
    with pytest.raises(SceneError, match=said):
        train_from_text(f'{text}[load]\noutput_torque = "200 N m"\n')
