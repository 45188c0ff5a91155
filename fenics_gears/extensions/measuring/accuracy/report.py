"""The study of `gears accuracy`: settings refined one at a time, the reference, whole settings and cheaper models, all
run and timed."""

from dataclasses import dataclass, replace
from functools import partial

import numpy as np
import xarray as xr

from fenics_gears import ComputationError, GearsError, Scene, model_of
from fenics_gears.many_runs import Progress, SilentProgress
from fenics_gears.measuring import (
    DEFECT,
    EVERY_STEP,
    STIFFNESS_TABLE,
    Accuracy,
    Answer,
    Cycle,
    Model,
    Output,
    Setting,
    SettingRuns,
    Times,
    answer,
    compile_kernels,
    default_setting,
    distances,
    judged,
    measures_of,
    own_setting,
    run_sharing,
    shared_gears,
    without_settings,
)

from ..machine import machine
from . import whole
from .convergence import Limit, error_from, together
from .over_face import PLANE, in_the_plane
from .refinement import (
    CONDENSATION,
    LENGTH,
    OF_FAMILY,
    Level,
    Refinement,
    check_measurable,
    fine,
    limit_of,
    plan_of,
    refinements,
)
from .root_point import peak_root_stress

OWN = "the scene's own"
DEFAULTS = "the program's defaults"


@dataclass(frozen=True)
class LevelResult:
    """A level that was run: relative errors by measure, from the limit of its setting, and times."""

    level: Level
    errors: dict[str, float]
    times: Times


@dataclass(frozen=True)
class RefinementResult:
    """A setting refined alone: the levels that ran, and the limit and observed order of each measure."""

    refinement: Refinement
    levels: tuple[LevelResult, ...]
    limits: dict[str, Limit]

    def order(self, measure: str) -> float | None:
        return self.limits[measure].order if measure in self.limits else None


@dataclass(frozen=True)
class WholeResult:
    """A whole setting or a cheaper model: errors from the reference, the parts of its settings, and times. `parts` is
    empty for a cheaper model, and for the settings of a `target`, which are no levels."""

    name: str
    setting: Setting | None
    errors: dict[str, float]
    parts: dict[str, float]
    times: Times
    target: float | None = None

    @property
    def total_error(self) -> float:
        return whole.total_error(judged(self.errors), self.parts)


@dataclass(frozen=True)
class AccuracyReport:
    """All that was measured; `uncertainty`: relative, of the reference, by measure; `failures`: what did not run, and
    why; `rounds`: how often whole settings were timed."""

    scene: Scene
    fine: Setting
    refinements: tuple[RefinementResult, ...]
    settings: tuple[WholeResult, ...]
    models: tuple[WholeResult, ...]
    uncertainty: dict[str, float]
    failures: tuple[tuple[str, str], ...]
    machine: dict[str, str]
    rounds: int
    targets: tuple[WholeResult, ...] = ()

    @property
    def own(self) -> WholeResult:
        return next(each for each in self.settings if each.name == OWN)

    @property
    def defaults(self) -> WholeResult | None:
        """The program's default settings; None where the scene's own are these, or they did not run."""
        return next((each for each in self.settings if each.name == DEFAULTS), None)

    @property
    def front(self) -> tuple[WholeResult, ...]:
        """The Pareto front of the whole settings, the quickest first."""
        places = whole.pareto_front([(each.times.total, each.total_error) for each in self.settings])
        return tuple(self.settings[place] for place in places)

    @property
    def floor(self) -> float:
        """The reference's own uncertainty; smaller errors cannot be judged."""
        return judged(self.uncertainty)


def measure(
    scene: Scene, progress: Progress | None = None, quick: bool = False, rounds: int | None = None
) -> AccuracyReport:
    """Refine every setting of a scene alone, then run and time whole settings; `quick`: few levels, coarse ones. Raises
    SceneError, GeometryError, ComputationError."""
    plan = plan_of(scene, quick)
    study = AccuracyStudy(scene, progress or SilentProgress(), quick, rounds or plan.rounds)
    results = study.refine()
    reference, uncertainty = study.reference(results)
    whole_settings, models, targets = study.whole_runs(results, reference, plan.targets)
    return AccuracyReport(
        scene, study.base, results, whole_settings, models, uncertainty, tuple(study.failures), machine(),
        study.rounds, targets,
    )  # fmt: skip


class AccuracyStudy:
    """The measurement of one scene: the answers and times of each setting so far, and what failed."""

    def __init__(self, scene: Scene, progress: Progress, quick: bool, rounds: int):
        check_measurable(scene)
        # Root stress is taken at one point; the output of it along both fillets is not what is measured here.
        self.scene = replace(scene, output=Output())
        self.progress = progress
        self.rounds = rounds
        self.base = fine(scene, quick)
        self.refinements = refinements(scene, quick)
        # Length over which pressures are compared, mm.
        self.window = max(level.setting.length for each in self.refinements for level in each.levels)
        self.failures: list[tuple[str, str]] = []
        self.runs = SettingRuns(self.scene, self._answer)

    def refine(self) -> tuple[RefinementResult, ...]:
        """Run every level with the other settings fine."""
        self.progress.stage("compile")
        compile_kernels(self.scene.friction is not None, progress=self.progress)
        self.progress.stage("single settings")
        if not self._run(self.base, "all settings fine"):
            raise ComputationError(
                f"the setting that all others are compared with does not run: {self.failures[-1][1]}"
            )
        levels = [(f"{each.name} {level.label}", level.setting) for each in self.refinements for level in each.levels]
        levels += [(f"the base of {each.name}", each.base) for each in self.refinements]
        for name, setting in self.progress.counted(levels, lambda level: level[0]):
            self._run(setting, name)
        results = [self._result(each) for each in self.refinements if each.base in self.runs]
        return tuple(result for result in results if result.levels)

    def reference(self, results: tuple[RefinementResult, ...]) -> tuple[Answer, dict[str, float]]:
        """The reference, all settings at their limits, and its relative uncertainty by measure."""
        base = self.runs.answers[self.base]
        value = {}
        uncertainty = dict.fromkeys(measures_of(base), float("nan"))
        moved = [
            (each.limits, self.runs.answers[each.refinement.base])
            for each in results
            if each.refinement.name not in (*OF_FAMILY, CONDENSATION)
        ]
        for name in base:
            limit = together(base[name], [(limits[name], own_base[name]) for limits, own_base in moved], name)
            value[name] = limit.value
            scale = float(np.linalg.norm(limit.value))
            uncertainty[name] = limit.uncertainty / scale if scale and name != DEFECT else 0.0
        return value, uncertainty

    def whole_runs(
        self, results: tuple[RefinementResult, ...], reference: Answer, targets: tuple[float, ...]
    ) -> tuple[tuple[WholeResult, ...], ...]:
        """Run and time whole settings, cheaper models, and the settings of targets."""
        ran = [each.refinement for each in results]
        errors = {
            (each.refinement.name, each.refinement.levels.index(level.level)): judged(level.errors)
            for each in results
            for level in each.levels
        }
        plain = without_settings(self.scene)
        chosen: dict[str, Setting | None] = {OWN: own_setting(self.scene)}
        if plain != self.scene:
            chosen[DEFAULTS] = default_setting(self.scene)
        for setting in whole.path(self.base, ran, errors, partial(whole.fits, self.scene), whole.ENOUGH):
            chosen[setting.words] = setting
        chosen |= dict.fromkeys(plan_of(self.scene).models)
        of_targets = whole.settings_of(self.scene, targets, self.progress, self.failures)
        chosen |= {name: setting for name, (setting, _) in of_targets.items()}
        answers, times = self._in_turns({name: scene_of(self.scene, name, setting) for name, setting in chosen.items()})
        measured = []
        for name in answers:
            setting = chosen[name]
            target = of_targets[name][1] if name in of_targets else None
            parts = {} if setting is None or target else whole.parts_of(setting, ran, errors)
            measured.append(WholeResult(name, setting, distances(answers[name], reference), parts, times[name], target))
        if OWN not in answers:
            raise ComputationError(f"the scene itself does not run: {dict(self.failures)[OWN]}")
        return (
            tuple(each for each in measured if each.setting and not each.target),
            tuple(each for each in measured if not each.setting),
            tuple(each for each in measured if each.target),
        )

    def _run(self, setting: Setting, name: str) -> bool:
        """Run a setting unless it has run before; whether it could be run."""
        if setting in self.runs:
            return True
        try:
            if not whole.fits(self.scene, setting):
                raise ComputationError(f"its contact operators would take more than {whole.MOST_BYTES / 1e9:g} GB")
            self.runs.run(setting)
        except GearsError as error:
            self.failures.append((name, str(error).splitlines()[0]))
            return False
        return True

    def _answer(self, run: xr.Dataset, model: Model, cycle: Cycle) -> Answer:
        """All measures; root stress only where contact is resolved on one mesh. Its time is not counted."""
        scene = model.scene
        recovered = scene.resolves_contact and plan_of(scene).root_stress and scene.accuracy.condensation != EVERY_STEP
        return answer(run, self.window, peak_root_stress(run, model, cycle) if recovered else None)

    def _in_turns(self, scenes: dict[str, Scene]) -> tuple[dict[str, Answer], dict[str, Times]]:
        """Run every scene once a round, with gears of its own, so that other load of the machine affects all alike."""
        self.progress.stage("whole settings")
        answers = {}
        times: dict[str, Times] = {}
        left = set(scenes)
        for name in self.progress.counted(list(scenes) * self.rounds, str):
            if name not in left:
                continue
            try:
                model = model_of(scenes[name])
                run, cycle = run_sharing(model, shared_gears())
                if name not in answers:
                    answers[name] = self._answer(run, model, cycle)
            except GearsError as error:
                self.failures.append((name, str(error).splitlines()[0]))
                left.remove(name)
                continue
            times[name] = times.get(name, Times()).and_also(run)
        return answers, times

    def _result(self, refinement: Refinement) -> RefinementResult:
        """Errors of the levels from the limit of their setting; a choice is compared with its base."""
        answers = self.runs.answers
        base = self.runs.answers[refinement.base]
        ran = [(level, answers[level.setting]) for level in refinement.levels if level.setting in answers]
        regular = [(level, measured) for level, measured in ran if not level.own or refinement.name == LENGTH]
        limits = {name: limit_of(refinement, regular, base, name) for name in base}
        levels = []
        for level, measured in ran:
            errors = {name: error_from(limits, measured, name) for name in measures_of(base)}
            levels.append(LevelResult(level, errors, self.runs.times[level.setting]))
        return RefinementResult(refinement, tuple(levels), limits)


def scene_of(scene: Scene, name: str, setting: Setting | None) -> Scene:
    """The scene with a whole setting, or with the cheaper model of a name."""
    if setting is None:
        return in_the_plane(scene) if name == PLANE else replace(scene, accuracy=_accuracy_of(scene, name))
    return {OWN: scene, DEFAULTS: without_settings(scene)}.get(name) or setting.of(scene)


def _accuracy_of(scene: Scene, name: str) -> Accuracy:
    """The scene's own accuracy for a cheaper model; models without contact on flanks have steps only."""
    if name == STIFFNESS_TABLE:
        return replace(scene.accuracy, model=name)
    return Accuracy(model=name, steps_per_mesh_cycle=own_setting(scene).steps)
