"""A map of a gear train over loads and speeds of the first shaft."""

import numpy as np
import pytest
import xarray as xr
from tests.trains import gearbox_file

from fenics_gears import load_train, overall_orders, simulate_train
from fenics_gears.commands.cli import main
from fenics_gears.extensions.maps.load_map import OVER_SPEED, QUASI_STATIC
from fenics_gears.extensions.maps.train_map import train_map

MOVING = """
[motion]
input_speed = "900 rpm"
mesh_cycles = 2
[inertia]
density = "7.85 g/cm^3"
[damping]
ratio = 0.06
"""
WHOLE = "peak_to_peak_overall_transmission_error"


@pytest.fixture
def scene(tmp_path):
    file = gearbox_file(tmp_path)
    file.write_text(file.read_text() + MOVING)
    return file


def test_orders_that_runs_do_not_tell_apart_are_left_out(tmp_path):
    """Shafts that twist, at rest, a cycle each: a map of all else, as the run itself has it."""
    file = gearbox_file(tmp_path)
    twist = '[shafts.one]\ncarries = ["first.wheel", "second.pinion"]\ntorsional_stiffness = "1e8 N mm/rad"\n'
    file.write_text(file.read_text() + twist)
    assert main(["map", str(file), "--loads", "200 N m", "400 N m", "-o", str(tmp_path / "out"), "-q"]) == 0
    found = xr.load_dataset(tmp_path / "out" / "map.nc")
    run = simulate_train(load_train(file))
    assert found.sizes["order"] == 0 and "too few to tell order" in run.attrs["warnings"]
    assert float(found[WHOLE].sel(load=400.0)) == pytest.approx(1e6 * run.attrs[WHOLE], rel=1e-9)
    assert (tmp_path / "out" / "over_load.png").stat().st_size > 100


def test_a_map_of_a_train_has_what_its_runs_have(scene, tmp_path, capsys):
    """At rest that of the train without inertia, at its own speed that of the train itself; pictures and tables."""
    out = tmp_path / "out"
    asked = ["--loads", "200 N m", "400 N m", "--speeds", "900 rpm", "1800 rpm"]
    assert main(["map", str(scene), *asked, "-o", str(out), "-q"]) == 0
    found = xr.load_dataset(out / "map.nc")
    assert found["input_speed"].values == pytest.approx([900.0, 1800.0])
    still = tmp_path / "still.toml"
    still.write_text(scene.read_text().replace(MOVING, ""))
    train = load_train(still)
    run = simulate_train(train)
    at_rest = found.sel(load=400.0)
    assert float(at_rest[WHOLE]) == pytest.approx(1e6 * run.attrs[WHOLE], rel=1e-9)
    expected = {(each.place, each.harmonic): 1e6 * each.amplitude for each in overall_orders(run, train)}
    keys = list(zip(at_rest["place"].values, at_rest["harmonic"].values))
    amplitudes = dict(zip(keys, at_rest["overall_transmission_error_amplitude"].values))
    assert amplitudes == pytest.approx(expected, rel=1e-9)
    first = (found["harmonic"] == 1).values
    assert np.isfinite(found["dynamic_overall_transmission_error_amplitude"][..., first]).all()
    cycles = train_map(scene, load_train(scene), asked[1:3], asked[4:], 9).studies[OVER_SPEED].cases[0].scene
    moving = tmp_path / "moving.toml"
    longer = f"mesh_cycles = {cycles.meshes[0].scene.motion.mesh_cycles}"
    moving.write_text(scene.read_text().replace("mesh_cycles = 2", longer))
    expected = 1e6 * simulate_train(load_train(moving)).attrs[WHOLE]
    assert float(found[f"dynamic_{WHOLE}"].sel(load=400.0, input_speed=900.0)) == pytest.approx(expected, rel=1e-9)
    for name in ("over_load.png", "over_speed.png", "campbell.png", "map_over_load.csv"):
        assert (out / name).stat().st_size > 100


def test_runs_over_speed_are_so_long_that_their_start_dies_down(scene):
    """exp(-zeta omega t) = 0.001 for the slowest mode, at the highest speed, by the slowest mesh: 20/30 of 3000 rpm
    are 2000 rpm, at 20 teeth 667 Hz."""
    wanted = train_map(scene, load_train(scene), ["400 N m"], ["600 rpm", "3000 rpm"], 9)
    case = wanted.studies[OVER_SPEED].cases[0]
    slowest = min(2.0 * np.pi * each.frequency * each.damping_ratio for each in case.model.rows[0].vibrations)
    cycles = case.scene.meshes[0].scene.motion.mesh_cycles
    assert cycles - 2 == np.ceil(np.log(1000.0) / slowest * 2000.0 / 3.0)


def test_a_quasi_static_map_leaves_out_what_moves(scene):
    """No masses, no damping, one cycle of each mesh."""
    wanted = train_map(scene, load_train(scene), ["100 N m", "400 N m"], [], 9)
    assert list(wanted.studies) == [QUASI_STATIC]
    for case, torque in zip(wanted.studies[QUASI_STATIC].cases, (100e3, 400e3)):
        assert not case.scene.shafts.moving
        assert case.scene.output_torque == pytest.approx(torque)
        assert case.scene.meshes[0].scene.motion.mesh_cycles == 1


@pytest.mark.parametrize(
    ("more", "asked", "said"),
    [
        ("", [], "neither --loads nor --speeds is given"),
        ("", ["--loads", "-5 N m"], "is driven by its first shaft"),
        ("", ["--speeds", "200 rpm"], "has no section [inertia]"),
        (MOVING, ["--speeds", "200 Hz"], "Speeds are of the first shaft"),
        (MOVING, ["--speeds", "1 .. 100 rpm in 60", "--most-runs", "50"], "are 61 runs"),
    ],
)
def test_maps_of_trains_that_are_refused(tmp_path, capsys, more, asked, said):
    """Before anything is computed."""
    file = gearbox_file(tmp_path)
    file.write_text(file.read_text() + more)
    assert main(["map", str(file), *asked]) == 2
    assert said in capsys.readouterr().err
