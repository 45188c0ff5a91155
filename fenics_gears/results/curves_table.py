"""CSV tables for programs that do not read NetCDF: all curves over time of a result, and what a dataset has over given
dimensions."""

import csv
from collections.abc import Iterator
from itertools import zip_longest
from pathlib import Path

import numpy as np
import xarray as xr

from fenics_gears.system.output import write_whole

from .files import save
from .layout import OVERALL

# Significant digits: more than a measurement has, and still readable.
DIGITS = 12
# Of trains.
OF_TIME = ("time", OVERALL)
STEPS_OF_MESH = "time_of_mesh"


def save_curves(result: xr.Dataset, path: Path) -> None:
    """Write comma-separated values: a line for each stored step, units in the heads, decimal points. Of a train, whose
    meshes have steps of their own, a column for each mesh; cells below its last step are empty."""
    columns = dict(curves_of_train(result) if OVERALL in result else curves(result))
    with open(path, "w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(columns)
        for row in zip_longest(*columns.values()):
            writer.writerow(["" if value is None else f"{value:.{DIGITS}g}" for value in row])


def save_tables(dataset: xr.Dataset, directory: Path, stem: str) -> list[Path]:
    """Write a dataset as `stem`.nc and, of its variables over the same dimensions, a table each, called by them
    (`map_over_load_and_mesh_phase.csv`): a line for each combination of their coordinates. Returns the files.

    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder:
    ...     files = save_tables(xr.Dataset({"force": ("load", [1.0, 2.0])}), Path(folder), "map")
    >>> [file.name for file in files]
    ['map.nc', 'map_over_load.csv']
    """
    save(dataset, directory / f"{stem}.nc")
    files = [directory / f"{stem}.nc"]
    for dims in dict.fromkeys(each.dims for each in dataset.data_vars.values() if each.dims):
        table = directory / f"{stem}_over_{'_and_'.join(dims)}.csv"
        files.append(write_whole(table, lambda path, dims=dims: _save_table(dataset, dims, path)))
    return files


def _save_table(dataset: xr.Dataset, dimensions: tuple[str, ...], path: Path) -> None:
    template = xr.DataArray(np.zeros([dataset.sizes[name] for name in dimensions]), dims=dimensions)
    coordinates = [name for name, each in dataset.coords.items() if each.dims and set(each.dims) <= set(dimensions)]
    names = [*coordinates, *(name for name, each in dataset.data_vars.items() if each.dims == dimensions)]
    columns = [dataset[name].broadcast_like(template).transpose(*dimensions).values.ravel() for name in names]
    with open(path, "w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file)
        writer.writerow([f"{name}{_unit(dataset[name].attrs.get('units', '1'))}" for name in names])
        writer.writerows(
            [value if isinstance(value, str) else f"{value:.{DIGITS}g}" for value in row] for row in zip(*columns)
        )


def curves(result: xr.Dataset) -> Iterator[tuple[str, np.ndarray]]:
    """The head and the values (steps,) of each curve: time, mesh phase, then each variable over time alone or over time
    and gear."""
    first = [name for name in ("time", "mesh_phase") if name in result.variables]
    for name in (*first, *(name for name in result.data_vars if name not in first)):
        variable = result[name]
        unit = _unit(result[name].attrs.get("units", "1"))
        if variable.dims == ("time",):
            yield f"{name}{unit}", variable.values
        elif variable.dims == ("time", "gear"):
            for gear in result["gear"].values:
                yield f"{name} {gear}{unit}", variable.sel(gear=gear).values


def curves_of_train(result: xr.Dataset) -> Iterator[tuple[str, np.ndarray]]:
    """The head and the values (steps,) of each curve of a train: those over time, then those of each mesh over its own
    steps, the mesh's name behind the variable's."""
    yield from ((f"{name}{_unit(result[name].attrs.get('units', '1'))}", result[name].values) for name in OF_TIME)
    for mesh in result["mesh"].values:
        own = result.drop_dims("time").sel(mesh=mesh).isel(step=np.isfinite(result[STEPS_OF_MESH].sel(mesh=mesh)))
        first = (STEPS_OF_MESH, "mesh_phase")
        for name in (*first, *(name for name in own.data_vars if name not in first)):
            of_gears = [f" {gear}" for gear in own["gear"].values] if "gear" in own[name].dims else [""]
            if {*own[name].dims} - {"gear"} != {"step"} or np.isnan(own[name].values.astype(float)).all():
                continue
            for gear, values in zip(of_gears, own[name].transpose(..., "step").values.reshape(len(of_gears), -1)):
                called = str(name).removesuffix("_of_mesh")
                yield f"{called} {mesh}{gear}{_unit(own[name].attrs.get('units', '1'))}", values


def _unit(unit: str) -> str:
    return "" if unit == "1" else f" [{unit}]"
