"""The effects of a train, each wherever its scene has it: of a pair in any stage, and what only trains have."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cached_property
from pathlib import Path
from typing import Any

from fenics_gears import GearsError
from fenics_gears.measuring import SECTIONS
from fenics_gears.scene_text import NoScene, model_of_tree, parsed

from .subsets import Sections

OF_BENT = ("housing", "sections", "gears_at", "torque_at", "seats", "material", "bearings")
# What only trains and sets have, and the fields that make it; "*" is any name.
OF_TRAINS = {
    "shafts that bend": (
        "shafts.housing", *(f"shafts.*.{name}" for name in OF_BENT),
    ),
    "shafts that twist": ("shafts.*.torsional_stiffness",),
    "clocking": ("shafts.*.clocking",),
    "floating members": ("stages.*.floating",),
    "pins that give way": tuple(f"stages.*.carrier.{name}stiffness" for name in ("pin_", "", "bearing_")),
    "pin errors": ("stages.*.carrier.pin_errors", "stages.*.carrier.radial_pin_errors"),
    "pitch errors": ("stages.*.pitch_errors",),
    "the ring's support": ("stages.*.ring.support",),
}  # fmt: skip
# Of a pair in all stages, in one, in a mesh of a set. Rigid teeth are not computed together.
OF_PAIRS = {name: (name, f"stages.*.{name}", f"stages.*.*_mesh.{name}") for name in SECTIONS if name != "shafts"}
PLACES = {**OF_PAIRS, **OF_TRAINS}
# What goes with an effect and means nothing without it; and what stands in place of a field that is left out.
BESIDE = dict.fromkeys(("inertia", "pins that give way"), ("stages.*.vibration",))
IN_PLACE = {"support": "held"}
Tree = dict[str, Any]


class EffectsOfTrain:
    """See `subsets.EffectsOfPair`, of a train."""

    base: Sections = frozenset()

    def __init__(self, train):
        self.scene = train
        self._tree = parsed(train.text, train.name)
        self._made: dict[Sections, Any] = {}

    @cached_property
    def every(self) -> Sections:
        return frozenset(name for name, places in PLACES.items() if any(_present(self._tree, places)))

    def in_order(self, sections) -> list[str]:
        return [each for each in PLACES if each in sections]

    def needs(self, name: str) -> tuple[str, ...]:
        return {"damping": ("inertia",), "speed_ramp": ("inertia",)}.get(name, ())

    def problem(self, sections: Sections) -> str:
        """What is wrong with the train when only those effects are left in it."""
        made = self._train(sections)
        return made if isinstance(made, str) else ""

    def of(self, sections: Sections):
        """The train with only those effects."""
        return self._train(sections)

    def parts(self, whole) -> Iterator[tuple[str, Any]]:
        yield from ()

    def _train(self, sections: Sections) -> Any:
        """The train, or why there is none."""
        if sections not in self._made:
            self._made[sections] = self._made_of(sections)
        return self._made[sections]

    def _made_of(self, sections: Sections) -> Any:
        gone = [place for name in self.every - sections for place in (*PLACES[name], *BESIDE.get(name, ()))]
        less = _without(self._tree, gone)
        said = ""
        # What is left may be in the plane, where slices and layers mean nothing.
        for tree in (
            less,
            _without(less, [f"{home}accuracy.{name}" for home in ("", "stages.*.") for name in OF_FACE]),
        ):
            try:
                return model_of_tree(self.scene.name, tree, Path(self.scene.meshes[0].scene.folder)).scene
            except NoScene as error:
                said = said or "; ".join(problem.message for problem in error.problems)
            except GearsError as error:
                said = said or str(error).splitlines()[0]
        return said


OF_FACE = ("slices", "layers")


def _present(tree: Tree, places) -> Iterator[bool]:
    """For each of some places whether the tree has it."""
    for place in places:
        yield _without(tree, [place]) != tree


def _without(tree: Any, places) -> Tree:
    """A tree less all that stands at some places."""
    for place in places:
        tree = _less(tree, place.split("."))
    return tree


def _less(tree: Any, names: list[str]) -> Any:
    if not isinstance(tree, Mapping):
        return tree
    name, *behind = names
    found = {}
    for own, value in tree.items():
        if name not in ("*", own) and not (name.startswith("*_") and own.endswith(name[1:])):
            found[own] = value
        elif behind:
            found[own] = _less(value, behind)
        elif own in IN_PLACE:
            found[own] = IN_PLACE[own]
    return found
