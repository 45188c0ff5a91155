"""Curves of single tooth pairs from the slots in which a result keeps them, and the cycles that pictures show."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import xarray as xr

from fenics_gears.errors import SceneError

if TYPE_CHECKING:
    from .dataset import RunResult


@dataclass(frozen=True)
class Life:
    """A tooth pair's `number`, the `slot` that it is kept in, and the `steps` at which it is in reach."""

    number: int
    slot: int
    steps: slice


def carrying_side(result: xr.Dataset) -> str:
    """What names of variables of the flanks that carry more begin with: nothing for drive flanks, "coast_" for coast
    flanks."""
    carried = [float(result[name].sum()) for name in ("normal_force", "coast_normal_force") if name in result]
    return "coast_" if len(carried) > 1 and carried[1] > carried[0] else ""


def shown_steps(result: RunResult | xr.Dataset) -> slice:
    """Which steps of a result pictures show: its last cycles, as many as its attribute `shown_cycles` says."""
    cycles = result.attrs.get("shown_cycles")
    phase = np.asarray(result["mesh_phase"])
    if cycles is None or not len(phase) or phase[-1] - phase[0] <= cycles * (1.0 + 1e-9):
        return slice(None)
    return slice(int(np.searchsorted(phase, phase[-1] - cycles - 1e-9)), None)


def shown(result: xr.Dataset) -> xr.Dataset:
    """A result with the steps only that pictures show."""
    steps = shown_steps(result)
    return result if steps.start is None else result.isel(time=steps)


def contact_times(result: xr.Dataset) -> xr.Dataset:
    """A result with the steps whose contact fields are stored: `time` and `contact_time` go together. Raises SceneError
    without any."""
    if not result.sizes.get("contact_time", 0):
        raise SceneError(
            'the result holds no contact fields. [output] contact_fields = true or "last 2 cycles" in the scene stores'
            " them; run it again."
        )
    return result.isel(time=np.isin(result["time"].values, result["contact_time"].values))


def in_middle_slice(result: xr.Dataset) -> xr.Dataset:
    """A result with the contact fields of the slice in the middle of the face only; unchanged where it has no
    slices."""
    return result.isel(face_position=result.sizes["face_position"] // 2) if "face_position" in result.sizes else result


def words_of_slice(result: xr.Dataset) -> str:
    middle = in_middle_slice(result).coords.get("face_position")
    return "" if middle is None else f", in the slice at {float(middle):.2f} mm from the middle of the face"


def lives(numbers: np.ndarray) -> Iterator[Life]:
    """Every tooth pair of pair numbers (time, slot), in the order in which they enter."""
    every = []
    for slot, column in enumerate(np.asarray(numbers).T):
        ends = np.flatnonzero(np.diff(column)) + 1
        for first, last in zip([0, *ends], [*ends, len(column)]):
            if last > first and column[first]:
                every.append(Life(int(column[first]), slot, slice(int(first), int(last))))
    yield from sorted(every, key=lambda life: life.number)


def by_pair(variable: xr.DataArray, absent: float = np.nan) -> xr.DataArray:
    """A variable of a result with the dimension `pair` in place of `slot`: each tooth pair's own curve, `absent` while
    it is out of reach. As many values as steps times pairs: of a long run take a part first, `shown(result)`."""
    stored = "contact_" if "contact_time" in variable.dims else ""
    time = f"{stored}time"
    numbers = f"{stored}pair_number"
    rest = [each for each in variable.dims if each not in (time, "slot")]
    values = variable.transpose(time, "slot", *rest).values
    pairs = list(lives(variable[numbers].values))
    own = np.full((len(values), len(pairs), *values.shape[2:]), absent)
    for place, life in enumerate(pairs):
        own[life.steps, place] = values[life.steps, life.slot]
    kept = {name: each for name, each in variable.coords.items() if "slot" not in each.dims}
    of_pairs = xr.DataArray(
        own, {**kept, "pair": [life.number for life in pairs]}, (time, "pair", *rest), variable.name, variable.attrs
    )
    of_pairs["pair"].attrs["long_name"] = "tooth pair, in the order in which they enter"
    return of_pairs.transpose(*("pair" if each == "slot" else each for each in variable.dims))
