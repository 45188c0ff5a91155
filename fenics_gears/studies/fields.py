"""Sections and fields of a scene by their dotted paths, and changes of a parsed scene."""

from __future__ import annotations

import copy
import functools
import json
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
from pydantic import BaseModel

from fenics_gears.inputs.names import did_you_mean
from fenics_gears.scene.schema import SceneText

Path = tuple[str, ...]
ABSENT = "absent"
PRESENT = "present"


@functools.lru_cache(maxsize=1)
def known_paths() -> dict[Path, bool]:
    """Every path of a scene; True for a section, False for a field."""
    return dict(_paths(SceneText, ()))


def _paths(section: type[BaseModel], home: Path) -> Iterator[tuple[Path, bool]]:
    for name, field in section.model_fields.items():
        kinds = (field.annotation, *getattr(field.annotation, "__args__", ()))
        inner = next((kind for kind in kinds if isinstance(kind, type) and issubclass(kind, BaseModel)), None)
        yield (*home, name), inner is not None
        if inner is not None:
            yield from _paths(inner, (*home, name))


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
    return f"is no section or field of a scene.{hint}" + ("" if hint else f" Sections: {', '.join(p[0] for p in known_paths() if len(p) == 1)}.")


def changed(tree: Mapping[str, Any], path: Path, value: Any) -> dict[str, Any]:
    """A copy of a parsed scene with the value at ``path``; ABSENT removes what is there, PRESENT leaves it as it is."""
    if value == PRESENT:
        return dict(tree)
    tree = copy.deepcopy(dict(tree))
    home = tree
    for name in path[:-1]:
        if not isinstance(home.get(name), dict):
            if value == ABSENT:
                return tree
            home[name] = {}
        home = home[name]
    if value == ABSENT:
        home.pop(path[-1], None)
    else:
        home[path[-1]] = copy.deepcopy(value)
    return tree


def with_section(tree: Mapping[str, Any], path: Path) -> dict[str, Any]:
    """A copy of a parsed scene that has the section at ``path``, with the fields that it had before, if any."""
    home: Any = tree
    for name in path:
        home = home.get(name) if isinstance(home, Mapping) else None
    return dict(tree) if isinstance(home, Mapping) else changed(tree, path, {})


def as_toml(tree: Mapping[str, Any]) -> str:
    """A parsed scene as the text of a scene file."""
    return "\n".join(_section_lines(tree, ())).strip() + "\n"


def _section_lines(section: Mapping[str, Any], path: Path) -> Iterator[str]:
    plain = {name: value for name, value in section.items() if not isinstance(value, Mapping)}
    if path:
        yield f"\n[{'.'.join(path)}]"
    for name, value in plain.items():
        yield f"{name} = {toml_value(value)}"
    for name, value in section.items():
        if isinstance(value, Mapping):
            yield from _section_lines(value, (*path, name))


def toml_value(value: Any) -> str:
    """A value, a table of values included, in TOML's spelling on one line."""
    if isinstance(value, np.generic):
        # From numpy 2 on it spells itself np.float64(0.1).
        value = value.item()
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{name} = {toml_value(inner)}" for name, inner in value.items()) + " }"
    if isinstance(value, list):
        return "[" + ", ".join(map(toml_value, value)) + "]"
    if isinstance(value, str):
        # JSON's escapes are among TOML's, but for the one character that JSON leaves as it is.
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007F")
    if isinstance(value, bool):
        return "true" if value else "false"
    return getattr(value, "text", None) or repr(value)
