"""Settings for a target: errors are estimated at coarse sizes, sizes of least counted cost follow from them by order
2."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass, replace
from math import ceil, inf, sqrt

import numpy as np

from fenics_gears.errors import ComputationError
from fenics_gears.scene.data import Accuracy, Scene
from fenics_gears.studies.accuracy.convergence import EXPECTED_ORDER
from fenics_gears.studies.accuracy.setting import Setting
from fenics_gears.studies.accuracy.trial_runs import (
    FEWEST_STEPS,
    MESH,
    SLICES,
    STEPS,
    Sizes,
    TargetNotReached,
    TrialRuns,
)
from fenics_gears.system.progress import Progress

# Sizes at which errors are estimated first for a target of 1 %; over the face the mesh also for larger ones.
FIRST_MESH, FIRST_STEPS = 2.5, 60.0
# In the plane: twice a mesh of 2.5 has 0.6 elements in the Hertz half-width, and the change from there says nothing of
# 1 % (1.2 % was seen where 0.95 % were expected).
FIRST_PLANE_MESH = 1.8
# Over the face the first mesh of larger targets is coarser, up to that of this part.
COARSEST_FIRST = 0.7
# Slices of the first trial runs for a target of 1 %, in the default number; at least the second, whose half has half
# the layers: with the fewest layers in both runs, what layers leave would not be seen.
FIRST_SLICES, FEWEST_SLICES = 0.7, 10
# Ratio of neighbouring numbers of slices in the search for the cheapest, and how many there are.
RATIO_OF_SLICES, SLICINGS = 2.0**0.25, 13
# Steps in a mesh cycle are multiples of this, so that curves of different runs have phases in common.
ROUND_STEPS = 20
# Ratio of neighbouring meshes in the search for the cheapest, and how many there are: down to 1/32 of the tried one.
RATIO, MESHES = 2.0 ** (1.0 / 6.0), 31
# Sizes finer by more than this factor than those of the trial runs are not trusted: new trial runs with sizes coarser
# by the second factor.
EXTRAPOLATED, COARSER_FIRST = 2.5, 1.5
MOST_ROUNDS = 6
# The search ends where costs have risen by this factor above the least.
DEARER = 1.5
# Usual number of runs until settings are chosen, for the progress bar.
USUAL_RUNS = 3
# Where a target is not reached, larger ones are tried by this factor.
REACHABLE = 1.2

Errors = dict[str, np.ndarray]


@dataclass(frozen=True)
class Chosen:
    """Chosen settings with their relative estimated error in the measure that is worst: `parts` by setting,
    `estimated_error` of all together; `runs`: how many it took."""

    accuracy: Accuracy
    setting: Setting
    parts: dict[str, float]
    runs: int

    @property
    def estimated_error(self) -> float:
        """The parts' sum: they might cancel, but would not at another load or speed."""
        return sum(self.parts.values())


def choose(scene: Scene, target: float, progress: Progress) -> Chosen:
    """The cheapest settings that reach a relative error in T_E (L2, mean removed) and in T_EPP, over the face also in
    line load and load factors.

    Raises TargetNotReached where none does within the limits; ComputationError where a run fails.
    """
    progress.stage(f"choose settings for {100.0 * target:g} %")
    try:
        return _chosen(_reporting_runs(scene, progress), scene.gears.module, target)
    except TargetNotReached as reason:
        raise TargetNotReached(
            f"accuracy.target = {100.0 * target:g} % is not reached: {reason}. Take a larger target, or give settings"
            " of your own; `gears accuracy` shows the error of each."
        ) from None


def settings_of(
    scene: Scene, targets: tuple[float, ...], progress: Progress, failures: list[tuple[str, str]]
) -> dict[str, tuple[Setting, float]]:
    """By name the settings that targets choose, with the targets; those that none reaches join the failures."""
    found = {}
    for target in targets:
        name = f"target {100.0 * target:g} %"
        try:
            found[name] = choose(scene, target, progress).setting, target
        except ComputationError as error:
            failures.append((name, str(error).splitlines()[0]))
    return found


def _reporting_runs(scene: Scene, progress: Progress) -> TrialRuns:
    """Trial runs that report their progress; there are three, unless the first are too coarse."""
    done, now = -1, ""

    def begun(words: str) -> None:
        nonlocal done, now
        done, now = done + 1, words
        tick()

    def tick() -> None:
        progress.update(done, max(done + 1, USUAL_RUNS), now)

    return TrialRuns(scene, begun, tick)


def _chosen(runs: TrialRuns, module: float, target: float) -> Chosen:
    """Estimate errors and choose; once more from finer sizes where the chosen ones are much finer."""
    tried = _within_limits(runs, first_sizes(target, runs.fewest_steps, runs.steps_matter, runs.slices))
    for _ in range(MOST_ROUNDS):
        errors = runs.errors(tried)
        sizes = _cheapest(runs, tried, errors, target)
        if (
            tried.mesh <= EXTRAPOLATED * sizes.mesh
            and sizes.steps <= EXTRAPOLATED * tried.steps
            and sizes.slices <= EXTRAPOLATED * tried.slices
        ):
            setting = runs.setting(sizes)
            return Chosen(setting.accuracy(module), setting, _of_worst(errors_at(tried, errors, sizes)), runs.runs)
        tried = Sizes(
            min(COARSER_FIRST * sizes.mesh, tried.mesh),
            max(round_steps(sizes.steps / COARSER_FIRST), tried.steps),
            max(even(sizes.slices / COARSER_FIRST), tried.slices),
        )  # fmt: skip
    raise TargetNotReached(f"errors do not fall with order 2 down to {runs.setting(tried).words}")


def _of_worst(errors: Errors) -> dict[str, float]:
    """The parts of the error in the measure in which their sum is largest."""
    worst = int(np.argmax(sum(errors.values())))
    return {name: float(np.ravel(parts)[worst]) for name, parts in errors.items()}


def first_sizes(target: float, fewest_steps: int, steps_matter: bool, slices: int = 0) -> Sizes:
    """Sizes of the first trial runs, somewhat coarser than those that will be chosen; `slices`: the default number, 0
    in the plane."""
    finer = sqrt(0.01 / target)
    steps = round_steps(max(FIRST_STEPS * finer, fewest_steps) if steps_matter else fewest_steps)
    plane = max(min(FIRST_MESH / finer, FIRST_PLANE_MESH), min(FIRST_PLANE_MESH / finer, FIRST_MESH))
    return Sizes(
        FIRST_MESH / max(finer, COARSEST_FIRST) if slices else plane,
        steps,
        max(even(FIRST_SLICES * finer * slices), FEWEST_SLICES) if slices else 0,
    )


def even(number: float) -> int:
    """An even whole number from this on: half of it is whole."""
    return 2 * ceil(0.5 * number - 1e-9)


def _within_limits(runs: TrialRuns, sizes: Sizes) -> Sizes:
    """These sizes, or a coarser mesh where they are beyond the limits; raises TargetNotReached where all are."""
    try:
        runs.cost(sizes)
    except TargetNotReached:
        if sizes.mesh >= FIRST_MESH:
            raise
        return _within_limits(runs, replace(sizes, mesh=COARSER_FIRST * sizes.mesh))
    return sizes


def round_steps(steps: float) -> int:
    """A number of steps in a mesh cycle from this on."""
    return max(ROUND_STEPS * ceil(steps / ROUND_STEPS - 1e-9), FEWEST_STEPS)


def errors_at(tried: Sizes, errors: Errors, sizes: Sizes) -> Errors:
    """Errors at other sizes than the tried ones: of order 2."""
    ratios = {
        MESH: sizes.mesh / tried.mesh,
        STEPS: tried.steps / sizes.steps,
        SLICES: tried.slices / (sizes.slices or 1),
    }
    return {name: error * ratios[name] ** EXPECTED_ORDER for name, error in errors.items()}


def _cheapest(runs: TrialRuns, tried: Sizes, errors: Errors, target: float) -> Sizes:
    """The cheapest sizes; raises TargetNotReached with the target that can be reached instead."""
    try:
        return search(runs, tried, errors, target)
    except TargetNotReached as reason:
        reachable = "nothing near it can be"
        for larger in (target * REACHABLE**times for times in range(30, 0, -1)):
            with suppress(TargetNotReached):
                search(runs, tried, errors, larger)
                reachable = f"{100.0 * larger:.2g} % can be reached"
        raise TargetNotReached(f"{reason}; {reachable}") from None


def search(runs: TrialRuns, tried: Sizes, errors: Errors, target: float) -> Sizes:
    """The sizes of least cost within the limits, none coarser than those tried; raises TargetNotReached."""
    best, least, refused = None, inf, ""
    for mesh in (tried.mesh / RATIO**place for place in range(MESHES)):
        left = target - errors[MESH] * (mesh / tried.mesh) ** 2
        if np.all(left > 0.0):
            cost = inf
            for sizes in _beside(mesh, tried, errors, left):
                try:
                    its_cost = runs.cost(sizes)
                except TargetNotReached as reason:
                    its_cost, refused = inf, refused or str(reason)
                if its_cost < least:
                    best, least = sizes, its_cost
                # With more slices fewer steps are needed, so that costs fall before they rise.
                if its_cost > DEARER * cost:
                    break
                cost = min(cost, its_cost)
            if cost > DEARER * least:
                break
    if best is None:
        raise TargetNotReached(refused or "no mesh is fine enough")
    return best


def _beside(mesh: float, tried: Sizes, errors: Errors, left: np.ndarray) -> Iterator[Sizes]:
    """Sizes with a mesh and as many slices and steps as what is `left` of the error for them asks for, from the fewest
    slices on."""
    slicings = [tried.slices * RATIO_OF_SLICES**place for place in range(SLICINGS)] if tried.slices else [0.0]
    for slices in map(even, slicings):
        for_steps = left - (errors.get(SLICES, 0.0) * (tried.slices / slices) ** 2 if slices else 0.0)
        if np.all(for_steps > 0.0):
            of_steps = float(np.max(errors.get(STEPS, 0.0) / for_steps))
            yield Sizes(mesh, round_steps(tried.steps * max(1.0, sqrt(of_steps))), slices)
            if not of_steps:
                return
