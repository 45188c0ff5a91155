"""The fields of a scene that the page has sliders for, with their units and ranges; any other field by its name."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from math import floor, isfinite, isnan, log10, nan
from typing import Any

from fenics_gears.scene_text import GEARS, as_written, factor_of, fields, number_in, value_at

Path = tuple[str, ...]
Tree = Mapping[str, Any]
STEPS = 200
# Of a slider's ends, and the groups of fields with which the gears change.
REACHED = 0.75
SHAPES = ("Gears", "Friction", "More fields")
SHIFT = "profile_shift"
# How a relief says where it begins.
STARTS = ("start", "length_on_path", "length_on_flank")


@dataclass(frozen=True)
class Control:
    """A field of the scene: where it is, what the page calls it and in which group.

    `unit`: of the slider, empty where there is none. `ends`: of the slider; the number may be further out, within what
    the scene allows. `absent`: what is left out of the scene at zero, None where zero is a value as others are.
    `with_it`: fields, by their places in that section, that a scene without it gets with it.
    """

    path: Path
    label: str
    group: str
    unit: str = ""
    ends: tuple[float, float] = (0.0, 1.0)
    absent: Path | None = None
    start: str = ""

    @property
    def name(self) -> str:
        return ".".join(self.path)

    def value(self, tree: Tree) -> float:
        """The number in the unit of the slider; zero of what is left out, NaN of words."""
        written = value_at(tree, *self.path)
        if written is None:
            return 0.0
        return self._number(written)

    def _number(self, written: Any) -> float:
        """A value in the unit of the slider, NaN for words."""
        if self.unit:
            number = number_in(written, self.unit)
            return nan if number is None else number
        try:
            return nan if isinstance(written, bool) else float(written)
        except (TypeError, ValueError):
            return nan

    def changed(self, tree: Tree, written: str | float) -> Tree:
        """The scene with another value, as a scene has it or as a number of the slider's units."""
        if self._number(written) == 0.0 and self.absent is not None:
            return _without(tree, self.absent)
        if self.start:
            own = {**(value_at(tree, *self.path[:-2]) or {}), **(value_at(tree, *self.path[:-1]) or {})}
            if not any(name in own for name in STARTS):
                tree = fields.changed(tree, (*self.path[:-1], STARTS[0]), self.start)
        value = f"{written:.10g} {self.unit}" if isinstance(written, (int, float)) and self.unit else written
        return fields.changed(tree, self.path, value)

    def described(self, tree: Tree) -> dict[str, Any]:
        """What the page needs of it."""
        allowed, _, _ = fields.allowed_at(self.path)
        value = self.value(tree)
        written = value_at(tree, *self.path)
        lowest, highest = self.ends
        if not isnan(value):
            lowest = min(lowest, value)
            highest = max(highest, value)
        said = "" if allowed is None else f"{allowed.meaning}. Allowed: {allowed.description}."
        text = written if isinstance(written, str) else as_written(written) if written is not None else ""
        return {
            "name": self.name, "label": self.label, "group": self.group, "unit": self.unit, "lowest": lowest,
            "highest": highest, "step": _round(max((highest - lowest) / STEPS, 1e-12)), "number": _none_for_nan(value),
            "text": text, "said": said, "slides": bool(highest > lowest) and not isnan(value),
        }  # fmt: skip


def controls_of(tree: Tree, over_face: bool) -> list[Control]:
    """What the page shows from the start; `over_face`: whether the flanks are resolved over the face."""
    along = _over_the_face(tree) if over_face else ()
    return [*_load(tree), *_gears(tree), *reliefs(tree, (), GEARS, "Reliefs"), *along, *friction(tree)]


def reach(tree: Tree, controls: Sequence[Control]) -> list[Tree]:
    """The scene with each slider in turn towards either end: what contact nodes have to reach from the start, so that
    all of them share contact operators."""
    apart = [each for each in controls if each.group not in SHAPES and each.path[-1] != SHIFT]
    ends = [(each, REACHED * end) for each in apart for end in each.ends]
    return [control.changed(tree, end) for control, end in ends if end]


def control_of(path: Path, tree: Tree) -> Control:
    """Any field of a scene by its path."""
    allowed, lowest, highest = fields.allowed_at(path)
    unit = "" if allowed is None else allowed.unit
    control = Control(path, ".".join(path), "More fields", unit)
    value = control.value(tree)
    if not fields.is_numeric(path) or isnan(value):
        return replace(control, ends=(0.0, 0.0))
    example = number_in(allowed.description.rsplit('"', 2)[-2], unit) if unit and '"' in allowed.description else None
    about = abs(value) or abs(example or 0.0) or 1.0
    factor = factor_of(unit) if unit else 1.0
    ends = max(value - about, lowest / factor), min(value + about, highest / factor)
    return replace(control, ends=ends if all(map(isfinite, ends)) else (value - about, value + about))


def _load(tree: Tree) -> Iterator[Control]:
    words = {"wheel_torque": "torque on the wheel", "pinion_torque": "torque on the pinion", "power": "power"}
    for name, label in words.items():
        if value_at(tree, "load", name) is not None:
            yield twice(("load", name), label, "Load and speed", tree)
    for name, label in (("pinion_speed", "speed of the pinion"), ("mesh_frequency", "mesh frequency")):
        if value_at(tree, "motion", name) is not None and "inertia" in tree:
            yield twice(("motion", name), label, "Load and speed", tree)


def _gears(tree: Tree) -> Iterator[Control]:
    for gear in GEARS:
        path = ("gears", gear, SHIFT)
        if value_at(tree, *path) is not None:
            yield profile_shift(path, gear, "Gears", tree)
    if value_at(tree, "gears", "centre_distance") is not None:
        control = Control(("gears", "centre_distance"), "centre distance", "Gears", "mm")
        value = control.value(tree)
        yield replace(control, ends=(0.98 * value, 1.02 * value))


def profile_shift(path: Path, gear: str, group: str, tree: Tree) -> Control:
    """Of a gear by its name on the page."""
    control = Control(path, f"profile shift, {gear}", group)
    value = control.value(tree)
    return replace(control, ends=(value - 0.5, value + 0.5))


def reliefs(tree: Tree, place: Path, names: tuple[str, str], group: str) -> Iterator[Control]:
    """Of the mesh whose sections are at a place of the scene; `names`: what its pinion and its wheel are called. A
    depth of both gears is one field. A relief of the scene keeps its start and shape at depth zero."""
    for section, words, start in (("tip_relief", "tip relief", "HPSTC"), ("root_relief", "root relief", "LPSTC")):
        own = (*place, section)
        of_both = Control((*own, "depth"), f"{words}, {' and '.join(names)}", group, "um", (0.0, 50.0))
        both = value_at(tree, *of_both.path) is not None
        if both:
            yield of_both
        for gear, name in zip(GEARS, names):
            path = (*own, gear, "depth")
            there = value_at(tree, *path) is not None
            if there or not both:
                absent = None if there else path[:-1]
                yield Control(path, f"{words}, {name}", group, "um", (0.0, 50.0), absent=absent, start=start)


def _over_the_face(tree: Tree) -> Iterator[Control]:
    group = "Along the face"
    for gear in GEARS:
        yield Control(("lead_modifications", gear, "crowning"), f"crowning, {gear}", group, "um", (0.0, 30.0))
    for gear in GEARS:
        slope = ("lead_modifications", gear, "helix_slope")
        yield Control(slope, f"helix slope modification, {gear}", group, "um", (-40.0, 40.0))
    misaligned = ("misalignment", "in_plane")
    yield Control(misaligned, "misalignment in the plane of action", group, "um", (-60.0, 60.0))


def friction(tree: Tree) -> Iterator[Control]:
    """The coefficient, where no formula gives it."""
    path = ("friction", "coefficient")
    if value_at(tree, "friction", "formula") is None:
        yield Control(path, "coefficient of friction", "Friction", "", (0.0, 0.2), absent=("friction",))


def twice(path: Path, label: str, group: str, tree: Tree) -> Control:
    """From nothing to twice the value, in the unit that the field usually has."""
    allowed, _, _ = fields.allowed_at(path)
    control = Control(path, label, group, "" if allowed is None else allowed.unit)
    value = control.value(tree)
    ends = sorted((0.02 * value, 2.0 * value)) if value else (0.0, 1.0)
    return replace(control, ends=(_round(ends[0]), _round(ends[1])))


def _without(tree: Tree, path: Path) -> Tree:
    """A scene without a field or section, and without the sections that are empty then."""
    if value_at(tree, *path) is None:
        return tree
    tree = fields.changed(tree, path, fields.ABSENT)
    return _without(tree, path[:-1]) if path[:-1] and value_at(tree, *path[:-1]) == {} else tree


def _round(number: float) -> float:
    """A number of two digits."""
    return round(number, 1 - floor(log10(abs(number)))) if number else 0.0


def _none_for_nan(number: float) -> float | None:
    return None if isnan(number) else number
