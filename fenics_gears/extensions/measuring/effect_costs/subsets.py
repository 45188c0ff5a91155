"""The subsets of a scene's effects that are run: none, each alone, all but each, all; only those that make a valid
scene."""

import functools
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from itertools import combinations
from typing import Any

from fenics_gears import Scene
from fenics_gears.many_runs import effects_on
from fenics_gears.measuring import SECTIONS, LeadModification, broken_rules, effect_named, every_effect, without
from fenics_gears.scene_text import GEARS, over_the_face, parsed

NOTHING = "nothing"
BARE = "bare"
ALONE = "alone"
LEFT_OUT = "left out"
ALL = "all"
# The other effects act on elastic teeth: a scene that has them is called bare with them and nothing else.
BASE = "tooth_elasticity"
UNMODIFIED = LeadModification()
OF_LEAD = tuple(vars(UNMODIFIED))
TILTING = "tilting and axial motion"
AXIAL = "axial motion"
# Most further effects that are added or left out to make a subset valid.
MOST_FURTHER = 2

Sections = frozenset[str]
Valid = Callable[[Sections], str]


@dataclass(frozen=True)
class Subset:
    """A scene with some of its effects: `kind` of subset, the `effect` that is added or left out ("" for none), the
    `sections` that are on. `beside`: further effects that had to be added or left out with it."""

    kind: str
    effect: str
    sections: Sections
    scene: Any
    beside: tuple[str, ...] = ()

    @property
    def name(self) -> str:
        changed = ", ".join([self.effect, *self.beside])
        names = {NOTHING: "rigid flanks, no effect", ALONE: f"+ {changed}", LEFT_OUT: f"all - {changed}"}
        return names.get(self.kind, self.kind)

    @property
    def note(self) -> str:
        """Why further effects were added or left out; empty where none were."""
        others = " and ".join(self.beside)
        if not others:
            return ""
        return f"{self.effect} needs {others}" if self.kind == ALONE else f"{others} cannot be without {self.effect}"


@dataclass(frozen=True)
class Skipped:
    """A subset that is no scene, and why."""

    name: str
    reason: str


class EffectsOfPair:
    """What the subsets of a scene's effects are made of: `every` effect that it has, and the `base` of all others. The
    scene must have been read from its text: the rules between sections are the text's."""

    def __init__(self, scene: Scene):
        self.scene = scene
        self.every: Sections = frozenset(each.section for each in effects_on(scene))
        self.base: Sections = self.every & {BASE}
        self.problem: Valid = functools.cache(functools.partial(_problem, scene))

    def in_order(self, sections: Iterable[str]) -> list[str]:
        return [each for each in SECTIONS if each in sections]

    def needs(self, name: str) -> Iterable[str]:
        """The effects without which an effect is none."""
        return effect_named(name).needs

    def of(self, sections: Sections) -> Scene:
        """The scene with only those effects."""
        return without(self.scene, *self.in_order(self.every - sections))

    def parts(self, whole: Scene) -> Iterator[tuple[str, Scene]]:
        """Parts of effects in words, and the scene without each."""
        return _without_parts(whole)


def subsets_of(effects: Any) -> tuple[list[Subset], list[Skipped]]:
    """The subsets of effects (`EffectsOfPair`, or of a train) that are run, and those that make no scene; no set of
    effects comes twice."""
    every = effects.every
    base = effects.base
    # A set with several names keeps the first one here.
    wanted: list[tuple[str, str, Sections | None]] = [(ALL, "", every), (BARE, "", base)]
    if base:
        wanted.insert(1, (NOTHING, "", frozenset()))
    wanted += [(ALONE, each, smallest_valid(base | {each}, effects)) for each in effects.in_order(every - base)]
    wanted += [(LEFT_OUT, each, largest_valid(every - {each}, effects)) for each in effects.in_order(every)]
    subsets: dict[Sections, Subset] = {}
    skipped = []
    for kind, name, sections in wanted:
        if sections is None or effects.problem(sections):
            asked = sections if sections is not None else every - {name} if kind == LEFT_OUT else base | {name}
            skipped.append(Skipped(Subset(kind, name, asked, effects.scene).name, effects.problem(asked)))
        elif sections not in subsets:
            left = every - sections
            beside = {ALONE: sections - {*base, name}, LEFT_OUT: left - {name}}.get(kind, ())
            subsets[sections] = Subset(kind, name, sections, effects.of(sections), tuple(effects.in_order(beside)))
    whole, *others = subsets.values()
    parts = [Subset(LEFT_OUT, name, whole.sections, less) for name, less in effects.parts(whole.scene)]
    return [*others, *parts, whole], skipped


def smallest_valid(wanted: Sections, effects: Any) -> Sections | None:
    """The smallest valid set of effects that holds the `wanted` ones; None where there is none near."""
    closed = wanted
    while missing := {need for each in closed for need in effects.needs(each) if need in effects.every} - closed:
        closed = closed | missing
    further = effects.in_order(effects.every - closed)
    candidates = (closed | set(added) for count in range(MOST_FURTHER + 1) for added in combinations(further, count))
    return next((each for each in candidates if not effects.problem(each)), None)


def largest_valid(left: Sections, effects: Any) -> Sections | None:
    """The largest valid set of effects within those that are `left`; None where there is none near."""
    while lost := {each for each in left if not set(effects.needs(each)) <= left}:
        left = left - lost
    candidates = (
        left - set(gone) for count in range(MOST_FURTHER + 1) for gone in combinations(effects.in_order(left), count)
    )
    return next((each for each in candidates if not effects.problem(each)), None)


def _problem(scene: Scene, sections: Sections) -> str:
    """What is wrong with the scene's text when only those effects are left in it."""
    tree = parsed(scene.text, scene.name)
    for each in every_effect():
        if each.section not in sections:
            *homes, name = each.within or (each.section,)
            functools.reduce(lambda table, home: table.get(home, {}), homes, tree).pop(name, None)
    if not over_the_face(tree):
        # What is left is a plane scene, in which they mean nothing.
        for name in ("slices", "layers"):
            tree.get("accuracy", {}).pop(name, None)
    return "; ".join(f"{'.'.join(problem.path)}: {problem.message}" for problem in broken_rules(tree))


def _without_parts(scene: Scene) -> Iterator[tuple[str, Scene]]:
    """Each part of an effect over the face, in words, and the scene without it, but for an effect that has that part
    alone. The helix is none: without it a pair has another transverse section and centre distance."""
    lead = scene.lead_modifications
    if lead is not None:
        own = {gear: each for gear in GEARS if (each := getattr(lead, gear)) is not None}
        named = [name for name in OF_LEAD if any(getattr(each, name) for each in own.values())]
        for name in named if len(named) > 1 else ():
            less = {gear: replace(each, **{name: getattr(UNMODIFIED, name)}) for gear, each in own.items()}
            yield name, replace(scene, lead_modifications=replace(lead, **less))
    bearings = scene.bearings
    if bearings is None or bearings.places is None:
        return
    held = bearings.held_axially
    yield TILTING, replace(scene, bearings=replace(held, places=None))
    if any(bearings.axial(gear) is not None for gear in GEARS):
        yield AXIAL, replace(scene, bearings=held)
