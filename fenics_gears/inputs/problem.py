"""A mistake in a scene file, its line, and the known name that a misspelt one is nearest to or stands for."""

import difflib
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache

from fenics_gears.errors import SceneError

Path = tuple[str, ...]
# By this name a section has the tables that a file may also list in its place.
LISTED = "each"
# What a rule finds in a parsed scene: each place where it is broken, and what to do about it.
Broken = Iterator[tuple[Path, str]]


@dataclass(frozen=True)
class Problem:
    """One mistake: the field's path, its value as written, and what to do about it.

    ``written`` is None where nothing is written and empty for a section; ``unknown`` marks a name that no scene has.
    """

    path: Path
    written: str | None
    message: str
    unknown: bool = False

    def line(self, lines: Mapping[Path, int]) -> int:
        """The line of the field or of the section that lacks it; 0 where neither is found."""
        return next((lines[self.path[:n]] for n in range(len(self.path), 0, -1) if self.path[:n] in lines), 0)

    def describe(self, source: str, lines: Mapping[Path, int]) -> str:
        """Two lines for people: file, line, field and value; what is wrong and what is allowed."""
        line = self.line(lines)
        place = f"{source}:{line}" if line else source
        field = ".".join(self.path).removesuffix(f".{LISTED}" if self.written == "a list" else "")
        if self.written is not None:
            field = f"{field} = {self.written}" if self.written else f"[{field}]"
        return f"{place}: {field}\n    {self.message}"


# More mistakes than these are counted, not told: they are of a file that is no scene.
MOST_TOLD = 20
NOTHING_DONE = "Nothing was computed or written."


def listed(problems: Sequence[Problem], lines: Mapping[Path, int], source: str) -> str:
    """The message on the problems of a file: how many there are, and the first of them with their lines."""
    first = sorted(problems, key=lambda each: each.line(lines))[:MOST_TOLD]
    return counted([problem.describe(source, lines) for problem in first], len(problems), source)


def counted(entries: Sequence[str], count: int, source: str) -> str:
    more = [f"... and {count - MOST_TOLD} more"] if count > MOST_TOLD else []
    total = f"{count} mistake{'s' if count > 1 else ''} in {source}. {NOTHING_DONE}"
    return "\n".join([*entries[:MOST_TOLD], *more, total])


class Mistakes:
    """The mistakes of a file so far, each once."""

    def __init__(self, source: str, lines: Mapping[Path, int]):
        self._source = source
        self._lines = lines
        self._said: dict[str, None] = {}

    def add(self, path: Path, written: str | None, message: str) -> None:
        """Note a mistake at a path of the file; ``written`` as for `Problem`."""
        problem = Problem(path, written, message)
        self._said.setdefault(problem.describe(self._source, self._lines))

    def check(self) -> None:
        if self._said:
            raise SceneError(counted(list(self._said), len(self._said), self._source))


def placed(said: str, text: str, source: str) -> str:
    """Objections against a scene as a whole, one below another: each with the line of the field that it begins with, of
    a gear's name that of the gear's section."""
    lines = line_numbers(text)
    told = []
    for each in said.removesuffix(NOTHING_DONE).strip().splitlines():
        begins = re.match(r"[a-z_]+(?:\.[a-z0-9_]+)*(?= =|:)", each)
        path = tuple(begins[0].split(".")) if begins else ()
        problem = Problem(("gears", *path) if ("gears", *path) in lines else path, None, "")
        line = problem.line(lines)
        told.append(f"{source}:{line}: {each}" if line else each if each[:1] == " " else f"{source}: {each}")
    return "\n".join([*told, NOTHING_DONE])


_NAME = r"(?:[A-Za-z0-9_-]+|\"[^\"]*\"|'[^']*')"
_DOTTED = rf"{_NAME}(?:\s*\.\s*{_NAME})*"
_HEADER = re.compile(rf"\s*\[\[?\s*({_DOTTED})\s*\]")
_KEY = re.compile(rf"\s*({_DOTTED})\s*=")


def line_numbers(text: str) -> dict[tuple[str, ...], int]:
    """The line, counted from 1, of each section header and each key that begins a line, by its path."""
    numbers: dict[tuple[str, ...], int] = {}
    section: tuple[str, ...] = ()
    within_text = False
    for number, line in enumerate(text.splitlines(), 1):
        # A text over several lines may hold anything, also what looks like a key.
        begins_within = within_text
        within_text = within_text ^ (len(re.findall(r'"""|\'\'\'', line)) % 2 == 1)
        if begins_within:
            continue
        if header := _HEADER.match(line):
            section = _path(header[1])
            numbers.setdefault(section, number)
        elif key := _KEY.match(line):
            numbers.setdefault((*section, *_path(key[1])), number)
    return numbers


def _path(dotted: str) -> tuple[str, ...]:
    return tuple(name.strip("\"'") for name in re.findall(_NAME, dotted))


def nearest(word: str, names: Iterable[str], likeness: float = 0.6) -> str | None:
    """The one of ``names`` that ``word`` most likely meant, whatever its case; None where none is alike.

    >>> nearest("frictoin", ["friction", "inertia"])
    'friction'
    >>> nearest("oil", ["friction", "inertia"]) is None
    True
    """
    return _nearest(word, tuple(names), likeness)


@lru_cache(maxsize=1024)
def _nearest(word: str, names: tuple[str, ...], likeness: float) -> str | None:
    """Cached: scenes of a study have the same names hundreds of times."""
    by_lower_case = {name.lower(): name for name in names}
    if word.lower() in by_lower_case:
        return by_lower_case[word.lower()]
    near = difflib.get_close_matches(word.lower(), by_lower_case, n=1, cutoff=likeness)
    return by_lower_case[near[0]] if near else None


def did_you_mean(word: str, names: Iterable[str], likeness: float = 0.6) -> str:
    """A question naming the nearest known name, with a blank before it; empty where none is alike."""
    name = nearest(word, names, likeness)
    return f' Did you mean "{name}"?' if name else ""


def meant(section: Iterable[str], word: str, known: Iterable[str]) -> str | None:
    """The one of the known names of a section (its path) that engineers also call `word`; None where none is.

    >>> meant(["tip_relief", "pinion"], "amount", ["depth", "start"])
    'depth'
    """
    from .synonyms import SYNONYMS

    section = tuple(section)
    known = tuple(known)
    homes = [section, *([section[:-1], (*section[:-1], "pinion")] if section[-1:] in (("pinion",), ("wheel",)) else [])]
    pairs = ((name, ".".join((*home, name))) for home in homes for name in known)
    return next((name for name, path in pairs if word.lower() in SYNONYMS.get(path, "").split()), None)
