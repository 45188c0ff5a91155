"""Tables of docs/result.md, from the lists of variables and attributes, and a run that has them all."""

from collections.abc import Sequence

import xarray as xr
from tests.benchmarks.marked_section import markers, replaced
from tests.docs.blocks import ROOT
from tests.docs.markdown import table
from tests.effects.examples import EXAMPLES, text_of

from fenics_gears import scene_from_text, simulate
from fenics_gears.contact.step_solver import METHODS
from fenics_gears.effects import COMMON_VARIABLES, FACE_VARIABLES, conflicts, effect_named, every_effect
from fenics_gears.effects.effect import ResultVariable
from fenics_gears.results.attributes import RESULT_ATTRIBUTES
from fenics_gears.results.numbers import ESTIMATED, RUNG

PAGE = ROOT / "docs" / "result.md"
# Bodies whose teeth differ exclude other effects; what makes a scene three-dimensional
# gives fields another dimension.
NOT_IN_THE_RUN = {each.section for each in every_effect() if each.excludes} | {"lead_modifications", "misalignment"}


def run_with_everything() -> xr.Dataset:
    """A short, coarse run with every effect that may stand beside the others, and root stress."""
    sections = [section for section in EXAMPLES if section not in NOT_IN_THE_RUN]
    assert not conflicts(sections)
    return simulate(scene_from_text(text_of(*sections) + "\n[output]\nroot_stress = true\n", "everything"))


def page(result: xr.Dataset | None = None) -> str:
    """The page with its tables made anew; `result`: that of `run_with_everything` where it is at hand."""
    result = run_with_everything() if result is None else result
    of_effects = []
    for each in every_effect():
        if each.variables:
            of_effects += [f"### `[{each.written}]`", "", *_variables(result, each.variables), ""]
    tables = {
        "coordinates": _coordinates(result),
        "variables": _variables(result, COMMON_VARIABLES),
        "effects": of_effects[:-1],
        "root stress": _root_stress(result),
        "over the face": _over_face(),
        "attributes": [*_attributes(), "", *_further_attributes()],
    }
    text = PAGE.read_text(encoding="utf-8")
    for name, lines in tables.items():
        text = replaced(text, *markers(name), "\n".join(lines))
    return text


def _further_attributes() -> list[str]:
    return [
        "Further attributes give the number of steps that each method solved, Newton's and its"
        f" [fallbacks](model.md#fallbacks): `{RUNG}newton` and so on",
        f"({', '.join(METHODS)}).",
        "",
        f"With `[accuracy] target`, further attributes give the estimated error of each setting: `{ESTIMATED}steps"
        " per mesh cycle` and so on.",
    ]


def _coordinates(result: xr.Dataset) -> list[str]:
    return table(("coordinate", "dimensions", "units", "meaning"), [_row(result, name) for name in result.coords])


def _variables(result: xr.Dataset, variables: Sequence[ResultVariable]) -> list[str]:
    """Dimensions are those of the run's variable, units and words must be the declared ones."""
    rows = []
    for each in variables:
        if each.name not in result and not (each.field or each.over_face):
            rows.append((f"`{each.name}`", ", ".join(each.dims), each.units, each.long_name))
            continue
        if each.name not in result:
            where = f"with `{each.field.replace(' or ', '` or `')}`" if each.field else "of three-dimensional scenes"
            rows.append((f"`{each.name}`", ", ".join(each.dims), each.units, f"{each.long_name} (only {where})"))
            continue
        name, dimensions, units, words = _row(result, each.name)
        assert (units, words) == (each.units, each.long_name), f"{each.name} is not as declared"
        beside = f" (only with `[{effect_named(each.needs).written}]`)" if each.needs else ""
        rows.append((name, dimensions, units, words + beside))
    return table(("variable", "dimensions", "units", "meaning"), rows)


def _over_face() -> list[str]:
    return table(
        ("variable", "dimensions", "units", "meaning"),
        [(f"`{each.name}`", ", ".join(each.dims), each.units, each.long_name) for each in FACE_VARIABLES],
    )


def _root_stress(result: xr.Dataset) -> list[str]:
    return table(
        ("variable", "dimensions", "units", "meaning"), [_row(result, name) for name in undeclared_variables(result)]
    )


def undeclared_variables(result: xr.Dataset) -> list[str]:
    """Variables that neither every run nor an effect has."""
    declared = {each.name for each in COMMON_VARIABLES} | {
        each.name for found in every_effect() for each in found.variables
    }
    return [name for name in result.data_vars if name not in declared]


def _row(result: xr.Dataset, name: str) -> tuple[str, str, str, str]:
    found = result[name]
    return f"`{name}`", ", ".join(found.dims), found.attrs.get("units", ""), found.attrs["long_name"]


def _attributes() -> list[str]:
    return table(
        ("attribute", "units", "meaning", "only if"),
        [(f"`{each.name}`", each.units, each.meaning, each.when) for each in RESULT_ATTRIBUTES],
    )
