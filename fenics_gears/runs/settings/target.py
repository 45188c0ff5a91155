"""Settings for a target: errors are estimated at coarse sizes, sizes of least counted cost follow from them by order
2."""

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, replace
from math import ceil, sqrt
from typing import Any

import numpy as np

from fenics_gears.results.numbers import ESTIMATED
from fenics_gears.scene.accuracy import RESOLVED
from fenics_gears.scene.data import Scene
from fenics_gears.system.progress import Progress

from .convergence import EXPECTED_ORDER, SAFETY_OF_TWO
from .trial_runs import COARSER, MESH, SLICES, STEPS, Sizes, TargetNotReached, TrialRuns, Trials

# Sizes at which errors are estimated first for a target of 1 %.
FIRST_MESH = 2.5
FIRST_STEPS = 60.0
# In the plane: twice a mesh of 2.5 has 0.6 elements in the Hertz half-width, and the change from there says nothing of
# 1 % (measured 1.2 % where 0.95 % were expected).
FIRST_PLANE_MESH = 1.8
# Over the face: the fewest slices of the first trial runs. From ten and five the change says too much.
FEWEST_SLICES = 16
# Steps over the face for a target of 1 %, where they know nothing of one another: line loads are averaged over them.
# From 20 to 100 steps the mean changes by 0.25 %.
FACE_STEPS = 28.0
# In the search for the cheapest a mesh becomes finer, steps become more by this factor.
RATIO = 2.0 ** (1.0 / 6.0)
# Sizes finer than the trial runs' by more than this factor are not trusted: new trial runs have sizes coarser by the
# second factor.
EXTRAPOLATED = 2.5
COARSER_FIRST = 1.5
MOST_ROUNDS = 6
# In the search a finer size counts as dearer by this part at least.
LEAST_DEARER = 1e-6
# Error of the peak pressure with one flank element in the Hertz half-width. It falls with order 2 to some per cent with
# two; more than two are not asked for.
PRESSURE_ERROR = 0.18
# Usual number of runs until settings are chosen, for the progress bar.
USUAL_RUNS = 3
# Where a target is not reached, larger ones are tried by this factor.
REACHABLE = 1.2

Errors = dict[str, np.ndarray]


@dataclass(frozen=True)
class Chosen:
    """A chosen setting, of one pair or of meshes together, with its relative estimated error in the measure that is
    worst: `parts` by setting, `estimated_error` of all together; `runs`: how many it took."""

    setting: Any
    parts: dict[str, float]
    runs: int

    @property
    def estimated_error(self) -> float:
        """Root of the sum of squares: the parts have nothing to do with one another."""
        return sqrt(sum(part**2 for part in self.parts.values()))

    def attributes(self, target: float) -> dict[str, Any]:
        """What a result says of it."""
        parts = {f"{ESTIMATED}{name}": part for name, part in self.parts.items()}
        return {"target": target, "estimated_error": self.estimated_error, **parts, "target_runs": self.runs}


def choose(scene: Scene, target: float, progress: Progress) -> Chosen:
    """The cheapest settings that reach a relative error in T_E (L2, mean removed) and in T_EPP, over the face also in
    line load and load factors. Raises TargetNotReached where none does within the limits; ComputationError where a run
    fails."""
    return chosen_by(lambda *told: TrialRuns(scene, *told), target, progress)


def chosen_by(trials: Callable[..., Trials], target: float, progress: Progress) -> Chosen:
    """As `choose`, by `trials(begun, tick)`."""
    progress.stage(f"choose settings for {100.0 * target:g} %")
    done = -1
    now = ""

    def begun(words: str) -> None:
        nonlocal done, now
        done = done + 1
        now = words
        tick()

    def tick() -> None:
        progress.update(done, max(done + 1, USUAL_RUNS), now)

    try:
        chosen = _chosen(trials(begun, tick), target)
        progress.update(chosen.runs, chosen.runs)
        return chosen
    except TargetNotReached as reason:
        raise TargetNotReached(
            f"accuracy.target = {100.0 * target:g} % is not reached: {reason}. Take a larger target, or give settings"
            " of your own; `gears accuracy` shows the error of each."
        ) from None


def _chosen(runs: Trials, target: float) -> Chosen:
    """Estimate errors and choose; once more from finer sizes where the chosen ones are much finer."""
    tried = _within_limits(runs, first_sizes(target, runs))
    for _ in range(MOST_ROUNDS):
        errors = runs.errors(tried)
        sizes = _cheapest(runs, tried, errors, target)
        if (
            tried.mesh <= EXTRAPOLATED * sizes.mesh
            and sizes.steps <= EXTRAPOLATED * tried.steps
            and sizes.slices <= EXTRAPOLATED * tried.slices
        ):
            setting = runs.setting(_resolving(runs, sizes, target))
            return Chosen(setting, _of_worst(errors_at(tried, errors, sizes)), runs.runs)
        tried = Sizes(
            min(COARSER_FIRST * sizes.mesh, tried.mesh),
            max(round_steps(sizes.steps / COARSER_FIRST, runs.step_unit), tried.steps),
            max(even(sizes.slices / COARSER_FIRST), tried.slices),
        )  # fmt: skip
    raise TargetNotReached(f"errors do not fall with order 2 down to {runs.setting(tried).words}")


def _resolving(runs: Trials, sizes: Sizes, target: float) -> Sizes:
    """These sizes with a mesh that resolves the contact as well as the target asks for pressures. Where that is beyond
    the limits the sizes stay, and a warning of the run says so."""
    elements = min(RESOLVED, sqrt(PRESSURE_ERROR / target))
    finer = replace(sizes, mesh=min(sizes.mesh, runs.resolving_mesh(elements)))
    with suppress(TargetNotReached):
        runs.cost(finer)
        return finer
    return sizes


def _squares(errors: Errors) -> np.ndarray:
    return np.sum([parts**2 for parts in errors.values()], axis=0)


def _of_worst(errors: Errors) -> dict[str, float]:
    worst = int(np.argmax(_squares(errors)))
    return {name: float(np.ravel(parts)[worst]) for name, parts in errors.items()}


def first_sizes(target: float, runs: Trials) -> Sizes:
    """Sizes of the first trial runs: in the plane somewhat coarser than those that will be chosen, over the face those
    that the expected errors ask for."""
    finer = sqrt(0.01 / target)
    by_target = FIRST_STEPS if runs.steps_matter else FACE_STEPS if runs.slices else 0.0
    steps = round_steps(max(by_target * finer, runs.fewest_steps), runs.step_unit)
    plane = max(min(FIRST_MESH / finer, FIRST_PLANE_MESH), min(FIRST_PLANE_MESH / finer, FIRST_MESH))
    if not runs.slices:
        return Sizes(plane, steps)
    mesh, slices = (SAFETY_OF_TWO * sqrt(2.0) * runs.expected[part] / target for part in (MESH, SLICES))
    return Sizes(
        min(mesh ** (-1.0 / EXPECTED_ORDER), FIRST_PLANE_MESH),
        steps,
        max(even(runs.slices * slices ** (1.0 / EXPECTED_ORDER)), FEWEST_SLICES),
    )


def even(number: float) -> int:
    """An even whole number from this on: half of it is whole."""
    return 2 * ceil(0.5 * number - 1e-9)


def _within_limits(runs: Trials, sizes: Sizes) -> Sizes:
    """These sizes, or a coarser mesh where they are beyond the limits; raises TargetNotReached where all are."""
    try:
        runs.cost(sizes)
    except TargetNotReached:
        if sizes.mesh >= FIRST_MESH:
            raise
        return _within_limits(runs, replace(sizes, mesh=COARSER_FIRST * sizes.mesh))
    return sizes


def round_steps(steps: float, unit: int) -> int:
    """A number of steps in a mesh cycle from this on, a multiple of the unit."""
    return max(unit * ceil(steps / unit - 1e-9), unit)


def errors_at(tried: Sizes, errors: Errors, sizes: Sizes) -> Errors:
    """Errors at other sizes than the tried ones: of order 2."""
    ratios = {
        MESH: sizes.mesh / tried.mesh,
        STEPS: tried.steps / sizes.steps,
        SLICES: tried.slices / (sizes.slices or 1),
    }
    return {name: error * ratios[name] ** EXPECTED_ORDER for name, error in errors.items()}


def _cheapest(runs: Trials, tried: Sizes, errors: Errors, target: float) -> Sizes:
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


def search(runs: Trials, tried: Sizes, errors: Errors, target: float) -> Sizes:
    """The sizes of about least cost within the limits, mesh and steps not coarser than those tried, slices than half of
    them; raises TargetNotReached.

    From the coarsest on, the size with the largest drop in error for its cost is made finer, one step after the other.
    Then sizes are made coarser again as far as the target allows.
    """
    # Twice the mesh and half the steps may be near the finer run by luck: of meshes between the two, one in a hundred
    # erred by more than its target.
    coarsest = replace(tried, slices=tried.slices // COARSER)

    def excess(sizes: Sizes) -> float:
        return float(np.maximum(_squares(errors_at(tried, errors, sizes)) - target**2, 0.0).sum())

    sizes = coarsest
    least = runs.cost(sizes)
    left = excess(sizes)
    while left > 0.0:
        best = None
        refused = ""
        for finer in _finer(sizes, errors, runs.step_unit):
            try:
                cost = runs.cost(finer)
            except TargetNotReached as reason:
                refused = refused or str(reason)
                continue
            worth = (left - excess(finer)) / max(cost - least, LEAST_DEARER * least)
            if best is None or worth > best[0]:
                best = worth, cost, finer
        if best is None or not best[0] > 0.0:
            raise TargetNotReached(refused)
        _, least, sizes = best
        left = excess(sizes)
    while True:
        allowed = [each for each in _coarser(sizes, coarsest, runs.step_unit) if not excess(each)]
        cost, _, cheaper = min(
            ((runs.cost(each), place, each) for place, each in enumerate(allowed)), default=(least, 0, sizes)
        )
        if cost >= least:
            return sizes
        least = cost
        sizes = cheaper


def _finer(sizes: Sizes, errors: Errors, step_unit: int) -> list[Sizes]:
    finer = {
        MESH: replace(sizes, mesh=sizes.mesh / RATIO),
        STEPS: replace(sizes, steps=round_steps(RATIO * sizes.steps, step_unit)),
        SLICES: replace(sizes, slices=sizes.slices + 2),
    }
    return [finer[name] for name in errors]


def _coarser(sizes: Sizes, coarsest: Sizes, step_unit: int) -> list[Sizes]:
    coarser = [
        replace(sizes, mesh=min(RATIO * sizes.mesh, coarsest.mesh)),
        replace(sizes, steps=max(sizes.steps - step_unit, coarsest.steps)),
        replace(sizes, slices=max(sizes.slices - 2, coarsest.slices)),
    ]
    return [each for each in coarser if each != sizes]
