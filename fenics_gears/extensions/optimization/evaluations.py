"""Designs to numbers: their runs over operating points and samples, computed where they are not kept."""

import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from fenics_gears import MICRORADIANS, OVERALL, Scene, SceneError, carried_train, overall_orders
from fenics_gears.many_runs import (
    NO_MEANING,
    Alone,
    CommonWindows,
    Failure,
    FolderOfLines,
    Interruption,
    Run,
    RunResult,
    Runs,
    Together,
    kept,
    numbers_of,
    record_of,
    run_of,
    seconds_of,
)
from fenics_gears.scene_text import Models, NoScene, is_train

from .conditions import trees_of
from .design import Design, Goal
from .goals import ERROR, OVER_FACE, OVERALL_ERROR, WEIGHTED, order_name

UNUSABLE = 1e6
"""What the search is told instead of a goal where a design failed; one that breaks bounds is told a thousandth of it
and more."""
# In what is kept of a run, why a train has no orders.
WITHOUT_ORDERS = "without_orders"


@dataclass(frozen=True)
class Evaluation:
    """What a design amounts to.

    `values`: of its variables. `goals`: by name, as the design file judges. `of_samples`: by name, the values
    (samples,) behind it. `at_points`: by name, the mean over the samples at each operating point. `violation`: of the
    constraints, 0 where all hold. `failure`: why it has no numbers, empty where it has.
    """

    values: dict[str, float | str]
    goals: dict[str, float] = field(default_factory=dict)
    of_samples: dict[str, np.ndarray] = field(default_factory=dict)
    at_points: dict[str, np.ndarray] = field(default_factory=dict)
    violation: float = 0.0
    failure: str = ""

    @property
    def allowed(self) -> bool:
        """Whether it has numbers and keeps the constraints."""
        return not self.failure and self.violation == 0.0

    def told(self, goals: Sequence[Goal]) -> list[float]:
        """What the search is told: the goals; a large number where there are none or bounds are broken, the larger the
        further."""
        if self.failure:
            return [UNUSABLE] * len(goals)
        return [
            self.goals[goal.name] if self.allowed else 1e-3 * UNUSABLE * (1.0 + min(self.violation, 100.0))
            for goal in goals
        ]


class Evaluator:
    """Evaluates designs with the processes of a `team`; runs that are in `directory` are taken from there.

    `designs`: how many of how many have been evaluated; `others`: kept runs of versions with other numbers.
    """

    def __init__(self, design: Design, directory: Path, team: Alone | Together, progress: Interruption):
        self.design = design
        self._progress = progress
        self.runs = Runs(FolderOfLines(directory, line_of, self.design.asked), team)
        self.others = kept(directory)[1]
        self._models = Models(design.name, design.directory)
        self._windows = CommonWindows()
        self.designs = 0, 0

    def of_designs(self, designs: Sequence[Mapping[str, float | str]], deviations: np.ndarray) -> list[Evaluation]:
        """Designs, by the values of their variables, under deviations (samples, scatters) in parts of their limits."""
        return self.of_trees([self.design.scene_tree(values) for values in designs], designs, deviations)

    def of_trees(
        self, trees: Sequence[Mapping[str, Any]], designs: Sequence[Mapping[str, float | str]], deviations: np.ndarray
    ) -> list[Evaluation]:
        """The same for parsed scenes; `designs` are only noted."""
        begun = time.perf_counter()
        cases = self._cases([trees_of(self.design, tree, deviations) for tree in trees])
        self.runs.spent.seconds += time.perf_counter() - begun
        self._run([case for of_tree in cases for case in of_tree if isinstance(case, Run)], len(trees))
        return [self._evaluation(dict(values), of_tree, len(deviations)) for values, of_tree in zip(designs, cases)]

    def curves(self, trees: Sequence[Mapping[str, Any]]) -> list[np.ndarray | None]:
        """Mesh phase and transmission error (2, steps), rad, of parsed scenes; None where a run failed."""
        (of_trees,) = self._cases([trees])
        runs = [case for case in of_trees if isinstance(case, Run)]
        cases = [replace(run, key=f"{run.key} curve", values={"curve": ""}) for run in runs]
        self._run(cases, len(trees))
        if len(cases) < len(trees):
            return [None] * len(trees)
        lines = (self.runs.known[case.key] for case in cases)
        return [None if isinstance(line, Failure) else np.array(line["curve"]) for line in lines]

    def _cases(self, trees: Sequence[Sequence[Mapping[str, Any]]]) -> list[list[Run | Failure]]:
        """The runs of parsed scenes, or why they are no scenes."""
        models_of_trees = [[self._model(tree) for tree in of_tree] for of_tree in trees]
        models = [each for of_tree in models_of_trees for each in of_tree if not isinstance(each, Failure)]
        runs = map(run_of, self._windows.of(models))
        return [[each if isinstance(each, Failure) else next(runs) for each in of_tree] for of_tree in models_of_trees]

    def _model(self, tree: Mapping[str, Any]) -> Any:
        """The model of a parsed scene, or why it is no scene."""
        try:
            return self._models.of(self._without_fields(tree))
        except NoScene as error:
            return Failure(error)

    def _without_fields(self, tree: Mapping[str, Any]) -> Mapping[str, Any]:
        """Fields over the flanks take memory and time, and only face load factors need them."""
        if is_train(tree) or any(name in OVER_FACE for name in self.design.asked):
            return tree
        return {**tree, "output": {**tree.get("output", {}), "contact_fields": False}}

    def _run(self, cases: list[Run], batch: int) -> None:
        """Compute the runs of a `batch` of designs that are not kept; their processes keep them."""
        missing = self.runs.missing(cases)
        known = len(self.runs.known)
        if not missing:
            return
        before, total = self.designs

        def tick() -> None:
            done = len(self.runs.known) - known
            self._progress.update(before + batch * done // len(missing), max(total, before + batch))

        self.runs.compute(missing, tick)

    def _evaluation(self, values: dict[str, float | str], cases: list[Run | Failure], samples: int) -> Evaluation:
        lines: list[Any] = [case if isinstance(case, Failure) else self.runs.known[case.key] for case in cases]
        failures = [str(line) for line in lines if isinstance(line, Failure)]
        if failures:
            return Evaluation(values, failure=failures[0])
        found = {name: [self.design.number(name, line["numbers"]) for line in lines] for name in self.design.asked}
        for name, numbers in found.items():
            if None in numbers:
                why = lines[numbers.index(None)].get(WITHOUT_ORDERS, "") if name == WEIGHTED else ""
                return Evaluation(values, failure=f"the run has no {name}{why and f': {why}'}")
        shape = len(self.design.loads.points), samples
        by_name = {name: np.array(numbers).reshape(shape) for name, numbers in found.items()}
        of_samples = {name: self.design.loads.combined(numbers) for name, numbers in by_name.items()}
        judge = self.design.tolerances.statistic
        goals = {goal.name: judge(of_samples[goal.name]) for goal in self.design.goals}
        bounds = self.design.bounds
        at_points = {name: each.mean(axis=1) for name, each in by_name.items()}
        violation = sum(max(bound.violation(judge(each)) for each in by_name[bound.goal.name]) for bound in bounds)
        return Evaluation(values, goals, of_samples, at_points, violation)


def _of_train(result: Any) -> dict[str, Any]:
    """What is kept of a train's run: numbers of the whole, and of its meshes the largest."""
    record = record_of(result.dataset)
    of_meshes = dict(record.of_meshes)
    of_meshes[ERROR] = of_meshes[ERROR] * 1e3 * result.dataset["base_radius_wheel"].values
    numbers = {name: float(np.nanmax(values)) for name, values in of_meshes.items()} | record.numbers
    numbers[OVERALL_ERROR] *= MICRORADIANS
    train = carried_train(result.dataset)
    without = {}
    try:
        for each in overall_orders(result.dataset, train):
            stage = train.meshes[each.place].gears[0].partition(".")[0]
            numbers[order_name(stage, each.harmonic)] = MICRORADIANS * each.amplitude
    except SceneError as error:
        without[WITHOUT_ORDERS] = str(error)
    curve = [record.mesh_phase.tolist(), record.curves[OVERALL].tolist()]
    return {"numbers": numbers, "curve": curve, "seconds": seconds_of(result), **without}


def _curve(run: RunResult) -> list[list[float]]:
    """Mesh phase from 0 on, and transmission error, rad."""
    phase = run["mesh_phase"]
    return [(phase - np.floor(phase[0] + 1e-9)).tolist(), run["transmission_error"].tolist()]


def line_of(run: Run, result: RunResult) -> dict[str, Any]:
    """What is kept of a run: its numbers and, where its values ask for it, its curve; or as `failure` that it has no
    meaning."""
    worthless = [said for said in result.attrs.get("warnings", "").splitlines() if NO_MEANING in said]
    if worthless:
        return {"failure": worthless[0]}
    if not isinstance(run.scene, Scene):
        return _of_train(result)
    numbers = numbers_of(result)
    numbers[ERROR] *= 1e3 * result.attrs["base_radius_wheel"]
    return {"numbers": numbers, "curve": _curve(result) if run.values else [], "seconds": seconds_of(result)}
