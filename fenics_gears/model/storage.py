"""The arrays of a result and their sizes: one list, by which the recorder keeps them and their memory is counted."""

from __future__ import annotations

from collections.abc import Mapping
from math import prod

import numpy as np

from fenics_gears.effects import result_variables
from fenics_gears.scene.data import Scene

# Stress points of either fillet of a tooth, `elasticity.fillet_points`; the last is the one at the 30 degree tangent.
FILLET_POINTS, FILLET_POINTS_OVER_FACE = 24, 12
ROOT_STRESS = {
    "root_stress": ("contact_time", "gear", "slot", "fillet_point"),
    "root_stress_maximum": ("time", "gear", "slot"),
    "root_stress_at_30_degrees": ("time", "gear", "slot", "fillet"),
}
ROOT_STRESS_OVER_FACE = ROOT_STRESS | {
    "root_stress": ("contact_time", "gear", "slot", "fillet_point", "face_position"),
    "root_stress_over_face": ("contact_time", "gear", "slot", "fillet", "face_position"),
}
COORDINATES = {"time": ("time",), "mesh_phase": ("time",), "pair_number": ("time", "slot")}
CONTACT_COORDINATES = {
    "contact_time": ("contact_time",),
    "contact_mesh_phase": ("contact_time",),
    "contact_pair_number": ("contact_time", "slot"),
}

Arrays = Mapping[str, tuple[tuple[str, ...], np.dtype]]


def fillet_points(slices: int) -> int:
    """Stress points of a fillet in each of so many slices."""
    return FILLET_POINTS if slices == 1 else FILLET_POINTS_OVER_FACE


def sizes(steps: int, contact_steps: int, slots: int, nodes: int, slices: int = 1) -> dict[str, int]:
    """Length of each dimension of a result with so many steps, of which the contact fields of so many are stored, over
    so many `slices` of the face."""
    return {
        "face_position": slices,
        "time": steps, "contact_time": contact_steps, "slot": slots, "contact_node": nodes,
        "gear": 2, "fillet": 2, "fillet_point": 2 * fillet_points(slices),
    }  # fmt: skip


def stored_arrays(scene: Scene, size: Mapping[str, int]) -> Arrays:
    """Dimensions and type of every array of a scene's result that grows with its steps; contact fields only where there
    are steps of them."""
    arrays = {variable.name: variable.dims for variable in result_variables(scene)} | COORDINATES
    if scene.output.root_stress and scene.resolves_contact:
        arrays |= ROOT_STRESS_OVER_FACE if scene.three_dimensional else ROOT_STRESS
    arrays |= CONTACT_COORDINATES
    whole = {
        "newton_iterations": np.dtype(np.int64),
        "closed_nodes": np.dtype(np.int64),
        "pair_number": np.dtype(np.int32),
        "contact_pair_number": np.dtype(np.int32),
    }
    return {
        name: (dims, whole.get(name, np.dtype(float)))
        for name, dims in arrays.items()
        if "time" in dims or ("contact_time" in dims and size["contact_time"])
    }


def counted_bytes(arrays: Arrays, size: Mapping[str, int]) -> int:
    """Memory of the arrays."""
    return sum(kind.itemsize * prod(size[each] for each in dims) for dims, kind in arrays.values())
