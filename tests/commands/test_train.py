"""`gears run` and `gears check` of a train."""

import pytest
from tests.trains import COARSE, stage

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
    written = {"run.nc", "train.png", "transmission_error.png", "order_spectrum.png", "first", "second"}
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


@pytest.mark.parametrize("command", ["effects", "accuracy"])
def test_commands_of_pairs_say_that_it_is_a_train(command, scene, capsys):
    """A scene without [gears] would have been called incomplete."""
    assert main([command, str(scene)]) != 0
    assert "is a train of gears" in capsys.readouterr().err


def test_commands_of_runs_take_a_train(scene, tmp_path, capsys):
    """Its pictures again, its curves, one page with a section for each mesh, its sound."""
    scene.write_text(scene.read_text() + '[motion]\ninput_speed = "3000 rpm"\n')
    out = tmp_path / "out"
    assert main(["run", str(scene), "-o", str(out), "-q", "--no-pictures"]) == 0
    assert main(["plot", str(out), "-q"]) == 0
    assert main(["export", str(out), "-q"]) == 0
    assert main(["report", str(out), "-q"]) == 0
    assert main(["listen", str(out), "--seconds", "0.5", "-q"]) == 0
    assert (out / "train.png").is_file() and (out / "curves.csv").is_file()
    page = (out / "report.html").read_text()
    for heading in ("Power flow", "Orders of the overall transmission error", "Mesh: first", "Mesh: second"):
        assert heading in page
    assert (out / "overall_transmission_error.wav").stat().st_size > 2 * 0.5 * 48000
    capsys.readouterr()


def test_commands_of_pairs_name_the_stages(scene, tmp_path, capsys):
    """What has no meaning for a train yet says which runs it takes."""
    assert main(["run", str(scene), "-o", str(tmp_path / "out"), "-q", "--no-pictures"]) == 0
    assert main(["plot", str(tmp_path / "out"), "--spectrum"]) == 2
    said = capsys.readouterr().err
    assert "is the run of a train" in said and str(tmp_path / "out" / "second") in said
