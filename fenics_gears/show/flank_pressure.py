"""The contact pressure at one time as tiles on the flanks of both gears in three dimensions."""

from dataclasses import dataclass

import numpy as np
import xarray as xr
from scipy.spatial import cKDTree

from fenics_gears.contact.window import coast_roll_angles, contact_roll_angles
from fenics_gears.geometry.involute import flank_point
from fenics_gears.geometry.pair import GearPair
from fenics_gears.results.face_ends import slice_ends
from fenics_gears.simulation.run_stresses import GearsInMesh

from .contact_pattern import over_face, rolls_on_wheel
from .loaded_contact import stored_place
from .pressure import node_edges

# Tiles are off the flank by this part of a module, so that the facets of the bodies' mesh do not cover them.
STAND_OFF = 0.02
NEAREST = 3


@dataclass(frozen=True)
class PressedTiles:
    """Quadrangles (n, 4, 3), mm, in the frame of the line of action, each with the pressure (n,), MPa, of a contact
    node in its slice."""

    corners: np.ndarray
    pressure: np.ndarray


def pressed_tiles(mesh: GearsInMesh, dataset: xr.Dataset, gear: int, scale: float) -> PressedTiles:
    """The tiles of a gear at the time of a mesh, moved as its teeth are; `scale`: of their displacements."""
    side = "coast_" if mesh.coast else ""
    pair = mesh.pair
    part = dataset.isel(contact_time=[stored_place(mesh, dataset)])
    pressure, rolls = over_face(part, side)
    low, high = node_edges(rolls_on_wheel(pair, part, side, rolls) if gear else rolls)
    pressed = (pressure > 0.0) & np.isfinite(low) & np.isfinite(high)
    _, slots, slices, _ = np.nonzero(pressed)
    numbers = part["contact_pair_number"]
    entered = (mesh.mesh_phase - (numbers.values[0] - numbers.attrs["number_at_phase_0"]))[slots]
    middles = part["face_position"].values
    ends = slice_ends(part)

    def contact_roll(z: np.ndarray) -> np.ndarray:
        xi = pair.path_start + entered * pair.base_pitch + pair.slope * z
        return (coast_roll_angles if side else contact_roll_angles)(pair, xi)[gear]

    def corners(edge: np.ndarray, z: np.ndarray) -> np.ndarray:
        # Along the line of contact a node's roll angle changes as that of the contact does.
        touching = contact_roll(z)
        rolls = edge[pressed] + touching - contact_roll(middles[slices])
        return np.column_stack([_placed(pair, gear, mesh.coast, rolls, touching), z])

    around = [(low, ends[slices]), (high, ends[slices]), (high, ends[slices + 1]), (low, ends[slices + 1])]
    points = np.stack([corners(*each) for each in around], axis=1)
    return PressedTiles(points + scale * _displacement(mesh, gear, points), pressure[pressed])


def _placed(pair: GearPair, gear: int, coast: bool, rolls: np.ndarray, touching: np.ndarray) -> np.ndarray:
    """Points (n, 2) of a gear's flank at roll angles (n,), a little off it, where the flank touches at others (n,)."""
    x, height = flank_point(pair.gears[gear].base_radius, rolls, touching)
    x = x + STAND_OFF * pair.pinion.module
    bases = pair.pinion.base_radius + pair.wheel.base_radius
    if gear:
        x = pair.line_of_action_length - x
        height = bases - height
    points = np.column_stack([x, -height])
    if not coast:
        return points
    # Coast flanks are the mirror image at the line of centres.
    along = np.array([pair.line_of_action_length, -bases]) / pair.centre_distance
    return 2.0 * np.outer(points @ along, along) - points


def _displacement(mesh: GearsInMesh, gear: int, points: np.ndarray) -> np.ndarray:
    """Displacement of the teeth's nodes around points (..., 3)."""
    teeth = mesh.gears[gear]
    distance, node = cKDTree(teeth.points.reshape(-1, 3)).query(points.reshape(-1, 3), NEAREST)
    weight = 1.0 / np.maximum(distance, 1e-9)
    displacement = (weight[..., None] * teeth.elastic.reshape(-1, 3)[node]).sum(axis=1) / weight.sum(
        axis=1, keepdims=True
    )
    return displacement.reshape(points.shape)
