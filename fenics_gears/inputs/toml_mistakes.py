"""What is wrong with a text that is no TOML, in the words of who wrote it."""

import re
import tomllib

NAME, PLACE = r"\s*([\w.-]+)\s*=\s*", re.compile(r" \(at (?:line (\d+), column \d+|end of document)\)$")


def why_no_toml(error: Exception, text: str) -> str:
    """What tomllib refused, where, and what to write in its place."""
    if not isinstance(error, tomllib.TOMLDecodeError):
        return (
            "it is nested too deeply" if isinstance(error, RecursionError) else "a number in it has thousands of digits"
        )
    lines, place = text.splitlines(), PLACE.search(str(error))
    number = len(lines) if place is None or place[1] is None else int(place[1])
    line = lines[number - 1] if number <= len(lines) else ""
    where = f"line {number}, {line.strip()[:60]}" if line.strip() else f"line {number}"
    return f"{where}: {_in_words(PLACE.sub('', str(error)), line, lines[: number - 1])}"


def _in_words(said: str, line: str, before: list[str]) -> str:
    if "twice" in said or "Cannot overwrite" in said or "Cannot mutate" in said:
        return _stands_twice(line, before)
    if re.match(r"\s*\[[^\]]*$", line):
        return "the bracket of the section is not closed"
    if re.match(r"\s*[\w.-]+\s*(#.*)?$", line):
        return "a value is missing; write name = value"
    value = re.match(NAME + r"(?![\"'\[{#\s])([^#]*)", line)
    if value is None:
        quotes = line.count('"') % 2 or line.count("'") % 2
        return "the closing quotes are missing" if quotes else said[0].lower() + said[1:]
    name, written = value[1], value[2].strip()
    if re.fullmatch(r"[-+]?\d+,\d+", written):
        return f"a number has a decimal point; write {name} = {written.replace(',', '.')}"
    if written in ("True", "False"):
        return f"write {name} = {written.lower()}"
    return f'quotes are missing; write {name} = "{written}"'


def _stands_twice(line: str, before: list[str]) -> str:
    """With the line that has the same section, or the same name in its section."""
    header = re.match(r"\s*\[([^\[\]]+)\]", line)
    if header:
        pattern, what, remedy = (
            rf"\s*\[\s*{re.escape(header[1])}\s*\]",
            f"the section [{header[1]}]",
            "Put its fields in one",
        )
    else:
        name = re.match(NAME, line)
        what, remedy = (f'"{name[1]}"' if name else "the name"), "Leave one out"
        pattern = rf"\s*{re.escape(name[1])}\s*=" if name else "$."
    first = next((number for number in range(len(before), 0, -1) if re.match(pattern, before[number - 1])), None)
    return f"{what} stands twice{f', first in line {first}' if first else ''}. {remedy}"
