"""docs/scene.md, made from the schema."""

import re
from collections.abc import Iterator
from dataclasses import dataclass

from tests.docs.markdown import capital, from_docstring, prose, table

from fenics_gears.effects import effect_named, every_effect
from fenics_gears.inputs import units
from fenics_gears.inputs.allowed import Allowed
from fenics_gears.inputs.section import AllowedTables, Section, allowed_in, names_in, required_in, section_within
from fenics_gears.scene.schema import scene_text

ALWAYS = ("gears", "load", "motion")
# The names that a section's docstring begins with; the page has them in the heading.
NAMES = re.compile(r"^`\[[^]]+\]`(?: and (?:`\[[^]]+\]`|the wheel's))?[.:;]\s*")


class NoMeaning(ValueError):
    pass


@dataclass(frozen=True)
class SectionOfScene:
    """The names under which a scene has it, what it is, and its fields with their own defaults."""

    names: tuple[str, ...]
    kind: type[Section]


def page() -> str:
    lines = [prose("scene.md"), *_units(), "## Top of the file", "", *fields(scene_text(), "the top")]
    lines += ["## Gears, load and motion", ""]
    for name in ALWAYS:
        lines += _with_parts(name)
    lines += ["## Accuracy and output", ""]
    for name in ("accuracy", "output"):
        lines += _with_parts(name)
    lines += ["## Effects", "", "[Effects](effects.md#examples) has an example of each.", ""]
    for each in every_effect():
        if not each.within:
            lines += _effect(each.section)
    return "\n".join(lines).rstrip() + "\n"


def _units() -> list[str]:
    rows = [(kind, ", ".join(f"`{name}`" for name in names)) for kind, names in units.names_by_kind().items()]
    words = (
        "These units may be combined by blanks, `*`, `/`, `^` and brackets (`kg m^2`, `N/mm`). Other prefixes are not"
        " accepted. A speed may also be in `min^-1` or `1/min`."
    )
    return ["## Units", "", words, "", *table(("for", "units"), rows), ""]


def _effect(name: str) -> list[str]:
    found = effect_named(name)
    lines = [f"### `[{found.written}]`", "", f"{capital(found.description)} Without this section: {found.absent}."]
    for words, names in (("Needs", found.needs), ("Excludes", found.excludes)):
        if names:
            lines.append(f"{words} {', '.join(f'`[{effect_named(name).written}]`' for name in names)}.")
    section = SectionOfScene((name,), found.fields)
    return [*lines, "", *_body(section), *_parts(section)]


def _with_parts(name: str) -> list[str]:
    section = SectionOfScene((name,), section_within(scene_text(), name))
    return [f"### `[{name}]`", "", *_body(section), *_parts(section)]


def _body(section: SectionOfScene) -> list[str]:
    words = NAMES.sub("", from_docstring(section.kind.__doc__))
    return [*([capital(words), ""] if words else []), *fields(section.kind, section.names[0])]


def _parts(section: SectionOfScene) -> Iterator[str]:
    """Sections within a section and listed tables; those of both gears together."""
    alike: dict[type, list[str]] = {}
    for name in names_in(section.kind):
        inner, allowed = section_within(section.kind, name), allowed_in(section.kind, name)
        if inner is not None:
            alike.setdefault(inner, []).extend(f"{outer.strip('[]')}.{name}" for outer in section.names)
        elif isinstance(allowed, AllowedTables):
            # Those of a field "each" are all that the section has.
            places = (outer if name == "each" else f"{outer}.{name}" for outer in section.names)
            alike.setdefault(allowed.section, []).extend(f"[{place}]" for place in places)
    for kind, names in alike.items():
        part = SectionOfScene(tuple(names), kind)
        yield from [f"#### {', '.join(f'`[{name}]`' for name in names)}", "", *_body(part), *_parts(part)]


def fields(kind: type[Section], place: str) -> list[str]:
    """The table of a section's fields; raises NoMeaning."""
    rows = []
    for name in names_in(kind):
        allowed = allowed_in(kind, name)
        if allowed is not None:
            rows.append(
                (
                    f"`{name}`",
                    _meaning(allowed, f"{place}.{name}"),
                    _allowed(allowed),
                    "required" if name in required_in(kind) else allowed.otherwise,
                )
            )
    return [*table(("field", "meaning", "allowed", "default"), rows), ""] if rows else []


def _meaning(allowed: Allowed, path: str) -> str:
    if not allowed.meaning:
        raise NoMeaning(f"{path}: the field has no meaning; say what it is, by meaning=, where it is declared")
    return allowed.meaning


def _allowed(allowed: Allowed) -> str:
    """What is allowed, with what is to be typed as code."""
    words = allowed.description.replace(", with its unit", "").replace(", without unit", "")
    return re.sub(r'(\[\{.*\}\]|\["[^]]*\]|"[^"]*"|(?<=such as )[^"\[,\s]+)', r"`\1`", words)
