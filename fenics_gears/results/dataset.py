"""The result of a run: one labelled dataset, with units and long names.

Dimensions: `time`, `gear` ("pinion", "wheel"), `pair` (tooth pairs, counted through the run), `contact_node`. A variable that
belongs to an effect is there only when the scene names that effect.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr

import fenics_gears
from fenics_gears.contact.laws import NO_FORCE
from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.dynamics.clock import Clock
from fenics_gears.dynamics.contact_loss import loss_attributes
from fenics_gears.dynamics.drivetrain import Drivetrain
from fenics_gears.dynamics.march import March, Record, VaryingLoad
from fenics_gears.effects import effects_on, result_variables
from fenics_gears.results.attributes import RUNG
from fenics_gears.results.contact_variables import largest_normal_force, mesh_variables, pair_variables
from fenics_gears.results.energy_variables import energy_variables, transmitted, work_variables
from fenics_gears.results.key_numbers import contact_point_names, contact_point_variables, key_numbers
from fenics_gears.results.mesh_curves import mesh_curves
from fenics_gears.scene.data import Scene
from fenics_gears.validity import warnings_of, warnings_of_energy

GEARS = ("pinion", "wheel")


def dataset(
    scene: Scene, cycle: Cycle, drivetrain: Drivetrain, march: March, clock: Clock, loads: Sequence[VaryingLoad] = ()
) -> xr.Dataset:
    """The stored steps of a march as a dataset; every variable with units and long name. `loads`: those that vary."""
    records = list(march.records)
    values = _centre_variables(scene, drivetrain, records)
    values |= mesh_variables(scene, records)
    values |= mesh_curves(scene, cycle, records)
    pairs = sorted({int(cycle.pair_number(r.step, p.place.index)) for r in records for p in r.position.operator.pairs})
    values |= pair_variables(scene, cycle, records, pairs)
    values |= energy_variables(scene, drivetrain, records)
    values |= work_variables(scene, cycle, drivetrain, clock, loads, records, values["energy"][1])
    for effect in effects_on(scene):
        if effect.results is not None:
            values |= effect.results(getattr(scene, effect.section), scene, cycle, records)
    steps = np.array([record.step for record in records], dtype=float)
    described = {variable.name: variable for variable in result_variables(scene)}
    result = xr.Dataset(
        {name: (dims, data, _labels(described[name])) for name, (dims, data) in values.items()},
        coords={
            "time": ("time", np.array([clock.time(step) for step in steps]), {"units": "s", "long_name": "time"}),
            "mesh_phase": ("time", steps / cycle.steps, {"units": "1", "long_name": "mesh cycles since the start"}),
            "gear": ("gear", list(GEARS), {"long_name": "gear"}),
            "pair": ("pair", np.array(pairs, dtype=np.int64), {"long_name": "tooth pair, counted through the run"}),
        },
    )
    of_points = contact_point_variables(result, scene, cycle.pair)
    result = result.assign({name: (dims, data, _labels(described[name])) for name, (dims, data) in of_points.items()})
    result = result.assign_coords(contact_point=contact_point_names())
    attributes = _attributes(scene, march, result)
    attributes |= key_numbers(result.assign_attrs(attributes), cycle.pair) | loss_attributes(march.separations, march.steps, clock)
    found = [*warnings_of(cycle, drivetrain, march, clock), *warnings_of_energy(scene, result, cycle.steps), *_undetermined_shares(result)]
    for effect in effects_on(scene):
        if effect.findings is not None:
            found += effect.findings(getattr(scene, effect.section), cycle, records)
    attributes["warnings"] = "\n".join(found)
    return result.assign_attrs(attributes)


def _undetermined_shares(result: xr.Dataset) -> list[str]:
    """A sentence on rigid pairs that touch together."""
    steps = int(np.isnan(result["pair_normal_force"].values).any(axis=1).sum())
    if not steps:
        return []
    return [
        f"several pairs of rigid flanks touch at once in {steps} of {len(result['time'])} stored steps: their shares of the force are not "
        "determined, and pair_normal_force is not a number there; a scene with [gears.material] has them"
    ]


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
    attributes |= {f"{RUNG}{rung}": count for rung, count in march.rungs.items() if count}
    if len(error):
        attributes["peak_to_peak_transmission_error"] = float(np.ptp(error))
        attributes["mean_transmission_error"] = float(error[:-1].mean() if len(error) > 1 else error[0])
    if len(error) > 1 and scene.friction is not None and not march.locked and largest_normal_force(result) > NO_FORCE:
        attributes |= _friction_loss(result)
    return attributes


def _friction_loss(result: xr.Dataset) -> dict[str, float]:
    """The share of the drive's work that friction takes; nothing where the drive does no work."""
    drive = abs(transmitted(result).drive)
    return {"friction_loss": float(result["work_friction"].values[-1]) / drive} if drive else {}

