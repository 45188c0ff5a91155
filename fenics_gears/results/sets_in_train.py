"""Planetary sets beside other stages in the result of a train: what each has as if it were the train, side by side by
their names, and one of them as the result of the set alone."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
import xarray as xr

from .layout import OVERALL
from .planetary import LARGEST_OF_SETS, MEMBER, NUMBERS_OF_SETS, PLANET, POINT
from .train_shafts import ResultOfShafts

SET = "set"
MESH = "mesh"
STEP = "step"
OF_SETS = (PLANET, MEMBER, POINT, SET)
# The lag of the output of each set behind its input.
LAG_OF_SET = f"{OVERALL}_of_set"


def side_by_side(sets: Sequence[tuple[str, ResultOfShafts]]) -> ResultOfShafts:
    """The results of several sets by their names: over their own steps, planets and members one after the other, and
    numbers over the sets; as numbers of the whole the largest of all sets."""
    variables: dict[str, tuple] = {}
    names = [name for name, _ in sets]
    for known in dict.fromkeys(each for _, own in sets for each in own.variables):
        of_each = [_of_set(own, known) for _, own in sets]
        dims, labels = next((dims, labels) for dims, _, labels in of_each if dims)
        steps = max(len(values) for _, values, _ in of_each)
        # Points are of those sets alone that have them.
        there = [each for own_dims, each, _ in of_each if own_dims or POINT not in dims]
        values = np.concatenate([_longer(each, steps) for each in there], axis=1)
        variables[LAG_OF_SET if known == OVERALL else known] = ((STEP, *dims[1:]), values, labels)
    # Of a set the loss is what its efficiency leaves; over meshes it has the name.
    for known in dict.fromkeys(each for _, own in sets for each in own.numbers if each in NUMBERS_OF_SETS):
        units, words = NUMBERS_OF_SETS[known]
        values = [own.numbers.get(known, np.nan if units else "") for _, own in sets]
        labels = {"units": units, "long_name": words} if units else {"long_name": words}
        variables[known] = (SET, np.array(values, float if units else object), labels)
    coordinates = sets[0][1].coordinates | {SET: (SET, names, {"long_name": "planetary set"})}
    for dimension, word in ((PLANET, f"{PLANET} "), (MEMBER, ""), (POINT, "point ")):
        of_sets = [(name, own.coordinates[dimension]) for name, own in sets if dimension in own.coordinates]
        members = [f"{name}.{word}{each}" for name, (_, known, _) in of_sets for each in known]
        if members:
            coordinates[dimension] = (dimension, members, {"long_name": f"{dimension} of a planetary set"})
    return ResultOfShafts(variables, coordinates, {name: float(np.max(variables[name][1])) for name in LARGEST_OF_SETS})


def _of_set(own: ResultOfShafts, name: str) -> tuple[tuple[str, ...], np.ndarray, dict[str, str]]:
    """Dimensions, values over steps and one of the dimensions of sets, and labels of a variable; without dimensions
    where the set does not have it, whose members then stand where they are."""
    if name not in own.variables:
        torques = own.variables["member_torque"][1]
        return (), np.zeros_like(torques), {}
    dims, values, labels = own.variables[name]
    if dims == "time":
        return ("time", SET), np.asarray(values)[:, None], labels
    return dims, np.asarray(values), labels


def _longer(values: np.ndarray, steps: int) -> np.ndarray:
    """The same over so many steps, behind its end not a number."""
    return np.pad(values, [(0, steps - len(values)), *((0, 0) for _ in values.shape[1:])], constant_values=np.nan)


def set_runs(found: xr.Dataset) -> list[xr.Dataset]:
    """The planetary sets of a train's result, each as the result of the set alone; of a set alone the same, of a train
    of pairs and rows none."""
    if SET in found.dims:
        return [set_run(found, str(name)) for name in found[SET].values]
    return [found] if PLANET in found.dims else []


def set_run(found: xr.Dataset, name: str) -> xr.Dataset:
    """A planetary set of a train, by its name, as the result of the set alone."""
    places: dict[str, Any] = {
        dimension: [at for at, each in enumerate(found[dimension].values) if str(each).startswith(f"{name}{sign}")]
        for dimension, sign in ((PLANET, "."), (MEMBER, "."), (POINT, "."), (MESH, ":"))
        if dimension in found.dims
    }
    places[SET] = [str(each) for each in found[SET].values].index(name)
    steps = int(np.isfinite(found[LAG_OF_SET].isel({SET: places[SET]})).sum())
    own = found.isel({**places, STEP: slice(steps)}).drop_dims("time").drop_vars(SET)
    points = own.sizes.get(POINT, 0)
    own = own if points else own.drop_dims(POINT, errors="ignore")
    variables = dict(_as_alone(found, own))
    attributes = {each: variables.pop(each).item() for each in _numbers(found)}
    attributes = {each: value for each, value in attributes.items() if value and value == value}
    if "efficiency" in attributes:
        attributes["friction_loss"] = 1.0 - attributes["efficiency"]
    coordinates = {
        PLANET: np.arange(1, own.sizes[PLANET] + 1),
        MEMBER: [str(each).removeprefix(f"{name}.") for each in own[MEMBER].values],
    }
    if points:
        coordinates[POINT] = np.arange(1, points + 1)
    return xr.Dataset(variables, attrs=attributes).assign_coords(coordinates)


def _as_alone(found: xr.Dataset, own: xr.Dataset) -> Iterator[tuple[str, xr.Variable]]:
    """Variables of a set, over `time` those that a set alone has so."""
    for name, variable in own.variables.items():
        if name in (PLANET, MEMBER, POINT):
            continue
        of_set = bool({*OF_SETS} & {*found[name].dims})
        dims = ["time" if of_set and each == STEP else each for each in variable.dims]
        yield OVERALL if name == LAG_OF_SET else str(name), xr.Variable(dims, variable.values, variable.attrs)


def _numbers(found: xr.Dataset) -> list[str]:
    """Numbers of the sets."""
    return [str(name) for name, variable in found.variables.items() if variable.dims == (SET,) and name != SET]
