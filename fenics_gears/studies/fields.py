"""Sections and fields of a scene by their dotted paths, and changes of a parsed scene. Tables that are listed have
numbers from 1: ``shafts.input.sections.2.diameter``. Those of a train too: ``stages.first.pinion.profile_shift``."""

import math
from collections.abc import Iterable, Mapping
from typing import Any

from fenics_gears.errors import SceneError
from fenics_gears.inputs.allowed import Allowed, AllowedEither, AllowedList, AllowedNumber
from fenics_gears.inputs.problem import LISTED, did_you_mean
from fenics_gears.inputs.section import AllowedTables, Section, allowed_in, names_in, section_within
from fenics_gears.inputs.tree import GEARS, LOADS, value_at
from fenics_gears.scene.schema import known_paths, paths_in, scene_text
from fenics_gears.scene.train_loads import TrainLoad
from fenics_gears.scene.train_pair import STAGES
from fenics_gears.scene.train_rules import OF_GEARS
from fenics_gears.scene.train_schema import stage_text, train_text
from fenics_gears.scene.train_shafts import TrainShaft

Path = tuple[str, ...]
SHAFTS = "shafts"
ABSENT = "absent"
PRESENT = "present"
# Of a pair, and of a train.
ALL_LOADS = (*LOADS, *TrainLoad.alternatives[0])


def is_section(path: Path) -> bool:
    """Whether the path names a section of the scene, or a table that is listed in one."""
    field = _field_at(path)
    return field is not None and field[1] is None


def has_parts(path: Path) -> bool:
    """Whether paths go on behind that of a section or of a list of tables."""
    field = _field_at(path)
    return field is not None and (field[1] is None or isinstance(field[1], AllowedTables))


def _field_at(path: Path) -> tuple[type[Section] | None, Allowed | None] | None:
    """The section at a path, or what its field allows; None where a scene has nothing of that name."""
    # Stages and shafts of a train have any names: the scene says which.
    if path[0] == STAGES:
        named = [GEARS[1] if each.isdigit() and path[2] in OF_GEARS else each for each in path[2:]]
        return _field_within(stage_text(), tuple(named))
    found = _field_within(scene_text(), path) or _field_within(train_text(), path)
    return found or (_field_within(TrainShaft, path[2:]) if path[0] == SHAFTS and len(path) > 1 else None)


def _field_within(section: type[Section] | None, path: Path) -> tuple[type[Section] | None, Allowed | None] | None:
    allowed: Allowed | None = None
    for name in path:
        if name.isdigit():
            listed = allowed_in(section, LISTED) if section is not None else allowed
            if not isinstance(listed, AllowedTables):
                return None
            section = listed.section
            allowed = None
            continue
        if section is None or name not in names_in(section):
            return None
        allowed = allowed_in(section, name)
        section = section_within(section, name)
    return section, allowed


def why_unknown(path: Path) -> str | None:
    """Why a path is unknown, with the nearest known one; None for a known path."""
    if _field_at(path) is not None:
        return None
    known = known_paths() if path[0] != STAGES else [path[:2] + each for each in of_stages()]
    dotted = [".".join(each) for each in known]
    hint = did_you_mean(".".join(path), dotted)
    if not hint:
        homes = [name for name in dotted if name.split(".")[-1] == path[-1]]
        hint = f" Did you mean {' or '.join(homes)}?" if homes else ""
    if not hint:
        hint = f" Sections: {', '.join(each[0] for each in known_paths() if len(each) == 1)}, {STAGES}."
    return f"is no section or field of a scene.{hint}"


def of_stages() -> dict[Path, bool]:
    """Every path within a stage of a train; True for a section, False for a field."""
    return paths_in(stage_text())


def second_load(paths: Iterable[Path]) -> tuple[Path, str] | None:
    """Of fields that vary together the second one that gives the load, and why it cannot: a `changed` scene has the
    last one alone. None without one."""
    loads = [path for path in dict.fromkeys(paths) if path[0] == "load" and path[-1] in ALL_LOADS]
    return (loads[1], f"gives the load, as {'.'.join(loads[0])} does. Leave one out.") if len(loads) > 1 else None


def changed(tree: Mapping[str, Any], path: Path, value: Any) -> dict[str, Any]:
    """A copy of a parsed scene with the value at ``path``; ABSENT removes what is there, PRESENT leaves it as it is. A
    load that is given in one way takes the place of one given in another. What does not change is the same object in
    both."""
    if value == PRESENT:
        return dict(tree)
    if path[0] == "load" and path[-1] in ALL_LOADS and value != ABSENT and isinstance(tree.get("load"), Mapping):
        tree = {**tree, "load": {name: each for name, each in tree["load"].items() if name not in ALL_LOADS}}
    return _changed(tree, path, value, path)


def _changed(home: Any, path: Path, value: Any, whole: Path) -> Any:
    """A copy of a section, or of a list of tables, with the value at a path in it, which ends the `whole` path."""
    name: Any = path[0]
    if isinstance(home, list):
        name = _place_in(home, name, whole)
        home = list(home)
    elif name.isdigit() and not (whole[0] == STAGES and whole[2] in OF_GEARS):
        return {**home, LISTED: _changed(home.get(LISTED, []), path, value, whole)}
    else:
        home = dict(home)
    if len(path) > 1:
        inner = home[name] if isinstance(home, list) else home.get(name)
        if isinstance(inner, str) and whole[0] == STAGES and (isinstance(home, list) or name in GEARS):
            raise SceneError(f"{'.'.join(whole)}: this is the gear {inner} of another stage: change it there")
        if isinstance(inner, Mapping | list) or value != ABSENT:
            home[name] = _changed(inner if isinstance(inner, Mapping | list) else {}, path[1:], value, whole)
    elif value != ABSENT:
        home[name] = value
    elif name in home or isinstance(home, list):
        del home[name]
    return home


def _place_in(listed: list, number: str, whole: Path) -> int:
    if not 1 <= int(number) <= len(listed):
        raise SceneError(f"{'.'.join(whole)}: the scene has {len(listed)} of these tables, counted from 1")
    return int(number) - 1


def with_section(tree: Mapping[str, Any], path: Path) -> dict[str, Any]:
    """A copy of a parsed scene that has the section at ``path``."""
    return dict(tree) if isinstance(value_at(tree, *path), Mapping) else changed(tree, path, {})


def allowed_at(path: Path) -> tuple[Allowed | None, float, float]:
    """What a field allows, None for a section; and its least and largest number in N, mm, s, rad, infinite without
    bounds."""
    _, allowed = _field_at(path) or (None, None)
    if isinstance(allowed, AllowedEither):
        return allowed, min(low for low, _ in allowed.ranges.values()), max(high for _, high in allowed.ranges.values())
    if isinstance(allowed, AllowedNumber):
        return allowed, allowed.lowest, allowed.highest
    return allowed, -math.inf, math.inf


def is_numeric(path: Path) -> bool:
    """Whether a field takes a number, with a unit or without, that need not be whole."""
    allowed, lowest, _ = allowed_at(path)
    whole = allowed is not None and "whole number" in allowed.description
    return (
        allowed is not None
        and not isinstance(allowed, AllowedList)
        and not whole
        and (allowed.kind is not None or math.isfinite(lowest))
    )
