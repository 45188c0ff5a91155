"""Designs to numbers: their runs over operating points and samples, computed where they are not kept, and what they
amount to."""

from __future__ import annotations

import functools
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from fenics_gears import GearsError, gear_pair, simulate
from fenics_gears.results.validity import NO_MEANING
from fenics_gears.scene.data import Output
from fenics_gears.studies.combine import record_of
from fenics_gears.studies.gear_store import own_gear_store
from fenics_gears.studies.ranks import Alone, Together
from fenics_gears.studies.study import Case, scene_key
from fenics_gears.studies.study_file import scene_of_tree
from fenics_gears.studies.work import Tick, Ticking, in_order_of_sharing
from fenics_gears.system.interruption import Interruption

from . import run_lines
from .conditions import trees_of
from .design import Bound, Design, Goal
from .goals import ERROR, OVER_FACE

UNUSABLE = 1e6
"""What the search is told instead of a goal where a design failed; one that breaks bounds is told a thousandth of it
and more."""


@dataclass(frozen=True)
class Evaluation:
    """What a design amounts to.

    `values`: of its variables; `goals`: by name, judged by the design file's statistic; `of_samples`: by name, the
        values (samples,) behind it;
    `at_points`: by name, the mean over the samples at each operating point; `violation`: of the constraints, 0 where
        all hold; `failure`: why it
    has no numbers, empty where it has.
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

    `designs`: how many of how many have been evaluated, for the progress; `computed`: runs that were computed here;
        `kept`: those that were there before, beside `others` of versions with other numbers.
    """

    def __init__(self, design: Design, directory: Path, team: Alone | Together, progress: Interruption):
        self.design, self.directory, self._team, self._progress = design, directory, team, progress
        self._lines, self.others = run_lines.kept(directory)
        self.designs, self.kept, self.computed, self.seconds = (0, 0), len(self._lines), 0, 0.0

    def of_designs(self, designs: Sequence[Mapping[str, float | str]], deviations: np.ndarray) -> list[Evaluation]:
        """Designs, by the values of their variables, under deviations (samples, scatters) in parts of their limits."""
        return self.of_trees([self.design.scene_tree(values) for values in designs], designs, deviations)

    def of_trees(
        self, trees: Sequence[Mapping[str, Any]], designs: Sequence[Mapping[str, float | str]], deviations: np.ndarray
    ) -> list[Evaluation]:
        """The same for parsed scenes; `designs` are only noted."""
        cases = [[self._case(each) for each in trees_of(self.design, tree, deviations)] for tree in trees]
        self._run([case for of_tree in cases for case in of_tree if isinstance(case, Case)], len(trees))
        return [self._evaluation(dict(values), of_tree, len(deviations)) for values, of_tree in zip(designs, cases)]

    def curves(self, trees: Sequence[Mapping[str, Any]]) -> list[np.ndarray | None]:
        """Mesh phase and transmission error (2, steps), rad, of parsed scenes; None where a run failed."""
        cases = [
            replace(case, key=f"{case.key} curve", values={"curve": ""})
            for case in map(self._case, trees)
            if isinstance(case, Case)
        ]
        self._run(cases, len(trees))
        lines = [self._lines[case.key] for case in cases]
        return (
            [np.array(line["curve"]) if "curve" in line else None for line in lines]
            if len(lines) == len(trees)
            else [None] * len(trees)
        )

    def _case(self, tree: Mapping[str, Any]) -> Case | str:
        """The run of a parsed scene, or why it is no scene."""
        scene, problems = scene_of_tree(self.design.name, tree, self.design.directory)
        if scene is None:
            return "; ".join(f"{'.'.join(problem.path)} {problem.message}".strip() for problem in problems)
        # Fields over the flanks take memory and time, and only face load factors need them.
        if not any(name in OVER_FACE for name in self._names):
            scene = replace(scene, output=Output(scene.output.root_stress, contact_fields=False))
        return Case(0, {}, scene, scene_key(scene))

    @functools.cached_property
    def _names(self) -> list[str]:
        return [
            *dict.fromkeys(
                [goal.name for goal in self.design.goals] + [bound.goal.name for bound in self.design.bounds]
            )
        ]

    def _run(self, cases: list[Case], batch: int) -> None:
        """Compute the runs of a `batch` of designs that are not kept; their processes keep them."""
        missing = list({case.key: case for case in cases if case.key not in self._lines}.values())
        if not missing:
            return
        missing, begun, done = in_order_of_sharing(missing), time.perf_counter(), 0

        def finished(index: int, result: dict[str, Any] | Exception) -> None:
            nonlocal done
            done += 1
            failed = {"failure": f"{type(result).__name__}: {result}"} if isinstance(result, Exception) else result
            self._lines[missing[index].key] = failed

        before, total = self.designs

        def tick() -> None:
            self._progress.update(before + batch * done // len(missing), max(total, before + batch))

        self._team.run(functools.partial(run_and_keep, self.directory), missing, finished, tick)
        self.computed += done
        self.seconds += time.perf_counter() - begun

    def _evaluation(self, values: dict[str, float | str], cases: list[Case | str], samples: int) -> Evaluation:
        lines = [{"failure": case} if isinstance(case, str) else self._lines[case.key] for case in cases]
        failures = [line["failure"] for line in lines if "failure" in line]
        lacking = [
            f"the run has no {name}"
            for line in lines
            if "failure" not in line
            for name in self._names
            if name not in line["numbers"]
        ]
        if failures or lacking:
            return Evaluation(values, failure=[*failures, *lacking][0])
        points = len(self.design.loads.points)
        found = {
            name: np.array([line["numbers"][name] for line in lines]).reshape(points, samples) for name in self._names
        }
        of_samples = {name: self.design.loads.combined(numbers) for name, numbers in found.items()}
        judge = self.design.tolerances.statistic
        goals = {goal.name: judge(of_samples[goal.name]) for goal in self.design.goals}
        violation = sum(
            _violation(bound, [judge(each) for each in found[bound.goal.name]]) for bound in self.design.bounds
        )
        return Evaluation(
            values, goals, of_samples, {name: each.mean(axis=1) for name, each in found.items()}, violation
        )


def _violation(bound: Bound, of_points: Sequence[float]) -> float:
    """The worst of the operating points."""
    return max(map(bound.violation, of_points))


def _curve(run) -> list[list[float]]:
    """Mesh phase from 0 on, and transmission error, rad."""
    phase = run["mesh_phase"].values
    return [(phase - np.floor(phase[0] + 1e-9)).tolist(), run["transmission_error"].values.tolist()]


def run_and_keep(directory: Path, case: Case, tick: Tick | None = None) -> dict[str, Any]:
    """Run a case and keep its line: its numbers, or as `failure` why it has none. What is no error of this program is
    not kept, so that it is tried again."""
    begun = time.perf_counter()
    try:
        run = simulate(case.scene, progress=Ticking(tick), preparation=own_gear_store().prepared)
        if not run.attrs["complete"]:
            raise KeyboardInterrupt
        if NO_MEANING in run.attrs.get("warnings", ""):
            line = {
                "key": case.key,
                "failure": next(said for said in run.attrs["warnings"].splitlines() if NO_MEANING in said),
            }
        else:
            run.attrs["wall_time"] = time.perf_counter() - begun
            numbers = record_of(run).numbers
            numbers[ERROR] *= 1e3 * gear_pair(case.scene.gears).wheel.base_radius
            line = {"key": case.key, "numbers": numbers, "curve": _curve(run) if case.values else []}
    except GearsError as error:
        line = {"key": case.key, "failure": str(error)}
    except Exception as error:
        if isinstance(error.__cause__, KeyboardInterrupt):
            raise KeyboardInterrupt from error
        raise
    run_lines.append(directory, line)
    return line
