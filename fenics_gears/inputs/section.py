"""A section of a scene, declared once: a frozen dataclass whose fields say what they allow (``inputs.fields``).

``read`` makes one of a parsed file and tells what is wrong; ``tree_of`` is the way back, bit for bit.
"""

import functools
from collections.abc import Collection, Iterator, Mapping
from dataclasses import MISSING, Field, dataclass, fields, replace
from typing import Any, ClassVar, get_args, get_type_hints

from .allowed import Allowed, Refused
from .problem import Path, Problem, did_you_mean
from .written import as_written


class Section:
    """A section of a scene. Its subclasses are frozen dataclasses; a field that is of one is a section within it.

    ``empty``: what is wrong with a section that says nothing, empty where nothing is. ``alternatives``: groups of
    fields of which at most one is given.
    """

    empty: ClassVar[str] = ""
    alternatives: ClassVar[tuple[tuple[str, ...], ...]] = ()


def allowed_in(section: type[Section], name: str) -> Allowed | None:
    """What the field of that name allows; None for a section within a section."""
    return _allowed(section).get(name)


def section_within(section: type[Section], name: str) -> type[Section] | None:
    """The section of that name within a section; None where the name is a plain field."""
    return _sections(section).get(name)


@functools.cache
def names_in(section: type[Section]) -> tuple[str, ...]:
    """Names of all that a section may have in a file; a field that declares nothing is of the data alone."""
    return tuple(each.name for each in fields(section) if {each.name} & {*_allowed(section), *_sections(section)})


@functools.cache
def required_in(section: type[Section]) -> frozenset[str]:
    return frozenset(each.name for each in fields(section) if _default(each) is MISSING)


@functools.cache
def _allowed(section: type[Section]) -> dict[str, Allowed]:
    return {each.name: each.metadata["allowed"] for each in fields(section) if "allowed" in each.metadata}


@functools.cache
def _sections(section: type[Section]) -> dict[str, type[Section]]:
    hints = get_type_hints(section).items()
    kinds = {name: _section_of(hint) for name, hint in hints if name not in _allowed(section)}
    return {name: kind for name, kind in kinds.items() if kind is not None}


def _section_of(hint: Any) -> type[Section] | None:
    kinds = (each for each in (hint, *get_args(hint)) if isinstance(each, type))
    return next((each for each in kinds if issubclass(each, Section)), None)


class PartRefused(Refused):
    """A part of the value is not allowed; the message says what is allowed of that part too."""


def read_by_itself(section: type[Section], tree: Mapping[str, Any], path: Path) -> tuple[Any, list[Problem]]:
    """As `read`; unknown names are told with those of the section that they are in."""
    found, problems = read(section, tree, path)

    def told(problem: Problem) -> Problem:
        home: type[Section] = section
        for name in problem.path[len(path) : -1]:
            home = section_within(home, name) or home
        known = names_in(home)
        said = f"is not known here.{did_you_mean(problem.path[-1], known)} Known: {', '.join(known)}."
        return replace(problem, message=said)

    return found, [told(each) if each.unknown else each for each in problems]


def read(section: type[Section], tree: Mapping[str, Any], path: Path = ()) -> tuple[Any, list[Problem]]:
    """The section that a parsed file has at a path, None where it is wrong, and all that is wrong with it.

    An unknown name has no message yet: what it may mean depends on the whole scene.
    """
    values: dict[str, Any] = {}
    problems = [Problem(path, "", section.empty)] if section.empty and not tree else []
    for name in names_in(section):
        written = tree.get(name)
        place = (*path, name)
        inner = section_within(section, name)
        if written is None:
            problems += _missing(section, name, place) if name in required_in(section) else ()
        elif inner is None:
            allowed = _allowed(section)[name]
            try:
                values[name] = allowed.convert(written)
            except PartRefused as reason:
                problems.append(Problem(place, as_written(written), str(reason)))
            except Refused as reason:
                problems.append(Problem(place, as_written(written), f"{reason} Allowed: {allowed.description}."))
        elif isinstance(written, Mapping):
            values[name], wrong = read(inner, written, place)
            problems += wrong
        else:
            message = f"is not a section. Write a line [{'.'.join(place)}], and below it {fields_of(inner)}."
            problems.append(Problem(place, as_written(written), message))
    problems += _beside_another(section, tree, path)
    problems += (
        Problem((*path, name), as_written(written), "", unknown=True)
        for name, written in tree.items()
        if name not in names_in(section)
    )
    return (None if problems else section(**values)), problems


def _beside_another(section: type[Section], tree: Mapping[str, Any], path: Path) -> Iterator[Problem]:
    for group in section.alternatives:
        first, *others = [name for name in group if name in tree] or ("",)
        allowed = f"one of {'the two' if len(group) == 2 else ', '.join(group)}"
        for name in others:
            message = f"is given together with {first}; allowed is {allowed}. Leave one out."
            yield Problem((*path, name), as_written(tree[name]), message)


def given(section: type[Section], tree: Mapping[str, Any], path: Path = ()) -> Iterator[tuple[Path, Allowed, Any]]:
    """The fields that a parsed file gives: path, what is allowed there, and what is written."""
    for name, written in tree.items():
        inner = section_within(section, name)
        allowed = allowed_in(section, name)
        if allowed is not None:
            yield (*path, name), allowed, written
        elif inner is not None and isinstance(written, Mapping):
            yield from given(inner, written, (*path, name))


def _missing(section: type[Section], name: str, place: Path) -> Iterator[Problem]:
    inner = section_within(section, name)
    allowed = allowed_in(section, name)
    if allowed is not None:
        yield Problem(place, None, f"is missing. Allowed: {allowed.description}.")
    elif inner is not None:
        yield Problem(place, None, f"is missing. Add the section [{'.'.join(place)}] with {fields_of(inner)}.")


def fields_of(section: type[Section]) -> str:
    """The fields that a section may have; of those in one group at most one is given."""
    others = {name: group[0] for group in section.alternatives for name in group[1:]}
    groups = {name: [name] for name in names_in(section) if name not in others}
    for name, first in others.items():
        groups[first].append(name)
    return f"its fields: {', '.join(map(' or '.join, groups.values()))}"


@dataclass(frozen=True, kw_only=True)
class AllowedTables(Allowed):
    """A list of tables, each a ``section`` that is called ``singular``; ``empty``: what to do instead of giving
    none."""

    section: type[Section]
    singular: str
    empty: str
    most: int

    def convert(self, value: Any) -> tuple[Any, ...]:
        if not isinstance(value, list):
            raise Refused("is not a list.")
        if not 0 < len(value) <= self.most:
            raise Refused(f"has {len(value)} entries." if value else f"is empty. {self.empty}")
        return tuple(self._entry(place, entry) for place, entry in enumerate(value, 1))

    def _entry(self, place: int, entry: Any) -> Any:
        names = names_in(self.section)
        if not isinstance(entry, Mapping):
            listed = f"{', '.join(names[:-1])} and {names[-1]}"
            raise Refused(f"has the entry {as_written(entry)} at place {place}, which is no table of {listed}.")
        part, problems = read(self.section, entry)
        # An unknown name first: it may be what is missing.
        for problem in sorted(problems, key=lambda each: not each.unknown):
            name = ".".join(problem.path)
            where = f"at place {place}"
            if problem.unknown:
                raise Refused(f'has "{name}" {where}, which no {self.singular} has.{did_you_mean(name, names)}')
            if problem.written is None:
                raise Refused(f"has no {name} {where}.")
            raise PartRefused(f"has {name} = {problem.written} {where}, which {problem.message}")
        return part

    def spelled(self, value: Any) -> list[dict[str, Any]]:
        return [tree_of(each) for each in value]


def tree_of(values: Any, section: type[Section] | None = None, leaving: Collection[str] = ()) -> dict[str, Any]:
    """A section as a scene file has it: that of the values, or another ``section`` with fields of the same names.

    Left out are None, defaults and the fields ``leaving``; but a section that may not be empty has one of its fields.
    """
    section = section or type(values)
    tree: dict[str, Any] = {}
    usual: dict[str, Any] = {}
    for each in fields(values):
        name = each.name
        value = getattr(values, each.name)
        if name not in names_in(section) or name in leaving or value is None:
            continue
        if value == _default(each) and name not in required_in(section):
            usual.setdefault(name, value)
            continue
        inner = section_within(section, name)
        tree[name] = field_of(section, name, value) if inner is None else tree_of(value, inner)
    if section.empty and not tree and not leaving:
        tree = {name: field_of(section, name, value) for name, value in [*usual.items()][:1]}
    return tree


def field_of(section: type[Section], name: str, value: Any) -> Any:
    """A value of a section's field as a scene file has it."""
    return _allowed(section)[name].spelled(value)


def own_or_shared(own: Section | None, shared: Section, name: str) -> Any:
    """A field of one gear: its own section's, else that of the section of both gears; None where neither has it."""
    value = None if own is None else getattr(own, name)
    return getattr(shared, name) if value is None else value


def _default(each: Field) -> Any:
    return each.default if each.default_factory is MISSING else each.default_factory()
