"""Studies of trains: what they compute, keep and show."""

import functools
from pathlib import Path

import numpy as np
import pytest
from tests.planets import planetary_text
from tests.programs import gears
from tests.studies.conftest import stamps
from tests.trains import COARSE, split_text, stage

from fenics_gears import SceneError, load, load_train, simulate_train
from fenics_gears.commands.cli import main
from fenics_gears.runs import runs
from fenics_gears.runs.condensing import gear_tasks
from fenics_gears.runs.gear_store import GearStore
from fenics_gears.runs.run import scene_key
from fenics_gears.simulation import train as train_simulation
from fenics_gears.studies import fields
from fenics_gears.studies.combine import load_combined
from fenics_gears.studies.study_file import load_study

SWEEP = """
scene = "gearbox.toml"
[sweep]
stages.second.pinion.profile_shift = [0.0, 0.2]
load.input_torque = ["100 N m", "200 N m"]
"""


@pytest.fixture
def gearbox(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    text = f"{stage('first', 2.0, (20, 30))}{stage('second', 3.0, (20, 40))}\n"
    Path("gearbox.toml").write_text(f'{text}[load]\noutput_torque = "400 N m"\n[accuracy]\n{COARSE}\n')
    Path("study.toml").write_text(SWEEP)
    return tmp_path


def study_of(text: str, name: str = "other.toml"):
    Path(name).write_text(text)
    return load_study(name)


def test_shafts_with_names_are_swept(gearbox):
    """A train's own sections are fields of studies as those of pairs; a case has the value."""
    Path("gearbox.toml").write_text(
        Path("gearbox.toml").read_text() + '[shafts.middle]\ncarries = ["first.wheel", "second.pinion"]\n'
    )
    sweep = 'scene = "gearbox.toml"\n[sweep]\nshafts.middle.{} = ["1e8 N mm/rad", "2e8 N mm/rad"]\n'
    cases = study_of(sweep.format("torsional_stiffness")).cases
    assert [case.model.scene.shafts.torsion[1] for case in cases] == [1e8, 2e8]
    with pytest.raises(SceneError, match="no section or field"):
        study_of(sweep.format("stiffness_of_it"))


@pytest.mark.nightly
@pytest.mark.usefixtures("undrawn")
def test_every_case_is_what_a_run_of_its_train_gives(gearbox, capsys):
    """Exact identity with a run of each train alone: of the whole and of each mesh; and a study that is run again
    computes nothing."""
    assert main(["study", "study.toml", "--quiet"]) == 0
    combined = load_combined(gearbox / "results/study/study.nc")
    assert combined.sizes == {
        "profile_shift": 2,
        "input_torque": 2,
        "mesh": 2,
        "mesh_phase": combined.sizes["mesh_phase"],
    }
    for case in load_study("study.toml").cases:
        alone = simulate_train(case.model)
        row = combined.isel(profile_shift=case.index // 2, input_torque=case.index % 2)
        for name in ("peak_to_peak_overall_transmission_error", "mean_overall_transmission_error"):
            assert float(row[name]) == alone.attrs[name]
        for name in ("peak_to_peak_transmission_error", "peak_contact_pressure", "largest_pair_force"):
            assert np.array_equal(row[name].values, alone[name].values)
        assert np.array_equal(row["overall_transmission_error"].values, alone["overall_transmission_error"].values)
        kept = load(gearbox / "results/study" / str(row["case_file"].values))
        assert np.array_equal(kept["pair_normal_force"], alone["pair_normal_force"], equal_nan=True)
    before = stamps(gearbox / "results/study")
    assert main(["study", "study.toml"]) == 0
    said = capsys.readouterr()
    assert "4 kept, 0 to be computed" in said.err
    assert "overall transmission error, peak to peak" in said.out
    assert stamps(gearbox / "results/study") == before


def test_gears_that_cases_share_are_condensed_once(gearbox):
    """Four cases of four gears each, which differ in two of them: a pinion's shift changes its wheel's tip too."""
    assert len(gear_tasks(study_of(SWEEP.replace("200 N m", "101 N m")).cases)) == 6


def test_a_row_is_condensed_idler_and_all(gearbox):
    """Three gears of a row, whatever their directions and torques."""
    Path("row.toml").write_text(
        '[stages.row]\nkind = "row"\nmodule = "3 mm"\npressure_angle = "20 deg"\nface_width = "30 mm"\n'
        + "gears = [{}]".format(
            ", ".join(f'{{ teeth = {each}, profile_shift = 0, bore_diameter = "30 mm" }}' for each in (20, 24, 30))
        )
        + f'\nmaterial = "steel"\n[load]\noutput_torque = "100 N m"\n[accuracy]\n{COARSE}\n'
    )
    text = 'scene = "row.toml"\n[sweep]\nstages.row.gears.2.profile_shift = [0, 0.1]\n'
    shifted = study_of(text)
    assert [case.model.models[0].pair.wheel.profile_shift for case in shifted.cases] == [0.0, 0.1]
    turned = study_of(
        text.replace("gears.2.profile_shift = [0, 0.1]", 'directions = [["0 deg", "60 deg"], ["0 deg", "61 deg"]]')
    )
    assert [task.name for task in gear_tasks(turned.cases[:1])] == ["pinion", "row.2", "wheel"]
    assert turned.axes[0].coordinate()[0] == '["0 deg", "60 deg"]'


@pytest.mark.usefixtures("undrawn")
def test_errors_of_a_row_are_varied_by_numbers():
    """By hand: of the second gear a table of its own beside those of other gears."""
    tree = {"stages": {"row": {"gears": [{}, {}], "eccentricity": {"1": {"distance": "5 um"}}}}}
    path = ("stages", "row", "eccentricity", "2", "distance")
    assert fields.why_unknown(path) is None and fields.is_numeric(path)
    found = fields.changed(tree, path, "3 um")["stages"]["row"]
    assert found["eccentricity"] == {"1": {"distance": "5 um"}, "2": {"distance": "3 um"}} and len(found["gears"]) == 2


def test_rows_with_other_friction_share_their_contact_equations(gearbox, monkeypatch):
    """They are made once, and every case is what a run of its train alone gives."""
    made = []
    row_cycle = train_simulation.row_cycle
    monkeypatch.setattr(train_simulation, "row_cycle", lambda *given: made.append(given) or row_cycle(*given))
    monkeypatch.setattr(runs, "own_gear_store", functools.lru_cache(GearStore))
    gear = '{{ teeth = {}, profile_shift = 0, bore_diameter = "30 mm" }}'.format
    text = '[stages.row]\nkind = "row"\nmodule = "3 mm"\npressure_angle = "20 deg"\nface_width = "30 mm"\n'
    text += f'gears = [{gear(20)}, {gear(24)}, {gear(30)}]\nmaterial = "steel"\n'
    Path("row.toml").write_text(f'{text}[load]\noutput_torque = "100 N m"\n[accuracy]\n{COARSE}\n')
    Path("study.toml").write_text('scene = "row.toml"\n[sweep]\nfriction.coefficient = [0.05, 0.1]\n')
    assert main(["study", "study.toml", "--quiet"]) == 0
    assert len(made) == 1
    combined = load_combined(gearbox / "results/study/study.nc")
    for case in load_study("study.toml").cases:
        alone = simulate_train(case.model)
        found = combined["overall_transmission_error"].isel(coefficient=case.index)
        assert found.values == pytest.approx(alone["overall_transmission_error"].values, rel=1e-12)


def test_the_key_is_of_what_a_train_computes(gearbox):
    """Words change nothing; a direction of an idler does, since phases follow from it."""
    train = load_train("gearbox.toml")
    text = Path("gearbox.toml").read_text()
    Path("named.toml").write_text(f'title = "Another"\n{text}')
    assert scene_key(load_train("named.toml")) == scene_key(train)
    Path("loaded.toml").write_text(text.replace("400 N m", "401 N m"))
    assert scene_key(load_train("loaded.toml")) != scene_key(train)


@pytest.mark.parametrize(
    ("swept", "said"),
    [
        ("stages.frist.wheel.profile_shift = [0, 0.1]", 'has the stages first, second. Did you mean "first"?'),
        ("stages.first.wheel.profile_shft = [0, 0.1]", 'Did you mean "stages.first.wheel.profile_shift"?'),
        ('load.wheel_torque = ["1 N m", "2 N m"]', "Known: output_torque, input_torque, power"),
        ("stages.first.wheel.profile_shift = [0, 9]", "profile_shift = 9\n    is too large"),
    ],
)
def test_a_mistake_says_what_it_is(gearbox, swept, said):
    """Before anything is computed, at its line of the study."""
    with pytest.raises(SceneError) as refused:
        study_of(f'scene = "gearbox.toml"\n[sweep]\n{swept}\n')
    assert said in str(refused.value)
    assert str(refused.value).startswith("other.toml:3: ")


@pytest.mark.ranks
@pytest.mark.nightly
def test_two_processes_give_what_one_gives(gearbox):
    """Pictures too, which take longer than the runs."""
    assert main(["study", "study.toml", "--quiet", "-o", "alone"]) == 0
    together = gears(gearbox, "study", "study.toml", "-o", "both", ranks=2)
    assert together.returncode == 0, together.stderr
    alone, both = (load_combined(Path(each, "study.nc")) for each in ("alone", "both"))
    varying = ["wall_time", "newton_iterations"]
    assert alone.drop_vars(varying).equals(both.drop_vars(varying))
    assert Path("both/peak_to_peak_overall_transmission_error.png").is_file()


@pytest.mark.nightly
@pytest.mark.usefixtures("undrawn")
def test_studies_sweep_the_clocking_of_a_shaft(gearbox, capsys):
    """Two equal paths: turned back and ahead by the same angle, one has what the other has; a study has the shares."""
    Path("split.toml").write_text(split_text(of_shaft='clocking = "0 rad"'))
    sweep = 'scene = "split.toml"\n[sweep]\nshafts.path2.clocking = ["-2e-4 rad", "0 rad", "2e-4 rad"]\n'
    Path("study.toml").write_text(sweep)
    assert main(["study", "study.toml", "--quiet"]) == 0
    back, middle, ahead = load_combined(gearbox / "results/study/study.nc")["mean_path_share"].values
    assert middle == pytest.approx([0.5] * 4, abs=1e-9)
    assert ahead == pytest.approx(1.0 - back, rel=1e-3)
    assert ahead[[1, 3]] == pytest.approx(ahead[1], rel=1e-9)
    assert ahead[1] > 0.52
    Path("study.toml").write_text(sweep.replace("shafts.path2.clocking", "stages.in2.pinion.teeth"))
    assert main(["study", "study.toml", "--quiet"]) != 0
    assert "this is the gear in1.pinion of another stage" in capsys.readouterr().err


PINS = (
    'stages.set.carrier.pin_errors = { distribution = "normal", mean = "0 um", deviation = "10 um", count = 4,'
    " seed = 1, entries = 2 }"
)


@pytest.mark.usefixtures("undrawn")
@pytest.mark.parametrize("scene, sweep", [("set", PINS), ("pair", 'load.wheel_torque = ["90 N m", "100 N m"]')])
def test_numbers_alone_are_those_of_whole_runs(folder, capsys, scene, sweep):
    """Identity with a study that keeps whole runs: of a planetary set, whose cases are marched together, and of a pair.
    There are no files of cases, and what is kept is not computed again."""
    Path("set.toml").write_text(planetary_text(more='carrier.pin_errors = ["1 um", "0 um"]'))
    found = []
    for name, keep in (("whole", "runs"), ("alone", "numbers")):
        Path(f"{name}.toml").write_text(f'scene = "{scene}.toml"\nkeep = "{keep}"\n[sweep]\n{sweep}\n')
        assert main(["study", f"{name}.toml", "--quiet"]) == 0
        found.append(load_combined(folder / f"results/{name}/study.nc"))
    whole, alone = found
    numbers = ["load_sharing_factor", "largest_pin_force", "peak_to_peak_overall_transmission_error"]
    for number in numbers if scene == "set" else ["peak_to_peak_transmission_error", "max_normal_force"]:
        np.testing.assert_allclose(alone[number], whole[number], rtol=1e-12)
    assert not [*Path("results/alone/cases").glob("*.nc")]
    capsys.readouterr()
    assert main(["study", "alone.toml"]) == 0
    assert ", 0 to be computed" in capsys.readouterr().err


def test_what_a_study_keeps_is_named(folder):
    """Runs or numbers, nothing else."""
    Path("other.toml").write_text('scene = "pair.toml"\nkeep = "number"\n[sweep]\nfriction = ["absent", "present"]\n')
    with pytest.raises(SceneError, match='"numbers"'):
        load_study("other.toml")
