"""The place of the most loaded contact in the picture of a pair."""

from dataclasses import dataclass

import numpy as np
import xarray as xr

from fenics_gears.contact.window import coast_roll_angles
from fenics_gears.geometry.in_mesh import upright
from fenics_gears.geometry.involute import flank_point
from fenics_gears.results.pairs import contact_times
from fenics_gears.simulation.run_stresses import GearsInMesh

FEWEST_NODES = 4


@dataclass(frozen=True)
class LoadedContact:
    """The most loaded contact: its middle (2,), mm, in the picture's frame; half the length that is closed, mm."""

    point: np.ndarray
    half_width: float


def stored_place(mesh: GearsInMesh, dataset: xr.Dataset) -> int:
    """Which of the steps with contact fields a recovered pair is at."""
    return int(np.argmin(np.abs(dataset["contact_mesh_phase"].values - mesh.mesh_phase)))


def loaded_contact(mesh: GearsInMesh, dataset: xr.Dataset) -> LoadedContact | None:
    """The contact of the tooth pair with the largest normal force, on the flanks that carry more; None where nothing
    touches."""
    index = stored_place(mesh, dataset)
    pair = mesh.pair
    coast = mesh.coast
    dataset = contact_times(dataset)
    forces = np.nan_to_num(dataset["pair_coast_normal_force" if coast else "pair_normal_force"].values[index])
    slot = int(np.argmax(forces))
    if forces[slot] <= 0.0:
        return None
    names = [("coast_" if coast else "") + name for name in ("contact_pressure", "contact_roll_angle")]
    pressure, rolls = (dataset[name].values[index, slot] for name in names)
    numbers = dataset["contact_pair_number"]
    entered = int(numbers.values[index, slot]) - numbers.attrs["number_at_phase_0"]
    xi = pair.path_start + (mesh.mesh_phase - entered) * pair.base_pitch
    contact_roll = coast_roll_angles(pair, xi)[0] if coast else xi / pair.pinion.base_radius
    known = ~np.isnan(rolls)
    x, height = flank_point(pair.pinion.base_radius, rolls[known], contact_roll)
    pressure = pressure[known]
    points = np.column_stack([x, -height])
    spacing = float(np.median(np.linalg.norm(np.diff(points, axis=0), axis=1))) if len(points) > 1 else 0.0
    closed = max(np.count_nonzero(pressure > 0.0), FEWEST_NODES)
    return LoadedContact(upright(pair, np.average(points, axis=0, weights=pressure), coast), 0.5 * spacing * closed)
