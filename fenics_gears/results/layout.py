"""What every result's file has: names, dimensions and types; its seal only says that its bytes are those that were
written."""

from collections.abc import Iterator
from functools import cache

import numpy as np
import xarray as xr

from fenics_gears.effects import COMMON_VARIABLES, FACE_VARIABLES, every_effect
from fenics_gears.effects.effect import OF_NODES, OF_SLICES
from fenics_gears.inputs.tree import GEARS
from fenics_gears.model.storage import CONTACT_COORDINATES, COORDINATES, ROOT_STRESS, ROOT_STRESS_OVER_FACE

from .attributes import RESULT_ATTRIBUTES

# Without these nothing can be drawn or said of a result; and what this program writes with them into each.
REQUIRED = ("time", "mesh_phase", "transmission_error")
# Of trains: the lag of the last shaft; and what dimensions of meshes are in results of pairs.
OVERALL = "overall_transmission_error"
OF_OUTPUTS = "output_transmission_error"
OF_PAIRS = {"step": "time", "contact_step": "contact_time"}
# How the shafts of a train bend, on the average.
OF_SHAFTS = {f"shaft_deflection_{axis}": ("shaft", "shaft_point") for axis in "xy"}
WRITTEN = (*COORDINATES, "slot", "gear", "normal_force", "pair_normal_force")
MICRORADIANS = 1e6  # in a radian
TEXTS = ("title", "scene", "scene_name", "warnings")


def mistake_in(result: xr.Dataset) -> str:
    """The first thing in which a dataset is no result, in words; empty where there is none."""
    return next(_mistakes(result), "")


def _mistakes(result: xr.Dataset) -> Iterator[str]:
    if "mesh" in result.dims:
        yield from _mistakes_of_train(result)
        return
    needed = [*REQUIRED, *(WRITTEN if "fenics_gears_version" in result.attrs else ())]
    needed += ["face_slice_width"] if "face_position" in result.dims else []
    if missing := [name for name in dict.fromkeys(needed) if name not in result.variables]:
        yield f"it has no {', '.join(missing)}"
    yield from _mistakes_of_values(result)
    yield from _mistakes_of_places(result)


def _mistakes_of_train(result: xr.Dataset) -> Iterator[str]:
    """Of the run of a train, whose variables are those of pairs over its meshes."""
    missing = [name for name in (*REQUIRED, OVERALL, "mesh") if name not in result.variables]
    # Trains of versions before have fewer numbers.
    missing += [name for name in ("newton_iterations_total",) if name not in result.attrs]
    if missing:
        yield f"it has no {', '.join(missing)}"
    yield from _mistakes_of_values(result)
    if (np.diff(result["time"].values) < 0.0).any():
        yield "time does not go on from step to step"


def _mistakes_of_values(result: xr.Dataset) -> Iterator[str]:
    """Dimensions and kinds of variables and attributes; in trains variables are over meshes too."""
    for name, allowed in _known_dims().items():
        if name not in result.variables:
            continue
        dims = tuple(OF_PAIRS.get(each, each) for each in result[name].dims if each != "mesh")
        kind = result[name].dtype.kind
        if dims not in allowed:
            yield f"{name} is over ({', '.join(dims)}), not over ({', '.join(allowed[0])})"
        if kind not in "iuf":
            yield f"{name} holds {result[name].dtype}, not numbers"
    numbers = {each.name for each in RESULT_ATTRIBUTES if each.units}
    for name, value in result.attrs.items():
        kinds = str if name in TEXTS else (int, float, np.number) if name in numbers else object
        if not isinstance(value, kinds):
            yield f"its attribute {name} is {value!r:.60}"


@cache
def _known_dims() -> dict[str, list[tuple[str, ...]]]:
    """Dimensions that variables of numbers may have, by name; over a face variables of contact nodes have slices
    too."""
    of_effects = (variable for effect in every_effect() for variable in effect.variables)
    variables = [*COMMON_VARIABLES, *FACE_VARIABLES, *of_effects]
    known = {
        each.name: [each.dims, *([(*OF_SLICES, "contact_node")] if each.dims == OF_NODES else [])] for each in variables
    }
    for own in (COORDINATES, CONTACT_COORDINATES, {"slot": ("slot",)}, ROOT_STRESS, ROOT_STRESS_OVER_FACE, OF_SHAFTS):
        for name, dims in own.items():
            known.setdefault(name, []).append(dims)
    return known


def _mistakes_of_places(result: xr.Dataset) -> Iterator[str]:
    """Of the coordinates: steps in the order of time, contact fields at some of them, tooth pairs in their slots."""
    if "gear" in result.dims and tuple(result["gear"].values) != GEARS:
        yield "its gears are not pinion and wheel"
    for name in ("time", "mesh_phase"):
        values = result[name].values
        if not np.isfinite(values).all() or (np.diff(values) < 0.0).any():
            yield f"{name} does not go on from step to step"
    both = ["pair_number"] if "slot" in result.dims else []
    if "contact_time" in result.dims:
        if missing := [name for name in CONTACT_COORDINATES if name not in result.variables]:
            yield f"it has contact fields and no {', '.join(missing)}"
        elif not np.isin(result["contact_time"].values, result["time"].values).all():
            yield "its contact fields are not at its steps"
        both.append("contact_pair_number")
    for name in both:
        if name not in result.variables:
            yield f"it has tooth pairs in slots and no {name}"
        numbers = result[name]
        slots = result.sizes["slot"]
        if not isinstance(numbers.attrs.get("number_at_phase_0"), (int, np.integer)):
            yield f"{name} has no whole number as its attribute number_at_phase_0"
        wrong = (numbers.values != 0) & (numbers.values % max(slots, 1) != np.arange(slots)) | (numbers.values < 0)
        if wrong.any():
            yield f"{name} has a tooth pair in a slot that is not its own"


def in_microradians(angle: float) -> str:
    """An angle, rad, as it is printed beside the unit "urad".

    >>> in_microradians(3.3892e-05)
    '33.89'
    """
    return f"{MICRORADIANS * angle:.4g}"
