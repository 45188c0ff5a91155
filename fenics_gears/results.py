"""The result of a run: one labelled dataset, saved as NetCDF-4 and read back.

Dimensions: `time`, `gear` ("pinion", "wheel"), `pair` (tooth pairs, counted through the run), `contact_node`. A variable that
belongs to an effect is there only when the scene names that effect.
"""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import xarray as xr

import fenics_gears
from fenics_gears.contact.laws import OPEN
from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.dynamics.drivetrain import TRANSLATIONS, Drivetrain
from fenics_gears.dynamics.march import March, Record
from fenics_gears.effects import result_variables
from fenics_gears.errors import ComputationError
from fenics_gears.scene.data import Scene
from fenics_gears.validity import warnings_of

GEARS = ("pinion", "wheel")


def dataset(scene: Scene, cycle: Cycle, drivetrain: Drivetrain, march: March, time_step: float) -> xr.Dataset:
    """The stored steps of a march as a dataset; every variable with units and long name."""
    records = list(march.records)
    values = _centre_variables(scene, drivetrain, records)
    values |= _mesh_variables(scene, drivetrain, records)
    pairs = sorted({int(cycle.pair_number(r.step, p.index)) for r in records for p in r.position.operator.pairs})
    values |= _pair_variables(scene, cycle, records, pairs)
    values |= _energy_variables(scene, drivetrain, records)
    steps = np.array([record.step for record in records], dtype=float)
    described = {variable.name: variable for variable in result_variables(scene)}
    result = xr.Dataset(
        {name: (dims, data, _labels(described[name])) for name, (dims, data) in values.items()},
        coords={
            "time": ("time", steps * time_step, {"units": "s", "long_name": "time"}),
            "mesh_phase": ("time", steps / cycle.steps, {"units": "1", "long_name": "mesh cycles since the start"}),
            "gear": ("gear", list(GEARS), {"long_name": "gear"}),
            "pair": ("pair", np.array(pairs, dtype=np.int64), {"long_name": "tooth pair, counted through the run"}),
        },
    )
    attributes = _attributes(scene, march, result)
    attributes["warnings"] = "\n".join(warnings_of(cycle, drivetrain, march))
    return result.assign_attrs(attributes)


def _labels(variable) -> dict[str, str]:
    return {"units": variable.units, "long_name": variable.long_name}


def _centre_variables(scene: Scene, drivetrain: Drivetrain, records: list[Record]) -> dict:
    states = np.array([record.state.position for record in records]).reshape(len(records), len(drivetrain.coordinates))

    def both(first: str, second: str) -> np.ndarray:
        return np.stack([drivetrain.value(states, first), drivetrain.value(states, second)], axis=1)

    rotation = both("rotation_1", "rotation_2")
    ratio = scene.gears.pinion.teeth / scene.gears.wheel.teeth
    values = {
        "transmission_error": (("time",), rotation[:, 1] + ratio * rotation[:, 0]),
        "rotation": (("time", "gear"), rotation),
    }
    if scene.bearings is not None:
        values["centre_x"] = (("time", "gear"), both("centre_x1", "centre_x2"))
        values["centre_y"] = (("time", "gear"), both("centre_y1", "centre_y2"))
    if scene.shafts is not None:
        values["shaft_end_rotation"] = (("time",), drivetrain.value(states, "shaft_end"))
    return values


def _mesh_variables(scene: Scene, drivetrain: Drivetrain, records: list[Record]) -> dict:
    """Forces of the whole mesh and what they ask of either gear's centre; R_1 = -G_1^T p, R_2 = G_2^T p."""
    normal = np.array([_normal(record).sum() for record in records])
    friction = np.array([_tangential(record).sum() for record in records])
    couples = np.array([_couples(record) for record in records]).reshape(len(records), 2)
    values = {
        "normal_force": (("time",), normal),
        "reaction_x": (("time", "gear"), np.stack([-normal, normal], axis=1)),
        "reaction_y": (("time", "gear"), np.stack([-friction, friction], axis=1)),
        "reaction_couple": (("time", "gear"), couples * _base_radii(records)),
        "newton_iterations": (("time",), np.array([record.solution.iterations for record in records])),
        "closed_nodes": (("time",), np.array([np.count_nonzero(record.solution.status != OPEN) for record in records])),
    }
    if scene.friction is not None:
        values["friction_force"] = (("time",), friction)
    return values


def _normal(record: Record) -> np.ndarray:
    return record.solution.forces[: record.position.operator.nodes]


def _tangential(record: Record) -> np.ndarray:
    return record.solution.forces[record.position.operator.nodes :]


def _base_radii(records: list[Record]) -> np.ndarray:
    radii = [record.position.operator.base_radii for record in records]
    return np.array(radii).reshape(len(records), 2)


def _couples(record: Record) -> tuple[float, float]:
    """Couple of the contact forces on either gear about its centre, per base radius (N)."""
    operator, normal, tangential = record.position.operator, _normal(record), _tangential(record)
    pinion, wheel = (normal @ arms / radius for arms, radius in zip(operator.normal_arms, operator.base_radii))
    if len(tangential):
        pinion += tangential @ operator.arms[0] / operator.base_radii[0]
        wheel += tangential @ operator.arms[1] / operator.base_radii[1]
    return -pinion, -wheel


def _pair_variables(scene: Scene, cycle: Cycle, records: list[Record], pairs: list[int]) -> dict:
    """Forces of each tooth pair and the pressure over its contact nodes; zero where a pair does not touch."""
    row = {number: i for i, number in enumerate(pairs)}
    width, most = scene.gears.face_width, cycle.grid.nodes
    force = np.zeros((2, len(records), len(pairs)))
    stress = np.zeros((2, len(records), len(pairs), most))
    place = np.full((2, len(records), len(pairs), most), np.nan)
    for i, record in enumerate(records):
        normal, tangential, start = _normal(record), _tangential(record), 0
        for pair in record.position.operator.pairs:
            nodes = slice(start, start + len(pair.offsets))
            start = nodes.stop
            j, count = row[int(cycle.pair_number(record.step, pair.index))], len(pair.offsets)
            for kind, forces in enumerate((normal, tangential)):
                if len(forces):
                    force[kind, i, j] = forces[nodes].sum()
                    stress[kind, i, j, :count] = forces[nodes] / (pair.lengths * width)
            place[0, i, j, :count], place[1, i, j, :count] = pair.offsets, pair.pinion_roll
    over_nodes = ("time", "pair", "contact_node")
    values = {
        "pair_normal_force": (("time", "pair"), force[0]),
        "contact_pressure": (over_nodes, stress[0]),
        "contact_offset": (over_nodes, place[0]),
        "contact_roll_angle": (over_nodes, place[1]),
    }
    if scene.friction is not None:
        values["pair_friction_force"] = (("time", "pair"), force[1])
        values["contact_traction"] = (over_nodes, stress[1])
    return values


def _energy_variables(scene: Scene, drivetrain: Drivetrain, records: list[Record]) -> dict:
    """Elastic energy of the teeth, and of shafts, bearings and motion where the scene has them (N mm)."""
    teeth = [0.5 * r.solution.forces @ r.position.operator.compliance @ r.solution.forces for r in records]
    parts = {"energy_teeth": np.array(teeth)}
    translations = np.array([name in TRANSLATIONS for name in drivetrain.coordinates])
    states = np.array([record.state.position for record in records]).reshape(len(records), len(translations))
    if scene.bearings is not None:
        parts["energy_bearings"] = _quadratic(states * translations, drivetrain.stiffness)
    if scene.shafts is not None:
        parts["energy_shafts"] = _quadratic(states * ~translations, drivetrain.stiffness)
    if scene.inertia is not None:
        velocities = np.array([record.state.velocity for record in records]).reshape(states.shape)
        parts["energy_kinetic"] = _quadratic(velocities, drivetrain.mass)
    parts["energy"] = sum(parts.values())
    return {name: (("time",), energy) for name, energy in parts.items()}


def _quadratic(states: np.ndarray, matrix: np.ndarray) -> np.ndarray:
    return 0.5 * np.einsum("ti,ij,tj->t", states, matrix, states)


def _attributes(scene: Scene, march: March, result: xr.Dataset) -> dict:
    error = result["transmission_error"].values
    attributes = {
        "title": scene.title,
        "scene": scene.text,
        "scene_name": scene.name,
        "fenics_gears_version": fenics_gears.__version__,
        "complete": int(not march.interrupted),
        "steps": march.steps,
        "newton_iterations_total": march.newton_iterations,
        "time_march": march.seconds,
    }
    attributes |= {f"steps_by_rung: {rung}": count for rung, count in march.rungs.items() if count}
    if len(error):
        attributes["peak_to_peak_transmission_error"] = float(np.ptp(error))
        attributes["mean_transmission_error"] = float(error[:-1].mean() if len(error) > 1 else error[0])
    return attributes


def save(result: xr.Dataset, path: str | Path) -> None:
    """Write a dataset as NetCDF-4; it appears under its name only when whole."""
    path = Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    aside = path.with_name(f".{path.name}.{os.getpid()}.part")
    encoding = {
        name: {"zlib": True, "complevel": 1} for name, variable in result.data_vars.items() if variable.ndim > 1
    }
    try:
        result.to_netcdf(aside, engine="h5netcdf", encoding=encoding)
        os.replace(aside, path)
    finally:
        aside.unlink(missing_ok=True)


def load(path: str | Path) -> xr.Dataset:
    """Read a saved result into memory. Raises ComputationError when the file is no result of this program."""
    try:
        with xr.open_dataset(path, engine="h5netcdf") as opened:
            result = opened.load()
    except (OSError, ValueError) as failure:
        raise ComputationError(f"{path}: cannot be read as a result: {failure}") from failure
    if "transmission_error" not in result or "scene" not in result.attrs:
        raise ComputationError(f"{path}: holds no run of this program (no transmission_error, no scene text)")
    return result
