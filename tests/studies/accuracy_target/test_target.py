"""`[accuracy] target` on a real scene: what is chosen reaches it, is told, and repeats; what cannot be reached is refused."""

import contextlib
import re
import time
from dataclasses import replace

import numpy as np
import pytest
from tests.coarse import teeth_alone

from fenics_gears.commands.cli import main
from fenics_gears.effects.friction import Friction
from fenics_gears.errors import SceneError
from fenics_gears.model.cost import expected_cost
from fenics_gears.model.model import model_of
from fenics_gears.model.resolution import NODE_SPACING
from fenics_gears.results.summary import summary_rows
from fenics_gears.scene.data import Accuracy, Motion
from fenics_gears.scene.read import scene_from_text
from fenics_gears.studies.accuracy.measures import CURVE, JUDGED, SPAN, answer, distance, judged_answer
from fenics_gears.studies.accuracy.runs import run_sharing
from fenics_gears.studies.accuracy.setting import Setting, half_width
from fenics_gears.studies.accuracy_target import choose as choosing
from fenics_gears.studies.accuracy_target import trial_runs
from fenics_gears.studies.accuracy_target.choose import choose
from fenics_gears.studies.accuracy_target.trial_runs import Limits, TargetNotReached
from fenics_gears.studies.simulate import simulate
from fenics_gears.system.progress import SilentProgress

TARGET = 0.1
TEXT_TARGET = '\n[accuracy]\ntarget = "10 %"\n'


@pytest.fixture(scope="module")
def text(paper_scene):
    """The paper's pair, of which only the teeth give way; one mesh cycle."""
    plain = paper_scene.text.partition("[accuracy]")[0]
    for section in ("shafts", "bearings", "inertia", "damping", "friction"):
        before, _, after = plain.partition(f"[{section}]")
        plain = before + ("[" + after.partition("\n[")[2] if "\n[" in after else "")
    return plain.replace("mesh_cycles = 30", "mesh_cycles = 1").replace("recorded_cycles = 2", "recorded_cycles = 1") + TEXT_TARGET


@pytest.fixture(scope="module")
def scene(text):
    return scene_from_text(text)


@pytest.fixture(scope="module", autouse=True)
def runs_once():
    """Every trial run is made once for all tests here."""
    made = {}

    def once(scene, gears, progress):
        if scene not in made:
            made[scene] = run_sharing(scene, gears, progress)
        return made[scene]

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(trial_runs, "run_sharing", once)
        yield once


@pytest.fixture(scope="module")
def run(scene):
    return simulate(scene)


def test_the_scene_is_the_one_meant(scene, paper_scene):
    """Identity with the scene made from the paper's."""
    expected = replace(teeth_alone(paper_scene), friction=None, accuracy=Accuracy(target=TARGET), motion=Motion(200.0, 1, 1))
    assert replace(scene, text="", name="", title="") == replace(expected, text="", name="", title="")


def test_the_true_error_is_within_the_target(scene, run):
    """Another resolution: elements and steps four times as fine as what was chosen."""
    size = run.attrs["flank_element_size"] / 4.0
    length = run.attrs["contact_length"]
    fine = Accuracy(
        element="P2", flank_element_size=size, contact_length=length, contact_nodes=round(length / (NODE_SPACING * size)) + 1,
        steps_per_mesh_cycle=4 * run.attrs["steps_per_mesh_cycle"],
    )  # fmt: skip
    reference = answer(simulate(replace(scene, accuracy=fine)), length)
    errors = {name: distance(answer(run, length), reference, name) for name in JUDGED}
    assert max(errors.values()) <= run.attrs["estimated_error"] <= TARGET == run.attrs["target"]


def test_parts_of_the_error_are_told(run):
    """Triangle inequality: no part is larger than the whole, and the whole no larger than the sum of its parts."""
    parts = {name: value for name, value in run.attrs.items() if name.startswith("estimated_error: ")}
    assert set(parts) == {f"estimated_error: {name}" for name in trial_runs.NAMES}
    assert max(parts.values()) <= run.attrs["estimated_error"] <= sum(parts.values()) * (1.0 + 1e-12)
    said = "\n".join(" ".join(map(str, row)) for row in summary_rows(run))
    assert "target 10.000%" in said and "what limits it" in said and "settings chosen" in said


def test_the_scene_that_the_result_carries_repeats_it(run):
    """Identity, to the last bit: settings stand in the result's scene in place of the target, and nothing is measured again."""
    again = scene_from_text(run.attrs["scene"])
    assert again.accuracy.target is None and again.accuracy.flank_element_size == run.attrs["flank_element_size"]
    assert np.array_equal(simulate(again).transmission_error.values, run.transmission_error.values)


def test_a_scene_without_text_can_have_a_target(scene, monkeypatch):
    """A scene made in Python; settings go to its data alone."""
    monkeypatch.setattr("fenics_gears.studies.accuracy_target.choose.choose", lambda *arguments: choosing.Chosen(Accuracy("P1", 0.25), None, 0.05, {"x": 0.05}, (), 1))
    result = simulate(replace(scene, text=""))
    assert result.attrs["scene"] == "" and result.attrs["element"] == "P1"


@pytest.mark.nightly
def test_a_tighter_target_takes_finer_settings(scene, run):
    """By definition of a target."""
    tighter = choose(scene, 0.04, SilentProgress())
    assert tighter.estimated_error <= 0.04
    assert tighter.setting.flank < run.attrs["flank_element_size"] or tighter.setting.steps > run.attrs["steps_per_mesh_cycle"]
    assert tighter.setting.flank <= half_width(scene) / trial_runs.COARSEST[trial_runs.FLANK]


def test_the_clock_has_no_say(scene, run, runs_once, monkeypatch):
    """Identity: with a clock, and times of the trial runs, that say anything the same settings are chosen, by as many runs."""
    random = np.random.default_rng(5)

    def timed_at_random(scene, gears, progress):
        found, cycle = runs_once(scene, gears, progress)
        return found.assign_attrs({name: random.uniform(0.0, 1e3) for name in found.attrs if name.startswith("time_")}), cycle

    monkeypatch.setattr(trial_runs, "run_sharing", timed_at_random)
    monkeypatch.setattr(time, "perf_counter", lambda: float(random.uniform(0.0, 1e3)))
    found = choose(scene, TARGET, SilentProgress())
    assert found.estimated_error == run.attrs["estimated_error"] and found.runs == run.attrs["target_runs"]
    chosen = found.accuracy.flank_element_size, found.accuracy.steps_per_mesh_cycle, found.accuracy.contact_nodes
    assert chosen == tuple(run.attrs[name] for name in ("flank_element_size", "steps_per_mesh_cycle", "contact_nodes"))


def test_every_other_step_of_a_run_is_a_run_of_half_the_steps(scene):
    """Identity: a quasi-static step without friction knows nothing of the one before; a frictional one does, and is run.

    T_EPP is that of all steps, being located between them; what fewer steps miss of it is less than a tenth of what they change in the curve."""
    runs = trial_runs.TrialRuns(scene, lambda words: None)
    sizes = {trial_runs.FLANK: 0.2, trial_runs.BODY: 4.0, trial_runs.STEPS: 1.0 / 40.0}
    many = runs.answer(runs.setting(sizes))
    few = runs.setting({**sizes, trial_runs.STEPS: 1.0 / 20.0})
    found, own = runs.answer(few), judged_answer(simulate(replace(few.of(scene), motion=Motion(200.0, 1, 1))))
    assert runs.runs == 1
    assert np.allclose(found[CURVE], own[CURVE], rtol=1e-9, atol=1e-15) and found[SPAN] == many[SPAN]
    assert distance(own, many, SPAN) < 0.1 * distance(own, many, CURVE)
    rubbing = trial_runs.TrialRuns(replace(scene, friction=Friction(0.1)), lambda words: None)
    for steps in (1.0 / 40.0, 1.0 / 20.0):
        rubbing.answer(rubbing.setting({**sizes, trial_runs.STEPS: steps}))
    assert rubbing.runs == 2


def test_the_cost_of_any_sizes_is_that_of_the_scene_with_them(scene):
    """Authority: the cost that `gears check` shows, of the scene with these settings, but for what no size changes the share of: the blocks of
    compliance and the two positions that begin a run. Finer is dearer in every size; friction has twice the rows."""
    bounds, fine = Limits(replace(scene, accuracy=Accuracy())), dict(flank=0.04, body=1.0, step=0.01)
    ratios = []
    for sizes in (fine, {**fine, "flank": 0.08}, {**fine, "step": 0.005}):
        setting = Setting("P2", sizes["flank"], NODE_SPACING * sizes["flank"], 3.0, 1.0, round(1.0 / sizes["step"]))
        model = model_of(setting.of(scene))
        expected = expected_cost(model)
        assert bounds.stored_bytes(sizes["flank"], sizes["step"], 3.0) == pytest.approx(model.stored_bytes, rel=0.1)
        ratios.append(bounds.cost(**sizes, length=3.0) / (expected.condensing + expected.marching))
    assert ratios == pytest.approx([1.0] * 3, rel=0.2)
    plain = dict(**fine, length=3.0)
    assert all(bounds.cost(**{**plain, name: 0.5 * plain[name]}) > bounds.cost(**plain) for name in fine)
    assert Limits(replace(scene, accuracy=Accuracy(), friction=Friction(0.1))).cost(**plain) > bounds.cost(**plain)


def test_a_window_that_cuts_contact_off_is_lengthened(scene):
    """The program's own warning decides: trial runs that begin with too short a window end with one that is not."""
    runs = trial_runs.TrialRuns(scene, lambda words: None)
    runs.length *= 0.13
    assert runs.window_cuts_contact()
    choosing._lengthen_window(runs)
    assert not runs.window_cuts_contact() and runs.length > 0.13 * trial_runs.TrialRuns(scene, lambda words: None).length


def refusal(scene, monkeypatch):
    """What is said of 0.1 % with little memory; few larger targets are tried."""
    monkeypatch.setattr(choosing, "REACHABLE", 2.0)
    monkeypatch.setattr(trial_runs, "MOST_BYTES", 4e7)
    with pytest.raises(TargetNotReached, match=r"accuracy.target = 0.1 %.*contact operators and gears.*sharp edges.*; [\d.]+ % can be") as failure:
        choose(scene, 0.001, SilentProgress())
    return failure.value


def test_what_memory_does_not_hold_is_refused_by_name(scene, monkeypatch):
    """With little memory no fine settings fit."""
    assert refusal(scene, monkeypatch).exit_code == 3


@pytest.mark.nightly
def test_the_target_named_instead_can_be_reached(scene, monkeypatch):
    """By the same runs."""
    reachable = 0.01 * float(re.search(r"; ([\d.]+) % can be", str(refusal(scene, monkeypatch)))[1])
    assert 0.001 < choose(scene, 1.05 * reachable, SilentProgress()).estimated_error <= 1.05 * reachable


@pytest.mark.nightly
def test_a_light_load_is_named_as_the_reason(text, monkeypatch):
    """Its contact is narrower than any element that trial runs begin with."""
    monkeypatch.setattr(trial_runs, "MOST_BYTES", 7e7)
    with pytest.raises(TargetNotReached, match=r"because the contact's half-width under this load is only 0\.0\d+ mm"):
        choose(scene_from_text(text.replace('"437 N m"', '"1 N m"')), 0.001, SilentProgress())


@pytest.mark.nightly
def test_no_run_that_chooses_is_beyond_the_limits(scene, monkeypatch):
    """The check, which halves a size at settings that just fit, least of all."""
    tried, run = [], trial_runs.TrialRuns._run
    monkeypatch.setattr(trial_runs, "MOST_BYTES", 1.5e8)

    def noted(runs, setting):
        tried.append(Limits(scene).bytes_of(setting.flank, 1.0 / setting.steps, setting.length))
        return run(runs, setting)

    monkeypatch.setattr(trial_runs.TrialRuns, "_run", noted)
    with contextlib.suppress(TargetNotReached):
        choose(scene, 0.01, SilentProgress())
    assert len(tried) >= 5 and max(tried) <= 1.5e8


def test_memory_that_runs_out_is_a_typed_error(scene, monkeypatch):
    """What the estimate did not foresee."""
    def no_memory(scene, gears, progress):
        raise MemoryError

    monkeypatch.setattr(trial_runs, "run_sharing", no_memory)
    with pytest.raises(TargetNotReached, match="not enough memory for the run with P2"):
        choose(scene, TARGET, SilentProgress())


def test_elements_are_no_finer_than_a_scene_may_ask_for(scene):
    """The schema's own bounds: the chosen settings are written into a scene."""
    bounds, module = Limits(scene), scene.gears.module
    assert bounds.allowed(0.01 * module, 1.0, 0.05, 1.0) and not bounds.allowed(0.9e-3 * module, 1.0, 0.05, 1.0)
    assert "finer than a scene may ask for" in bounds.why_not(0.9e-3 * module, 1.0, 1.0)
    many_cycles = replace(scene, motion=Motion(200.0, 600, 600))
    assert Limits(many_cycles).allowed(0.01 * module, 1.0, 5e-3, 1.0)
    assert not Limits(many_cycles).allowed(0.01 * module, 1.0, 1e-4, 1.0)
    assert Limits(many_cycles).allowed(0.01 * module, 1.0, 1e-4, 1.0, stored=False)


def test_choosing_can_be_interrupted_within_a_run(scene, monkeypatch):
    """Ctrl-C becomes a KeyboardInterrupt at a step of the first run, not at its end."""
    class Interrupted(SilentProgress):
        said = 0

        def update(self, done, total, note=""):
            self.said += 1
            if self.said == 5:
                raise KeyboardInterrupt

    monkeypatch.setattr(trial_runs, "run_sharing", run_sharing)
    progress = Interrupted()
    with pytest.raises(KeyboardInterrupt):
        choose(scene, TARGET, progress)
    assert progress.said == 5


@pytest.mark.parametrize("line, reason", [
    ('element = "P1"', "is chosen by accuracy.target"), ("contact_nodes = 20", "is chosen by accuracy.target"),
    ('model = "rigid teeth"', "cannot stand beside accuracy.target, which is for the full contact of elastic teeth"),
    ('condensation = "once"', "cannot stand beside accuracy.target, which condenses once"),
])  # fmt: skip
def test_a_setting_beside_a_target_is_refused(text, line, reason):
    """Two answers to one question."""
    with pytest.raises(SceneError) as failure:
        scene_from_text(text + line + "\n")
    assert f"accuracy.{line}\n    {reason}. Leave one of the two out." in str(failure.value)


@pytest.mark.parametrize("written, reason", [
    ("1", 'is a number without its unit. In % it is written "1 %"'),
    ('"1"', "is a number without unit, not a percentage"), ('"1 mm"', "is a length, not a percentage"), ('"-1 %"', "is negative"),
    ('"0 %"', "is zero"), ('"0.01 %"', "is too small"), ('"60 %"', "is too large"), ("true", "is not a text with a number and its unit"),
    ('"1e999 %"', "is not a finite number"), ("0.2", 'In % it is written "0.2 %"'),
])  # fmt: skip
def test_a_wrong_percentage_says_what_is_wrong(text, written, reason):
    """Wording for people."""
    with pytest.raises(SceneError) as failure:
        scene_from_text(text.replace('"10 %"', written))
    assert reason in str(failure.value) and "Allowed: a percentage from 0.05 % to 50 %" in str(failure.value)


def test_no_load_and_rigid_teeth_have_no_target(text):
    """Nothing gives way there."""
    with pytest.raises(SceneError, match="has no meaning without a load"):
        scene_from_text(text.replace('"437 N m"', '"0 N m"'))
    rigid = text.partition("[gears.material]")
    with pytest.raises(SceneError, match="needs teeth that give way"):
        scene_from_text(rigid[0] + "[load]" + rigid[2].partition("[load]")[2])


def test_commands_that_measure_want_settings_as_they_stand(text, tmp_path, capsys):
    """`gears accuracy` and `gears effects` turn settings themselves."""
    (tmp_path / "scene.toml").write_text(text)
    for command in ("accuracy", "effects"):
        assert main([command, str(tmp_path / "scene.toml"), "--output", str(tmp_path)]) == 2
        assert "leave accuracy.target out" in capsys.readouterr().err


def test_check_says_that_settings_are_chosen_by_the_run(text, tmp_path, capsys):
    """`gears check` computes nothing."""
    (tmp_path / "scene.toml").write_text(text)
    assert main(["check", str(tmp_path / "scene.toml")]) == 0
    assert "10.000%: a run chooses settings" in capsys.readouterr().out
