"""`gears optimize`: its search, what it keeps, resumes and refuses, and its files."""

import csv
import json
import signal
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from matplotlib.image import imread
from tests.programs import command, ended, python

from fenics_gears.commands.cli import main
from fenics_gears.errors import ComputationError, SceneError
from fenics_gears.extensions.optimization import optimize as optimization
from fenics_gears.extensions.optimization.charts import tolerance_rows, write_pictures
from fenics_gears.extensions.optimization.conditions import samples, scattered
from fenics_gears.extensions.optimization.design import QUANTILE, WORST, Bound, Goal, Loads, Tolerances
from fenics_gears.extensions.optimization.design_file import load_design
from fenics_gears.extensions.optimization.evaluations import Evaluation, Evaluator
from fenics_gears.extensions.optimization.expected import at_ends, expected_work
from fenics_gears.extensions.optimization.optimize import chosen, optimize
from fenics_gears.extensions.optimization.page import write_page
from fenics_gears.extensions.optimization.search import front
from fenics_gears.geometry.pair import gear_pair
from fenics_gears.results.files import read
from fenics_gears.runs import lines as run_lines
from fenics_gears.runs import one_run, runs
from fenics_gears.runs.simulate import simulate
from fenics_gears.runs.team import Alone
from fenics_gears.scene.read import build_scene, load_scene
from fenics_gears.simulation.simulate import solved
from fenics_gears.system.progress import Interruption, SilentProgress

ERROR = "peak_to_peak_transmission_error"
STILL = 'scene = "pair.toml"\nwithout = ["inertia", "damping", "motion", "friction", "shafts", "bearings"]\n'
VARIABLES = '[variables]\ntip_relief.depth = ["0 um", "60 um"]\ntip_relief.length_on_path = ["3 mm", "9 mm"]\n'
GOAL = f"[goals]\n{ERROR} = 1\n"
FEW = "[search]\nevaluations = 8\n"
FEWER = "[search]\nevaluations = 4\npopulation = 4\n"
# Rigid teeth, which are computed fastest, where only the way of the runs is tested.
RIGID = (
    'scene = "pair.toml"\nwithout = ["inertia", "damping", "motion", "friction", "shafts", "bearings",'
    ' "accuracy"]\n[set]\naccuracy = { model = "rigid teeth", steps_per_mesh_cycle = 20 }\n'
)
OVER_LOADS = '[loads]\nload.wheel_torque = ["300 N m", "437 N m"]\nweights = [1, 3]\n'
SCATTER = (
    '[tolerances]\ntolerance_class = 6\ntip_relief.depth = "4 um"\nsamples = 4\njudged = "quantile"\nquantile = 0.75\n'
)


def write(folder, text, name="design.toml"):
    path = Path(folder) / name
    path.write_text(text)
    return path


@pytest.fixture(autouse=True)
def few(monkeypatch):
    monkeypatch.setattr(optimization, "VALUES", 2)
    monkeypatch.setattr(optimization, "TORQUES", (1.0,))


@pytest.fixture
def unwritten(monkeypatch):
    """Pictures and page, which take longer than the runs, are not made."""
    monkeypatch.setattr("fenics_gears.extensions.optimization.charts.write_pictures", lambda outcome: [])
    monkeypatch.setattr("fenics_gears.extensions.optimization.page.write_page", lambda outcome: Path("none"))


def found(path, output=None):
    return optimize(path, output, SilentProgress(), quiet=True)


def lines(directory):
    """Whole lines of all processes."""
    return [
        json.loads(line)
        for file in sorted(Path(directory, "runs").glob("*.jsonl"))
        for line in file.read_text().splitlines()
        if line.startswith("{") and line.endswith("}")
    ]


@pytest.mark.usefixtures("unwritten")
def test_the_chosen_design_is_a_scene_that_gives_its_goal(folder):
    """Identity: a run of best.toml alone."""
    path = write(folder, STILL + VARIABLES + GOAL + FEW)
    assert main(["optimize", str(path), "--quiet"]) == 0
    scene = load_scene("results/design/best.toml")
    result, designs = simulate(scene), read("results/design/optimization.nc")
    best = designs.isel(design=int(designs["best"].values.argmax()))
    assert result.attrs[ERROR] * 1e3 * gear_pair(scene.gears).wheel.base_radius == pytest.approx(
        float(best[ERROR]), rel=1e-14
    )
    assert 1e3 * scene.tip_relief.pinion.depth == pytest.approx(float(best["tip_relief.depth"]), rel=1e-12)
    assert float(best[ERROR]) == float(designs[ERROR].min())
    with open("results/design/designs.csv") as file:
        rows = list(csv.DictReader(file))
    assert [float(row[f"{ERROR} (um)"]) for row in rows] == designs[ERROR].values.tolist()
    quasi_static = designs["transmission_error"].sel(choice="best", load=437.0)
    assert (
        0.9 * result.attrs[ERROR] < np.ptp(quasi_static.values) <= result.attrs[ERROR]
    )  # the peaks may lie between steps


def test_goals_over_loads_and_tolerances_are_those_of_single_runs(folder):
    """Numpy on runs of each scene alone: weighted mean over loads, quantile over samples."""
    design = load_design(write(folder, STILL + VARIABLES + OVER_LOADS + GOAL + SCATTER + FEW))
    deviations, values = samples(design), {"tip_relief.depth": 25.0, "tip_relief.length_on_path": 6.0}
    assert deviations.shape == (4, 5)
    with Interruption(SilentProgress()) as interruption:
        (folder / "runs").mkdir()
        (evaluation,) = Evaluator(design, folder / "runs", Alone(), interruption).of_designs([values], deviations)
    alone = []
    for torque in (300.0, 437.0):
        tree = design.scene_tree(values)
        tree["load"] = {"wheel_torque": f"{torque} N m"}
        for each in deviations:
            scene = build_scene(scattered(tree, design.tolerances.scatters, each))
            alone.append(simulate(scene).attrs[ERROR] * 1e3 * gear_pair(scene.gears).wheel.base_radius)
    of_samples = np.average(np.reshape(alone, (2, 4)), axis=0, weights=[1, 3])
    assert evaluation.of_samples[ERROR] == pytest.approx(of_samples, rel=1e-12)
    assert evaluation.goals[ERROR] == pytest.approx(np.quantile(of_samples, 0.75), rel=1e-12)


def test_operating_points_statistics_and_bounds():
    """Definitions, by hand."""
    values = np.array([[1.0, 4.0], [3.0, 2.0]])
    assert Loads(({}, {}), (1.0, 3.0)).combined(values).tolist() == [2.5, 2.5]
    assert Loads(({}, {}), (1.0, 1.0), WORST).combined(values).tolist() == [3.0, 4.0]
    assert Tolerances((), 4, 0.75, QUANTILE).statistic(np.array([4.0, 1.0, 2.0, 3.0])) == 3.25
    bound = Bound(Goal(ERROR, "um", ""), at_least=2.0, at_most=10.0)
    assert [bound.violation(value) for value in (1.0, 2.0, 10.0, 15.0)] == [0.5, 0.0, 0.0, 0.5]


def test_the_front_is_that_of_every_pair_compared():
    """By hand; no design that breaks a bound or failed, and none twice."""
    goals = [(1.0, 5.0), (2.0, 2.0), (2.0, 3.0), (5.0, 1.0), (0.5, 0.5), (0.1, 9.0), (2.0, 2.0)]
    tried = [
        Evaluation(
            {"x": min(place, 5) if place != 6 else 1}, {"a": one, "b": other}, violation=1.0 if place == 4 else 0.0
        )
        for place, (one, other) in enumerate(goals)
    ]
    tried.append(Evaluation({"x": 9}, failure="broke"))
    assert front(tried, ["a", "b"]) == [0, 1, 3, 5]


@pytest.mark.nightly
@pytest.mark.usefixtures("unwritten")
def test_a_killed_search_repeats_nothing(folder):
    """The search that was not stopped; each run is there once."""
    path = write(folder, RIGID + VARIABLES + GOAL + FEW)
    whole = found(path, folder / "whole")
    call = (
        "-m",
        "tests.extensions.optimization.stopped_optimization",
        6,
        "optimize",
        path,
        "--output",
        folder / "killed",
        "--quiet",
    )
    python(*call, ends=-signal.SIGKILL)
    assert len(run_lines.kept(folder / "killed" / "runs")[0]) == 5
    resumed = found(path, folder / "killed")
    assert (resumed.kept, resumed.spent.computed) == (5, whole.spent.computed - 5)
    keys = [line["key"] for line in lines(folder / "killed")]
    assert len(keys) == len({*keys}) == whole.spent.computed
    assert [(each.values, each.goals) for each in resumed.tried] == [(each.values, each.goals) for each in whole.tried]
    again = found(path, folder / "killed")
    assert (again.kept, again.spent.computed, again.best) == (whole.spent.computed, 0, whole.best)


@pytest.mark.nightly
@pytest.mark.ranks
def test_any_number_of_processes_gives_the_same_result(folder):
    """Exact identity with one process."""
    path = write(folder, RIGID + VARIABLES + GOAL + FEWER)
    alone = found(path, folder / "alone")
    ended(command("optimize", path, "--output", folder / "two", ranks=2), folder, ends=0)
    designs = read(folder / "two" / "optimization.nc")
    assert designs[ERROR].values.tolist() == [each.goals[ERROR] for each in alone.tried]
    keys = [line["key"] for line in lines(folder / "two")]
    assert len(keys) == len({*keys}) and {*run_lines.kept(folder / "alone" / "runs")[0]} <= {*keys}


def test_page_and_pictures_show_what_was_found(folder):
    """The chosen scene run alone with its relief's depth at either limit; pictures have more than their ground."""
    text = RIGID + VARIABLES + GOAL + "max_normal_force = 1\n" + SCATTER + FEWER
    outcome = found(write(folder, text))
    design, chosen_tree = outcome.design, outcome.design.scene_tree(outcome.chosen.values)
    rows = {row[0]: row[1:] for row in tolerance_rows(outcome, design.goals[0])}
    place = [scatter.name for scatter in design.tolerances.scatters].index("tip_relief.depth")
    numbers = []
    for deviation in np.outer([-1.0, 0.0, 1.0], np.eye(5)[place]):
        scene = build_scene(scattered(chosen_tree, design.tolerances.scatters, deviation))
        numbers.append(f"{simulate(scene).attrs[ERROR] * 1e3 * gear_pair(scene.gears).wheel.base_radius:.4g}")
    assert rows["tip relief depth"] == ("± 4 um", *numbers)
    page = write_page(outcome).read_text()
    assert all(f">{number}<" in page for number in numbers)
    assert f"The {len(outcome.front)} designs of the Pareto front" in page
    pictures = {file.stem: imread(file) for file in write_pictures(outcome)}
    assert set(pictures) == {"search", "pareto_front", "variables", "harris_map"}
    assert all(np.mean(picture[..., :3].min(axis=2) < 0.9) > 0.005 for picture in pictures.values())


def test_the_number_of_runs_and_their_time_are_said_before_they_start(folder, monkeypatch, capsys, unwritten):
    """Brute force: the runs that are computed. More time than is allowed is refused unless agreed to; what is kept
    is not counted."""
    monkeypatch.setattr("fenics_gears.extensions.optimization.expected.VALUES", 2)
    monkeypatch.setattr("fenics_gears.extensions.optimization.expected.TORQUES", (1.0,))
    path = write(folder, RIGID + VARIABLES + GOAL + OVER_LOADS + FEWER)
    work = expected_work(load_design(path), 0)
    monkeypatch.setattr("fenics_gears.extensions.optimization.expected.MOST_HOURS", 0.5 * work.seconds / 3600.0)
    with pytest.raises(SceneError, match=rf"up to {work.runs} runs, about .* on an idle machine. Allowed.*--yes"):
        found(path, folder / "here")
    assert not list((folder / "here" / "runs").iterdir())
    assert main(["optimize", str(path), "--output", str(folder / "here"), "--yes"]) == 0
    computed = len(run_lines.kept(folder / "here" / "runs")[0])
    assert f"up to {work.runs} runs, about" in capsys.readouterr().err and 0.8 * work.runs <= computed <= work.runs
    assert expected_work(load_design(path), computed).runs == work.runs - computed


def test_time_of_runs_that_are_solved_together_is_less_than_of_single_ones(folder):
    """docs/optimize.md: quasi-static plane runs are solved together, but not for a number that only whole results
    have."""
    design = load_design(write(folder, STILL + VARIABLES + GOAL + FEW))
    models = [case.model for end in at_ends(design) for case in end]
    alone = replace(design, goals=(replace(design.goals[0], name="peak_to_peak_force"),))
    assert runs.solved_at_once(models, design.asked) and not runs.solved_at_once(models, alone.asked)
    one, two, single = (expected_work(*each) for each in ((design, 0), (design, 0, 2), (alone, 0)))
    assert one.runs == two.runs == single.runs
    assert one.seconds < two.seconds < single.seconds


def test_runs_that_fail_are_kept_as_failed(folder, monkeypatch):
    """docs/optimize.md: no numbers and the reason, not chosen, not tried again."""

    def failing(model, **arguments):
        relief = model.scene.tip_relief
        if relief is not None and relief.pinion.depth > 0.025:
            raise ComputationError("deep reliefs fail here")
        return solved(model, **arguments)

    def failing_together(models, *_):
        raise ComputationError("what fails together is computed run by run")

    monkeypatch.setattr(one_run, "solved", failing)
    monkeypatch.setattr(runs, "solved_together", failing_together)
    path = write(folder, STILL + VARIABLES + GOAL + FEW)
    outcome = found(path)
    failed = [each for each in outcome.tried if each.failure]
    assert failed and len(failed) < len(outcome.tried)
    assert all(each.failure == "deep reliefs fail here" and not each.goals for each in failed)
    assert outcome.chosen.values["tip_relief.depth"] <= 25.0 and not outcome.chosen.failure
    monkeypatch.setattr(one_run, "solved", None)
    again = found(path)
    assert again.spent.computed == 0 and [each.failure for each in again.tried] == [
        each.failure for each in outcome.tried
    ]


@pytest.mark.nightly
def test_bounds_are_kept_and_refused_where_nothing_keeps_them(folder):
    """The best of what the constraint allows, and an error in words where it allows nothing."""
    text = STILL + VARIABLES + GOAL + FEW + '[constraints]\ntransmission_error_harmonic_2 = {{ at_most = "{} um" }}\n'
    reached = [
        each.at_points["transmission_error_harmonic_2"][0]
        for each in found(write(folder, text.format(1e6)), folder / "wide").tried
    ]
    outcome = found(write(folder, text.format(float(np.mean(reached)))), folder / "half")
    assert outcome.chosen.allowed and outcome.chosen.at_points["transmission_error_harmonic_2"][0] <= np.mean(reached)
    assert any(each.violation > 0.0 for each in outcome.tried)
    with pytest.raises(ComputationError, match="None of 8 designs keeps the constraints"):
        found(write(folder, text.format(1e-6)), folder / "none")


def test_several_goals_give_a_front_and_weights_choose_from_it(folder):
    """Definition: the least weighted sum of goals in parts of those before, on the front."""
    outcome = found(write(folder, STILL + VARIABLES + GOAL + "peak_contact_pressure = 2\n" + FEW))
    assert outcome.best in outcome.front

    def summed(each):
        return sum(
            weight * each.goals[name] / outcome.before.goals[name]
            for name, weight in ((ERROR, 1.0), ("peak_contact_pressure", 2.0))
        )

    assert summed(outcome.chosen) == min(map(summed, outcome.tried))
    limited = replace(outcome.design, bounds=(Bound(outcome.design.goals[1], at_most=10.0),))
    with pytest.raises(ComputationError, match=r"peak_contact_pressure is \d+(\.\d+)? MPa, at most 10 allowed"):
        chosen(limited, outcome.before, [replace(each, violation=1.0) for each in outcome.tried])
    only = [replace(outcome.tried[0], violation=1.0)]
    with pytest.raises(ComputationError, match="the nearest one breaks the bounds by 1"):
        chosen(outcome.design, outcome.before, only)


REFUSED = {
    "an unknown field": (
        '[variables]\ntip_relief.dept = ["1 um", "2 um"]\n' + GOAL,
        'variables.tip_relief.dept = a list\n    is no section or field of a scene. Did you mean "tip_relief.depth"?',
    ),
    "ends the wrong way round": (
        '[variables]\ntip_relief.depth = ["60 um", "2 um"]\n' + GOAL,
        "Allowed: two ends, the lower one first.",
    ),
    "more than two ends": (
        '[variables]\ntip_relief.depth = ["2 um", "20 um", "60 um"]\n' + GOAL,
        "has 3 values. Allowed: two ends, the lower one first.",
    ),
    "an end that the field does not allow": (
        "[variables]\ntip_relief.exponent = [1, 30]\n" + GOAL,
        "goes from 1 to 30. Allowed for this field: a number from 1 up to 10",
    ),
    "another kind": ('[variables]\ntip_relief.depth = ["1 N", "2 N"]\n' + GOAL, "is a force, not a length"),
    "a range without units": (
        "[variables]\ntip_relief.depth = [1, 2]\n" + GOAL,
        "is not of this field. Allowed: a length",
    ),
    "a section": (
        '[variables]\nfriction = ["absent", "present"]\n' + GOAL,
        "variables.friction = a list\n    is a section.",
    ),
    "an end that no flank has": (
        '[variables]\ntip_relief.length_on_path = ["3 mm", "30 mm"]\n[set]\ntip_relief.depth = "20 um"\n' + GOAL,
        "its involute runs from",
    ),
    "an unknown goal": (VARIABLES + "[goals]\npeak_to_peak_transmission_eror = 1\n", f'Did you mean "{ERROR}"?'),
    "a goal that the scene cannot give": (
        VARIABLES + "[goals]\ndynamic_factor_by_force = 1\n",
        "goals.dynamic_factor_by_force]\n    is no result of this scene. It needs [inertia].",
    ),
    "a goal without friction": (VARIABLES + "[goals]\nfriction_loss = 1\n", "It needs [friction]."),
    "a goal over the face": (
        VARIABLES + "[goals]\nface_load_factor = 1\n",
        "It needs flanks that are resolved over the face",
    ),
    "a weight": (VARIABLES + f"[goals]\n{ERROR} = 0\n", "is not a weight. Allowed: a number above 0"),
    "a bound of another kind": (
        VARIABLES + GOAL + '[constraints]\npeak_contact_pressure = { at_most = "3 mm" }\n',
        'is no limit of a number in MPa. Allowed: { at_most = "20 MPa" }',
    ),
    "a scatter of nothing": (
        VARIABLES + GOAL + "[tolerances]\nfriction.coefficient = 0.02\n",
        "is not in the scene, so that it cannot scatter",
    ),
    "a scatter of no width": (VARIABLES + GOAL + '[tolerances]\ntip_relief.depth = "0 um"\n', "is not above zero"),
    "samples": (VARIABLES + GOAL + "[tolerances]\ntolerance_class = 6\nsamples = 12\n", "is no power of two"),
    "operating points of different number": (
        VARIABLES + GOAL + '[loads]\nload.wheel_torque = ["1 N m", "2 N m"]\nweights = [1]\n',
        "is not a list of 2 numbers",
    ),
    "a speed without inertia": (
        VARIABLES + GOAL + '[loads]\nmotion.mesh_frequency = ["10 Hz", "20 Hz"]\n',
        "has no effect on a scene without [inertia]",
    ),
    "an unknown word of the search": (VARIABLES + GOAL + "[search]\nevaluation = 3\n", 'Did you mean "evaluations"?'),
    "no variables": (GOAL, "variables\n    is missing. Add the section [variables]"),
}


@pytest.mark.parametrize("what", REFUSED)
def test_what_no_design_could_have_is_refused_by_name(folder, what):
    """docs/optimize.md; nothing is computed or written."""
    text, words = REFUSED[what]
    with pytest.raises(SceneError) as refusal:
        load_design(write(folder, STILL + text))
    assert words in str(refusal.value) and "Nothing was computed or written" in str(refusal.value)


def test_a_missing_optimiser_is_said_before_anything_is_computed(folder, monkeypatch):
    """The words themselves; no run is there."""
    monkeypatch.setitem(sys.modules, "optuna", None)
    with pytest.raises(ComputationError, match="needs Optuna and cmaes"):
        found(write(folder, RIGID + VARIABLES + GOAL + FEWER))
    assert not (folder / "results").exists()
