"""What commands of extensions do with a train."""

import pytest
from tests.trains import bent_two_stages, gearbox_file

from fenics_gears.commands.cli import main
from fenics_gears.results import load


@pytest.fixture
def scene(tmp_path):
    return gearbox_file(tmp_path)


def test_a_map_says_that_it_is_a_train(scene, capsys):
    """A scene without [gears] would have been called incomplete; it names the scenes that it takes."""
    assert main(["map", str(scene)]) == 2
    said = capsys.readouterr().err
    assert "is a train of gears" in said and "scene.toml" in said


def test_a_train_is_rated_mesh_by_mesh(scene, tmp_path, capsys):
    """One table; a stage has the rows that its own run has."""
    scene.write_text(scene.read_text() + '[motion]\ninput_speed = "3000 rpm"\n')
    out = tmp_path / "out"
    assert main(["run", str(scene), "-o", str(out), "-q", "--no-pictures"]) == 0
    assert main(["rate", str(out), "-q"]) == 0
    rows = (out / "rating.csv").read_text().splitlines()
    assert rows[0] == "mesh,quantity,unit,ISO 6336,this run"
    for name in ("first", "second"):
        assert main(["rate", str(out / name), "-q"]) == 0
        own = (out / name / "rating.csv").read_text().splitlines()
        assert [row.removeprefix(f"{name},") for row in rows if row.startswith(f"{name},")] == own[1:]
    capsys.readouterr()


def test_commands_of_pairs_name_the_stages(scene, tmp_path, capsys):
    """What has no meaning for a train yet says which runs it takes."""
    assert main(["run", str(scene), "-o", str(tmp_path / "out"), "-q", "--no-pictures"]) == 0
    assert main(["plot", str(tmp_path / "out"), "--spectrum"]) == 2
    said = capsys.readouterr().err
    assert "is the run of a train" in said and str(tmp_path / "out" / "second") in said


def test_the_sound_of_a_train(scene, tmp_path, capsys):
    """Of its overall transmission error: half a second of samples of two bytes."""
    scene.write_text(scene.read_text() + '[motion]\ninput_speed = "3000 rpm"\n')
    out = tmp_path / "out"
    assert main(["run", str(scene), "-o", str(out), "-q", "--no-pictures"]) == 0
    assert main(["listen", str(out), "--seconds", "0.5", "-q"]) == 0
    assert (out / "overall_transmission_error.wav").stat().st_size > 2 * 0.5 * 48000
    capsys.readouterr()


def test_stages_that_move_together_are_rated(scene, tmp_path, capsys):
    """Each mesh by its own forces, without folders of stages."""
    more = '[motion]\ninput_speed = "900 rpm"\nmesh_cycles = 2\n[inertia]\ndensity = "7.85 g/cm^3"\n'
    scene.write_text(scene.read_text() + more)
    out = tmp_path / "out"
    assert main(["run", str(scene), "-o", str(out), "-q", "--no-pictures"]) == 0
    assert main(["rate", str(out)]) == 0
    said = capsys.readouterr().out
    assert "first" in said
    assert "second" in said


def test_a_train_whose_shafts_bend_is_rated(tmp_path, capsys):
    """Misalignment over the face is that of the run, by both gears of a shaft; a face factor iterated over shafts that
    are the pair's alone would leave the other gear out, and is not there."""
    scene = tmp_path / "bent.toml"
    scene.write_text(bent_two_stages(1.0, '[motion]\ninput_speed = "900 rpm"\n').text)
    out = tmp_path / "out"
    assert main(["run", str(scene), "-o", str(out), "-q", "--no-pictures"]) == 0
    assert main(["rate", str(out)]) == 0
    said = capsys.readouterr().out
    assert "the axes' inclination in this run" in said
    assert "iterated" not in said
    rows = [row.split(",") for row in (out / "rating.csv").read_text().splitlines() if "F_betax" in row]
    means = load(out / "run.nc")["mean_axis_inclination_in_plane"].values
    assert [float(row[-1]) for row in rows] == pytest.approx(abs(means), rel=1e-3)
