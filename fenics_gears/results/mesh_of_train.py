"""Meshes side by side in the result of a train, and one of them as the result of its pair: what charts, tables and
ratings of pairs take."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from fenics_gears.model.storage import CONTACT_COORDINATES, COORDINATES
from fenics_gears.scene.train import TrainScene, train_from_text

from .attributes import RESULT_ATTRIBUTES
from .carried_scene import scene_attributes
from .layout import OF_PAIRS
from .sets_in_train import MESH, OF_SETS
from .validity import NAMES_BETWEEN

OF_MESH = "_of_mesh"
# Each mesh has its own steps, in place of the times of a pair.
STEPS = {time: step for step, time in OF_PAIRS.items()}
SHARED = ("gear", "path_point", "slot")
COORDINATES_OF_PAIRS = (
    *COORDINATES, *CONTACT_COORDINATES, "face_position", "face_slice_width", "gear", "path_point", "slot",
)  # fmt: skip
SAID = ("fenics_gears_version", "numbers_version", "complete")


def over_meshes(meshes: Sequence[Mapping[str, tuple]]) -> Iterator[tuple[str, tuple]]:
    """Name, and dimensions, values and labels of each variable of all meshes, side by side. What only some meshes have
    over the face stands in its first slice for the others."""
    own = [{name: of for name, of in each.items() if name not in SHARED} for each in meshes]
    sizes = _largest_sizes(own)
    for name in dict.fromkeys(name for each in own for name in each):
        there = [each.get(name) for each in own]
        dims = max((_names_of(each[0]) for each in there if each is not None), key=len)
        values = _side_by_side(
            [None if each is None else _over(dims, each) for each in there], [sizes[each] for each in dims]
        )
        behind = 1 if dims and dims[0] in STEPS else 0
        renamed = [STEPS.get(each, each) for each in dims]
        labels = _labels([each[2] for each in there if each is not None], len(meshes))
        # Times and places of one mesh are no coordinate of all.
        known = f"{name}{OF_MESH}" if name in dims else name
        yield known, ((*renamed[:behind], MESH, *renamed[behind:]), np.moveaxis(values, 0, behind), labels)


def _labels(of_meshes: Sequence[Mapping[str, Any]], meshes: int) -> dict[str, Any]:
    """Labels of a variable of several meshes; a number that differs between all meshes is a list."""
    labels = dict(of_meshes[0])
    for name, value in labels.items():
        every = [each[name] for each in of_meshes]
        if not isinstance(value, str) and len(every) == meshes and any(each != value for each in every):
            labels[name] = every
    return labels


def _over(dims: tuple[str, ...], variable: tuple) -> np.ndarray:
    """The values of a variable with an axis for each of some dimensions."""
    own = _names_of(variable[0])
    values = np.asarray(variable[1])
    return values.reshape([values.shape[own.index(each)] if each in own else 1 for each in dims])


def _names_of(dims: str | Sequence[str]) -> tuple[str, ...]:
    return (dims,) if isinstance(dims, str) else tuple(dims)


def _largest_sizes(of_meshes: Sequence[Mapping[str, tuple]]) -> dict[str, int]:
    """The largest size that any variable of any mesh has over each dimension."""
    sizes: dict[str, int] = {}
    for own in of_meshes:
        for dims, values, _ in own.values():
            for name, size in zip(_names_of(dims), np.shape(values)):
                sizes[name] = max(size, sizes.get(name, 0))
    return sizes


def _side_by_side(arrays: Sequence[np.ndarray | None], shape: Sequence[int]) -> np.ndarray:
    """Arrays of all meshes (meshes, ...): not a number, or 0, where one has less than another."""
    kind = next(each.dtype for each in arrays if each is not None)
    values = np.full((len(arrays), *shape), np.nan if kind.kind == "f" else 0, dtype=kind)
    for own, each in zip(values, arrays):
        if each is not None:
            own[tuple(slice(size) for size in each.shape)] = each
    return values


def carried_train(result: xr.Dataset) -> TrainScene:
    """The train that was run. Raises SceneError where its text is no train of this version.

    >>> from pathlib import Path
    >>> text = Path("demos/gear_trains/idler.toml").read_text()
    >>> [mesh.name for mesh in carried_train(xr.Dataset(attrs={"scene": text})).meshes]
    ['idler: gears 1 and 2', 'idler: gears 2 and 3']
    """
    text, name, folder = (str(result.attrs.get(each, "")) for each in ("scene", "scene_name", "scene_folder"))
    return train_from_text(text, name or "train", directory=Path(folder))


def mesh_run(result: xr.Dataset, train: TrainScene, number: int) -> xr.Dataset:
    """The result of one mesh as that of its pair: variables over its own steps, numbers as attributes; without what the
    mesh does not have.

    >>> from pathlib import Path
    >>> from fenics_gears import simulate_train
    >>> coarse = "[accuracy]\\nsteps_per_mesh_cycle = 20\\nflank_element_size = '0.2 mm'"
    >>> train = train_from_text(Path("demos/gear_trains/idler.toml").read_text() + coarse)
    >>> mesh_run(simulate_train(train), train, 1)["pair_normal_force"].dims
    ('time', 'slot')
    """
    mesh = train.meshes[number]
    own = {
        str(name): (tuple(each for each in variable.dims if each != MESH), _of_mesh(variable, number), variable.attrs)
        for name, variable in result.variables.items()
        if not {"time", "shaft", "bearing", *OF_SETS} & {*variable.dims} and name not in (MESH, "pin_direction")
    }
    sizes = _sizes(own)
    numbers = {each.name: each for each in RESULT_ATTRIBUTES}
    attributes = {name: values.item() for name, (dims, values, _) in own.items() if name in numbers and not dims}
    variables = dict(_trimmed(own, sizes, number, len(train.meshes)))
    warnings = str(result.attrs.get("warnings", "")).splitlines()
    attributes = {
        "shown_cycles": mesh.scene.motion.recorded_cycles,
        **{name: value for name, value in attributes.items() if value and isinstance(value, str) or _is_number(value)},
        **{name: result.attrs[name] for name in SAID if name in result.attrs},
        "title": f"{mesh.name} ({train.title})",
        **scene_attributes(mesh.scene),
        "warnings": "\n".join(_said_of(mesh.name, [each.name for each in train.meshes], warnings)),
    }
    return xr.Dataset(variables, attrs=attributes).set_coords(
        [name for name in COORDINATES_OF_PAIRS if name in variables]
    )


def _of_mesh(variable: xr.Variable, number: int) -> np.ndarray:
    return np.asarray(variable.isel({MESH: number}) if MESH in variable.dims else variable)


def _said_of(name: str, every: Sequence[str], warnings: Iterable[str]) -> Iterator[str]:
    """The warnings that begin with the name of a mesh, alone or among those of others."""
    names = "|".join(map(re.escape, every))
    heading = re.compile(f"((?:{names})(?:{NAMES_BETWEEN}(?:{names}))*): ")
    for warning in warnings:
        found = heading.match(warning)
        if found and name in found[1].split(NAMES_BETWEEN):
            yield warning[found.end() :]


def _is_number(value: Any) -> bool:
    return not isinstance(value, str) and bool(np.isfinite(value))


def _sizes(own: dict[str, tuple]) -> dict[str, int]:
    """How far the numbers of a mesh go over each dimension."""
    sizes: dict[str, int] = {}
    for dims, values, _ in own.values():
        if values.dtype.kind != "f" or not dims:
            continue
        there = np.nonzero(np.isfinite(values))
        for name, places in zip(dims, there):
            sizes[name] = max(sizes.get(name, 0), int(places.max(initial=-1)) + 1)
    return sizes


def _trimmed(own: dict[str, tuple], sizes: dict[str, int], number: int, meshes: int) -> Iterator[tuple[str, tuple]]:
    """Name, and dimensions, values and labels of each variable that the mesh has, as its pair would have it."""
    in_plane = not np.isfinite(own[f"face_position{OF_MESH}"][1]).any() if f"face_position{OF_MESH}" in own else True
    for name, (dims, values, labels) in own.items():
        values = values[tuple(slice(sizes.get(each)) for each in dims)]
        if not dims or values.dtype.kind == "f" and not np.isfinite(values).any():
            continue
        if in_plane and "face_position" in dims:
            values = values.take(0, dims.index("face_position"))
            dims = tuple(each for each in dims if each != "face_position")
        # Of labels that differ from mesh to mesh there is a list.
        labels = {each: said[number] if np.shape(said) == (meshes,) else said for each, said in labels.items()}
        renamed = tuple(OF_PAIRS.get(each, each) for each in dims)
        yield name.removesuffix(OF_MESH), (renamed, values, labels)
