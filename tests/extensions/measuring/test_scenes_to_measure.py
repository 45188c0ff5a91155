"""`gears accuracy` and `gears effects` of trains, and of scenes with a target."""

import csv

import pytest
from tests.paper_text import coarse_text
from tests.trains import bent_two_stages, gearbox_file, row

from fenics_gears import load_train, simulate_train, train_from_text
from fenics_gears.commands.cli import main
from fenics_gears.extensions.measuring import train_rows
from fenics_gears.extensions.measuring.effect_costs.subsets import subsets_of
from fenics_gears.extensions.measuring.effect_costs.train_subsets import EffectsOfTrain


@pytest.mark.nightly
def test_stages_are_measured_one_by_one(tmp_path, capsys):
    """A table and a picture for each stage of two gears, and the standard error says so."""
    assert main(["effects", str(gearbox_file(tmp_path)), "-o", str(tmp_path / "out")]) == 0
    assert "Each stage of two gears by itself" in capsys.readouterr().err
    for name in ("first", "second"):
        assert (tmp_path / "out" / name / "effects.csv").is_file()


def test_effects_of_meshes_that_are_computed_together(tmp_path, capsys):
    """Identity with the trains that are written so: bare, with one effect more, with one less, and with all."""
    relief = '[stages.row.tip_relief]\ndepth = "10 um"\nstart = "HPSTC"\n'
    friction = "[friction]\ncoefficient = 0.1\n"
    bare = row((24, 24, 24), (0, 0), 400.0).text.replace('"0.1 mm"', '"0.4 mm"')
    path = tmp_path / "idler.toml"
    path.write_text(bare + relief + friction)
    assert main(["effects", str(path), "-o", str(tmp_path)]) == 0
    assert "+ tip_relief" in capsys.readouterr().out and (tmp_path / "effects.png").is_file()
    with open(tmp_path / "effects.csv", encoding="utf-8") as file:
        rows = {next(iter(each.values())): each for each in csv.DictReader(file)}
    written = {"bare": "", "+ friction": friction, "+ tip_relief": relief, "all": relief + friction}
    assert [*rows] == [*written]
    assert rows["+ friction"]["compared_with"] == "bare"
    for name, more in written.items():
        expected = simulate_train(train_from_text(bare + more))
        for number, value in train_rows.numbers_of(expected).items():
            assert float(rows[name][number]) == pytest.approx(value, rel=1e-9)


EFFECTS_OF_SET = {
    "floating_sun": ["tip_relief", "floating members", "pins that give way", "pin errors"],
    "in_time": ["inertia", "damping", "tip_relief", "floating members", "pins that give way"],
}


@pytest.mark.parametrize("name", EFFECTS_OF_SET)
def test_effects_of_a_set_are_those_of_its_scene(name):
    """By the demonstrations' files: damping takes masses with it, and masses the pins' springs that they need."""
    subsets, skipped = subsets_of(EffectsOfTrain(load_train(f"demos/planetary_sets/{name}.toml")))
    assert not skipped
    assert sorted(subsets[-1].sections) == sorted(EFFECTS_OF_SET[name])
    found = {subset.name for subset in subsets}
    assert {"bare", "all", *(f"all - {each}" for each in EFFECTS_OF_SET[name][2:4])} <= found
    assert ("all - inertia, damping" in found) == (name == "in_time")


def test_shafts_that_do_not_bend_have_nothing_of_it():
    """What a shaft that bends has beside its sections goes with them, and so do slices over the face."""
    train = bent_two_stages(1.0, "[friction]\ncoefficient = 0.08\n")
    subsets, skipped = subsets_of(EffectsOfTrain(train))
    assert not skipped
    bare = next(subset.scene for subset in subsets if subset.name == "bare")
    assert not bare.shafts.bent


def test_accuracy_of_meshes_that_are_computed_together(tmp_path, capsys):
    """A row with a setting finer, or quickly coarser, has the numbers of the train that is written so."""
    train = train_from_text(row((24, 24, 24), (0, 0), 400.0).text.replace('"0.1 mm"', '"0.4 mm"'))
    path = tmp_path / "idler.toml"
    path.write_text(train.text)
    assert main(["accuracy", str(path), "-o", str(tmp_path)]) == 0
    assert "twice the steps" in capsys.readouterr().out and (tmp_path / "accuracy.png").is_file()
    with open(tmp_path / "accuracy.csv", encoding="utf-8") as file:
        rows = {next(iter(each.values())): each for each in csv.DictReader(file)}
    written = {
        "as they stand": train.text,
        "twice the steps": train.text.replace("mesh_cycle = 20", "mesh_cycle = 40"),
        "flank elements half as large": train.text.replace('"0.4 mm"', '"0.2 mm"'),
    }
    for name, text in written.items():
        expected = simulate_train(train_from_text(text))
        for number, value in train_rows.numbers_of(expected).items():
            assert float(rows[name][number]) == pytest.approx(value, rel=1e-9)
    assert main(["accuracy", "--quick", str(path), "-o", str(tmp_path)]) == 0
    assert "half the steps" in capsys.readouterr().out
    with open(tmp_path / "accuracy.csv", encoding="utf-8") as file:
        quick = {next(iter(each.values())): each for each in csv.DictReader(file)}
    coarser = simulate_train(train_from_text(train.text.replace('"0.4 mm"', '"0.8 mm"')))
    for number, value in train_rows.numbers_of(coarser).items():
        assert float(quick["flank elements twice as large"][number]) == pytest.approx(value, rel=1e-9)
    finer = abs(float(rows["body elements half as large"]["mean_overall_transmission_error"]))
    assert finer == pytest.approx(float(rows["as they stand"]["mean_overall_transmission_error"]), rel=0.02)


def test_settings_are_wanted_as_they_stand(tmp_path, capsys):
    """`gears accuracy` and `gears effects` turn settings themselves."""
    text = coarse_text(accuracy='[accuracy]\ntarget = "10 %"\n')
    (tmp_path / "scene.toml").write_text(text)
    for command in ("accuracy", "effects"):
        assert main([command, str(tmp_path / "scene.toml"), "--output", str(tmp_path)]) == 2
        assert "leave accuracy.target out" in capsys.readouterr().err
