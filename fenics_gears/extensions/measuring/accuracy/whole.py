"""Whole settings: a path of them from coarse to fine, and the Pareto front. Errors may cancel in one run and add up at
another load or speed. So the total error of a whole setting is the sum of its parts' errors, each measured with the
others fine, or its own distance from the reference where that is larger."""

from collections.abc import Mapping, Sequence
from functools import reduce

from fenics_gears import ComputationError, Scene, expected_cost, model_of
from fenics_gears.many_runs import Progress
from fenics_gears.measuring import Setting, choose

from .convergence import largest_part
from .refinement import FAMILY, LENGTH, OF_FAMILY, Refinement

# The path keeps a setting when its error is below this part of the error of the last one kept.
KEPT_PART = 0.7
MOST_KEPT = 9
# Halving flank elements and contact nodes costs most, so that it waits until this part of their error is the largest.
WAITS = {FAMILY: 0.5}
# What is well below 0.1 % is not looked for.
ENOUGH = 0.0008
# Contact operators of a mesh cycle are held all at once; larger ones are not tried.
MOST_BYTES = 1.8e9

Errors = Mapping[tuple[str, int], float]


def total_error(direct: float, parts: Mapping[str, float]) -> float:
    return max(direct, sum(parts.values()))


def parts_of(setting: Setting, refinements: Sequence[Refinement], errors: Errors) -> dict[str, float]:
    """Error by setting of a whole setting all of whose values are levels; `errors` by setting and level. Flank elements
    and contact nodes count together, not each."""
    levels = {each.name: each.level_of(setting) for each in refinements if each.name not in OF_FAMILY}
    return {
        name: errors[name, level] for name, level in levels.items() if level is not None and (name, level) in errors
    }


def pareto_front(points: Sequence[tuple[float, float]]) -> list[int]:
    """Places of the points (time, error) that no other point beats in both, the quickest first; one of equal points."""
    front: list[int] = []
    for place in sorted(range(len(points)), key=lambda each: points[each]):
        if not front or points[place][1] < points[front[-1]][1]:
            front.append(place)
    return front


def path(
    base: Setting, refinements: Sequence[Refinement], errors: Errors, allowed=lambda setting: True, enough: float = 0.0
) -> list[Setting]:
    """Whole settings from the coarsest on: from one to the next the setting with the largest error, weighed by WAITS,
    goes one level finer. The path ends where the sum of errors is below `enough`, or where that setting has no finer
    level that is `allowed`; its end is kept. Choices, such as the element, are taken from `base`."""
    moving = {
        each.name: each
        for each in refinements
        if (each.expected is not None or each.name == LENGTH) and each.name not in OF_FAMILY
    }
    levels = {
        name: [place for place, level in enumerate(each.levels) if not level.own and (name, place) in errors]
        for name, each in moving.items()
    }
    at = {name: 0 for name, places in levels.items() if places}

    def setting() -> Setting:
        return reduce(lambda whole, name: moving[name].moved(whole, levels[name][at[name]]), at, base)

    settings = []
    last = float("inf")
    while at and allowed(setting()):
        parts = {name: errors[name, levels[name][place]] for name, place in at.items()}
        if sum(parts.values()) <= KEPT_PART * last:
            last = sum(parts.values())
            settings.append(setting())
        worst = largest_part({name: error * WAITS.get(name, 1.0) for name, error in parts.items()})
        if at[worst] + 1 == len(levels[worst]) or sum(parts.values()) <= enough:
            break
        at[worst] += 1
    if settings and settings[-1] != setting() and allowed(setting()):
        settings.append(setting())
    return _thinned(settings)


def _thinned(settings: list[Setting]) -> list[Setting]:
    if len(settings) <= MOST_KEPT:
        return settings
    return [settings[round(place * (len(settings) - 1) / (MOST_KEPT - 1))] for place in range(MOST_KEPT)]


def fits(scene: Scene, setting: Setting) -> bool:
    """Whether the contact operators of a mesh cycle can be held."""
    return expected_cost(model_of(setting.of(scene))).operators <= MOST_BYTES


def settings_of(
    scene: Scene, targets: tuple[float, ...], progress: Progress, failures: list[tuple[str, str]]
) -> dict[str, tuple[Setting, float]]:
    """By name the settings that targets choose, with the targets; those that none reaches join the failures."""
    settings = {}
    for target in targets:
        name = f"target {100.0 * target:g} %"
        try:
            settings[name] = choose(scene, target, progress).setting, target
        except ComputationError as error:
            failures.append((name, str(error).splitlines()[0]))
    return settings
