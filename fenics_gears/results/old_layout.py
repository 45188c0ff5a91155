"""Results of earlier versions, whose arrays had a dimension `pair` for all tooth pairs of the run, converted to the
present layout of slots."""

from __future__ import annotations

import numpy as np
import xarray as xr

NODE_FIELDS = ("contact_pressure", "contact_traction", "contact_offset", "contact_roll_angle")


def upgraded(result: xr.Dataset) -> xr.Dataset:
    """The result with slots in place of pairs, unchanged where it has no dimension `pair`.

    An old result holds the last cycles only, all of them with contact fields. Its pairs are numbered from the first
    stored one.
    """
    if "pair" not in result.dims:
        return result
    phase, pairs = result["mesh_phase"].values, result["pair"].values
    first = 1 - int(min(pairs, default=0))
    there = _in_reach(result)
    held = np.where(there, pairs + first, 0)
    # Consecutive pairs, of which so many are in reach at once.
    ends = [(row[row > 0].min(), row[row > 0].max()) for row in held if row.any()]
    slots = max((last - begin + 1 for begin, last in ends), default=1)
    numbers = np.zeros((len(phase), slots), dtype=np.int32)
    step, pair = np.nonzero(there)
    numbers[step, held[step, pair] % slots] = held[step, pair]
    labels = {
        "units": "1",
        "long_name": "number of the tooth pair in each slot; 0 for an empty slot",
        "number_at_phase_0": first,
    }
    variables = {name: _in_slots(variable, step, pair, held, slots) for name, variable in result.data_vars.items()}
    contact = any("contact_time" in variable.dims for variable in variables.values())
    coordinates = {name: each for name, each in result.coords.items() if "pair" not in each.dims}
    coordinates |= {"slot": np.arange(slots), "pair_number": (("time", "slot"), numbers, labels)}
    if contact:
        coordinates |= {
            "contact_time": ("contact_time", result["time"].values, result["time"].attrs),
            "contact_mesh_phase": ("contact_time", phase, result["mesh_phase"].attrs),
            "contact_pair_number": (("contact_time", "slot"), numbers, labels),
        }
    return xr.Dataset(
        {name: (each.dims, each.values, each.attrs) for name, each in variables.items()}, coordinates, result.attrs
    )


def _in_reach(result: xr.Dataset) -> np.ndarray:
    """Whether each pair has contact nodes at each step (time, pair); rigid flanks and springs store no nodes, there:
    whether the pair carries."""
    places = [result[name] for name in ("contact_roll_angle", "coast_contact_roll_angle") if name in result]
    if places:
        return np.any(
            [np.isfinite(each.transpose("time", "pair", "contact_node").values).any(axis=2) for each in places], axis=0
        )
    forces = [
        variable.transpose("time", "pair").values
        for variable in result.data_vars.values()
        if set(variable.dims) == {"time", "pair"}
    ]
    return np.any([each != 0.0 for each in forces], axis=0)


def _in_slots(variable: xr.DataArray, step: np.ndarray, pair: np.ndarray, held: np.ndarray, slots: int) -> xr.Variable:
    """A variable of pairs as a variable of slots."""
    if "pair" not in variable.dims:
        return variable.variable
    rest = [name for name in variable.dims if name not in ("time", "pair")]
    values = variable.transpose("time", "pair", *rest).values
    absent = np.nan if np.isnan(values).any() and rest else 0.0
    own = np.full((len(values), slots, *values.shape[2:]), absent)
    own[step, held[step, pair] % slots] = values[step, pair]
    time = (
        "contact_time"
        if variable.name.removeprefix("coast_") in NODE_FIELDS or variable.name == "root_stress"
        else "time"
    )
    return xr.Variable((time, "slot", *rest), own, variable.attrs).transpose(
        *(time if name == "time" else "slot" if name == "pair" else name for name in variable.dims)
    )
