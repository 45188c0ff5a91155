"""Write docs/effects.md: `python -m tests.effects_table`."""

from pathlib import Path

from tests.docs.markdown import prose
from tests.effects.examples import EXAMPLES

from fenics_gears.effects import COMMON_VARIABLES, effect_named, every_effect
from fenics_gears.effects.effect import Effect

PAGE = Path(__file__).parents[1] / "docs" / "effects.md"


def page() -> str:
    lines = [
        prose("effects.md"),
        "| section | effect | without it | adds | needs | excludes |",
        "|---|---|---|---|---|---|",
    ]
    lines += [_row(each) for each in every_effect()]
    lines += ["", "## Examples", ""]
    for each in every_effect():
        lines += ["```toml", EXAMPLES[each.section].strip(), "```", ""]
    lines += ["## Result variables of each effect", "", "Every run has " + _names(COMMON_VARIABLES) + ".", ""]
    lines += ["| variable | units | meaning | effect |", "|---|---|---|---|"]
    for each in every_effect():
        for found in each.variables:
            beside = f", only with `[{effect_named(found.needs).written}]`" if found.needs else ""
            beside += f", only with `{found.field.replace(' or ', '` or `')}`" if found.field else ""
            beside += ", only of three-dimensional scenes" if found.over_face else ""
            lines.append(f"| `{found.name}` | {found.units} | {found.long_name} | `[{each.written}]`{beside} |")
    return "\n".join(lines) + "\n"


def _row(each: Effect) -> str:
    added = [
        f"{kind}: {', '.join(words)}" for kind, words in (("unknowns", each.unknowns), ("terms", each.terms)) if words
    ]
    if each.variables:
        added.append("results: " + _names(each.variables))
    needs, excludes = (
        ", ".join(f"`[{effect_named(name).written}]`" for name in names) for names in (each.needs, each.excludes)
    )
    anchor = "gearsmaterial" if "." in each.written else each.written
    return f"| [`[{each.written}]`](scene.md#{anchor}) | {each.description} | {each.absent} | {'; '.join(added)} | {needs} | {excludes} |"


def _names(variables) -> str:
    return ", ".join(f"`{variable.name}`" for variable in variables)


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
    print(PAGE)
