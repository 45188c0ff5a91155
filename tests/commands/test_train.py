"""`gears run` and `gears check` of a train."""

import re

import pytest
from tests.trains import COARSE, helical_row, stage

from fenics_gears import load, load_scene
from fenics_gears.commands.cli import main

LOAD = f'[load]\noutput_torque = "400 N m"\n[accuracy]\n{COARSE}\n'


@pytest.fixture
def scene(tmp_path):
    path = tmp_path / "gearbox.toml"
    path.write_text(f"{stage('first', 2.0, (20, 30))}{stage('second', 3.0, (20, 40))}\n{LOAD}")
    return path


def test_run_writes_result_and_pictures(scene, tmp_path):
    """What the page on trains says."""
    assert main(["run", str(scene), "-o", str(tmp_path / "out"), "-q"]) == 0
    written = {"run.nc", "train.png", "transmission_error.png", "first", "second"}
    assert {each.name for each in (tmp_path / "out").iterdir()} == written
    found = load(tmp_path / "out" / "run.nc")
    assert found.sizes["mesh"] == 2
    assert found.attrs["complete"] == 1
    assert found.attrs["scene"] == scene.read_text()


def test_each_stage_is_a_run_and_a_scene_for_all_other_commands(scene, tmp_path, capsys):
    """A stage is a pair under its torque: 200 N m on the first wheel."""
    assert main(["run", str(scene), "-o", str(tmp_path / "out"), "-q", "--no-pictures"]) == 0
    first = tmp_path / "out" / "first"
    assert main(["export", str(first), "-q"]) == 0
    assert main(["check", str(first / "scene.toml")]) == 0
    assert load_scene(first / "scene.toml").load.wheel_torque == pytest.approx(200e3)
    capsys.readouterr()


def test_check_tells_shafts_and_meshes(scene, capsys):
    """Torque falls and speed rises by the ratios: 400 N m, 200 N m, 133.33 N m."""
    assert main(["check", str(scene)]) == 0
    said = capsys.readouterr().out
    assert "turns of the first shaft in one of the last  3" in said
    for shaft in ("counter-clockwise, 133.33 N m", "clockwise, 200 N m", "counter-clockwise, 400 N m"):
        assert shaft in said


def test_a_row_that_memory_does_not_hold_is_refused(tmp_path, monkeypatch, capsys):
    """Before anything is computed, by check and by run: with the size, what is allowed, and settings that fit. More
    gears take more."""
    path = tmp_path / "row.toml"
    needed = []
    for teeth, directions in (([24, 31], [0]), ([24, 31, 40], [0, 60]), ([24, 31, 40, 25], [0, 60, 20])):
        path.write_text(helical_row(teeth, directions, 300).text)
        assert main(["check", str(path), "--memory", "20 GB"]) == 0
        needed.append(float(re.search(r"memory +(\d+) MB", capsys.readouterr().out)[1]))
    assert needed[0] < needed[1] < needed[2]
    monkeypatch.setattr("fenics_gears.simulation.train.row_cycle", lambda *arguments: pytest.fail("computed"))
    for command in ("check", "run"):
        assert main([command, str(path), "--memory", "20 MB"]) == 3
        said = capsys.readouterr().err
        assert "contact operators apart, and 0.02 GB are allowed. Nothing was computed" in said


@pytest.mark.parametrize("command", ["effects", "accuracy"])
def test_commands_of_pairs_say_that_it_is_a_train(command, scene, capsys):
    """A scene without [gears] would have been called incomplete."""
    assert main([command, str(scene)]) != 0
    assert "is a train of gears" in capsys.readouterr().err


def test_commands_of_runs_say_that_it_is_a_train(scene, tmp_path, capsys):
    """Not a traceback for a dimension that pairs do not have."""
    assert main(["run", str(scene), "-o", str(tmp_path / "out"), "-q", "--no-pictures"]) == 0
    for command in ("plot", "export", "report"):
        assert main([command, str(tmp_path / "out")]) != 0
        assert "is the run of a train" in capsys.readouterr().err
