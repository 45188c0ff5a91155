"""`gears run` and `gears check` of a train."""

import re

import numpy as np
import pytest
from tests.trains import COARSE, gearbox_file, helical_row, split_text

from fenics_gears import load, load_scene, load_train, simulate, simulate_train, train_from_text
from fenics_gears.commands.cli import main

LOAD = f'[load]\noutput_torque = "400 N m"\n[accuracy]\n{COARSE}\n'


@pytest.fixture
def scene(tmp_path):
    return gearbox_file(tmp_path)


@pytest.fixture(scope="module")
def ran(tmp_path_factory):
    """A scene with a speed, and the folder of its run with pictures."""
    folder = tmp_path_factory.mktemp("train")
    scene = gearbox_file(folder)
    scene.write_text(scene.read_text() + '[motion]\ninput_speed = "3000 rpm"\n')
    assert main(["run", str(scene), "-o", str(folder / "out"), "-q"]) == 0
    return scene, folder / "out"


def test_run_writes_result_and_pictures(ran, capsys):
    """What the page on trains says; pictures again, and curves."""
    scene, out = ran
    written = {"run.nc", "train.png", "transmission_error.png", "order_spectrum.png", "first", "second"}
    assert {each.name for each in out.iterdir()} == written
    found = load(out / "run.nc")
    assert found.sizes["mesh"] == 2
    assert found.attrs["complete"] == 1
    assert found.attrs["scene"] == scene.read_text()
    (out / "train.png").unlink()
    assert main(["plot", str(out), "-q"]) == main(["export", str(out), "-q"]) == 0
    assert {each.name for each in out.iterdir()} == {*written, "curves.csv"}
    capsys.readouterr()


def test_each_stage_is_a_run_and_a_scene_for_all_other_commands(ran, tmp_path, capsys):
    """A stage is a pair under its torque: 200 N m on the first wheel. Not the run of the whole: which of its meshes
    would be drawn?"""
    first = ran[1] / "first"
    assert main(["export", str(first), "-q"]) == 0
    assert main(["check", str(first / "scene.toml")]) == 0
    assert load_scene(first / "scene.toml").load.wheel_torque == pytest.approx(200e3)
    capsys.readouterr()
    assert main(["picture", str(ran[1]), "-o", str(tmp_path / "one.png")]) == 2
    assert "--mesh; known: first, second" in capsys.readouterr().err
    assert main(["picture", str(ran[1]), "--mesh", "third"]) == 2
    assert "Known: first, second" in capsys.readouterr().err


def test_a_stage_without_a_speed_is_a_scene_too(scene, tmp_path, capsys):
    """The one behind, whose mesh cycles are not those of the first: its file is read, and its run repeats to the last
    digit."""
    assert main(["run", str(scene), "-o", str(tmp_path / "out"), "-q", "--no-pictures"]) == 0
    second = tmp_path / "out" / "second"
    assert main(["check", str(second / "scene.toml")]) == 0
    again = simulate(load_scene(second / "scene.toml"))
    assert np.array_equal(again["transmission_error"], load(second / "run.nc")["transmission_error"])
    assert main(["picture", str(second), "-q"]) == 0
    capsys.readouterr()


def test_check_tells_shafts_and_meshes(scene, capsys):
    """Torque falls and speed rises by the ratios: 400 N m, 200 N m, 133.33 N m."""
    assert main(["check", str(scene)]) == 0
    said = capsys.readouterr().out
    assert "turns of the first shaft in one of the last  3" in said
    for shaft in ("counter-clockwise, 133.33 N m", "clockwise, 200 N m", "counter-clockwise, 400 N m"):
        assert shaft in said


def test_check_tells_how_paths_close_and_share(tmp_path, capsys):
    """Two equal paths under 400 N m: 100 N m on either shaft. A tooth of 20 and one of 40, from opposite sides, are
    alike for both paths, but for the clocking. Shafts that twist without inertia have no frequencies."""
    path = tmp_path / "split.toml"
    path.write_text(split_text(of_shaft='clocking = "2 mrad"\ntorsional_stiffness = "1e8 N mm/rad"'))
    assert main(["check", str(path)]) == 0
    said = capsys.readouterr().out
    assert said.count("  clockwise, 100 N m, carries in") == 2
    assert "shaft 4  counter-clockwise, 400 N m, carries out1.wheel" in said
    angles = re.findall(r"clocking +([0-9.]+) rad: .* stands ([0-9.]+) deg", said)
    assert [float(clocking) for clocking, _ in angles] == [0.0, 0.002]
    assert float(angles[0][1]) == pytest.approx(float(angles[1][1]), abs=1e-4)
    out = tmp_path / "out"
    assert main(["run", str(path), "-o", str(out), "-q"]) == 0
    assert load(out / "run.nc")["mean_path_share"].values[1] > 0.55
    capsys.readouterr()


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


@pytest.mark.nightly
def test_a_target_is_kept_stage_by_stage(scene, tmp_path):
    """Settings are those that the pair alone gets for its target, and the scene in the result has them: it repeats the
    run."""
    text = scene.read_text().partition("[accuracy]")[0]
    scene.write_text(f'{text}[stages.first.accuracy]\ntarget = "5 %"\n[stages.second.accuracy]\n{COARSE}\n')
    found = simulate_train(load_train(scene))
    alone = simulate(load_train(scene).meshes[0].scene)
    own = found.sel(mesh="first")
    assert float(own["estimated_error"]) == alone.attrs["estimated_error"]
    assert float(own["mean_transmission_error"]) == alone.attrs["mean_transmission_error"]
    again = simulate_train(train_from_text(found.attrs["scene"]))
    for name in ("mean_transmission_error", "peak_to_peak_transmission_error"):
        assert np.array_equal(again[name], found[name])


def test_commands_take_stages_that_move_together(scene, tmp_path, capsys):
    """They have no folders of their own, but for a picture of each mesh."""
    more = '[motion]\ninput_speed = "900 rpm"\nmesh_cycles = 2\n[inertia]\ndensity = "7.85 g/cm^3"\n'
    scene.write_text(scene.read_text() + more)
    out = tmp_path / "out"
    assert main(["check", str(scene)]) == 0
    assert "mostly rotation of shaft 2" in capsys.readouterr().out
    assert main(["run", str(scene), "-o", str(out), "-q", "--no-pictures"]) == 0
    for command in ("plot", "export"):
        assert main([command, str(out), "-q"]) == 0
    assert not (out / "first").exists()
    assert main(["picture", str(out), "-q"]) == 0
    assert all((out / name / "stress.png").is_file() for name in ("first", "second"))


def test_a_train_without_meaning_has_the_exit_code_of_a_pair(scene, capsys):
    """On springs of 50 N/mm the teeth go through each other, which exit code 4 says (docs/promises.md)."""
    scene.write_text(scene.read_text() + '[bearings]\nstiffness = "50 N/mm"\n')
    out = scene.parent / "out"
    assert main(["run", str(scene), "-o", str(out), "-q", "--no-pictures"]) == 4
    assert capsys.readouterr().err.startswith(f"{out / 'run.nc'}: first; second: the result has no meaning")
