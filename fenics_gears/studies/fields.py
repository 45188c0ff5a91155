"""Sections and fields of a scene by their dotted paths, and changes of a parsed scene."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from fenics_gears.inputs.allowed import Allowed, AllowedEither, AllowedList, AllowedNumber
from fenics_gears.inputs.problem import did_you_mean
from fenics_gears.inputs.section import allowed_in, section_within
from fenics_gears.inputs.tree import LOADS
from fenics_gears.scene.schema import known_paths, scene_text

Path = tuple[str, ...]
ABSENT = "absent"
PRESENT = "present"


def is_section(path: Path) -> bool:
    """Whether the path names a section of the scene."""
    return known_paths().get(path, False)


def why_unknown(path: Path) -> str | None:
    """Why a path is unknown, with the nearest known one; None for a known path."""
    if path in known_paths():
        return None
    dotted = [".".join(each) for each in known_paths()]
    hint = did_you_mean(".".join(path), dotted)
    if not hint:
        homes = [name for name in dotted if name.split(".")[-1] == path[-1]]
        hint = f" Did you mean {' or '.join(homes)}?" if homes else ""
    return f"is no section or field of a scene.{hint}" + (
        "" if hint else f" Sections: {', '.join(p[0] for p in known_paths() if len(p) == 1)}."
    )


def changed(tree: Mapping[str, Any], path: Path, value: Any) -> dict[str, Any]:
    """A copy of a parsed scene with the value at ``path``; ABSENT removes what is there, PRESENT leaves it as it is.

    A load that is given in one way takes the place of one given in another. What does not change is the same object in
    both.
    """
    tree = dict(tree)
    if value == PRESENT:
        return tree
    home = tree
    for name in path[:-1]:
        inner = home.get(name)
        if not isinstance(inner, Mapping) and value == ABSENT:
            return tree
        home[name] = dict(inner) if isinstance(inner, Mapping) else {}
        home = home[name]
    if value == ABSENT:
        home.pop(path[-1], None)
        return tree
    for other in LOADS if path[0] == "load" and path[-1] in LOADS else ():
        home.pop(other, None)
    home[path[-1]] = value
    return tree


def with_section(tree: Mapping[str, Any], path: Path) -> dict[str, Any]:
    """A copy of a parsed scene that has the section at ``path``, with the fields that it had before, if any."""
    home: Any = tree
    for name in path:
        home = home.get(name) if isinstance(home, Mapping) else None
    return dict(tree) if isinstance(home, Mapping) else changed(tree, path, {})


def allowed_at(path: Path) -> tuple[Allowed | None, float, float]:
    """What a field allows and its least and largest number in N, mm, s, rad; None for a section. Fields without bounds
    have infinite ones."""
    section: Any = scene_text()
    for name in path[:-1]:
        section = section_within(section, name)
    allowed = allowed_in(section, path[-1])
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
