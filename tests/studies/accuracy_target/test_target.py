"""`[accuracy] target` on a real scene."""

import re
from dataclasses import replace

import numpy as np
import pytest
from tests.benchmarks.target_pairs import pairs
from tests.paper_text import coarse_text

from fenics_gears import SceneError, scene_from_text, simulate
from fenics_gears.commands.cli import main
from fenics_gears.effects.friction import Friction
from fenics_gears.results.validity import WINDOW_REACHED
from fenics_gears.runs.settings import setting_runs
from fenics_gears.runs.settings.measures import FACE_LOAD, JUDGED, SPAN, distance, judged_answer
from fenics_gears.runs.settings.target import choose
from fenics_gears.runs.settings.trial_runs import MESH, STEPS, Sizes, TargetNotReached, TrialRuns
from fenics_gears.runs.timed import run_sharing
from fenics_gears.scene.data import Accuracy
from fenics_gears.system.memory import MEMORY_VARIABLE
from fenics_gears.system.progress import SilentProgress

TARGET = 0.1


@pytest.fixture(scope="module")
def text():
    effects = ("shafts", "bearings", "inertia", "damping", "friction")
    return coarse_text(*effects, cycles=1, recorded=1, accuracy='[accuracy]\ntarget = "10 %"\n')


@pytest.fixture(scope="module")
def scene(text):
    return scene_from_text(text)


@pytest.fixture(scope="module", autouse=True)
def runs_once():
    made = {}

    def once(model, gears, progress):
        if model.scene not in made:
            made[model.scene] = run_sharing(model, gears, progress)
        return made[model.scene]

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(setting_runs, "run_sharing", once)
        yield once


@pytest.fixture(scope="module")
def run(scene):
    return simulate(scene)


def test_the_true_error_is_within_the_target(scene, run):
    """A mesh three times and steps twice as fine."""
    runs = TrialRuns(scene, lambda words: None)
    mesh = run.attrs["flank_element_size"] / runs.setting(Sizes(1.0, 40)).flank
    fine = runs.setting(Sizes(mesh / 3.0, 2 * run.attrs["steps_per_mesh_cycle"]))
    found, reference = (judged_answer(each) for each in (run, simulate(fine.of(replace(scene, accuracy=Accuracy())))))
    assert (
        max(distance(found, reference, name) for name in JUDGED)
        <= run.attrs["estimated_error"]
        <= TARGET
        == run.attrs["target"]
    )


def test_the_scene_that_the_result_carries_repeats_it(run):
    """Identity, to the last bit; nothing is measured again."""
    again = scene_from_text(run.attrs["scene"])
    assert again.accuracy.target is None and again.accuracy.flank_element_size == run.attrs["flank_element_size"]
    assert np.array_equal(simulate(again).transmission_error.values, run.transmission_error.values)


def test_only_steps_with_a_past_have_an_error(scene):
    """Identity: without friction half the steps give the same values; with it one more run measures by how much not."""
    runs, sizes = TrialRuns(scene, lambda words: None), Sizes(2.5, 40)
    assert set(runs.errors(sizes)) == {MESH} and runs.runs == 2
    rubbing = TrialRuns(replace(scene, friction=Friction(0.1)), lambda words: None)
    errors = rubbing.errors(sizes)
    assert set(errors) == {MESH, STEPS} and rubbing.runs == 3 and errors[STEPS] > 0.0


def test_finer_settings_are_expected_to_cost_more(scene):
    """Count of operations: half the element size has more unknowns, twice the steps are more."""
    runs, sizes = TrialRuns(scene, lambda words: None), Sizes(1.0, 80)
    assert min(runs.cost(Sizes(0.5, 80)), runs.cost(Sizes(1.0, 160))) > runs.cost(sizes)


def test_a_window_that_cuts_contact_off_is_lengthened(scene):
    """The program's own warning decides."""
    runs, sizes = TrialRuns(scene, lambda words: None), Sizes(2.5, 40)
    whole = runs.setting(sizes).length
    runs._default = replace(runs._default, length=0.13 * whole)
    runs.errors(sizes)
    assert runs.setting(sizes).length > 0.13 * whole
    assert WINDOW_REACHED not in simulate(runs.setting(sizes).of(scene)).attrs["warnings"]


@pytest.mark.parametrize(("finer", "coarser"), [({}, {FACE_LOAD: 2.0}), ({FACE_LOAD: 0.0}, {FACE_LOAD: 2.0})])
def test_what_two_runs_do_not_both_have_is_not_judged(scene, monkeypatch, finer, coarser):
    """Nothing is known of the error of a number that one run lacks, or of which nothing is left: no settings are
    chosen by it."""
    answers = {1.0: finer, 2.0: coarser}
    runs, same = TrialRuns(scene, lambda words: None), {SPAN: np.ones(1)}
    with_span = {
        mesh: same | {name: np.array([each]) for name, each in found.items()} for mesh, found in answers.items()
    }
    monkeypatch.setattr(runs, "_answered", lambda sizes: (with_span[sizes.mesh],))
    with pytest.raises(TargetNotReached, match="do not both have the face load factor: .* Raise the load"):
        runs._error(Sizes(1.0, 40), Sizes(2.0, 40))


def test_what_memory_does_not_hold_is_refused_by_name(scene, monkeypatch):
    """With little memory; the target named instead is reached by the same runs."""
    monkeypatch.setenv(MEMORY_VARIABLE, "360 MB")
    with pytest.raises(
        TargetNotReached,
        match=r"accuracy.target = 0.1 %.*P2 .* would take [\d.]+ GB of memory, and 0.36 GB are .*; [\d.]+ % can be",
    ) as failure:
        choose(scene, 0.001, SilentProgress())
    assert failure.value.exit_code == 3
    reachable = 0.01 * float(re.search(r"; ([\d.]+) % can be", str(failure.value))[1])
    assert 0.001 < choose(scene, 1.1 * reachable, SilentProgress()).estimated_error <= 1.1 * reachable


def test_choosing_can_be_interrupted_within_a_run(scene, monkeypatch):
    """Ctrl-C within the first run, not at its end."""

    class Interrupted(SilentProgress):
        said = 0

        def update(self, done, total, note=""):
            self.said += 1
            if self.said == 2:
                raise KeyboardInterrupt

    monkeypatch.setattr(setting_runs, "run_sharing", run_sharing)
    progress = Interrupted()
    with pytest.raises(KeyboardInterrupt):
        choose(scene, TARGET, progress)
    assert progress.said == 2


@pytest.mark.parametrize("line, reason", [
    ('element = "P1"', "is chosen by accuracy.target"), ("contact_nodes = 20", "is chosen by accuracy.target"),
    ('model = "rigid teeth"',
     "cannot be combined with accuracy.target, which is for the full contact of elastic teeth"),
    ('condensation = "once"', "cannot be combined with accuracy.target, which condenses once"),
])  # fmt: skip
def test_a_setting_beside_a_target_is_refused(text, line, reason):
    """Two answers to one question."""
    with pytest.raises(SceneError) as failure:
        scene_from_text(text + line + "\n")
    assert f"accuracy.{line}\n    {reason}. Leave one of the two out." in str(failure.value)


@pytest.mark.parametrize("written, reason", [
    ("1", 'is a number without its unit. In % it is written "1 %"'),
    ('"1"', "is a number without unit, not a percentage"), ('"1 mm"', "is a length, not a percentage"),
    ('"0 %"', "is zero"), ('"0.01 %"', "is too small"),
    ('"1e999 %"', "is not a finite number"),
])  # fmt: skip
def test_a_wrong_percentage_says_what_is_wrong(text, written, reason):
    """Wording."""
    with pytest.raises(SceneError) as failure:
        scene_from_text(text.replace('"10 %"', written))
    assert reason in str(failure.value) and "Allowed: a percentage from 0.05 % to 50 %" in str(failure.value)


def test_no_load_and_rigid_teeth_have_no_target(text):
    """Nothing gives way there."""
    with pytest.raises(SceneError, match="has no meaning without a load"):
        scene_from_text(text.replace('"437 N m"', '"0 N m"'))
    rigid = text.partition("[gears.material]")
    with pytest.raises(SceneError, match="needs elastic teeth"):
        scene_from_text(rigid[0] + "[load]" + rigid[2].partition("[load]")[2])


def test_check_says_that_settings_are_chosen_by_the_run(text, tmp_path, capsys):
    """`gears check` computes nothing."""
    (tmp_path / "scene.toml").write_text(text)
    assert main(["check", str(tmp_path / "scene.toml")]) == 0
    assert "10.000%: a run chooses settings" in capsys.readouterr().out


@pytest.mark.nightly
def test_steps_that_barely_follow_a_vibration_keep_the_target(paper_scene):
    """A pair whose errors fall by order 1, with four times the steps and half the mesh; targets of 4.3 to 4.7 % were
    missed."""
    name = "20/80, shifts 0.22 and 0.23, 60 N/mm, sharp tips, friction 0.05, 200 Hz"
    scene, target = pairs(paper_scene)[name], 0.044
    setting = choose(scene, target, SilentProgress()).setting
    finer = replace(
        setting, flank=0.5 * setting.flank, spacing=0.5 * setting.spacing, body=0.5 * setting.body,
        steps=4 * setting.steps,
    )  # fmt: skip
    found, reference = (judged_answer(simulate(each.of(scene))) for each in (setting, finer))
    assert max(distance(found, reference, measure) for measure in JUDGED) < target
