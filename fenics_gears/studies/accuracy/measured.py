"""The study itself: knobs turned one at a time, the reference, whole settings and cheaper models, all run and timed."""

from __future__ import annotations

import time
from dataclasses import dataclass, replace
from math import ceil

import numpy as np
import xarray as xr

from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.cost import operator_bytes
from fenics_gears.errors import ComputationError, GearsError
from fenics_gears.progress import Progress, SilentProgress
from fenics_gears.resolution import EVERY_STEP
from fenics_gears.scene.data import ISO_6336, RIGID_TEETH, STIFFNESS_TABLE, Accuracy, Output, Scene
from fenics_gears.studies.accuracy import ladder, whole
from fenics_gears.studies.accuracy.ladder import Knob, Rung, Setting
from fenics_gears.studies.accuracy.measures import DEFECT, MEASURES, Answer, answer, distance, distances, judged
from fenics_gears.studies.accuracy.reference import Limit, last_of, richardson, together
from fenics_gears.studies.accuracy.root_point import peak_root_stress
from fenics_gears.studies.accuracy.timing import KeptGears, Times, run_afresh
from fenics_gears.studies.effect_lattice.machine import machine
from fenics_gears.warm_up import compile_kernels

ROUNDS, QUICK_ROUNDS = 5, 1
# What repeating the rungs for their times may take, s, unless the user gives more; their answers need one run.
SECONDS_ON_RUNGS = 60.0
MODELS = (STIFFNESS_TABLE, ISO_6336, RIGID_TEETH)
OWN = "the scene's own"


@dataclass(frozen=True)
class RungResult:
    """A rung that was run: relative errors by measure against its knob's limit, and times."""

    rung: Rung
    errors: dict[str, float]
    times: Times


@dataclass(frozen=True)
class KnobResult:
    """A knob: its rungs that ran, and by measure its limit, with the order observed."""

    knob: Knob
    rungs: tuple[RungResult, ...]
    limits: dict[str, Limit]

    def order(self, measure: str) -> float | None:
        """Observed in a measure; None where there is none."""
        return self.limits[measure].order if measure in self.limits else None


@dataclass(frozen=True)
class WholeResult:
    """A whole setting or a cheaper model: direct errors against the reference, errors by knob, what it is charged, and times.

    `parts` is empty for a cheaper model, whose error no knob makes smaller.
    """

    name: str
    setting: Setting | None
    errors: dict[str, float]
    parts: dict[str, float]
    times: Times

    @property
    def counted(self) -> float:
        """The error that it is charged."""
        return whole.counted_error(judged(self.errors), self.parts)


@dataclass(frozen=True)
class Report:
    """All that was measured; `uncertainty`: of the reference, relative, by measure; `failures`: what did not run, and why.

    rounds: how often whole settings were timed, and rungs as far as `seconds_on_rungs` went.
    """

    scene: Scene
    half_width: float
    fine: Setting
    knobs: tuple[KnobResult, ...]
    settings: tuple[WholeResult, ...]
    models: tuple[WholeResult, ...]
    uncertainty: dict[str, float]
    failures: tuple[tuple[str, str], ...]
    machine: dict[str, str]
    rounds: int
    seconds_on_rungs: float

    @property
    def own(self) -> WholeResult:
        """The scene's own setting."""
        return next(each for each in self.settings if each.name == OWN)

    @property
    def front(self) -> tuple[WholeResult, ...]:
        """The whole settings that pay, the quickest first."""
        places = whole.pareto_front([(each.times.total, each.counted) for each in self.settings])
        return tuple(self.settings[place] for place in places)

    @property
    def floor(self) -> float:
        """Below this an error cannot be told from the reference's own."""
        return judged(self.uncertainty)


def measure(
    scene: Scene, progress: Progress | None = None, quick: bool = False, rounds: int | None = None, seconds_on_rungs: float = SECONDS_ON_RUNGS
) -> Report:
    """Run and time the ladder of a scene; `quick`: few rungs, coarse ones; `seconds_on_rungs`: for repeating rungs for their times.

    Raises SceneError, GeometryError, ComputationError.
    """
    study = Study(scene, progress or SilentProgress(), quick, rounds or (QUICK_ROUNDS if quick else ROUNDS), seconds_on_rungs)
    knobs = study.turn_knobs()
    reference, uncertainty = study.reference(knobs)
    settings, models = study.whole_runs(knobs, reference)
    return Report(
        scene, ladder.half_width(scene), study.base, knobs, settings, models, uncertainty, tuple(study.failures), machine(),
        study.rounds, seconds_on_rungs,
    )  # fmt: skip


class Study:
    """One scene's study while it runs: what was answered by which setting, and what failed."""

    def __init__(self, scene: Scene, progress: Progress, quick: bool, rounds: int, seconds_on_rungs: float = SECONDS_ON_RUNGS):
        # Root stress is taken at one point; the output of it along both fillets is not what is measured here.
        self.scene, self.progress, self.rounds = replace(scene, output=Output()), progress, rounds
        self.seconds_on_rungs = seconds_on_rungs
        self.pair = ladder.checked_model(scene).pair
        self.base, self.knobs = ladder.fine(scene, quick), ladder.knobs(scene, quick)
        lengths = [rung.setting.length for knob in self.knobs for rung in knob.rungs]
        self.window = max(lengths)
        self.failures: list[tuple[str, str]] = []
        self._known: dict[Setting, tuple[Answer, Times]] = {}
        self._seconds: dict[Setting, float] = {}
        self._gears = KeptGears()

    def turn_knobs(self) -> tuple[KnobResult, ...]:
        """Every rung run with the other knobs fine."""
        self.progress.stage("compile")
        compile_kernels(self.scene.friction is not None)
        self.progress.stage("knobs")
        total, done = sum(len(knob.rungs) for knob in self.knobs), 0
        if not self._run(self.base, "all knobs fine"):
            raise ComputationError(f"the setting that all others are compared with does not run: {self.failures[-1][1]}")
        for knob in self.knobs:
            for rung in knob.rungs:
                self.progress.update(done, total, f"{knob.name} {rung.label}")
                done += 1
                self._run(rung.setting, f"{knob.name} {rung.label}")
        self._time_rungs()
        results = [self._knob_result(knob) for knob in self.knobs]
        return tuple(result for result in results if result.rungs)

    def _time_rungs(self) -> None:
        """More rounds for the times of the rungs, the quickest first, as far as there is time for all rounds of them."""
        repeated = within(self._seconds, self.seconds_on_rungs / max(self.rounds - 1, 1))
        if self.rounds > 1:
            self.progress.stage("knobs for the time")
        for turn in range(self.rounds - 1):
            gears = KeptGears()
            for place, setting in enumerate(repeated):
                self.progress.update(turn * len(repeated) + place, (self.rounds - 1) * len(repeated))
                answers, times = self._known[setting]
                self._known[setting] = answers, times.and_also(gears.run(self._scene(setting)))

    def _knob_result(self, knob: Knob) -> KnobResult:
        ran = [(rung, *self._known[rung.setting]) for rung in knob.rungs if rung.setting in self._known]
        origin = self._known.get(knob.base or self.base, self._known[self.base])
        return _knob_result(knob, ran, self._known[self.base][0], origin[0])

    def _scene(self, setting: Setting) -> Scene:
        return replace(self.scene, accuracy=setting.accuracy(self.scene.gears.module))

    def reference(self, knobs: tuple[KnobResult, ...]) -> tuple[Answer, dict[str, float]]:
        """All knobs at their limits, and how uncertain that is, relative, by measure."""
        base, value, uncertainty = self._known[self.base][0], {}, {}
        for name in base:
            limit = together(base[name], [each.limits[name] for each in knobs])
            value[name], scale = limit.value, float(np.linalg.norm(limit.value))
            uncertainty[name] = limit.uncertainty / scale if scale and name != DEFECT else 0.0
        return value, uncertainty

    def whole_runs(self, knobs: tuple[KnobResult, ...], reference: Answer) -> tuple[tuple[WholeResult, ...], tuple[WholeResult, ...]]:
        """Whole settings and cheaper models in turns, and what they are charged."""
        mine = ladder.own(self.scene)
        results = [each.knob for each in knobs]
        errors = {(each.knob.name, place): judged(rung.errors) for each in knobs for place, rung in _places(each)}
        chosen = {OWN: (mine, self.scene)}
        for setting in whole.path(self.base, results, errors, self._fits):
            chosen[setting.words] = (setting, self._scene(setting))
        for name in MODELS:
            chosen[name] = (None, replace(self.scene, accuracy=_accuracy_of(self.scene, name)))
        answers, times = self._in_turns({name: scene for name, (_, scene) in chosen.items()})
        found = []
        for name in answers:
            setting = chosen[name][0]
            parts = {} if setting is None else whole.parts_of(setting, results, errors)
            found.append(WholeResult(name, setting, distances(answers[name], reference), parts, times[name]))
        if OWN not in answers:
            raise ComputationError(f"the scene itself does not run: {dict(self.failures)[OWN]}")
        return tuple(each for each in found if each.setting), tuple(each for each in found if not each.setting)

    def _fits(self, setting: Setting) -> bool:
        friction = self.scene.friction is not None
        rows = ceil(self.pair.contact_ratio) * setting.grid.nodes * (2 if friction else 1)
        return operator_bytes(setting.steps, rows, friction) <= whole.MOST_BYTES

    def _run(self, setting: Setting, name: str) -> bool:
        """A setting's answers and time, run once whatever knobs it stands on; whether it ran."""
        if setting in self._known:
            return True
        try:
            if not self._fits(setting):
                raise ComputationError(f"its contact operators would take more than {whole.MOST_BYTES / 1e9:g} GB")
            begun = time.perf_counter()
            run, cycle = self._gears.run_with_cycle(self._scene(setting))
            self._seconds[setting] = time.perf_counter() - begun
            found = self._answer(run, self._scene(setting), cycle)
        except GearsError as error:
            self.failures.append((name, str(error).splitlines()[0]))
            return False
        self._known[setting] = (found, Times().and_also(run))
        return True

    def _answer(self, run: xr.Dataset, scene: Scene, cycle: Cycle) -> Answer:
        """All measures; the root stress of what has flanks in contact and one mesh to be recovered on, and outside of all times."""
        recovered = scene.resolves_contact and scene.accuracy.condensation != EVERY_STEP
        return answer(run, self.window, peak_root_stress(run, scene, cycle) if recovered else None)

    def _in_turns(self, scenes: dict[str, Scene]) -> tuple[dict[str, Answer], dict[str, Times]]:
        """Every scene once a round, so that whatever else the machine does meets all of them."""
        self.progress.stage("whole settings")
        answers, times, left = {}, {}, dict(scenes)
        for turn in range(self.rounds):
            for place, (name, scene) in enumerate(list(left.items())):
                self.progress.update(turn * len(scenes) + place, self.rounds * len(scenes), name)
                try:
                    run, cycle = run_afresh(scene)
                    if name not in answers:
                        answers[name] = self._answer(run, scene, cycle)
                except GearsError as error:
                    self.failures.append((name, str(error).splitlines()[0]))
                    del left[name]
                    continue
                times[name] = times.get(name, Times()).and_also(run)
        return answers, times


def within(seconds: dict[Setting, float], budget: float) -> list[Setting]:
    """The quickest settings that together take no longer than `budget` (s), in the order in which they were run."""
    spent, chosen = 0.0, set()
    for setting in sorted(seconds, key=seconds.__getitem__):
        spent += seconds[setting]
        if spent > budget:
            break
        chosen.add(setting)
    return [setting for setting in seconds if setting in chosen]


def _knob_result(knob: Knob, ran: list, base: Answer, origin: Answer) -> KnobResult:
    """Errors of the rungs against the knob's own limit, in the fine setting of all others.

    Choices are measured from `origin`, the setting in which they are turned: none of them is the limit of the others.
    """
    regular = [(rung, found) for rung, found, _ in ran if not rung.own or knob.field == "length"]
    limits = {name: _limit(knob, regular, base, name) for name in base}
    zero = {name: Limit(value, None, 0.0) for name, value in origin.items()} if knob.base else limits
    rungs = tuple(RungResult(rung, {name: _error(found, zero, name) for name in MEASURES}, times) for rung, found, times in ran)
    return KnobResult(knob, rungs, limits)


def _error(found: Answer, limits: dict[str, Limit], name: str) -> float:
    """Relative distance from a knob's limit; not less than can be told where the limit is the finest rung itself."""
    if name not in limits or name not in found:
        return float("nan")
    limit = limits[name]
    scale = float(np.linalg.norm(limit.value))
    least = limit.least_error / scale if scale and name != DEFECT else 0.0
    return max(distance(found, {name: limit.value}, name), least)


def _limit(knob: Knob, ran: list, base: Answer, name: str) -> Limit:
    if len(ran) > 1 and (knob.expected is not None or knob.field == "length"):
        values = [found[name] for _, found in ran]
        return last_of(values) if knob.expected is None else richardson(values, [rung.size for rung, _ in ran], knob.expected)
    return Limit(base[name], None, 0.0)


def _places(result: KnobResult):
    """Rungs that ran, with their places on the whole ladder."""
    ran = {each.rung: each for each in result.rungs}
    return [(place, ran[rung]) for place, rung in enumerate(result.knob.rungs) if rung in ran]


def _accuracy_of(scene: Scene, name: str) -> Accuracy:
    """The scene's own accuracy for a cheaper model; those without flanks in contact have steps alone."""
    if name == STIFFNESS_TABLE:
        return replace(scene.accuracy, model=name)
    return Accuracy(model=name, steps_per_mesh_cycle=ladder.own(scene).steps)
