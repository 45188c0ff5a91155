"""`gears accuracy` and `gears effects` of trains, and of scenes with a target."""

import csv

import pytest
from tests.paper_text import coarse_text
from tests.trains import gearbox_file, row

from fenics_gears import simulate_train, train_from_text
from fenics_gears.commands.cli import main
from fenics_gears.extensions.measuring import train_accuracy


@pytest.mark.nightly
def test_stages_are_measured_one_by_one(tmp_path, capsys):
    """A table and a picture for each stage of two gears, and the standard error says so."""
    assert main(["effects", str(gearbox_file(tmp_path)), "-o", str(tmp_path / "out")]) == 0
    assert "Each stage of two gears by itself" in capsys.readouterr().err
    for name in ("first", "second"):
        assert (tmp_path / "out" / name / "effects.csv").is_file()


def test_effects_of_rows_with_idlers_are_not_measured(tmp_path, capsys):
    """Before anything is computed, with what can be done."""
    path = tmp_path / "idler.toml"
    path.write_text(row((24, 24, 24), (0, 0), 400.0).text)
    assert main(["effects", str(path)]) == 2
    assert "computed together (row)" in capsys.readouterr().err


def test_accuracy_of_meshes_that_are_computed_together(tmp_path, capsys):
    """A row with a setting finer has the numbers of the train that is written so."""
    train = train_from_text(row((24, 24, 24), (0, 0), 400.0).text.replace('"0.1 mm"', '"0.4 mm"'))
    path = tmp_path / "idler.toml"
    path.write_text(train.text)
    assert main(["accuracy", str(path), "-o", str(tmp_path)]) == 0
    assert "twice the steps" in capsys.readouterr().out and (tmp_path / "accuracy.png").is_file()
    with open(tmp_path / "accuracy.csv", encoding="utf-8") as file:
        rows = {each["settings"]: each for each in csv.DictReader(file)}
    written = {
        "as they stand": train.text,
        "twice the steps": train.text.replace("mesh_cycle = 20", "mesh_cycle = 40"),
        "flank elements half as large": train.text.replace('"0.4 mm"', '"0.2 mm"'),
    }
    for name, text in written.items():
        expected = simulate_train(train_from_text(text))
        for number, value in train_accuracy.numbers_of(expected).items():
            assert float(rows[name][number]) == pytest.approx(value, rel=1e-9)
    finer = abs(float(rows["body elements half as large"]["mean_overall_transmission_error"]))
    assert finer == pytest.approx(float(rows["as they stand"]["mean_overall_transmission_error"]), rel=0.02)


def test_settings_are_wanted_as_they_stand(tmp_path, capsys):
    """`gears accuracy` and `gears effects` turn settings themselves."""
    text = coarse_text(accuracy='[accuracy]\ntarget = "10 %"\n')
    (tmp_path / "scene.toml").write_text(text)
    for command in ("accuracy", "effects"):
        assert main([command, str(tmp_path / "scene.toml"), "--output", str(tmp_path)]) == 2
        assert "leave accuracy.target out" in capsys.readouterr().err
