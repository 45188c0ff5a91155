"""A scene's values as TOML, each with its origin in a comment behind it."""

from collections.abc import Iterable, Mapping, Sequence

from fenics_gears import toml_value

from .model import RexsModel
from .stage import Stage
from .values import Value

# Where the comments begin.
COLUMN = 44


def scene_text(
    file: str,
    model: RexsModel,
    stage: Stage,
    sections: Mapping[str, Mapping[str, Value]],
    notes: Mapping[str, Iterable[str]],
) -> str:
    """The TOML text of a scene; ``file`` is the name of the REXS file, ``notes`` are lists under a heading each."""
    named = stage.stage.name or f"stage {stage.stage.id}"
    who = [f"The pair is {stage.stage}: {stage.pinion.gear} drives {stage.wheel.gear}."]
    more = [
        "",
        "Sections that may be added: [friction], [shafts], [bearings], [inertia], [damping], ... (docs/effects.md).",
    ]
    return _head(file, model, who, notes, more) + _body(f"{named} of {file}", sections)


def train_text(
    file: str,
    model: RexsModel,
    who: Sequence[str],
    sections: Mapping[str, Mapping[str, Value]],
    notes: Mapping[str, Iterable[str]],
) -> str:
    """The TOML text of a train's scene, of all stages; `who` drives whom in them."""
    more = ["", "Sections that may be added: [friction], [shafts], [bearings], [inertia], ... (docs/trains.md)."]
    return _head(file, model, list(who), notes, more) + _body(f"gears of {file}", sections)


def _body(title: str, sections: Mapping[str, Mapping[str, Value]]) -> str:
    text = f"\ntitle = {toml_value(_one_line(title)[:500])}\n"
    for section, fields in sections.items():
        text += f"\n{_header(section)}\n" + "".join(_line(name, value) for name, value in fields.items())
    return text


def _header(section: str) -> str:
    """A section's line; numbers in its name count the tables of a list."""
    parts = section.split(".")
    name = ".".join(each for each in parts if not each.isdigit())
    return f"[[{name}]]" if parts[-1].isdigit() else f"[{name}]"


def _head(file: str, model: RexsModel, who: list[str], notes: Mapping[str, Iterable[str]], more: list[str]) -> str:
    program = f"{model.applicationId} {model.applicationVersion}".strip() or "by a program not named"
    lines = [
        f"Made by gears import from {file} (REXS {model.version}, {program}, {model.date or 'without a date'}).",
        *who,
        "Each value is followed by its origin. This is a scene like any other: change what you know better.",
        *(line for heading, items in notes.items() for line in _listed(heading, items)),
        *more,
    ]
    return "".join(f"# {_one_line(line)}".rstrip() + "\n" for line in lines)


def _listed(heading: str, items: Iterable[str]) -> list[str]:
    items = list(items)
    return ["", heading, *(f"  {item}" for item in items)] if items else []


def _line(name: str, value: Value) -> str:
    assumed = "assumed: " if value.assumed else ""
    return f"{f'{name} = {value.written}':<{COLUMN - 1}} # {assumed}{_one_line(value.origin)}\n"


def _one_line(text: str) -> str:
    return "".join(each if each.isprintable() else "?" for each in text)
