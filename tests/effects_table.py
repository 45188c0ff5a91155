"""Write the documentation's table of effects from the list: `python -m tests.effects_table`. Writes docs/effects.md."""

from __future__ import annotations

from pathlib import Path

from tests.effects.examples import EXAMPLES

from fenics_gears.effects import COMMON_VARIABLES, EFFECTS, effect_named
from fenics_gears.effects.effect import Effect

PAGE = Path(__file__).parents[1] / "docs" / "effects.md"
HEADING = """# Effects

A scene always has `[gears]`, `[load]` and `[motion]`. Each section below is an effect: named, it is simulated; left out, it is not constructed: no
unknowns, no terms, no result variables, and the modules that compute it are not imported. `gears check SCENE` says of each whether it is on,
`gears effects SCENE` what each costs and what it changes in the answer. How to add one: [adding_an_effect.md](adding_an_effect.md).

This page is written by `python -m tests.effects_table` from `fenics_gears.effects.EFFECTS`; a test says when it is out of date.
"""


def page() -> str:
    """The whole page."""
    lines = [HEADING, "| section | what | without it | adds | needs | excludes |", "|---|---|---|---|---|---|"]
    lines += [_row(each) for each in EFFECTS]
    lines += ["", "## Examples", ""]
    for each in EFFECTS:
        lines += ["```toml", EXAMPLES[each.section].strip(), "```", ""]
    lines += ["## Result variables of each effect", "", "Every run has " + _names(COMMON_VARIABLES) + ".", ""]
    lines += ["| variable | units | is | effect |", "|---|---|---|---|"]
    for each in EFFECTS:
        for found in each.variables:
            beside = f", beside `[{effect_named(found.needs).written}]`" if found.needs else ""
            lines.append(f"| `{found.name}` | {found.units} | {found.long_name} | `[{each.written}]`{beside} |")
    return "\n".join(lines) + "\n"


def _row(each: Effect) -> str:
    added = [f"{kind}: {', '.join(words)}" for kind, words in (("unknowns", each.unknowns), ("terms", each.terms)) if words]
    if each.variables:
        added.append("results: " + _names(each.variables))
    needs, excludes = (", ".join(f"`[{effect_named(name).written}]`" for name in names) for names in (each.needs, each.excludes))
    return f"| `[{each.written}]` | {each.description} | {each.absent} | {'; '.join(added)} | {needs} | {excludes} |"


def _names(variables) -> str:
    return ", ".join(f"`{variable.name}`" for variable in variables)


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
    print(PAGE)
