"""A map over loads and speeds."""

from dataclasses import replace
from math import pi, sqrt
from pathlib import Path

import numpy as np
import pandas
import pytest
import xarray as xr
from tests.programs import DEMO
from tests.studies.conftest import stamps

from fenics_gears import Load, SceneError, load_scene, model_of, results, simulate
from fenics_gears.commands.cli import main
from fenics_gears.dynamics.inertia import Inertia
from fenics_gears.dynamics.shafts import Shafts
from fenics_gears.extensions.maps.load_map import OVER_SPEED, QUASI_STATIC, load_map, shared_accuracy
from fenics_gears.extensions.maps.map_results import frequencies_over_load
from fenics_gears.results.settled import settling_time
from fenics_gears.scene.data import Accuracy, Motion
from fenics_gears.simulation.dynamic_factor import quasi_static


def mapped(loads=(), speeds=(), most=1000, **changes):
    return load_map(DEMO, replace(load_scene(DEMO), **changes), loads, speeds, most)


@pytest.mark.parametrize(
    "load, loads, other",
    [('pinion_torque = "200 N m"', ("200 N m",), "20 kW"), ('power = "20 kW"', ("20 kW",), "200 N m")],
)
def test_a_map_sweeps_the_load_that_the_scene_names(tmp_path, load, loads, other):
    """T_2 = T_1 z_2/z_1 and T_2 = P/(2 pi n_2), a power being the same at every speed."""
    file = tmp_path / "pair.toml"
    file.write_text(load_scene(DEMO).text.replace('wheel_torque = "437 N m"', load))
    wanted = load_map(file, load_scene(file), (), ("100 Hz", "400 Hz"), 10)
    assert wanted.loads == loads and wanted.numbers == [float(loads[0].split()[0])]
    cases = {name: [case.scene for case in study.cases] for name, study in wanted.studies.items()}
    for scene in (*cases[QUASI_STATIC], *cases[OVER_SPEED]):
        by_power = 20e6 / (2.0 * pi * scene.motion.mesh_frequency / 24)
        assert scene.load.wheel_torque == pytest.approx(by_power if "power" in load else 200e3 * 24 / 16)
    assert [scene.motion.mesh_frequency for scene in cases[OVER_SPEED]] == [100.0, 400.0]
    with pytest.raises(SceneError, match="The scene gives its load as"):
        load_map(file, load_scene(file), (other,), (), 10)


@pytest.mark.parametrize(
    "arguments, changes, message",
    [
        ({}, {}, "neither --loads nor --speeds is given"),
        ({"loads": ["100 N m", "-50 N m"]}, {}, r"--loads -50 N m: a negative torque .* no section \[coast_flanks\]"),
        (
            {"speeds": ["100 Hz"]},
            {"inertia": None, "damping": None},
            r"--speeds: without inertia nothing depends on the speed, .* no section \[inertia\]",
        ),
        ({"speeds": ["100 Hz", "3000 rpm"]}, {}, "both speeds of the pinion and mesh frequencies"),
        ({"loads": ["100"]}, {}, "number without unit, not a torque. Write each value in quotes with its unit"),
        ({"loads": ["100 N"]}, {}, "is a force, not a torque"),
        ({"speeds": ["100 N m"]}, {}, "is a torque, not a frequency"),
        ({"loads": ["100 N m", "0.1 kNm"]}, {}, '"0.1 kNm" is given twice'),
        ({"loads": ["inf N m"]}, {}, "not a finite number"),
        (
            {"loads": ["1 .. 100 N m in 20"], "speeds": ["10 .. 1000 Hz in 50"]},
            {},
            r"20 loads with 50 speeds each, and at rest, are 1020 runs, about \d.* on one core of an idle machine. "
            r"Allowed: up to 1000.*--most-runs 1020",
        ),
    ],
)
def test_what_cannot_be_mapped_is_refused_by_name(arguments, changes, message):
    """Rule 7 of the house: what, where, the value, what is allowed, the remedy."""
    with pytest.raises(SceneError, match=message) as refusal:
        mapped(**arguments, **changes)
    assert "Nothing was computed or written." in str(refusal.value)


def test_the_studies_of_a_map():
    """Definition: quasi-static without inertia; steady speeds long enough for the start to die down."""
    scene, found = load_scene(DEMO), mapped(["50 N m", "400 N m"], ["750 rpm", "1500 rpm"]).studies
    still, moving = found[QUASI_STATIC].cases, found[OVER_SPEED].cases
    assert len(still) == 2 and len(moving) == 4
    assert all(
        case.scene.inertia is None and case.scene.damping is None and case.scene.motion.mesh_cycles == 2
        for case in still
    )
    assert [case.scene.motion.mesh_frequency for case in moving] == pytest.approx([200.0, 400.0] * 2)
    longest = settling_time(model_of(scene))
    assert all(
        (case.scene.motion.mesh_cycles - 2) / case.scene.motion.mesh_frequency >= longest * (1.0 - 1e-3)
        for case in moving
    )


def test_settings_that_the_scene_leaves_open_are_the_same_for_all_loads():
    """Definition: elements are those of the geometric mean of the loads, here 200 N m, the window that of the
    largest."""
    scene = replace(load_scene(DEMO), accuracy=Accuracy())
    middle, largest = (
        model_of(quasi_static(replace(scene, load=Load(torque)))).resolution for torque in (200e3, 400e3)
    )
    wanted = load_map(DEMO, scene, ["100 N m", "400 N m"], [], 10)
    assert shared_accuracy(wanted) == {
        "accuracy.flank_element_size": f"{middle.flank_element_size:.6g} mm",
        "accuracy.contact_length": f"{largest.contact_grid.length:.6g} mm",
    }
    assert shared_accuracy(mapped(["100 N m"])) == {}


def test_natural_frequencies_are_those_of_two_inertias(paper_scene, paper_pair):
    """Exact: two free bodies against a spring vibrate at sqrt(k (rb1^2/J1 + rb2^2/J2))/2 pi."""
    scene = replace(
        paper_scene, bearings=None, friction=None, damping=None, shafts=Shafts(1e-5), inertia=Inertia(4.9e-3, 24.5)
    )
    tangents = xr.DataArray([14.0, 17.0], dims="load")
    found = frequencies_over_load(scene, np.array([100.0, 400.0]), tangents, paper_pair)
    for value, frequencies in zip(tangents.values, found["natural_frequency"][1]):
        stiffness = value * paper_pair.face_width * 1e3
        expected = sqrt(stiffness * (paper_pair.pinion.base_radius**2 + paper_pair.wheel.base_radius**2) / 24.5) / (
            2.0 * pi
        )
        assert frequencies == pytest.approx([expected], rel=1e-8)
    assert found["excited"][1].tolist() == [1]


def test_a_map_is_what_runs_of_its_scenes_give(folder, capsys):
    """Exact identity with a run of each scene alone; a second call computes nothing."""
    scene, coarse = load_scene("pair.toml"), 'model = "ISO 6336-1"\nsteps_per_mesh_cycle = 20\n'
    Path("pair.toml").write_text(f"{scene.text[: scene.text.index('[accuracy]')]}[accuracy]\n{coarse}")
    call = ["map", "pair.toml", "--loads", "100 N m", "200 N m", "--speeds", "300 Hz", "600 Hz", "--output", "out"]
    assert main(call) == 0
    written = {Path(line).name for line in capsys.readouterr().out.splitlines()}
    pictures = ("harris_map", "over_load", "over_speed", "campbell", "waterfall_100_N_m", "waterfall_200_N_m")
    assert {"map.nc", *(f"{name}.png" for name in pictures)} <= written
    found, scene = results.files.read(Path("out/map.nc")), load_scene("pair.toml")
    length = found.attrs["base_radius_wheel"] / 1e-3
    for load in (100.0, 200.0):
        still = simulate(replace(quasi_static(scene), load=Load(1e3 * load), motion=Motion(200.0, 2, 2)))
        at = found.sel(load=load)
        np.testing.assert_array_equal(at["transmission_error"], still["transmission_error"].values * length)
        assert float(at["peak_to_peak_transmission_error"]) == still.attrs["peak_to_peak_transmission_error"] * length
    table = pandas.read_csv("out/map_over_load_and_mesh_frequency.csv")
    assert table["load [N m]"].tolist() == [100.0, 100.0, 200.0, 200.0]
    np.testing.assert_allclose(table["pinion_speed [rpm]"], np.array([300.0, 600.0] * 2) * 60.0 / 16.0)
    moving = results.load(next(Path("out/over_speed/cases").glob("0001*.nc")))
    amplitudes = found["transmission_error_amplitude"].sel(load=100.0, mesh_frequency=600.0)
    assert float(amplitudes.sel(order=1.0)) == pytest.approx(moving.attrs["transmission_error_harmonic_1"], rel=1e-2)
    # Parseval: all lines together are the mean square.
    assert 0.5 * float((amplitudes**2).sum()) == pytest.approx(moving.attrs["rms_transmission_error"] ** 2, rel=2e-2)
    before = stamps("out/quasi_static") | stamps("out/over_speed")
    assert main([*call, "--quiet"]) == 0
    assert stamps("out/quasi_static") | stamps("out/over_speed") == before
