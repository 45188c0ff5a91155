"""Settings for a target: the cheapest ones by measured errors and counted costs, checked by a run with half the size that limits them."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from fenics_gears.scene.data import Accuracy, Scene
from fenics_gears.studies.accuracy.convergence import SAFETY, ErrorCurve, largest_part, total_error
from fenics_gears.studies.accuracy.measures import distance
from fenics_gears.studies.accuracy.setting import Setting
from fenics_gears.studies.accuracy_target.trial_runs import BODY, FLANK, STEPS, Sizes, TargetNotReached, TrialRuns
from fenics_gears.system.progress import Progress

# Ratio of neighbouring sizes in the search; the best between them is at most a tenth cheaper.
RATIO = 2.0**0.25
# A check corrects errors by this factor at least.
LEAST_CORRECTION = 0.5
# Where the checked error is below this part of the target, cheaper settings are searched once more.
WELL_USED = 0.75
# Settings with less than this part of the error get no remark.
NOTABLE_PART = 0.1
# Usual number of runs until settings are chosen, for the progress bar.
USUAL_RUNS = 8
# Where a target is not reached, larger ones are tried by this factor.
REACHABLE = 1.2
MOST_LENGTHENED, MOST_REFINED, MOST_CHECKS = 4, 24, 6
SIZE_WORDS = {FLANK: "{:.3g} mm", BODY: "default x {:.2g}", STEPS: "{:.2g} of a mesh cycle"}

Arrays = Mapping[str, np.ndarray]


@dataclass(frozen=True)
class Chosen:
    """Chosen settings with their relative estimated error: `parts` by setting, `estimated_error` of all together; `runs`: how many it took."""

    accuracy: Accuracy
    setting: Setting
    estimated_error: float
    parts: dict[str, float]
    remarks: tuple[str, ...]
    runs: int


def choose(scene: Scene, target: float, progress: Progress) -> Chosen:
    """The cheapest settings that reach a relative error in T_E (L2, mean removed) and in T_EPP.

    Raises TargetNotReached where none does that fits into memory; ComputationError where a run fails.
    """
    progress.stage(f"choose settings for {100.0 * target:g} %")
    try:
        return _chosen(scene, target, _reporting_runs(scene, progress))
    except TargetNotReached as reason:
        raise TargetNotReached(
            f"accuracy.target = {100.0 * target:g} % is not reached: {reason}. Take a larger target, or give settings of your own; "
            "`gears accuracy` shows the error of each."
        ) from None


def cheapest(curves: Sequence[ErrorCurve], cost: Callable[[Arrays], np.ndarray], target: float, allowed: Callable[[Arrays], np.ndarray]) -> Sizes | None:
    """Sizes by setting; None where nothing that is `allowed` and between the curves' ends stays within `target`.

    `cost` and `allowed` take arrays of sizes by setting, as np.meshgrid makes them sparse.
    """
    axes = np.meshgrid(*[_grid(curve) for curve in curves], indexing="ij", sparse=True)
    sizes = {curve.name: axis for curve, axis in zip(curves, axes)}
    costs = np.where((total_error(curves, axes) <= target) & allowed(sizes), cost(sizes), np.inf)
    best = np.unravel_index(np.argmin(costs), costs.shape)
    if not np.isfinite(costs[best]):
        return None
    return {curve.name: float(axis.ravel()[place]) for curve, axis, place in zip(curves, axes, best)}


def _grid(curve: ErrorCurve) -> np.ndarray:
    """Sizes from the coarsest level down to the finest promised, that one included."""
    steps = int(np.floor(np.log(curve.sizes[0] / curve.finest) / np.log(RATIO) + 1e-9))
    sizes = curve.sizes[0] / RATIO ** np.arange(steps + 1)
    return sizes if sizes[-1] <= curve.finest * (1 + 1e-9) else np.append(sizes, curve.finest)


def _reporting_runs(scene: Scene, progress: Progress) -> TrialRuns:
    """Trial runs that report their progress; how many there will be is not known, for levels are added as needed."""
    at = [-1, USUAL_RUNS, ""]

    def begun(words: str) -> None:
        at[:] = at[0] + 1, max(at[0] + 2, USUAL_RUNS), words
        tick()

    def tick() -> None:
        progress.update(*at)

    return TrialRuns(scene, begun, tick)


def _chosen(scene: Scene, target: float, runs: TrialRuns) -> Chosen:
    """Choose, check, and choose again by the checked errors: finer where these are too large, cheaper where they are far below the target."""
    _lengthen_window(runs)
    accepted, sizes_accepted = None, None
    for _ in range(MOST_CHECKS):
        sizes, curves = _refined_until_reached(runs, target)
        worst = largest_part(_errors_at(curves, sizes))
        checked = _checked(runs, sizes, worst, curves)
        error = _error_together(checked, sizes)
        if error <= target and (accepted is None or runs.cost(sizes) < runs.cost(sizes_accepted)):
            settled = accepted is not None
            accepted, sizes_accepted = _result(scene, runs, sizes, checked, error), sizes
            if settled or error >= WELL_USED * target:
                break
        elif accepted is not None:
            break
    if accepted is None:
        raise TargetNotReached(f"the {worst}'s errors are still above what its levels showed after {MOST_CHECKS} checks")
    return replace(accepted, runs=runs.runs)


def _lengthen_window(runs: TrialRuns) -> None:
    """Lengthen the contact window until no contact reaches its ends."""
    for _ in range(MOST_LENGTHENED):
        if not runs.window_cuts_contact():
            return
        runs.lengthen()
    raise TargetNotReached("contact reaches the ends of the contact window however long it is")


def _refined_until_reached(runs: TrialRuns, target: float) -> tuple[Sizes, list[ErrorCurve]]:
    """The cheapest sizes; levels are added until they reach the target."""
    for _ in range(MOST_REFINED):
        curves = runs.curves()
        sizes = _cheapest(runs, curves, target)
        if sizes is not None:
            return sizes, curves
        try:
            runs.refine(largest_part({curve.name: curve.largest(curve.finest) for curve in curves}))
        except TargetNotReached as reason:
            raise TargetNotReached(f"{reason}; {_reachable(runs, target)}") from None
    raise TargetNotReached(f"not after {MOST_REFINED} halvings")


def _reachable(runs: TrialRuns, target: float) -> str:
    """The smallest target that the present levels reach, checked as a choice is, in words."""
    for larger in target * REACHABLE ** np.arange(1, 30):
        curves = runs.curves()
        sizes = _cheapest(runs, curves, larger)
        if sizes is not None and _error_together(_checked(runs, sizes, largest_part(_errors_at(curves, sizes)), curves), sizes) <= larger:
            return f"{100.0 * larger:.2g} % can be reached"
    return "nothing near it can be"


def _cheapest(runs: TrialRuns, curves: Sequence[ErrorCurve], target: float) -> Sizes | None:
    """The cheapest sizes for the whole scene's run, with a whole number of steps."""
    sizes = cheapest(curves, runs.cost, target, lambda sizes: runs.may_run(sizes, stored=True))
    return None if sizes is None else {**sizes, STEPS: 1.0 / round(1.0 / sizes[STEPS])}


def _checked(runs: TrialRuns, sizes: Sizes, name: str, curves: list[ErrorCurve]) -> list[ErrorCurve]:
    """The curves, the named setting's errors corrected by a run with half its size, the others as chosen; they are at most halved.

    Where that run is beyond the limits, by one with twice the size.
    """
    curve = next(each for each in curves if each.name == name)
    factor = 0.5 if runs.may_run({**sizes, name: 0.5 * sizes[name]}) else 2.0
    # Twice as many steps first: the chosen ones may be among them.
    other, chosen = (runs.answer(runs.setting(each)) for each in ({**sizes, name: factor * sizes[name]}, sizes))
    found = max(SAFETY * distance(chosen, other, measure) / abs(1.0 - factor**fit.used) for measure, fit in curve.fits.items())
    runs.factors[name] = curve.factor * max(found / curve.largest(sizes[name]), LEAST_CORRECTION)
    return runs.curves()


def _errors_at(curves: Sequence[ErrorCurve], sizes: Sizes) -> dict[str, float]:
    """Every setting's error, the larger of the judged measures."""
    return {curve.name: curve.largest(sizes[curve.name]) for curve in curves}


def _error_together(curves: Sequence[ErrorCurve], sizes: Sizes) -> float:
    return float(total_error(curves, [sizes[curve.name] for curve in curves]))


def _result(scene: Scene, runs: TrialRuns, sizes: Sizes, curves: list[ErrorCurve], error: float) -> Chosen:
    setting, parts = runs.setting(sizes), _errors_at(curves, sizes)
    matters = (curve for curve in curves if not curve.trusted and parts[curve.name] >= NOTABLE_PART * error)
    remarks = tuple(_remark(curve, sizes[curve.name]) for curve in matters)
    return Chosen(setting.accuracy(scene.gears.module), setting, error, parts, remarks, runs.runs)


def _remark(curve: ErrorCurve, size: float) -> str:
    leading = curve.leading
    order = "no order" if leading.order is None else f"order {leading.order:.3g}"
    # T_EPP varies irregularly with ripples of the curve; it is then given the order of the curve.
    whose = " in T_EPP alone, which is taken to have T_E's" if leading.order is not None and leading.used > leading.order else ""
    return (
        f"{curve.name}: {order} observed{whose} where {curve.expected:g} was expected; its error at {SIZE_WORDS[curve.name].format(size)} is "
        f"taken to fall as h^{leading.used:.2g}, and nothing finer than its finest run is relied on"
    )
