"""From a scene's data to a scene file that gives the same data, bit for bit; and to a table for notebooks."""

from __future__ import annotations

import math
import numbers
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import fields, is_dataclass, replace
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any

from fenics_gears.effects import effects_on
from fenics_gears.errors import GearsError, SceneError
from fenics_gears.geometry.gear_data import GearData, GearPairData, Web
from fenics_gears.inputs.problem import NOTHING_DONE
from fenics_gears.inputs.section import allowed_in, field_of, section_within, tree_of
from fenics_gears.inputs.tree import GEARS
from fenics_gears.inputs.written import as_toml, toml_value

from . import gear_parts, gear_schema, schema
from .parsing import NO_FILE, parsed, values_of_text
from .schema import HUNTING_TOOTH_PERIOD, LAST_CYCLES, WORDS, scene_text

if TYPE_CHECKING:
    from .data import Scene


def text_of(scene: Scene) -> str:
    """The text of a scene file that gives a scene's data: sections as they were read where they give them, else written
    from the data. What no file gives, as where a mesh file was overwritten since, has a text that says so."""
    sections = section_trees(scene)
    # As read, a section may follow from another one, as a load by its power does from the speed: then all are written.
    why = ""
    for tree in [sections] if not scene.written else [_as_read_where_the_same(scene, sections), sections]:
        text = as_toml(tree)
        why = why_another(scene, text)
        if not why:
            return text
    return f"{NO_FILE}: {why}\n"


def why_another(scene: Scene, text: str) -> str:
    """Why a text does not give a scene's data, in words; empty where it does."""
    try:
        values = values_of_text(text, scene.name, directory=Path(scene.folder), with_lines=False)
    except GearsError as error:
        return " ".join(str(error).removesuffix("Nothing was computed or written.").split())
    if not scene.motion.speed_given:
        # No file says how long a mesh cycle takes without a speed; it scales times alone, in a train by the teeth.
        values = {**values, "motion": replace(values["motion"], mesh_frequency=scene.motion.mesh_frequency)}
    names = (each.name for each in fields(scene) if each.name not in WORDS)
    differing = [name for name in names if values.get(name) != getattr(scene, name)]
    if not differing:
        return ""
    verb = "is" if len(differing) == 1 else "are"
    return f"{', '.join(differing)} {verb} not what a file, and the files that it names, can say"


# What Python has for a field of a simple type, and its name in messages.
_OF_TYPE = {
    "int": (numbers.Integral, "a whole number, without unit"),
    "float": (numbers.Real, "a number, in N, mm, s and rad"),
    "str": (str, "a text"),
}


# Of mistakes. In Python other units than N, mm, s may be taken, beyond the ranges that a file has.
_NEVER_ALLOWED = ("is not a finite number", "is zero", "is negative")


def refuse_wrong(scene: Scene) -> None:
    """Refuse a scene that was changed in Python to values that no scene file may have; raises SceneError, in the words
    of `gears check`."""
    mistakes = list(_of_another_type(scene, ""))
    if mistakes:
        raise SceneError("\n".join([*(f"{scene.name}: {said}" for said in mistakes), NOTHING_DONE]))
    if not scene.text.startswith(NO_FILE):
        return
    text = as_toml(section_trees(scene))
    try:
        values_of_text(text, scene.name, directory=Path(scene.folder), with_lines=False)
    except SceneError as error:
        if any(words in str(error) for words in _NEVER_ALLOWED):
            raise


def _of_another_type(data: Any, home: str) -> Iterator[str]:
    """Sentences on fields of a dataclass, and of those within it, that have no value of their type."""
    for field in fields(data):
        value = getattr(data, field.name)
        place = f"{home}{field.name}"
        kinds = str(getattr(field.type, "__name__", field.type)).split(" | ")
        section = kinds[0].rpartition(".")[2]
        if field.name not in WORDS and section[:1].isupper() and not (value is None and "None" in kinds):
            if section not in (each.__name__ for each in type(value).__mro__):
                yield f"{place} = {value!r} is of type {type(value).__name__}. Allowed: the data of a scene, {section}."
            elif is_dataclass(value):
                yield from _of_another_type(value, f"{place}.")
        elif kinds[0] in _OF_TYPE and type(value).__name__ not in kinds and not (value is None and "None" in kinds):
            allowed = [_OF_TYPE[kind] for kind in kinds if kind in _OF_TYPE]
            if not isinstance(value, tuple(python for python, _ in allowed)):
                words = " or ".join(said for _, said in allowed)
                yield f"{place} = {value!r} is of type {type(value).__name__}. Allowed: {words}."


def section_trees(scene: Scene) -> dict[str, Any]:
    """All sections of a scene file, by their names, from the data alone."""
    trees = {
        "title": scene.title or None,
        "gears": _gears(scene.gears),
        "load": tree_of(scene.load, schema.LoadText),
        "motion": _motion(scene),
        "accuracy": tree_of(scene.accuracy) or None,
        "output": tree_of(scene.output) or None,
    }
    own = (effect for effect in effects_on(scene) if not effect.within)
    trees |= {effect.section: effect.as_section(getattr(scene, effect.section)) for effect in own}
    return {name: tree for name, tree in trees.items() if tree is not None}


def _as_read_where_the_same(scene: Scene, sections: dict[str, Any]) -> dict[str, Any]:
    read = values_of_text(scene.written, scene.name, directory=Path(scene.folder))
    written = parsed(scene.written, "")
    chosen = {}
    for name in written | sections:
        if read.get(name) != getattr(scene, name):
            chosen[name] = sections.get(name)
        elif name in written:
            chosen[name] = written[name]
    return chosen


def _gears(pair: GearPairData) -> dict[str, Any]:
    section = gear_schema.Gears
    own_width = any(getattr(pair, name).face_width is not None for name in GEARS)
    leaving = ("pinion", "wheel", "pinion_hand", *(("face_width",) if own_width else ()))
    tree = tree_of(replace(pair, centre_distance=abs(pair.centre_distance)), section, leaving)
    if pair.helix_angle:
        tree["pinion_hand"] = pair.pinion_hand
    for name, width, offset in zip(GEARS, pair.face_widths, pair.axial_offsets):
        tree[name] = _gear(getattr(pair, name), width, own_width)
        if offset:
            tree[name]["axial_offset"] = field_of(gear_schema.GearText, "axial_offset", offset)
    return tree


def _gear(gear: GearData, width: float, own_width: bool) -> dict[str, Any]:
    internal = gear.teeth < 0
    positive = {name: abs(getattr(gear, name)) for name in ("tip_diameter", "root_diameter", "bore_diameter")}
    without = ("face_width", "web", *(("bore_diameter",) if internal else ()))
    tree = tree_of(replace(gear, **positive), gear_schema.GearText, without)
    if internal:
        tree["outer_diameter"] = field_of(gear_schema.GearText, "outer_diameter", positive["bore_diameter"])
    if own_width:
        tree["face_width"] = field_of(gear_schema.GearText, "face_width", width)
    if gear.protuberance:
        tree["rack"] = tree_of(gear, gear_parts.RackText)
    if gear.web is not None:
        tree["web"] = _web(gear.web, width)
    return tree


def _web(web: Web, face_width: float) -> dict[str, Any]:
    width, offset = (_length_of(share, face_width) for share in (web.share, web.offset))
    sizes = {"rim_inner_diameter": 2.0 * web.rim_radius, "hub_diameter": 2.0 * web.hub_radius, "width": width}
    if offset:
        sizes["axial_offset"] = offset
    return {name: field_of(gear_parts.WebText, name, size) for name, size in sizes.items()}


def _length_of(share: float, whole: float) -> float:
    product = share * whole
    # The quotient is rounded too: a neighbour of the product may be the number that gives the share.
    near = (product, math.nextafter(product, math.inf), math.nextafter(product, -math.inf))
    return next((each for each in near if each / whole == share), product)


def _motion(scene: Scene) -> dict[str, Any]:
    motion = scene.motion
    period = math.lcm(*scene.gears.teeth)
    tree: dict[str, Any] = {}
    if motion.speed_given:
        tree["mesh_frequency"] = field_of(schema.MotionText, "mesh_frequency", motion.mesh_frequency)
    if not motion.fewer_where_too_large:
        return tree | {"mesh_cycles": motion.mesh_cycles, "recorded_cycles": motion.recorded_cycles}
    # As many as fit are recorded of a ramp, of a whole hunting tooth period, and of one after a settling time.
    if scene.speed_ramp is not None:
        return tree | {"mesh_cycles": motion.mesh_cycles}
    if motion.mesh_cycles == period:
        return tree | {"mesh_cycles": HUNTING_TOOTH_PERIOD}
    settling = (motion.mesh_cycles - max(period, LAST_CYCLES)) / motion.mesh_frequency
    if settling < 0.0:  # changed in Python
        return tree | {"mesh_cycles": motion.mesh_cycles, "recorded_cycles": motion.recorded_cycles}
    return tree | {"settling_time": field_of(schema.MotionText, "settling_time", settling)}


MOST_LETTERS = 80


def html(scene: Scene) -> str:
    """The fields that are not at their defaults, as a scene file has them, and what each of them is."""

    def row(kind: str, cells: Iterable[str]) -> str:
        inner = "".join(f'<{kind} style="text-align: left">{escape(cell)}</{kind}>' for cell in cells)
        return f"<tr>{inner}</tr>"

    rows = "".join(row("td", cells) for cells in rows_of(section_trees(scene), scene_text()))
    head = row("th", ("field", "value", "meaning"))
    return f"<table><caption>{escape(scene.title)}</caption><thead>{head}</thead><tbody>{rows}</tbody></table>"


def rows_of(tree: Mapping[str, Any], section: Any, home: str = "") -> Iterator[tuple[str, str, str]]:
    """Name with its sections, value, and meaning, of all fields of a section's tree."""
    for name, value in tree.items():
        inner = section_within(section, name)
        if inner is not None:
            yield (f"[{home}{name}]", "", "")
            yield from rows_of(value, inner, f"{home}{name}.")
        else:
            text = value if isinstance(value, str) else toml_value(value)
            meaning = allowed_in(section, name).meaning
            yield (f"{home}{name}", text if len(text) <= MOST_LETTERS else text[: MOST_LETTERS - 3] + "...", meaning)
