"""Mistakes of a scene file against its schema, in sentences that say what to do."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from typing import Any

from pydantic import BaseModel, ValidationError

from fenics_gears.inputs.fields import Allowed, allowed_in
from fenics_gears.inputs.names import did_you_mean, nearest
from fenics_gears.inputs.problem import MOST_TOLD, Path, Problem
from fenics_gears.inputs.synonyms import meant
from fenics_gears.inputs.written import as_written
from fenics_gears.scene.schema import SceneText, known_paths, section_within


def problems_of_schema(tree: Mapping[str, Any]) -> tuple[Any, list[Problem]]:
    """The validated ``SceneText`` of a parsed TOML file, None where it is wrong, and all that is wrong with it."""
    try:
        return SceneText.model_validate(tree), []
    except ValidationError as error:
        return None, list(_problems(error.errors(include_url=False), tree))


def _problems(errors: Iterable[Mapping[str, Any]], tree: Mapping[str, Any]) -> Iterator[Problem]:
    """Each error's problem. Only of the first unknown names it is searched what they may mean, which takes time."""
    unknown = 0
    for error in errors:
        unknown += error["type"] == "extra_forbidden"
        if unknown <= MOST_TOLD or error["type"] != "extra_forbidden":
            yield _problem(error, tree)
        else:
            path = tuple(map(str, error["loc"]))
            yield Problem(path, as_written(_value(path, tree)), "is not known.", unknown=True)


def without_echoes(problems: Iterable[Problem]) -> list[Problem]:
    """The problems without those that follow from another: a second one of the same field, or a field that is missing
    because it is misspelt.

    Where a rule and the schema both complain of a name, the rule's message stays.
    """
    by_path: dict[Path, list[Problem]] = {}
    for problem in problems:
        by_path.setdefault(problem.path, []).append(problem)
    first = {path: next((each for each in found if not each.unknown), found[0]) for path, found in by_path.items()}
    unknown = [problem.path for problem in first.values() if problem.unknown]
    return [
        problem for problem in first.values() if problem.written is not None or not _is_misspelt(problem.path, unknown)
    ]


def _is_misspelt(missing: Path, unknown: Iterable[Path]) -> bool:
    return any(
        path[:-1] == missing[:-1] and (nearest(path[-1], missing[-1:]) or meant(path[:-1], path[-1], missing[-1:]))
        for path in unknown
    )


def _problem(error: Mapping[str, Any], tree: Mapping[str, Any]) -> Problem:
    """The problem that one of pydantic's errors stands for."""
    kind, path = error["type"], tuple(map(str, error["loc"]))
    section = _section(path[:-1])
    if kind == "extra_forbidden":
        return Problem(path, as_written(_value(path, tree)), _why_unknown(path, section), unknown=True)
    allowed = allowed_in(section, path[-1])
    if allowed is None:
        return _section_problem(kind, path, tree)
    if kind == "missing":
        return Problem(path, None, f"is missing. Allowed: {allowed.description}.")
    value = _value(path, tree)
    return Problem(path, as_written(value), f"{_reason(error, value, allowed)} Allowed: {allowed.description}.")


_REASONS = {
    "less_than": "is too large.",
    "less_than_equal": "is too large.",
    "finite_number": "is not a finite number.",
    "literal_error": "is not known.",
    "string_too_long": "is too long.",
    "string_type": "is not a text.",
    "bool_type": "is neither true nor false.",
}


def _reason(error: Mapping[str, Any], value: Any, allowed: Allowed) -> str:
    """What is wrong with a value as written, for the error that pydantic reports."""
    kind, context = error["type"], error.get("ctx", {})
    if kind == "quantity":
        return context["reason"]
    if kind in ("greater_than", "greater_than_equal"):
        return f"{_too_low(error['input'], context)} {allowed.below}".rstrip()
    if kind == "literal_error" and isinstance(value, str):
        return "is not known." + did_you_mean(value, re.findall(r"'([^']+)'", context["expected"]))
    if kind in _REASONS:
        return _REASONS[kind]
    if isinstance(value, str):
        return "is a text, not a bare number."
    if isinstance(value, bool):
        return "is true or false, not a number."
    if isinstance(value, int):
        return "is too large."
    if isinstance(value, float):
        return "is not a whole number."
    return "is not a number."


def _too_low(number: float, context: Mapping[str, Any]) -> str:
    lowest = context.get("ge", context.get("gt"))
    if lowest < 0 or number > 0:
        return "is too small."
    return "is negative." if number < 0 else "is zero."


def _section_problem(kind: str, path: Path, tree: Mapping[str, Any]) -> Problem:
    name, fields = ".".join(path), ", ".join(_section(path).model_fields)
    if kind == "missing":
        return Problem(path, None, f"is missing. Add the section [{name}] with its fields: {fields}.")
    return Problem(
        path,
        as_written(_value(path, tree)),
        f"is not a section. Write a line [{name}], and below it its fields: {fields}.",
    )


def _why_unknown(path: Path, section: type[BaseModel]) -> str:
    name, home = path[-1], ".".join(path[:-1])
    known = list(section.model_fields)
    synonym = meant(path[:-1], name, known)
    hint = f' Did you mean "{synonym}"?' if synonym else did_you_mean(name, known) or _lives_elsewhere(name)
    kind = f"a known field of [{home}]" if home else "a known section or field of a scene"
    return f"is not {kind}.{hint} Known: {', '.join(known)}."


def _lives_elsewhere(name: str) -> str:
    # What both gears share stands for what each may have of its own.
    fields = [
        path
        for path in known_paths()
        if len(path) == 2 or len(path) > 2 and (*path[:-2], path[-1]) not in known_paths()
    ]
    homes = [f"[{'.'.join(path[:-1])}]" for path in fields if path[-1] == name]
    if homes:
        return f' "{name}" belongs to {" or ".join(homes)}.'
    # A symbol stands for something else in every section.
    named = [
        f'"{path[-1]}" of [{".".join(path[:-1])}]'
        for path in fields
        if len(name) > 2 and meant(path[:-1], name, path[-1:])
    ]
    return f" Did you mean {' or '.join(named)}?" if named else ""


def _section(path: Path) -> type[BaseModel]:
    """The schema of the section at ``path``."""
    section: type[BaseModel] = SceneText
    for name in path:
        section = section_within(section, name)
    return section


def _value(path: Path, tree: Mapping[str, Any]) -> Any:
    """What the file has at ``path``."""
    value: Any = tree
    for name in path:
        value = value[name]
    return value
