"""A scene as a table for notebooks: its sections, fields and values with their units."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from html import escape
from typing import Any

from fenics_gears.inputs.section import allowed_in, section_within
from fenics_gears.inputs.written import toml_value
from fenics_gears.scene.data import Scene
from fenics_gears.scene.schema import scene_text
from fenics_gears.scene.write import section_trees

MOST_LETTERS = 80
CELL = '<td style="text-align: left">{}</td>'


def html(scene: Scene) -> str:
    """The fields that are not at their defaults, as a scene file has them, and what each of them is."""
    rows = "".join(
        f"<tr>{''.join(CELL.format(escape(cell)) for cell in row)}</tr>"
        for row in rows_of(section_trees(scene), scene_text())
    )
    head = "".join(f'<th style="text-align: left">{word}</th>' for word in ("field", "value", "meaning"))
    return f"<table><caption>{escape(scene.title)}</caption><thead><tr>{head}</tr></thead><tbody>{rows}</tbody></table>"


def rows_of(tree: Mapping[str, Any], section: Any, home: str = "") -> Iterator[tuple[str, str, str]]:
    """Name with its sections, value, and meaning, of all fields of a section's tree."""
    for name, value in tree.items():
        inner = section_within(section, name)
        if inner is not None:
            yield (f"[{home}{name}]", "", "")
            yield from rows_of(value, inner, f"{home}{name}.")
        else:
            text, meaning = value if isinstance(value, str) else toml_value(value), allowed_in(section, name).meaning
            yield (f"{home}{name}", text if len(text) <= MOST_LETTERS else text[: MOST_LETTERS - 3] + "...", meaning)
