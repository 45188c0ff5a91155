"""An optimisation from its design file to its result: the stages, in order."""

import sys
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from fenics_gears import ComputationError
from fenics_gears.command_line import check_writable
from fenics_gears.many_runs import Alone, Interruption, Progress, Spent, Together, ranks, sole_writer
from fenics_gears.scene_text import Tree, fields, is_train, model_of_tree, number_in

from .conditions import samples
from .design import Design
from .design_file import load_design
from .evaluations import Evaluation, Evaluator
from .expected import TORQUES, VALUES, ExpectedWork, at_ends, expected_work
from .search import front, optimiser, search

RESULT = "optimization.nc"
TABLE = "designs.csv"
BEST = "best.toml"
PAGE = "report.html"
NOT_IN_A_HARRIS_MAP = ("inertia", "damping", "motion", "speed_ramp", "torque_ripple")


@dataclass
class SearchOutcome:
    """What an optimisation found.

    `before`: the scene before, `tried`: all designs in their order, `best`: the place of the chosen one, `front`:
    places of the Pareto front. `fresh`: the scene before and the chosen design under samples that the search did not
    know, where there are tolerances. `along`: by variable its values and the chosen design's evaluations there, without
    scatter. `limits`: by scatter the evaluations of the chosen design at the lower limit, without scatter and at the
    upper limit; nothing where one failed. `harris`: torques (loads,), N m, and of the scene before and the chosen one
    curves (2, steps) of mesh phase and transmission error, rad. `spent`: on the runs that were not `kept` from before.
    """

    design: Design
    directory: Path
    before: Evaluation
    tried: list[Evaluation]
    best: int
    front: list[int]
    fresh: list[Evaluation] = field(default_factory=list)
    along: dict[str, tuple[list[float | str], list[Evaluation]]] = field(default_factory=dict)
    limits: dict[str, dict[str, np.ndarray]] = field(default_factory=dict)
    harris: tuple[np.ndarray, list[list[np.ndarray | None]]] = (np.zeros(0), [])
    kept: int = 0
    spent: Spent = field(default_factory=Spent)

    @property
    def chosen(self) -> Evaluation:
        return self.tried[self.best]


def optimize(
    path: Path, output: Path | None, progress: Progress, quiet: bool = False, any_time: bool = False
) -> SearchOutcome | None:
    """Search the best design and look at it from all sides; None on every rank of an MPI job but 0. Finished runs are
    kept in `runs` of the directory, `results/<name of the design file>` unless `output`.

    Raises SceneError, before anything is computed, where the design file is wrong, or where the work takes more than
    `expected.MOST_HOURS` and not `any_time`. Raises ComputationError where the directory cannot be used or no design
    keeps the constraints, and KeyboardInterrupt at Ctrl-C.
    """
    with ranks() as team:
        if team is None:
            return None
        design = load_design(path)
        directory = output or Path("results") / design.name
        check_writable(directory, RESULT, TABLE, BEST, PAGE)
        optimiser()
        with sole_writer(directory, "runs"), Interruption(progress) as interruption:
            return _run(design, directory, team, interruption, quiet, any_time)


def _run(
    design: Design, directory: Path, team: Alone | Together, progress: Interruption, quiet: bool, any_time: bool
) -> SearchOutcome:
    evaluator = Evaluator(design, directory / "runs", team, progress)
    deviations = samples(design)
    work = expected_work(design, evaluator.runs.kept, team.size)
    if not any_time:
        work.check(design.title, team.size)
    if not quiet:
        print(_opening(design, len(deviations), evaluator, work, team.size), file=sys.stderr, flush=True)
    evaluator.runs.condense([case for end in at_ends(design)[-1:] for case in end], progress)
    progress.stage("before")
    (before,) = evaluator.of_trees([design.before], [{}], deviations)
    progress.stage("search")

    def report(count: int) -> None:
        evaluator.designs = count, design.search.evaluations
        progress.update(*evaluator.designs)

    tried = search(design, lambda designs: evaluator.of_designs(designs, deviations), report)
    evaluator.designs = 0, 0
    best = chosen(design, before, tried)
    outcome = SearchOutcome(design, directory, before, tried, best, front(tried, [goal.name for goal in design.goals]))
    progress.stage("sensitivity")
    _look_around(outcome, evaluator)
    progress.stage("Harris map")
    outcome.harris = _harris(design, evaluator, outcome.chosen)
    outcome.kept = evaluator.runs.kept
    outcome.spent = evaluator.runs.spent
    return outcome


def _opening(design: Design, count: int, evaluator: Evaluator, work: ExpectedWork, size: int) -> str:
    runs = len(design.loads.points) * count
    kept = f" {evaluator.runs.kept} runs are kept from before." if evaluator.runs.kept else ""
    if evaluator.others:
        kept += f" {evaluator.others} runs of a version of the program with other numbers are not used."
    return (
        f"{design.title}: {design.search.evaluations} designs of {len(design.variables)} variables, {runs} runs each,"
        f" and around them; {work.words(size)}.{kept}"
    )


def _broken(design: Design, tried: Evaluation) -> str:
    """Numbers of a design that are beyond their bounds, on average over its samples, and what is allowed."""
    said = []
    for bound in design.bounds:
        goal = bound.goal
        value = max(tried.at_points.get(goal.name, ()), key=bound.violation, default=None)
        if value is not None and bound.violation(value):
            ends = (("at least", bound.at_least), ("at most", bound.at_most))
            allowed = " and ".join(f"{words} {end:.4g}" for words, end in ends if np.isfinite(end))
            said.append(f"{goal.name} is {value:.4g} {goal.unit}".rstrip() + f", {allowed} allowed")
    return f" ({'; '.join(said)})" if said else ""


def chosen(design: Design, before: Evaluation, tried: Sequence[Evaluation]) -> int:
    """The place of the design with the least `score`. Raises ComputationError where none keeps the constraints."""
    allowed = [place for place, each in enumerate(tried) if each.allowed]
    if not allowed:
        failed = [each.failure for each in tried if each.failure]
        nearest = min(tried, key=lambda each: each.violation)
        why = f"the nearest one breaks the bounds by {nearest.violation:.3g} times their size{_broken(design, nearest)}"
        if failed:
            why = f"{len(failed)} failed, the first since: {failed[0]}"
        raise ComputationError(
            f"None of {len(tried)} designs keeps the constraints: {why}. Widen ranges or bounds; the runs are kept."
        )
    reference = tried[allowed[0]] if before.failure else before
    return min(allowed, key=lambda place: score(design, reference, tried[place]))


def score(design: Design, before: Evaluation, evaluation: Evaluation) -> float:
    """The weighted sum of the goals, each in parts of what it is before."""
    return sum(
        goal.weight * evaluation.goals[goal.name] / (abs(before.goals.get(goal.name, 0.0)) or 1.0)
        for goal in design.goals
    )


def _look_around(outcome: SearchOutcome, evaluator: Evaluator) -> None:
    """The chosen design with each variable over its range, and at both limits of each scatter."""
    design = outcome.design
    values = outcome.chosen.values
    count = len(design.tolerances.scatters)
    nominal = np.zeros((1, count))
    for variable in design.variables:
        evenly = {*map(variable.at, np.linspace(0.0, 1.0, VALUES)), values[variable.name]}
        places: list[Any] = [*variable.words] or sorted(evenly)
        designs = [values | {variable.name: place} for place in places]
        outcome.along[variable.name] = places, evaluator.of_designs(designs, nominal)
    if not count:
        return
    trees = [design.before, design.scene_tree(values)]
    outcome.fresh = evaluator.of_trees(trees, [{}, values], samples(design, fresh=True))
    deviations = np.concatenate([nominal, -np.eye(count), np.eye(count)])
    (evaluation,) = evaluator.of_designs([values], deviations)
    for place, scatter in enumerate(design.tolerances.scatters if not evaluation.failure else ()):
        at = [1 + place, 0, 1 + count + place]
        outcome.limits[scatter.name] = {name: numbers[at] for name, numbers in evaluation.of_samples.items()}


def _torque_of(design: Design, tree: Tree) -> float:
    """The torque (N m) on the wheel of a parsed scene, on the last shaft of a train."""
    scene = model_of_tree(design.name, tree, design.directory).scene
    return 1e-3 * (scene.output_torque if is_train(tree) else scene.load.wheel_torque)


def _path_of_torque(design: Design) -> tuple[str, ...]:
    """The field of that torque."""
    if not is_train(design.tree):
        return "load", "wheel_torque"
    return model_of_tree(design.name, design.tree, design.directory).scene.path_of_output_torque


def _harris(design: Design, evaluator: Evaluator, best: Evaluation) -> tuple[np.ndarray, list[list[np.ndarray | None]]]:
    """Quasi-static transmission errors over the torque of the scene before and of the chosen design."""
    path = _path_of_torque(design)
    trees = [design.before, design.scene_tree(best.values)]
    torques = sorted({number_in(point[path], "N m") for point in design.loads.points if path in point})
    if len(torques) < 2:
        torques = [part * (torques or [_torque_of(design, trees[1])])[0] for part in TORQUES]
    loaded: list[Any] = []
    for tree in trees:
        for section in NOT_IN_A_HARRIS_MAP:
            tree = fields.changed(tree, (section,), fields.ABSENT)
        loaded += [fields.changed(tree, path, f"{torque:.9g} N m") for torque in torques]
    curves = evaluator.curves(loaded)
    return np.array(torques), [curves[: len(torques)], curves[len(torques) :]]
