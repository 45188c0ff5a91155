"""docs/result.md, made from the effects' list of variables, from the list of attributes, and from a run that has them
all."""

from __future__ import annotations

from collections.abc import Sequence

import xarray as xr
from tests.docs.markdown import table
from tests.effects.examples import EXAMPLES, text_of

from fenics_gears import scene_from_text, simulate
from fenics_gears.contact.step_solver import METHODS
from fenics_gears.effects import COMMON_VARIABLES, FACE_VARIABLES, conflicts, effect_named, every_effect
from fenics_gears.effects.effect import ResultVariable
from fenics_gears.results.attributes import ESTIMATED, RESULT_ATTRIBUTES, RUNG

HEADING = """# The result

A run's result is one `xarray.Dataset`, the same in memory (`simulate`) and in `run.nc`, which is NetCDF-4: xarray, ParaView, MATLAB, Panoply and `ncdump` open it
([in Python](python.md)). Every variable has `units` and `long_name`. A variable of an effect exists only if the scene names the effect. Missing values are NaN, for example
the places of contact nodes where a slot holds no pair, or the forces of rigid tooth pairs that touch at the same time.

## Signs

* **Directions.** x points along the line of action, from the tangent point on the pinion's base circle to that on the wheel's. y is perpendicular to it and points towards the pinion's centre.
* **Rotations and torques** of both gears are positive in the pinion's sense of rotation, so the wheel's nominal rotation is negative. Displacements and rotations are relative to the nominal motion. A wheel that
  lags behind has a positive `rotation`, and the transmission error is then positive.
* **Reactions** are forces and torques of a gear on its shaft. Under the normal force F the pinion presses its shaft along -x, the wheel along +x. Without friction `reaction_couple` is -F r_b1 on the pinion's shaft and -F r_b2
  on the wheel's.
* **Load.** `load.wheel_torque` and `wheel_couple` are torques of the load on the wheel's shaft. They are positive where they resist the wheel's rotation.
* **Contact.** Normal forces and pressures are positive in compression. A positive friction force acts on the pinion along -y. The sliding speed is that of the pinion's flank relative to the wheel's, positive towards the
  pinion's tip: negative before the pitch point, positive after it.
* **Work** is positive from the pinion to the wheel. Where the wheel drives, `work_input` and `work_output` are negative, but `input_power` is positive.

At whole numbers of `mesh_phase` a new pair reaches the theoretical start of contact. Deflected teeth and bearings let it touch earlier.

This page is written by `python -m tests.docs.write`, from `fenics_gears/effects`, `fenics_gears/results/attributes.py` and a run with every effect; a test says when it is out of date.
"""
PAIRS = """**Tooth pairs.** Variables over `time` cover all steps of the run. `pair_number` says which tooth pair a slot holds, 0 for none. Pairs are numbered from 1 in the order in which they
enter. A pair reaches the theoretical start of contact at the mesh phase `pair_number` minus the attribute `number_at_phase_0` of that variable. Two functions of `fenics_gears.results`
help ([in Python](python.md#tooth-pairs)): `by_pair(result["pair_normal_force"])` gives each pair its own curve, with the dimension `pair` in place of `slot`; `shown(result)` returns the
last mesh cycles, which pictures show.

**Settled steps.** Numbers among the attributes are taken over the settled steps, from `settled_from` to the end. Steps are settled when the slowest vibration excited by the start has
decreased to 1 %; without inertia all steps are. Where mesh cycles differ, whole common periods are taken: a common period is the number of mesh cycles after which every
deviation has met every other, such as the hunting tooth period. If the run is too short for this, the last common period is taken, or the last `recorded_cycles` where all mesh cycles are equal,
and `warnings` say how much of the start is left. They also say if the run is shorter than the common period.
"""
UNFINISHED = """## A run that has not ended

While `gears run` marches through time, it writes the values of every block of steps to the directory `run.nc.part` in its output directory, and removes the directory when `run.nc` is there. If the run is killed, `gears plot DIR`,
`gears report DIR`, `gears picture DIR` and `gears export DIR` read `run.nc.part`, also while the run goes on. They make the same result as if the run had been interrupted by Ctrl-C after the last step that is there. `complete` is 0,
`stopped` is "not ended", and the first of the `warnings` says which steps are missing.

* **What is lost:** the block of steps that was being computed, at most 512 steps (less than a second in most runs), or 32 of the slower steps of `condensation = "every step"`. A run that is killed in the first 2 seconds of its march leaves nothing.
* **Full disk:** the run goes on without `run.nc.part`, and a warning says so.
* **Power failure:** the operating system may not have written everything to the disk. A `run.nc.part` that does not hold what was written into it is refused.
* **Only the same version** of the program reads it. An older `run.nc` in the directory is read first; `gears plot DIR/run.nc.part` names the other one.
"""
DIMENSIONS = {
    "time": "all time steps, with the start as step 0",
    "contact_time": "steps whose contact fields are stored, at the end of the run (`[output] contact_fields`)",
    "gear": '"pinion", "wheel"',
    "slot": "places for the tooth pairs that can touch at the same time; a pair keeps its slot as long as it can touch",
    "path_point": (
        "points of the path of contact: A start of contact, B LPSTC of the pinion, C pitch point, D HPSTC of the"
        " pinion, E end of contact"
    ),
    "contact_node": "contact nodes of a pair, in the order of their offset from the line of action",
    "pinion_tooth": "teeth of the pinion, in the order in which they mesh",
    "wheel_tooth": "teeth of the wheel, in the order in which they mesh",
    "fillet_point": (
        "points along both fillets of a tooth, from the root circle to the form circle, first on the drive side, then"
        " on the coast side"
    ),
    "fillet": '"drive", "coast": the two sides of a tooth',
}
OVER_THE_FACE = """The common face is divided into slices. Their middles are the coordinate `face_position`: the distance along the axes, mm, from the middle of the common face, towards the end from which
the pinion is seen to turn counter-clockwise; `face_slice_width` is the width of each slice, mm. Fields of contact nodes have the dimension `face_position` between `slot` and `contact_node`. Forces of tooth pairs and of the
mesh are along the contact normal, which leans along the axes by the base helix angle. Further variables are those below. Load factors are among the attributes, read off the computed contact of the flanks that carry (the coast
flanks where the wheel drives), in the settled steps whose contact fields are stored. There are three along the face:

* **`face_load_factor`** says how unevenly the face is loaded on average: the line loads of all tooth pairs are summed and averaged over whole mesh cycles, and the largest along the face is divided by the mean. This is what stands
  beside ISO's K_Hbeta.
* **`largest_line_load_factor`** says how much more than its even share any place of a flank carries at any time: the largest line load of one tooth pair is divided by the line load that the mesh's force makes if it spreads evenly
  along the lines of contact of rigid gears when these are shortest. An aligned spur pair whose pairs share evenly has 1. Below 1 the teeth, which bend, share better than rigid ones.
* **`edge_line_load_factor`** says the same of edges: the ends of the face, and the tip or form circle where a line of contact ends on the flank. There the pressure has a peak that is narrower than a slice: the number depends on the
  slices, and is a reason for chamfers, crowning or tip relief, not for a rating.

The first two leave edges out: half a module of the face at either end (a tenth of the face if that is less), and as much of a line of contact where it ends on the flank. The free end of a tooth, or the end of the narrower
gear on the wider one, changes the line load no further in. Elsewhere they take the mean over half a module of the face (the same length), since line loads of single slices within a layer of the gear bodies are not resolved. Both are
then the same with twice as many slices, to 1 %. For the same reason `peak_contact_pressure` leaves the ends of the face out; they are in `peak_edge_pressure`.

* **`transverse_load_factor`**: the standard's K_Halpha is the largest load of a tooth divided by that of a pair without deviations. Here both are shares in the mesh force at the same step, so that no dynamic factor is in them; the
  shares without deviations are those of the same line load along all lines of contact, as the standard's contact ratio factor assumes."""
ROOT_STRESS = "`[output] root_stress`"
# Bodies read from meshes exclude other effects and have no variables of their own; what makes a scene three-dimensional
# gives fields another dimension.
ROOT_STRESS_OVER_FACE = """In three-dimensional scenes root stress is averaged over each slice of the face and acts across the tooth's trace. `root_stress` has the further dimension `face_position`, `root_stress_over_face` (contact_time, gear, slot, fillet,
face_position), MPa, is the stress at the 30 degree tangent, and the other two are the largest over the face."""
NOT_IN_THE_RUN = {each.section for each in every_effect() if each.excludes} | {"lead_modifications", "misalignment"}


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
    for each in every_effect():
        if each.variables:
            lines += [f"### `[{each.written}]`", "", *_variables(result, each.variables), ""]
    lines += [f"### {ROOT_STRESS}", "", *_root_stress(result), "", ROOT_STRESS_OVER_FACE, ""]
    lines += ["### Three-dimensional scenes", "", OVER_THE_FACE, "", *_over_face(), ""]
    lines += [UNFINISHED]
    lines += ["## Attributes", "", *_attributes(), ""]
    lines += [
        "Further attributes give the number of steps that each method solved, Newton's and its"
        f" [fallbacks](model.md#fallbacks): `{RUNG}newton` and so on"
    ]
    lines += [
        f"({', '.join(METHODS)}).",
        "",
        (
            f"With `[accuracy] target`, further attributes give the estimated error of each setting: `{ESTIMATED}steps"
            " per mesh cycle` and so on."
        ),
    ]
    return "\n".join(lines) + "\n"


def _dimensions(result: xr.Dataset) -> list[str]:
    return table(
        ("dimension", "meaning"),
        [(f"`{name}`", DIMENSIONS[name]) for name in sorted(result.sizes, key=list(DIMENSIONS).index)],
    )


def _coordinates(result: xr.Dataset) -> list[str]:
    return table(("coordinate", "dimensions", "units", "meaning"), [_row(result, name) for name in result.coords])


def _variables(result: xr.Dataset, variables: Sequence[ResultVariable]) -> list[str]:
    """A table; dimensions are those that the run's variable has, units and words must be the declared ones."""
    rows = []
    for each in variables:
        if (each.field or each.over_face) and each.name not in result:
            where = f"with `{each.field}`" if each.field else "of three-dimensional scenes"
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
    """Variables that neither every run nor an effect has: those of the output that was asked for."""
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
