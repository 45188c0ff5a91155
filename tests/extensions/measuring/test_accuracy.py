"""`gears accuracy`: settings of a small scene refined, told, written and drawn."""

import csv
from dataclasses import replace

import numpy as np
import pytest
from tests.effects.examples import scene_of, text_of
from tests.helical import wide_pair

from fenics_gears import ComputationError, SceneError, model_of, simulate
from fenics_gears.commands.cli import main
from fenics_gears.extensions.measuring.accuracy import refinement, table
from fenics_gears.extensions.measuring.accuracy import report as reports
from fenics_gears.extensions.measuring.accuracy.refinement import (
    BODY,
    FAMILY,
    FLANK,
    LENGTH,
    NODES,
    QUICK_IN_THE_PLANE,
    STEPS,
)
from fenics_gears.extensions.measuring.accuracy.work_precision import work_precision
from fenics_gears.runs.settings import setting_runs
from fenics_gears.runs.settings.measures import CURVE, FACE_LOAD, MEAN, MEASURES, ROOT, SPAN, judged
from fenics_gears.runs.settings.setting import default_setting, half_width, own_setting
from fenics_gears.runs.timed import run_sharing
from fenics_gears.scene.accuracy import NODE_SPACING
from fenics_gears.scene.data import RIGID_TEETH, Accuracy, Motion

TEETH = "tooth_elasticity"
# Fewer and coarser than --quick: what is tested here is the way, not the numbers.
TINY = {
    FAMILY: (0.7, 1.4), FLANK: (0.7, 1.4), NODES: (1.4,), BODY: (4.0,), LENGTH: (1.0,), STEPS: (10, 20, 40),
}  # fmt: skip
TINY_FINE = {FLANK: 1.4, NODES: 1.4, BODY: 4.0, LENGTH: 1.0, STEPS: 20}
# What is run of them, one of each kind.
MEASURED = ("flank elements and contact nodes", "body element size", "steps per mesh cycle", "interpolation")
SETTINGS = Accuracy(
    element="P1", flank_element_size=0.25, contact_length=3.0, contact_nodes=13, steps_per_mesh_cycle=20
)


def coarse_default(scene):
    """The program's own setting but for flank elements and steps."""
    size = half_width(scene) / 1.4
    return replace(default_setting(scene), flank=size, spacing=NODE_SPACING * size, steps=20)


def measured(*arguments):
    return tuple(each for each in refinement.refinements(*arguments) if each.name in MEASURED)


@pytest.fixture(scope="module", autouse=True)
def tiny():
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(refinement, "QUICK_IN_THE_PLANE", replace(QUICK_IN_THE_PLANE, values=TINY, fine=TINY_FINE))
        patch.setattr(reports, "refinements", measured)
        for module in (refinement, reports):
            patch.setattr(module, "default_setting", coarse_default)
        yield


@pytest.fixture(scope="module")
def scene():
    return replace(scene_of(TEETH), accuracy=SETTINGS)


@pytest.fixture(scope="module")
def report(scene, tiny, tmp_path_factory):
    """Its study; the cache is left alone, so that condensing is timed."""
    cache = tmp_path_factory.mktemp("accuracy") / "cache"
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("FENICS_GEARS_CACHE", str(cache))
        found = reports.measure(scene, quick=True)
    assert not cache.exists()
    return found


def refined(report, name):
    return next(each for each in report.refinements if each.refinement.name == name)


def test_the_scenes_own_setting_is_the_scenes_own_run(report, scene):
    """Identity with `gears run`."""
    run = simulate(scene)
    reference = report.own.errors[SPAN]
    span = run.attrs["peak_to_peak_transmission_error"] * run.attrs["base_radius_wheel"]
    again = reports.answer(run, 3.0)
    assert again[SPAN][0] == pytest.approx(span) and reference > 0.0
    assert own_setting(scene).flank == model_of(scene).resolution.flank_element_size == SETTINGS.flank_element_size
    assert own_setting(scene).grid.nodes == SETTINGS.contact_nodes


def test_every_setting_of_the_issue_is_refined_with_the_others_fine(scene, report):
    """Each level differs from its base in its own fields alone."""
    every = refinement.refinements(scene, True)
    assert {each.name for each in every} == {
        *MEASURED, "flank element size", "contact node spacing", "contact length", "element", "elastic teeth",
    }  # fmt: skip
    assert [each.refinement.name for each in report.refinements] == [each.name for each in measured(scene, True)]
    for each in every:
        assert each.base == report.fine
        for level in each.levels:
            assert replace(level.setting, **{field: getattr(each.base, field) for field in each.fields}) == each.base


def test_cheaper_models_stand_beside_them(report):
    """Rigid teeth have no transmission error and no pressure: all is lost."""
    models = {each.name: each for each in report.models}
    assert set(models) == set(QUICK_IN_THE_PLANE.models)
    rigid = models[RIGID_TEETH]
    assert rigid.errors[SPAN] == pytest.approx(1.0, abs=1e-6) and np.isnan(rigid.errors["pressure"]) and not rigid.parts
    assert all(each not in report.front for each in report.models)


def test_root_stress_has_errors_and_orders(report):
    """Every level and whole setting has one, models without flanks in contact none, and it costs no time."""
    assert all(np.isfinite(each.errors[ROOT]) for result in report.refinements for each in result.levels)
    assert all(np.isfinite(each.errors[ROOT]) for each in report.settings) and all(
        np.isnan(each.errors[ROOT]) for each in report.models
    )
    body = refined(report, "body element size").levels
    assert max(each.errors[ROOT] for each in body) < 0.1
    assert "root stress" in table.headings(report)[0]


def test_condensing_anew_at_every_step_is_measured_from_condensing_once(scene, monkeypatch):
    """A model of its own, in one setting that both routes have; it limits no setting."""
    coarse = {FLANK: 1.4, NODES: 1.4, BODY: 4.0, STEPS: 4}
    monkeypatch.setattr(refinement, "REMESHED_FINE", coarse)
    assert [each.name for each in refinement.refinements(scene)][-1] == "condensation"
    study = reports.AccuracyStudy(scene, reports.SilentProgress(), True, 1)
    study.refinements = (refinement.condensation(scene),)
    (result,) = study.refine()
    anew, once = result.levels
    assert once.errors[CURVE] == once.errors[ROOT] == 0.0 and 0.0 < anew.errors[CURVE] < 0.2
    assert np.isnan(anew.errors[ROOT])
    assert all(
        (value == study.runs.answers[study.base][name]).all() for name, value in study.reference((result,))[0].items()
    )


def test_the_sentence_says_no_more_than_the_reference_can(report):
    """The reference's uncertainty; a target below it is not claimed."""
    said = table.in_one_sentence(replace(report, uncertainty=dict.fromkeys(MEASURES, 0.004)))
    assert "0.1 % cannot be assessed" in said and said.startswith("1 % in T_E")
    assert f"% is due to the {table.largest_part(report.own.parts)}." in said
    cheap = replace(report.settings[0], errors=dict.fromkeys(MEASURES, 1e-4), parts={"steps per mesh cycle": 2e-4})
    sure = replace(report, settings=(replace(report.own), cheap), uncertainty=dict.fromkeys(MEASURES, 1e-5))
    cost = table.seconds(cheap.times.total)
    sure_words = table.in_one_sentence(replace(sure, settings=(report.own, replace(cheap, name="cheap"))))
    assert f"0.1 % in T_E and T_EPP costs {cost} s (cheap)" in sure_words


@pytest.mark.parametrize(
    "changes, words",
    [
        ({"accuracy": Accuracy(model=RIGID_TEETH)}, "accuracy.model"),
        ({"accuracy": Accuracy(condensation="every step")}, 'Take "once"'),
    ],
)
def test_what_cannot_be_measured_is_refused_with_the_remedy(scene, changes, words):
    """House rule: no option is silently ignored."""
    with pytest.raises(SceneError, match=words):
        reports.measure(replace(scene, **changes))


def test_without_load_there_is_nothing_to_measure(scene):
    """What, and the remedy."""
    with pytest.raises(SceneError, match="wheel_torque is 0"):
        reports.measure(replace(scene, load=replace(scene.load, wheel_torque=0.0)))


def test_a_level_that_fails_is_told_and_the_others_are_measured(scene, monkeypatch):
    """House rule."""

    def fails(model, gears, progress):
        if model.scene.accuracy.interpolation == "collocated":
            raise ComputationError("no solution at step 3\nand a history")
        return run_sharing(model, gears, progress)

    monkeypatch.setattr(setting_runs, "run_sharing", fails)
    study = reports.AccuracyStudy(scene, reports.SilentProgress(), True, 1)
    study.refinements = tuple(each for each in study.refinements if each.name == "interpolation")
    (result,) = study.refine()
    assert [each.level.label for each in result.levels] == ["averaged"]
    assert study.failures == [("interpolation collocated", "no solution at step 3")]


def test_the_command_prints_and_writes_table_and_picture(report, tmp_path, monkeypatch, capsys):
    """Tables and the sentence on the terminal, DIR/accuracy.csv and DIR/accuracy.png."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(reports, "measure", lambda *arguments, **options: report)
    (tmp_path / "small.toml").write_text(text_of(TEETH))
    assert main(["accuracy", "small.toml", "--quick", "--output", "there"]) == 0
    output = capsys.readouterr().out
    assert sorted(file.name for file in (tmp_path / "there").iterdir()) == ["accuracy.csv", "accuracy.png"]
    assert (tmp_path / "there" / "accuracy.png").read_bytes().startswith(b"\x89PNG")
    assert "The scene's own settings have an error of" in output and "rigid teeth" in output
    with open(tmp_path / "there" / "accuracy.csv", newline="") as file:
        lines = list(csv.DictReader(file))
    assert {line["kind"] for line in lines} == {"single setting", "setting", "model", "reference"}
    own = next(line for line in lines if line["name"] == reports.OWN)
    assert float(own["total_error"]) >= float(own["judged_error"]) > 0.0
    assert float(own["time_s"]) == pytest.approx(
        sum(float(own[f"time_{stage}_s"]) for stage in ("mesh", "condense", "march"))
    )
    assert all(None not in line and None not in line.values() for line in lines)


def test_ctrl_c_ends_it_with_nothing_written(tmp_path, monkeypatch, capsys):
    """Exit code 130."""
    from fenics_gears.runs import one_run
    from fenics_gears.simulation.simulate import solved

    monkeypatch.chdir(tmp_path)

    def interrupted(scene, **options):
        result = solved(scene, **options)
        result.attrs["complete"] = 0
        return result

    monkeypatch.setattr(one_run, "solved", interrupted)
    (tmp_path / "small.toml").write_text(text_of(TEETH))
    assert main(["accuracy", "small.toml", "--quick", "--output", "there"]) == 130
    assert "Interrupted" in capsys.readouterr().err
    assert not (tmp_path / "there").exists()


@pytest.mark.parametrize("frequency, order", [(200.0, 2.0), (0.02, 1.0)])
def test_the_order_expected_of_steps_is_that_of_the_time_stepping(frequency, order):
    """Newmark, average acceleration h^2; backward Euler h; friction by the exact slip keeps them."""
    scene = replace(scene_of(TEETH, "inertia", "friction"), motion=Motion(frequency, 2, 1))
    steps = next(each for each in refinement.refinements(scene, quick=True) if each.name == STEPS)
    assert steps.expected == order


def test_settings_of_targets_and_numbers_over_the_face_are_drawn(report):
    """Definition: a target's settings are charged their distance alone; over the face there are curves of their own."""
    numbers = {MEAN: 0.01, FACE_LOAD: 0.02}
    own = replace(report.own, errors={**report.own.errors, **numbers})
    chosen = replace(own, name="target 5 %", parts={}, target=0.05)
    settings, models = (
        tuple(replace(each, errors={**each.errors, **numbers}) for each in results)
        for results in (report.settings, report.models)
    )
    told = replace(
        report,
        scene=wide_pair(),
        settings=settings,
        models=models,
        targets=(chosen,),
        uncertainty={**report.uncertainty, **numbers},
    )
    (row,) = [row for row in table.whole_rows(told) if row[0].startswith("target 5 %")]
    assert row[0] == "target 5 %" and row[-1] == "" and chosen.total_error == judged(chosen.errors)
    whole, single, _ = work_precision(told).axes
    assert "target 5 %" in [text.get_text() for text in whole.texts]
    labels = [line.get_label() for line in single.lines]
    assert {"peak-to-peak transmission error", "mean transmission error", "face load factor"} <= set(labels)
    assert len(work_precision(report).axes) == 2
