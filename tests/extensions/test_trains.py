"""What commands of extensions do with a train."""

from math import log10

import pytest
import xarray as xr
from tests.trains import bent_two_stages, gearbox_file

from fenics_gears import carried_train, load, overall_orders
from fenics_gears.commands.cli import main
from fenics_gears.extensions.noise.train_figures import train_charts


@pytest.fixture
def scene(tmp_path):
    return gearbox_file(tmp_path)


@pytest.fixture(scope="module")
def ran(tmp_path_factory):
    """The folder of a run with a speed."""
    folder = tmp_path_factory.mktemp("train")
    scene = gearbox_file(folder)
    scene.write_text(scene.read_text() + '[motion]\ninput_speed = "3000 rpm"\n')
    assert main(["run", str(scene), "-o", str(folder / "out"), "-q", "--no-pictures"]) == 0
    return folder / "out"


def test_a_train_is_rated_mesh_by_mesh(ran, capsys):
    """One table; a stage has the rows that its own run has."""
    assert main(["rate", str(ran)]) == 0
    assert "a stage's own scene.toml, which is in its folder" in capsys.readouterr().out
    rows = (ran / "rating.csv").read_text().splitlines()
    assert rows[0] == "mesh,quantity,unit,ISO 6336,this run"
    for name in ("first", "second"):
        assert main(["rate", str(ran / name), "-q"]) == 0
        own = (ran / name / "rating.csv").read_text().splitlines()
        assert [row.removeprefix(f"{name},") for row in rows if row.startswith(f"{name},")] == own[1:]
    capsys.readouterr()


def test_the_spectrum_of_a_train(ran, capsys):
    """Levels of its orders: 20 log10 of what the run's own orders have in urad; 20 teeth mesh 20 times a turn, those of
    the second stage 20 times in 30/20 turns."""
    assert main(["plot", str(ran), "--spectrum", "-q"]) == 0
    figures = xr.load_dataset(ran / "noise.nc")
    found = load(ran / "run.nc")
    expected = overall_orders(found, carried_train(found))
    levels = [20.0 * log10(1e6 * each.amplitude) for each in expected]
    assert figures["overall_transmission_error_level"].values == pytest.approx(levels, abs=1e-9)
    first = [float(figures["order"][(figures["meshes"] == name).values][0]) for name in ("first", "second")]
    assert first == pytest.approx([20.0, 20.0 * 20 / 30])
    assert (ran / "noise.png").stat().st_size > 10000
    assert [each.name for each in train_charts(figures)[0].curves][:2] == ["first", "second"]
    assert main(["plot", str(ran), "--spectrum", "hann"]) == 2
    assert "orders of a train are of whole cycles" in capsys.readouterr().err


def test_the_sound_of_a_train(ran):
    """Of its overall transmission error: half a second of samples of two bytes."""
    assert main(["listen", str(ran), "--seconds", "0.5", "-q"]) == 0
    assert (ran / "overall_transmission_error.wav").stat().st_size > 2 * 0.5 * 48000


def test_stages_that_move_together_are_rated(scene, tmp_path, capsys):
    """Each mesh by its own forces, without folders of stages, which the table's last words then do not send to."""
    more = '[motion]\ninput_speed = "900 rpm"\nmesh_cycles = 2\n[inertia]\ndensity = "7.85 g/cm^3"\n'
    scene.write_text(scene.read_text() + more)
    out = tmp_path / "out"
    assert main(["run", str(scene), "-o", str(out), "-q", "--no-pictures"]) == 0
    assert main(["rate", str(out)]) == 0
    said = capsys.readouterr().out
    assert "first" in said
    assert "second" in said
    assert not (out / "first").exists()
    assert "in its folder" not in said
    assert "run a scene of one of its pairs" in said


@pytest.mark.nightly
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
