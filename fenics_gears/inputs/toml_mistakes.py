"""What is wrong with a text that is no TOML, in the words of who wrote it: the line, and what to write instead."""

import re
import tomllib
from collections.abc import Iterator

from .problem import line_numbers

_PLACE = re.compile(r" \(at (?:line (\d+), column \d+|end of document)\)$")
_FIELD = re.compile(r"\s*([A-Za-z0-9_.\"'-]+)\s*=\s*(.*?)\s*$")
# What an editor or a page makes of straight quotes.
_CURLED = "“”„‘’‚«»′″"
_LONGEST = 60
_NUMBER = re.compile(r"[+-]?[\d.,_]+(?:[eE][+-]?\d*)?")


def in_words(error: tomllib.TOMLDecodeError, text: str, source: str) -> str:
    """Two lines for people, as for any other mistake: file, line and its text; what to write."""
    lines = text.splitlines()
    place = _PLACE.search(str(error))
    own = _PLACE.sub("", str(error))
    number = int(place[1]) if place is not None and place[1] else _open_quote(lines)
    written = lines[number - 1].strip() if 0 < number <= len(lines) else ""
    shown = written if len(written) <= _LONGEST else written[: _LONGEST - 3] + "..."
    said = next(_said(own, written, text, number), f"is not valid TOML: {own}.")
    return f"{source}:{number}: {shown}\n    {said}"


def _said(own: str, written: str, text: str, number: int) -> Iterator[str]:
    """What TOML's `own` words mean in the line that is `written`; nothing where they say it as well."""
    if match := _HEADER_TWICE.match(own):
        name = ".".join(re.findall(r"'([^']*)'", match[1]))
        yield f"[{name}] is there twice{_first(text, name, number)}. Put all of its fields below one of them."
    if own.startswith(("Cannot overwrite a value", "Cannot mutate", "Cannot redefine")):
        if field := _FIELD.match(written):
            yield f"{field[1]} is given twice{_first(text, field[1], number)}. Leave one out."
        if written.startswith("[["):
            name = written.strip("[] ")
            yield f"{name} is given above{_first(text, name, number)}. Write [[{name}]] there too, or leave one out."
    if any(each in written for each in _CURLED):
        yield 'has typographic quotes. Write straight ones: ".'
    if own.startswith("Unclosed") or own == "Expected ']' at the end of an array":
        yield "a list or a table has no end: its ] or } is missing."
    if written.startswith("["):
        yield "is no name of a section. Write it between brackets, such as [gears.pinion]."
    yield from _value(own, written)


_HEADER_TWICE = re.compile(r"Cannot declare (\(.*\)) twice")


def _value(own: str, written: str) -> Iterator[str]:
    field = _FIELD.match(written)
    if field is None:
        if own.startswith("Expected '='"):
            yield 'has no = between a field and its value. Write it as in module = "4.5 mm".'
        return
    name = field[1]
    value = re.sub(r"\s+#.*$", "", field[2])
    if not value or value.startswith("#"):
        yield f"{name} has no value."
    elif value[0] in "\"'":
        closed = value.count(value[0]) > 1
        after = value.rpartition(value[0])[2].strip()
        yield f"has {after} behind the value. Leave it out." if closed and after else "has quotes that do not end."
    elif _NUMBER.fullmatch(value):
        yield "is no number. A number has a point, a digit before and behind it, and no zero in front: 0.5, 16."
    elif value.lower() in ("true", "false"):
        yield f"is written {value.lower()}."
    elif value[0] not in "[{":
        yield f'lacks quotes: a word, or a number with its unit, goes between them. Write {name} = "{value}".'


def _open_quote(lines: list[str]) -> int:
    """The first line, from 1, of a value whose quotes do not end in it; the last one without any."""
    for number, line in enumerate(lines, 1):
        field = _FIELD.match(line)
        if field and field[2][:1] in ("'", '"') and field[2].count(field[2][0]) % 2:
            return number
    return len(lines)


def _first(text: str, name: str, number: int) -> str:
    """Where a name of a section, or of a field of the section at a line, comes first."""
    before = "\n".join(text.splitlines()[: number - 1])
    lines = [line for path, line in line_numbers(before).items() if ".".join(path) == name or path[-1:] == (name,)]
    return f", first in line {lines[-1]}" if lines else ""
