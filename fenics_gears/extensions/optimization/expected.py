"""How many runs an optimisation takes, and how long: said before it starts, refused where it is a day's work."""

from contextlib import suppress
from dataclasses import dataclass
from math import ceil

import numpy as np

from fenics_gears import SceneError, expected_cost
from fenics_gears.command_line import seconds_in_words
from fenics_gears.many_runs import (
    BODY,
    CommonWindows,
    Run,
    gear_tasks,
    most_together,
    operators_key,
    run_of,
    solved_at_once,
)
from fenics_gears.scene_text import GEARS, NoScene, model_of_tree

from .conditions import FRESH, trees_of
from .design import Design

MOST_HOURS = 8.0
# Of a run by itself, without its march: seconds, and positions between steps at which extremes need operators (measured
# on the paper's pair and on a helical one).
TIME_OF_A_RESULT = 0.015
EXTREMES = 10
# Seconds of runs that are solved together, without their march: of each, and of a task of them. Measured on the paper's
# pair with its march of 1.6 ms: 2.7 ms a run where a task has 32, 6.7 ms of 8, 10 ms of 4.
TIME_OF_NUMBERS = 0.001
TIME_OF_A_TASK = 0.02
# Of a run over the face that has the contact operators of an earlier run, by itself and together with others: seconds,
# and its march with its numbers in parts of a march; both with friction. Measured on a helical pair of 870 to 1,880
# contact nodes, within 1.5 times.
ALONE_OVER_FACE = (0.02, 1.4)
TOGETHER_OVER_FACE = (0.005, 0.56)
WITH_FRICTION = 2.0
# Marches until rolling bearings are as stiff as their loads make them.
ON_ROLLING_BEARINGS = 3.0
# Values of a variable at which the chosen design's goals are evaluated, over its whole range.
VALUES = 9
# Torques of the Harris map where the operating points have one, in parts of it.
TORQUES = (0.25, 0.5, 0.75, 1.0, 1.25, 1.5)


@dataclass(frozen=True)
class ExpectedWork:
    """The most runs of an optimisation that are not kept yet, and their seconds on one core of an idle machine; None
    where the ends of the variables make no scenes."""

    runs: int
    seconds: float | None

    def words(self, processes: int) -> str:
        by = f" by {processes} processes" if processes > 1 else ""
        if self.seconds is None:
            return f"up to {self.runs} runs"
        return f"up to {self.runs} runs, about {seconds_in_words(self.seconds / processes)}{by} on an idle machine"

    def check(self, title: str, processes: int) -> None:
        """Raise SceneError where it takes too long."""
        if self.seconds is not None and self.seconds / processes > 3600.0 * MOST_HOURS:
            raise SceneError(
                f"{title}: {self.words(processes)}. Allowed without being asked for: {MOST_HOURS:g} h. Nothing was"
                " computed. Take fewer evaluations, samples or operating points, coarser settings or more processes;"
                " or add --yes."
            )


def expected_work(design: Design, kept: int, processes: int = 1) -> ExpectedWork:
    """Of a design file of which so many runs are kept."""
    points = len(design.loads.points)
    samples = design.tolerances.samples
    scatters = len(design.tolerances.scatters)
    designs = 1 + design.search.evaluations
    along = sum(len(each.words) or VALUES + 1 for each in design.variables)
    around = 2 * FRESH * samples + 1 + 2 * scatters if scatters else 0
    runs = max(points * (designs * samples + along + around) + 2 * len(TORQUES) - kept, 0)
    ends = at_ends(design)
    if not ends:
        return ExpectedWork(runs, None)
    cases = [case for end in ends for case in end]
    costs = [expected_cost(model) for case in cases for model in case.model.models]
    marching, building, condensing = (
        sum(getattr(cost, name) or 0.0 for cost in costs) / len(cases)
        for name in ("marching", "building", "condensing")
    )
    tasks = len(gear_tasks(cases))
    bodies = 1 if tasks == len(gear_tasks(ends[0])) else designs
    first = marching - building
    model = cases[0].model.models[0]
    position = building / model.resolution.steps_per_mesh_cycle
    operators = len({_operators(case) for case in cases})
    together = solved_at_once([end[0].model for end in ends], design.asked)
    if model.scene.three_dimensional:
        own, march = TOGETHER_OVER_FACE if together else ALONE_OVER_FACE
        again = (own + march * first) * (WITH_FRICTION if model.scene.friction else 1.0)
        again *= ON_ROLLING_BEARINGS if model.drivetrain.rolling is not None else 1.0
        made = designs * points if bodies > 1 else operators * processes
        seconds = runs * again + min(made, runs) * (building + EXTREMES * position + first)
    elif together:
        in_a_task = most_together(design.search.population * points * samples, processes)
        seconds = runs * (TIME_OF_NUMBERS + TIME_OF_A_TASK / in_a_task + first)
    else:
        shared = operators == len({_operators(case) for case in ends[0]})
        seconds = runs * (TIME_OF_A_RESULT + EXTREMES * position + first + (0.0 if shared else building))
    pairs = ceil(sum(task.part == BODY for task in gear_tasks(ends[0])) / len(GEARS))
    return ExpectedWork(runs, seconds + (bodies * pairs * condensing if runs else 0.0))


def _operators(case: Run) -> tuple:
    """What the contact operators of all meshes of a run depend on."""
    return tuple(operators_key(model) for model in case.model.models)


def at_ends(design: Design) -> list[list[Run]]:
    """The scenes with all variables at the beginning and at the end of their ranges, where they are scenes: each at all
    operating points."""
    ends = []
    nominal = np.zeros((1, len(design.tolerances.scatters)))
    for end in (0, -1):
        values = {each.name: (each.words or (each.low, each.high))[end] for each in design.variables}
        # All variables at their ends together may be gears that cannot be.
        with suppress(NoScene):
            trees = trees_of(design, design.scene_tree(values), nominal)
            ends.append([model_of_tree(design.name, tree, design.directory) for tree in trees])
    runs = map(run_of, CommonWindows().of([model for end in ends for model in end]))
    return [[next(runs) for _ in end] for end in ends]
