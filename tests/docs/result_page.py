"""docs/result.md, made from the effects' list of variables, from the list of attributes, and from a run that has them all."""

from __future__ import annotations

from collections.abc import Sequence

import xarray as xr
from tests.docs.markdown import table
from tests.effects.examples import EXAMPLES, text_of

from fenics_gears.contact.step_solver import METHODS
from fenics_gears.effects import COMMON_VARIABLES, EFFECTS, conflicts, effect_named
from fenics_gears.effects.effect import ResultVariable
from fenics_gears.results.attributes import ESTIMATED, RESULT_ATTRIBUTES, RUNG
from fenics_gears.scene.read import scene_from_text
from fenics_gears.simulation.simulate import simulate

HEADING = """# The result

A run's result is one `xarray.Dataset`, the same in memory (`simulate`) and in `run.nc`, which is NetCDF-4: xarray, ParaView, MATLAB, Panoply and `ncdump` open it
([in Python](python.md)). Every variable has `units` and `long_name`. A variable that belongs to an effect is there when the scene names the effect. Values that do not
exist are not a number: places of contact nodes that a pair does not have, shares of rigid pairs that touch together.

## Signs

* Directions: x is along the line of action, from the pinion's tangent point to the wheel's, y off it, towards the pinion's centre.
* Rotations and torques are positive in the pinion's sense of rotation, on both gears; the wheel turns the other way, nominally. Displacements and rotations are those from the nominal motion: a
  wheel that lags has a positive `rotation`, and the transmission error is positive where the wheel lags behind the pinion.
* Reactions are what a gear does to its shaft: under the normal force F the pinion presses along -x and the wheel along +x. `reaction_couple` is then negative on both: -F r_b1 on the pinion's shaft, which
  the drive has to overcome, and -F r_b2 on the wheel's, which turns the load. Friction adds to them.
* `load.wheel_torque` and `wheel_couple` are torques of the load on the wheel's shaft: positive where they resist the drive, that is in the pinion's sense of rotation.
* Normal forces and pressures are positive in compression. Friction on the pinion acts along -y where it is positive. Sliding is that of the pinion's flank over the wheel's, positive towards the pinion's tip:
  negative before the pitch point, positive after it.
* Work is positive from the pinion to the wheel; where the wheel drives, `work_input` and `work_output` are negative. `input_power` is that of the gear that drives, and positive.

At whole numbers of `mesh_phase` a new pair reaches the theoretical start of contact; with bearings and teeth that give way it touches before.

This page is written by `python -m tests.docs.write`, from `fenics_gears/effects`, `fenics_gears/results/attributes.py` and a run with every effect; a test says when it is out of date.
"""
PAIRS = """Curves are of all steps. `pair_number` says which tooth pair a slot holds: pairs are numbered from 1 on in the order in which they enter, 0 is none; a pair's number
less the attribute `number_at_phase_0` of `pair_number` is the mesh phase at which it reaches the theoretical start of contact. `by_pair(result["pair_normal_force"])` of
`fenics_gears.results` gives each pair its own curve, over `pair` in place of `slot`, `shown(result)` the last cycles, which pictures show
([in Python](python.md#tooth-pairs)). Files of earlier versions are read as results are now.

All numbers among the attributes are of the settled steps, whatever contact fields are stored: of all steps from `settled_from` on, when the slowest vibration that the start sets off has
fallen to 1 %; without inertia of all. Where cycles are not alike these are whole common periods: as many mesh cycles as pass until every deviation has met every other.
The last common period counts in any case, where all cycles are alike the last `recorded_cycles`; `warnings` say what of the start is left then, and where fewer cycles were run than the common period has.
"""
DIMENSIONS = {
    "time": "all steps that were marched, the first being step 0",
    "contact_time": "those of them, the last, whose contact fields are stored (`[output] contact_fields`)",
    "gear": '"pinion", "wheel"',
    "slot": "places for the tooth pairs that can touch at once; a pair keeps its own as long as it is in reach, `pair_number` says which is there",
    "path_point": "points of the path of contact: A start, B and D ends of contact by the fewest pairs, C pitch point, E end",
    "contact_node": "contact nodes of a pair, in the order of their offset",
    "pinion_tooth": "teeth of the pinion, in the order in which they mesh",
    "wheel_tooth": "teeth of the wheel, likewise",
    "fillet_point": "points along both fillets of a tooth, from the root circle to the form circle, the drive side's first",
    "fillet": '"drive", "coast": the two sides of a tooth',
}
ROOT_STRESS = "`[output] root_stress`"
# Bodies read from meshes exclude other effects and have no variables of their own.
NOT_IN_THE_RUN = {each.section for each in EFFECTS if each.excludes}


def run_with_everything() -> xr.Dataset:
    """The result of a short, coarse run with every effect that may stand beside the others, and root stress."""
    sections = [section for section in EXAMPLES if section not in NOT_IN_THE_RUN]
    assert not conflicts(sections)
    return simulate(scene_from_text(text_of(*sections) + "\n[output]\nroot_stress = true\n", "everything"))


def page(result: xr.Dataset | None = None) -> str:
    """The whole page; `result`: that of `run_with_everything` where it is at hand."""
    result = run_with_everything() if result is None else result
    lines = [HEADING, "## Dimensions and coordinates", "", *_dimensions(result), "", *_coordinates(result), ""]
    lines += [PAIRS, "## Variables of every run", "", *_variables(result, COMMON_VARIABLES), ""]
    lines += ["## Variables of effects", ""]
    for each in EFFECTS:
        if each.variables:
            lines += [f"### `[{each.written}]`", "", *_variables(result, each.variables), ""]
    lines += [f"### {ROOT_STRESS}", "", *_root_stress(result), ""]
    lines += ["## Attributes", "", *_attributes(), ""]
    lines += [f"One attribute more for each method of the solver that was used, Newton or one of its [fallbacks](model.md#fallbacks), the number of steps that it solved: `{RUNG}newton` and so on"]
    lines += [f"({', '.join(METHODS)}).", "", f"With `[accuracy] target`, one for the error of each knob: `{ESTIMATED}steps per mesh cycle` and so on."]
    return "\n".join(lines) + "\n"


def _dimensions(result: xr.Dataset) -> list[str]:
    return table(("dimension", "is"), [(f"`{name}`", DIMENSIONS[name]) for name in sorted(result.sizes, key=list(DIMENSIONS).index)])


def _coordinates(result: xr.Dataset) -> list[str]:
    return table(("coordinate", "dimensions", "units", "is"), [_row(result, name) for name in result.coords])


def _variables(result: xr.Dataset, variables: Sequence[ResultVariable]) -> list[str]:
    """A table; dimensions are those that the run's variable has, units and words must be the declared ones."""
    rows = []
    for each in variables:
        name, dimensions, units, words = _row(result, each.name)
        assert (units, words) == (each.units, each.long_name), f"{each.name} is not as declared"
        beside = f" (beside `[{effect_named(each.needs).written}]`)" if each.needs else ""
        rows.append((name, dimensions, units, words + beside))
    return table(("variable", "dimensions", "units", "is"), rows)


def _root_stress(result: xr.Dataset) -> list[str]:
    return table(("variable", "dimensions", "units", "is"), [_row(result, name) for name in undeclared_variables(result)])


def undeclared_variables(result: xr.Dataset) -> list[str]:
    """Variables that neither every run nor an effect has: those of the output that was asked for."""
    declared = {each.name for each in COMMON_VARIABLES} | {each.name for found in EFFECTS for each in found.variables}
    return [name for name in result.data_vars if name not in declared]


def _row(result: xr.Dataset, name: str) -> tuple[str, str, str, str]:
    found = result[name]
    return f"`{name}`", ", ".join(found.dims), found.attrs.get("units", ""), found.attrs["long_name"]


def _attributes() -> list[str]:
    return table(("attribute", "units", "is", "there when"), [(f"`{each.name}`", each.units, each.meaning, each.when) for each in RESULT_ATTRIBUTES])
