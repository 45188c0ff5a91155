"""The dataset of a study: what it takes from the run of each case, over the swept fields."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

import fenics_gears
from fenics_gears.errors import ComputationError
from fenics_gears.results.attributes import RESULT_ATTRIBUTES
from fenics_gears.results.files import read, save
from fenics_gears.results.key_numbers import STUDIED
from fenics_gears.results.path_shares import OF_SHARES
from fenics_gears.results.planetary import LARGEST_OF_SETS
from fenics_gears.results.validity import NO_MEANING
from fenics_gears.runs.record import CURVES, NUMBERS, OF_TRAINS, RunRecord
from fenics_gears.system.output import write_whole

from .axis import SAMPLE, Axis
from .quantiles import quantiles_of
from .study import Study

STUDY_FILE = "study.nc"
MESH = "mesh"
# 800 MB; beyond, the curves stay in the files of the cases.
MOST_CURVE_VALUES = 100_000_000


def combined(study: Study, records: Mapping[int, RunRecord], failures: Mapping[int, str]) -> xr.Dataset:
    """The dataset of the cases so far, over the swept fields, or `case` where they are varied together; NaN where a
    case has no result or lacks a number. `failed` is 1 for cases that failed and `failure` says why; curves are there
    when every case has the same steps."""
    result = xr.Dataset(
        coords={name: coordinate for axis in study.axes for name, coordinate in [_coordinate(axis, study)]}
    )
    if study.combine == "zip":
        result = result.assign_coords(case=("case", np.arange(len(study.cases)), {"long_name": "case"}))
    if SAMPLE in study.dimensions:
        result = result.assign_coords(sample=(SAMPLE, np.arange(study.samples), {"long_name": "sample"}))
    for name, (of_case, missing, attributes) in _variables(study, records, failures).items():
        kind = object if missing == "" else type(missing)
        values = np.array([of_case.get(i, missing) for i in range(len(study.cases))], dtype=kind)
        result[name] = (study.dimensions, values.reshape(study.shape), attributes)
    curves, why_not = _curves(study, records)
    result = result.assign(_of_meshes(study, records)).assign(curves)
    return result.assign(quantiles_of(result)).assign_attrs(
        title=study.title,
        study=study.text,
        scene=study.scene_text,
        scene_name=study.name,
        fenics_gears_version=fenics_gears.__version__,
        cases=len(study.cases),
        cases_failed=len(failures),
        complete=int(len(records) == len(study.cases)),
        curves=why_not or ", ".join(name for name in CURVES if name in result),
    )


def _variables(
    study: Study, records: Mapping[int, RunRecord], failures: Mapping[int, str]
) -> dict[str, tuple[Mapping, Any, dict]]:
    """By name the values of the cases that have one, what stands for the others, and the attributes."""
    of_trains = any(record.of_train for record in records.values())
    known = {name for each in records.values() for name in each.numbers}
    of_sets = {name: said for name, said in LARGEST_OF_SETS.items() if name in known}
    numbers = (OF_TRAINS if of_trains else NUMBERS) | of_sets | _studied(known)
    variables: dict[str, tuple[Mapping, Any, dict]] = {
        name: (
            {i: each.numbers[name] for i, each in records.items() if name in each.numbers},
            np.nan,
            {"units": units, "long_name": words},
        )
        for name, (units, words) in numbers.items()
    }
    without_meaning = {i: int(NO_MEANING in each.warnings) for i, each in records.items()}
    return variables | {
        "failed": (dict.fromkeys(failures, 1), 0, {"units": "1", "long_name": "whether the case failed"}),
        "meaningless": (without_meaning, 0, {"units": "1", "long_name": "whether the case's result has no meaning"}),
        "failure": (failures, "", {"long_name": "why the case failed"}),
        "warnings": ({i: each.warnings for i, each in records.items()}, "", {"long_name": "warnings of the run"}),
        "case_file": ({i: study.file_of(i) for i in records}, "", {"long_name": "file of the case"}),
    }


def _studied(known: set[str]) -> dict[str, tuple[str, str]]:
    """Units and meaning of those numbers that not every record has."""
    return {each.name: (each.units, each.meaning) for each in RESULT_ATTRIBUTES if each.name in known & {*STUDIED}}


def _of_meshes(study: Study, records: Mapping[int, RunRecord]) -> dict[str, tuple]:
    """What trains have mesh by mesh, over the study's dimensions and the meshes of all its trains."""
    meshes = list(dict.fromkeys(name for record in records.values() for name in record.meshes))
    if not meshes:
        return {}
    known = {name for record in records.values() for name in record.of_meshes}
    found: dict[str, tuple] = {MESH: (MESH, np.array(meshes, dtype=object), {"long_name": "mesh"})}
    shares = {name: ("1", words) for name, words in OF_SHARES.items()}
    named = {name: of for name, of in (NUMBERS | shares).items() if name in known} | _studied(known)
    for name, (units, words) in named.items():
        values = np.full((len(study.cases), len(meshes)), np.nan)
        for index, record in records.items():
            if name in record.of_meshes:
                values[index, [meshes.index(mesh) for mesh in record.meshes]] = record.of_meshes[name]
        labels = {"units": units, "long_name": words}
        found[name] = ((*study.dimensions, MESH), values.reshape(*study.shape, len(meshes)), labels)
    return found


def save_study(dataset: xr.Dataset, directory: Path) -> Path:
    """Write the combined dataset, aside first and with a digest at its end. Raises ComputationError where it cannot be
    written."""
    return write_whole(directory / STUDY_FILE, lambda aside: save(dataset, aside))


def load_combined(path: Path) -> xr.Dataset:
    """Read a study's dataset into memory. Raises ComputationError when the file is none of this program, or damaged."""
    result = read(path)
    if "failed" not in result or "study" not in result.attrs:
        raise ComputationError(f"{path}: holds no study of this program (no variable `failed`, no study text)")
    return result


def _coordinate(axis: Axis, study: Study) -> tuple[str, tuple]:
    values = axis.coordinate()
    attributes = {"long_name": axis.dotted}
    if values.dtype != object or axis.unit:
        attributes["units"] = axis.unit or "1"
    return axis.name, (study.dimension(axis), values, attributes)


def _curves(study: Study, records: Mapping[int, RunRecord]) -> tuple[dict[str, tuple], str]:
    """The curves that some case has, over the study's dimensions and the mesh phase; or why there are none."""
    if not records:
        return {}, "none: no case has a result"
    if study.asked is not None:
        return {}, "none: the numbers alone are kept"
    phase = next(iter(records.values())).mesh_phase
    if any(
        len(each.mesh_phase) != len(phase) or not np.allclose(each.mesh_phase, phase, rtol=0, atol=1e-9)
        for each in records.values()
    ):
        return {}, "none: the cases have different time steps or recorded cycles; see the files of the cases"
    names = [name for name in CURVES if any(name in each.curves for each in records.values())]
    shapes = {name: next(each.curves[name].shape for each in records.values() if name in each.curves) for name in names}
    if len(study.cases) * sum(int(np.prod(shape)) for shape in shapes.values()) > MOST_CURVE_VALUES:
        return {}, "none: too many values; see the files of the cases"
    curves: dict[str, tuple] = {
        "mesh_phase": ("mesh_phase", phase, {"units": "1", "long_name": "mesh cycles since the first recorded step"})
    }
    for name in names:
        values = np.full((len(study.cases), *shapes[name]), np.nan)
        for index, record in records.items():
            if name in record.curves:
                values[index] = record.curves[name]
        labels = next(each.labels[name] for each in records.values() if name in each.labels)
        inner = ("mesh_phase", "gear")[: len(shapes[name])]
        curves[name] = ((*study.dimensions, *inner), values.reshape(*study.shape, *shapes[name]), labels)
    if any(len(shape) > 1 for shape in shapes.values()):
        curves["gear"] = ("gear", np.array(["pinion", "wheel"], dtype=object), {"long_name": "gear"})
    return curves, ""
