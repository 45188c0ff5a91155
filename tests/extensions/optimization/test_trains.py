"""`gears optimize` of trains."""

from pathlib import Path

import numpy as np
import pytest
from tests.planets import planetary_text
from tests.trains import COARSE, stage

from fenics_gears import load_scene, overall_orders, simulate_train, train_from_text
from fenics_gears.commands.cli import main
from fenics_gears.errors import SceneError
from fenics_gears.extensions.optimization.conditions import samples
from fenics_gears.extensions.optimization.design_file import load_design
from fenics_gears.extensions.optimization.evaluations import Evaluator
from fenics_gears.extensions.optimization.expected import expected_work
from fenics_gears.extensions.optimization.goals import lacking, unit_and_words, weighted_orders
from fenics_gears.results.files import read
from fenics_gears.runs.team import Alone
from fenics_gears.scene.train import load_train
from fenics_gears.system.progress import Interruption, SilentProgress

RELIEF = 'tip_relief = { depth = "10 um", start = "HPSTC" }'
OVERALL_ERROR = "peak_to_peak_overall_transmission_error"
DESIGN = f"""
scene = "gearbox.toml"
[variables]
stages.first.tip_relief.depth = ["2 um", "20 um"]
stages.second.pinion.profile_shift = [0, 0.2]
[goals]
{OVERALL_ERROR} = 1
[constraints]
peak_contact_pressure = {{ at_most = "1e5 MPa" }}
peak_to_peak_transmission_error = {{ at_most = "1 mm" }}
[search]
evaluations = 4
population = 4
"""
VALUES = {"stages.first.tip_relief.depth": 5.0, "stages.second.pinion.profile_shift": 0.2}


@pytest.fixture
def gearbox(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    stages = stage("first", 2.0, (20, 30), RELIEF) + stage("second", 3.0, (20, 40))
    text = f'{stages}\n[load]\noutput_torque = "400 N m"\n[accuracy]\n{COARSE}\n'
    Path("gearbox.toml").write_text(text)
    Path("design.toml").write_text(DESIGN)
    return text


def test_orders_that_a_run_does_not_tell_apart_are_no_goal(gearbox, tmp_path):
    """Of stages that move together for one cycle: said of the design; its other goals are there."""
    twist = '[shafts.one]\ncarries = ["first.wheel", "second.pinion"]\ntorsional_stiffness = "1e8 N mm/rad"\n'
    Path("gearbox.toml").write_text(gearbox + twist)
    goal = "weighted_orders = 1\n[orders]\nfirst = [1]\n"
    for text in (DESIGN, DESIGN.replace(f"{OVERALL_ERROR} = 1\n", goal)):
        Path("design.toml").write_text(text)
        design = load_design(Path("design.toml"))
        with Interruption(SilentProgress()) as progress:
            (tmp_path / "runs").mkdir(exist_ok=True)
            (found,) = Evaluator(design, tmp_path / "runs", Alone(), progress).of_designs([VALUES], samples(design))
        assert ("Allowed: 2 or more, by motion.mesh_cycles" in found.failure) == ("orders" in text)
        assert bool(found.goals) == ("orders" not in text)


def test_a_design_is_judged_by_the_run_of_its_train(gearbox, tmp_path):
    """The overall error in urad of the last shaft; of what each mesh has, the largest, errors on the wheel's base
    circle."""
    design = load_design(Path("design.toml"))
    with Interruption(SilentProgress()) as progress:
        (tmp_path / "runs").mkdir()
        evaluator = Evaluator(design, tmp_path / "runs", Alone(), progress)
        (found,) = evaluator.of_designs([VALUES], samples(design))
    changed = gearbox.replace('"10 um"', '"5 um"')
    before, second = changed.split("[stages.second]")
    alone = simulate_train(train_from_text(f"{before}[stages.second]{second.replace('0.1', '0.2', 1)}"))
    assert found.goals[OVERALL_ERROR] == pytest.approx(1e6 * alone.attrs[OVERALL_ERROR], rel=1e-12)
    largest = float((alone["peak_to_peak_transmission_error"] * alone["base_radius_wheel"]).max()) * 1e3
    assert found.at_points["peak_to_peak_transmission_error"] == pytest.approx([largest], rel=1e-12)
    assert found.at_points["peak_contact_pressure"] == pytest.approx([float(alone["peak_contact_pressure"].max())])
    assert expected_work(design, 0).seconds > 0.0


def test_orders_are_summed_by_their_weights(gearbox, tmp_path):
    """2 of the first and 0.5 of the third harmonic of the second stage, and the first of the first, in the lag of the
    last shaft, urad."""
    goal = "weighted_orders = 1\n[orders]\nfirst = [1]\nsecond = [2, 0, 0.5]\n"
    Path("design.toml").write_text(DESIGN.replace(f"{OVERALL_ERROR} = 1\n", goal))
    design = load_design(Path("design.toml"))
    with Interruption(SilentProgress()) as progress:
        (tmp_path / "runs").mkdir()
        evaluator = Evaluator(design, tmp_path / "runs", Alone(), progress)
        (found,) = evaluator.of_designs([VALUES | {"stages.second.pinion.profile_shift": 0.1}], samples(design))
    train = train_from_text(gearbox.replace('"10 um"', '"5 um"'))
    orders = {(each.meshes, each.harmonic): each.amplitude for each in overall_orders(simulate_train(train), train)}
    expected = orders["first", 1] + 2.0 * orders["second", 1] + 0.5 * orders["second", 3]
    assert found.goals["weighted_orders"] == pytest.approx(1e6 * expected, rel=1e-9)
    assert design.goals[0].unit == "urad"


def test_orders_of_a_pair_are_summed_by_their_weights():
    """Of the harmonics that a pair's run has, um along the line of action; what a run lacks gives nothing."""
    numbers = {"transmission_error_harmonic_1": 3.0, "transmission_error_harmonic_2": 0.5}
    assert weighted_orders({"mesh": (1.0, 4.0)}, numbers) == 5.0
    assert weighted_orders({"mesh": (1.0, 4.0, 1.0)}, numbers) is None


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (DESIGN.replace(OVERALL_ERROR, "weighted_orders"), "is missing, which weighted_orders needs"),
        (DESIGN + "[orders]\nfirst = [1]\n", "belong to the goal weighted_orders"),
        (DESIGN.replace(OVERALL_ERROR, "weighted_orders") + "[orders]\nfrist = [1]\n", "is no mesh"),
        (DESIGN.replace(OVERALL_ERROR, "weighted_orders") + "[orders]\nfirst = [-1]\n", "is no list of weights"),
        (DESIGN.replace("gearbox.toml", "pair.toml").replace("stages.first.", ""), "needs a train of gears"),
        (DESIGN.replace("peak_contact_pressure", "friction_loss").replace("1e5 MPa", "1"), "[friction]"),
        (DESIGN + "[tolerances]\ntolerance_class = 6\n", "Allowed in a train: fields of its stages"),
        (DESIGN.replace("[0, 0.2]", "[0, 9]"), "goes from 0 to 9"),
    ],
)
def test_what_no_train_has_is_refused(gearbox, text, said):
    """Before anything is computed."""
    from tests.paper_text import coarse_text

    Path("pair.toml").write_text(coarse_text() + f"\n[{RELIEF.split()[0]}]\ndepth = '10 um'\nstart = 'HPSTC'\n")
    text = text.replace("stages.second.pinion", "gears.pinion") if "pair.toml" in text else text
    Path("design.toml").write_text(text.replace('{ at_most = "1" }', "{ at_most = 1 }"))
    with pytest.raises(SceneError) as refused:
        load_design(Path("design.toml"))
    assert said in str(refused.value)


@pytest.mark.nightly
def test_a_search_ends_with_a_train(gearbox):
    """The chosen train is one that `gears run` takes and that has the numbers which the search names."""
    assert main(["optimize", "design.toml", "-q"]) == 0
    found = read("results/design/optimization.nc")
    best = int(np.flatnonzero(found["best"].values)[0])
    alone = simulate_train(load_train("results/design/best.toml"))
    assert 1e6 * alone.attrs[OVERALL_ERROR] == pytest.approx(float(found[OVERALL_ERROR][best]), rel=1e-9)
    assert Path("results/design/harris_map.png").is_file()
    with pytest.raises(SceneError, match="is a train"):
        load_scene("results/design/best.toml")


def test_load_sharing_is_a_goal_of_planetary_sets():
    """K_gamma is a number of a set, alone or beside other stages; of other trains and of pairs it is refused."""
    of_set = train_from_text(planetary_text())
    assert lacking("load_sharing_factor", of_set) == ""
    assert unit_and_words("load_sharing_factor")[1] == "K_gamma of the sun's meshes"
    pair = train_from_text(stage("first", 2.0, (20, 30)) + '[load]\noutput_torque = "400 N m"\n')
    for scene in (pair, pair.meshes[0].scene):
        assert lacking("load_sharing_factor", scene) == 'a planetary set, kind = "planetary"'
