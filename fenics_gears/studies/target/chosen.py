"""Settings for a target: chosen by measured errors and times, then checked by a run that halves the knob that limits them."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from fenics_gears.progress import Progress
from fenics_gears.scene.data import Accuracy, Scene
from fenics_gears.studies.accuracy.ladder import Setting
from fenics_gears.studies.accuracy.measures import distance
from fenics_gears.studies.accuracy.whole import dominant
from fenics_gears.studies.target.choice import Sizes, cheapest, error_together, errors_at
from fenics_gears.studies.target.error_curve import SAFETY, ErrorCurve
from fenics_gears.studies.target.errors import TargetNotReached
from fenics_gears.studies.target.pilot import BODY, FLANK, STEPS, Pilot

# A check corrects a knob's errors by this factor at least.
LEAST_CORRECTION = 0.5
# Where a check leaves more of the target than this unused, cheaper settings are looked for once more.
WELL_USED = 0.75
# A knob with less than this part of the error needs no remark.
NOTABLE_PART = 0.1
# Runs until settings are chosen, about.
USUAL_RUNS = 14
# Larger targets are tried in these steps where one is not reached.
REACHABLE = 1.2
MOST_LENGTHENED, MOST_REFINED, MOST_CHECKS = 4, 24, 6
SIZE_WORDS = {FLANK: "{:.3g} mm", BODY: "default x {:.2g}", STEPS: "{:.2g} of a mesh cycle"}


@dataclass(frozen=True)
class Chosen:
    """Settings with what they are expected to err by, relative: `parts` by knob, `estimated_error` all together; `runs` that it took."""

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
        return _chosen(scene, target, _told_pilot(scene, progress))
    except TargetNotReached as reason:
        raise TargetNotReached(
            f"accuracy.target = {100.0 * target:g} % is not reached: {reason}. Take a larger target, or give settings of your own; "
            "`gears accuracy` shows what each gains."
        ) from None


def _chosen(scene: Scene, target: float, pilot: Pilot) -> Chosen:
    """Choose, check, choose again with what the check found: finer where errors are larger, cheaper where much of the target is left."""
    _lengthen_window(pilot)
    factors: dict[str, float] = {}
    accepted = None
    for _ in range(MOST_CHECKS):
        sizes, curves = _refined_until_reached(pilot, target, factors)
        worst = dominant(errors_at(curves, sizes))
        _check(pilot, sizes, worst, curves, factors)
        checked = [_corrected(curve, factors) for curve in curves]
        together = error_together(checked, sizes)
        if together <= target and (accepted is None or _cheaper(pilot, sizes, accepted.setting)):
            settled = accepted is not None
            accepted = _told(scene, pilot, sizes, checked, together)
            if settled or together >= WELL_USED * target:
                break
        elif accepted is not None:
            break
    if accepted is None:
        raise TargetNotReached(f"the {worst}'s errors are still above what its rungs told after {MOST_CHECKS} checks")
    return replace(accepted, runs=pilot.runs)


def _cheaper(pilot: Pilot, sizes: Sizes, setting: Setting) -> bool:
    """Whether sizes take less time than a setting, as both ran."""
    return sum(pilot.run(pilot.setting(sizes)).seconds.values()) < sum(pilot.run(setting).seconds.values())


def _told(scene: Scene, pilot: Pilot, sizes: Sizes, curves: list[ErrorCurve], together: float) -> Chosen:
    setting = pilot.setting(sizes)
    parts = errors_at(curves, sizes)
    matters = (curve for curve in curves if not curve.trusted and parts[curve.name] >= NOTABLE_PART * together)
    remarks = tuple(_remark(curve, sizes[curve.name]) for curve in matters)
    return Chosen(setting.accuracy(scene.gears.module), setting, together, parts, remarks, pilot.runs)


def _told_pilot(scene: Scene, progress: Progress) -> Pilot:
    """A pilot that tells how far it is: how many runs there will be is not known, for ladders grow as they need to."""
    at = [-1, USUAL_RUNS, ""]

    def begun(words: str) -> None:
        at[:] = at[0] + 1, max(at[0] + 2, USUAL_RUNS), words
        tick()

    def tick() -> None:
        progress.update(*at)

    return Pilot(scene, begun, tick)


def _lengthen_window(pilot: Pilot) -> None:
    """Make the contact window so long that no contact reaches its ends: nothing is left out then."""
    for _ in range(MOST_LENGTHENED):
        if not pilot.window_cuts_contact():
            return
        pilot.lengthen()
    raise TargetNotReached("contact reaches the ends of the contact window however long it is")


def _refined_until_reached(pilot: Pilot, allowance: float, factors: dict[str, float]) -> tuple[Sizes, list[ErrorCurve]]:
    """The cheapest sizes, by ladders that were made longer where they had to be."""
    for _ in range(MOST_REFINED):
        curves = [_corrected(curve, factors) for curve in pilot.curves()]
        sizes = cheapest(curves, pilot.cost(), allowance, _allowed(pilot))
        if sizes is not None:
            return sizes, curves
        try:
            pilot.refine(dominant({curve.name: curve.largest(curve.finest) for curve in curves}))
        except TargetNotReached as reason:
            raise TargetNotReached(f"{reason}; {_reachable(pilot, curves, allowance)}") from None
    raise TargetNotReached(f"not after {MOST_REFINED} halvings")


def _reachable(pilot: Pilot, curves: list[ErrorCurve], target: float) -> str:
    """What the same runs say can be reached."""
    for larger in target * REACHABLE ** np.arange(1, 30):
        if cheapest(curves, pilot.cost(), larger, _allowed(pilot)) is not None:
            return f"{100.0 * larger:.2g} % can be"
    return "nothing near it can be"


def _allowed(pilot: Pilot):
    """Settings that stay within memory, their result too."""
    return lambda sizes: pilot.may_run(sizes, stored=True)


def _check(pilot: Pilot, sizes: Sizes, name: str, curves: list[ErrorCurve], factors: dict[str, float]) -> None:
    """Correct a knob's errors by one run that halves it at the chosen sizes; they are not made less than half of what they were.

    Where that run is beyond the limits, by one that doubles it.
    """
    curve = next(each for each in curves if each.name == name)
    finer = {**sizes, name: 0.5 * sizes[name]}
    factor = 0.5 if pilot.may_run(finer) else 2.0
    chosen, other = (pilot.run(pilot.setting(each)).answer for each in (sizes, {**sizes, name: factor * sizes[name]}))
    found = max(SAFETY * distance(chosen, other, measure) / abs(1.0 - factor**fit.used) for measure, fit in curve.fits.items())
    factors[name] = curve.factor * max(found / curve.largest(sizes[name]), LEAST_CORRECTION)


def _corrected(curve: ErrorCurve, factors: dict[str, float]) -> ErrorCurve:
    return replace(curve, factor=factors.get(curve.name, 1.0))


def _remark(curve: ErrorCurve, size: float) -> str:
    leading = curve.leading
    order = "no order" if leading.order is None else f"order {leading.order:.3g}"
    # Heights of curves jump where a corner falls between steps, and then have the curve's order.
    whose = " in T_EPP alone, which is taken to have T_E's" if leading.order is not None and leading.used > leading.order else ""
    return (
        f"{curve.name}: {order} observed{whose} where {curve.expected:g} was expected; its error at {SIZE_WORDS[curve.name].format(size)} is "
        f"taken to fall as h^{leading.used:.2g}, and nothing finer than its finest run is relied on"
    )
