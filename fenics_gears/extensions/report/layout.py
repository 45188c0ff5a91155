"""The layout of a customer's report: whose it is, its logo, its sections in order, and limits of its numbers.

``gears report RUN --layout FILE.toml``.
"""

from __future__ import annotations

import base64
import datetime
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from fenics_gears import MICRORADIANS, SceneError, user_file
from fenics_gears.many_runs import LARGEST_OF_SETS, OF_TRAINS, RESULT_ATTRIBUTES
from fenics_gears.pages import Cell, Letterhead, Page, PageSection, Table, Words
from fenics_gears.scene_text import (
    Limit,
    Problem,
    Section,
    as_written,
    did_you_mean,
    limits_of,
    line_numbers,
    listed,
    names_in,
    parsed,
    read,
    text,
    text_of,
    what_is_allowed,
)
from fenics_gears.shown import digits

PICTURES = {".png": "image/png", ".svg": "image/svg+xml", ".jpg": "image/jpeg", ".jpeg": "image/jpeg"}
LARGEST_LOGO = 2_000_000
LONGEST = 200
LIMITS = "limits"
UNKNOWN = "not in this run"
SECTIONS = "sections"
# Gear data stand on the first page, then what matters.
FIRST = ("geometry", LIMITS, "summary", "warnings")
# Numbers of a result that may have a limit, by name, with their unit there.
LIMITED = {each.name: each.units for each in RESULT_ATTRIBUTES if each.units}
# Those of the whole train, which has no base circle.
LIMITED_OF_TRAINS = {
    name: units for name, (units, _) in {**OF_TRAINS, **LARGEST_OF_SETS}.items() if name not in LIMITED
}
LIMITED |= LIMITED_OF_TRAINS


def _words(meaning: str, otherwise: str = "none") -> Any:
    return text(LONGEST, meaning=meaning, otherwise=otherwise)


@dataclass(frozen=True)
class LayoutText(Section):
    """What stands at the head of a report."""

    title: str | None = _words("title of the report", "that of the scene")
    author: str | None = _words("who wrote it")
    company: str | None = _words("for or from whom it is")
    number: str | None = _words("number of the report or of the drawing")
    date: str | None = _words("its date, as it is to be printed", "today")
    logo: str | None = _words("a picture, .png, .svg or .jpg, looked for from the layout's folder")


@dataclass(frozen=True)
class ReportLayout:
    """A layout that was read: its head, its sections in order (None: the usual ones), its limits by
    the names of numbers."""

    head: LayoutText
    sections: tuple[str, ...] | None
    limits: tuple[tuple[str, Limit], ...]
    logo: str = ""
    source: str = ""


def load_layout(path: Path) -> ReportLayout:
    """Read a layout. Raises SceneError, naming all mistakes at once."""
    content = text_of(path, "layout")
    tree = dict(parsed(content, str(path)))
    sections = tree.pop(SECTIONS, None)
    limits = tree.pop(LIMITS, {})
    head, problems = read(LayoutText, tree)
    known = (*names_in(LayoutText), SECTIONS, LIMITS)
    problems = [_explained(each, known) for each in problems]
    if sections is not None and not _is_list_of_texts(sections):
        message = 'is no list of names. Allowed: such as ["geometry", "limits", "summary"].'
        problems.append(Problem((SECTIONS,), as_written(sections), message))
    read_limits = list(_limits(limits, problems))
    if problems:
        raise SceneError(listed(problems, line_numbers(content), str(path)))
    order = None if sections is None else tuple(sections)
    return ReportLayout(head, order, tuple(read_limits), _logo(path, head.logo), str(path))


def _explained(problem: Problem, known: Sequence[str]) -> Problem:
    if not problem.unknown:
        return problem
    hint = did_you_mean(problem.path[-1], known)
    return replace(problem, message=f"is no field of a report's layout.{hint} Known: {', '.join(known)}.")


def _is_list_of_texts(value: Any) -> bool:
    return isinstance(value, list) and bool(value) and all(isinstance(each, str) for each in value)


def _limits(table: Any, problems: list[Problem]) -> Iterator[tuple[str, Limit]]:
    """The limits of ``[limits]`` by the names of their numbers; mistakes are added to the problems."""
    if not isinstance(table, Mapping):
        problems.append(Problem((LIMITS,), as_written(table), "is no section. Write [limits], and below it numbers."))
        return
    for name, ends in table.items():
        message = f"is no number of a result that can have a limit.{did_you_mean(name, LIMITED)}"
        if name in LIMITED:
            along = LIMITED[name] == "rad" and name not in LIMITED_OF_TRAINS
            units = (LIMITED[name], "um") if along else (LIMITED[name],)
            found = limits_of(ends, *units)
            if found is not None:
                yield from ((name, each) for each in found)
                continue
            message = what_is_allowed(*units)
        else:
            message += " The page on results has them all."
        problems.append(Problem((LIMITS, name), as_written(ends), message))


def _logo(layout: Path, name: str | None) -> str:
    """The picture as a data address; empty where there is none."""
    if name is None:
        return ""
    path = layout.parent / name
    kind = PICTURES.get(path.suffix.lower())
    if kind is None:
        raise SceneError(f"{layout}: logo = {as_written(name)} is no picture. Allowed: {', '.join(PICTURES)}.")
    try:
        content = user_file.content_of(path, LARGEST_LOGO)
    except user_file.Unreadable as problem:
        raise SceneError(f"{layout}: logo: {path}: {problem}") from None
    return f"data:{kind};base64,{base64.b64encode(content).decode()}"


def laid_out(page: Page, layout: ReportLayout, numbers: Mapping[str, Any], micrometres: Any) -> Page:
    """The page with the head, the sections and the limits of a layout; `numbers`: of the result, `micrometres`: of one
    radian of the wheel along the line of action; of a train both of all its meshes (n,), of which the worst counts.
    Raises SceneError for a section that the page has not."""
    by_name = {each.name: each for each in page.sections}
    if layout.limits:
        by_name[LIMITS] = _limit_section(layout.limits, numbers, micrometres)
    order = layout.sections
    if order is None:
        first = [name for name in FIRST if name in by_name]
        order = (*first, *(name for name in by_name if name not in first))
    unknown = [name for name in order if name not in by_name]
    if unknown:
        known = ", ".join(by_name)
        hint = did_you_mean(unknown[0], by_name)
        raise SceneError(f"{layout.source}: sections: {unknown[0]} is no section of this report.{hint} Known: {known}.")
    head = layout.head
    facts = {name: getattr(head, name) for name in ("author", "company", "number")}
    facts["date"] = head.date or f"{datetime.datetime.now().astimezone():%Y-%m-%d}"
    letterhead = Letterhead([(name, value) for name, value in facts.items() if value], layout.logo)
    sections = [by_name[name] for name in order]
    return replace(page, title=head.title or page.title, sections=sections, letterhead=letterhead)


def _limit_section(limits: Sequence[tuple[str, Limit]], numbers: Mapping[str, Any], micrometres: Any) -> PageSection:
    """A table of the limits: what was computed, and whether it is kept."""
    rows = [_row(*each, numbers, micrometres) for each in limits]
    unknown = sum(each[-1].text == UNKNOWN for each in rows)
    broken = sum(each[-1].warns for each in rows) - unknown
    said = [
        f"{count} of {len(rows)} limits {'is' if count == 1 else 'are'} {words}."
        for count, words in ((broken, "not kept"), (unknown, "on numbers that this run does not have"))
        if count
    ]
    table = Table(("number", "limit", "computed", "result"), rows, numbers=1)
    return PageSection(LIMITS, "Limits", [Words(" ".join(said) or "All are kept.", warns=bool(said)), table])


def _row(name: str, limit: Limit, numbers: Mapping[str, Any], micrometres: Any) -> list[Cell]:
    label = name.replace("_", " ")
    bound = f"{limit.end.replace('_', ' ')} {limit.written}"
    # An angle may have its limit as a length on the wheel's base circle.
    values = np.asarray(numbers.get(name, math.nan)) * (micrometres if limit.unit != LIMITED[name] else 1.0)
    value = float(np.fmax.reduce(values, None) if limit.end == "at_most" else np.fmin.reduce(values, None))
    if not math.isfinite(value):
        return [Cell(label), Cell(bound), Cell("-"), Cell(UNKNOWN, warns=True)]
    largest = limit.value
    over = value > largest if limit.end == "at_most" else value < largest
    off = f"off by {100.0 * abs(value / largest - 1.0):.2g} %" if over and largest else "not kept" if over else "kept"
    computed = f"{digits(MICRORADIANS * value)} urad" if limit.unit == "rad" else f"{digits(value)} {limit.unit}"
    computed = computed.removesuffix(" 1")
    return [Cell(label), Cell(bound), Cell(computed), Cell(off, warns=over)]
