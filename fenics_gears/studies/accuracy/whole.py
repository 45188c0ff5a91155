"""Whole settings: what their knobs' errors add up to, a path of them from coarse to fine, and those that pay.

Errors of knobs that cancel in one run are no accuracy: another load or speed undoes it. A whole setting's error is the sum of its
knobs' magnitudes, each measured with the others fine, or its own distance from the reference where that is larger.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from fenics_gears.studies.accuracy.ladder import Knob, Setting, rung_of

# A path keeps a setting when its error has fallen to this part of that of the last one kept.
KEPT_PART, MOST_KEPT = 0.6, 9
# Contact operators of a mesh cycle are held all at once; larger ones are not tried.
MOST_BYTES = 1.2e9

Errors = Mapping[tuple[str, int], float]


def counted_error(direct: float, parts: Mapping[str, float]) -> float:
    """What a whole setting is charged: `direct` distance from the reference, but never less than its knobs' errors together."""
    return max(direct, sum(parts.values()))


def parts_of(setting: Setting, knobs: Sequence[Knob], errors: Errors) -> dict[str, float]:
    """Error by knob of a setting all of whose values are rungs; `errors` by knob and rung."""
    places = {knob.name: rung_of(knob, setting) for knob in knobs}
    return {name: errors[name, place] for name, place in places.items() if place is not None and (name, place) in errors}


def dominant(parts: Mapping[str, float]) -> str:
    """The knob with the largest error."""
    return max(parts, key=parts.__getitem__)


def pareto_front(points: Sequence[tuple[float, float]]) -> list[int]:
    """Which of the points (time, error) no other beats in one without losing in the other, the quickest first; one of equal points."""
    front: list[int] = []
    for place in sorted(range(len(points)), key=lambda each: points[each]):
        if not front or points[place][1] < points[front[-1]][1]:
            front.append(place)
    return front


def path(base: Setting, knobs: Sequence[Knob], errors: Errors, allowed=lambda setting: True) -> list[Setting]:
    """Whole settings from the coarsest on: at each the knob with the largest error goes one rung finer.

    It ends where that knob has no finer rung, or none that is `allowed`; the end is kept. Knobs that are choices stay as `base` has them.
    """
    moving = [knob for knob in knobs if knob.expected is not None or knob.field == "length"]
    rungs = {knob.name: [place for place, rung in enumerate(knob.rungs) if not rung.own and (knob.name, place) in errors] for knob in moving}
    moving = [knob for knob in moving if rungs[knob.name]]
    at = {knob.name: 0 for knob in moving}

    def setting() -> Setting:
        values = {knob.field: getattr(knob.rungs[rungs[knob.name][at[knob.name]]].setting, knob.field) for knob in moving}
        return replace(base, **values)

    def parts() -> dict[str, float]:
        return {knob.name: errors[knob.name, rungs[knob.name][at[knob.name]]] for knob in moving}

    found, last = [], float("inf")
    while moving:
        if not allowed(setting()):
            break
        if sum(parts().values()) <= KEPT_PART * last:
            last = sum(parts().values())
            found.append(setting())
        worst = dominant(parts())
        if at[worst] + 1 == len(rungs[worst]) or last == 0.0:
            break
        at[worst] += 1
    if moving and found and found[-1] != setting() and allowed(setting()):
        found.append(setting())
    return _thinned(found)


def _thinned(found: list[Setting]) -> list[Setting]:
    """At most as many as are worth a run, the ends among them."""
    if len(found) <= MOST_KEPT:
        return found
    return [found[round(place * (len(found) - 1) / (MOST_KEPT - 1))] for place in range(MOST_KEPT)]
