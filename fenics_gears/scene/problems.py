"""Mistakes of a scene file against its schema, in sentences that say what to do."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from typing import Any

from fenics_gears.inputs.names import did_you_mean, meant, nearest
from fenics_gears.inputs.problem import MOST_TOLD, Path, Problem
from fenics_gears.inputs.section import read
from fenics_gears.scene.schema import known_paths, scene_text


def checked(tree: Mapping[str, Any]) -> tuple[Any, list[Problem]]:
    """The sections of a parsed TOML file, None where it is wrong, and all that is wrong with it."""
    section, problems = read(scene_text(tree), tree)
    return section, list(_explained(problems))


def _explained(problems: Iterable[Problem]) -> Iterator[Problem]:
    """Unknown names with what they may mean, which takes time to search: the first of them alone."""
    unknown = 0
    for problem in problems:
        unknown += problem.unknown
        if not problem.unknown:
            yield problem
        else:
            yield replace(problem, message=_why_unknown(problem.path) if unknown <= MOST_TOLD else "is not known.")


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


def _why_unknown(path: Path) -> str:
    name, home = path[-1], ".".join(path[:-1])
    known = [each[-1] for each in known_paths() if each[:-1] == path[:-1]]
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
