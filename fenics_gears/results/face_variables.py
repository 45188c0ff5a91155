"""Contact over a face in the result: line loads, mesh stiffness in the transverse plane, and a warning where much of
the face does not touch."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import xarray as xr

from fenics_gears.contact.face import Face
from fenics_gears.contact.laws import NO_FORCE
from fenics_gears.results.pairs import carrying_side
from fenics_gears.results.side_by_side import SideBySide

# Part of the face that touches, below which there is a warning: end relief takes the load off less than the rest.
NOTABLE_PART = 0.75
# Slices that touch, below which their number does not resolve how.
FEWEST_TOUCHING = 3


def face_variables(nodes: SideBySide) -> dict[str, np.ndarray]:
    """Line load of each tooth pair on its drive flanks, and on its coast flanks where they can touch, over the slices
    of the face (steps, slots, slices), N/mm."""
    sides = {"line_load": nodes.drive} | ({"coast_line_load": ~nodes.drive} if nodes.cycle.coast_flanks else {})
    return {name: nodes.by_slice(nodes.normal * side) / nodes.cycle.face.widths for name, side in sides.items()}


def in_transverse_plane(curves: Mapping[str, np.ndarray], nodes: SideBySide) -> dict[str, np.ndarray]:
    """Mesh stiffness in the transverse plane, as ISO 6336-1 has it, from that along the contact normal; and the loaded
    tooth pairs, not their slices.

    A transverse approach of 1 mm is one of the cosine of the base helix angle along the normal, and of the force the
    transverse part is as large.
    """
    share = nodes.cycle.face.cosine**2
    loaded = [(nodes.by_slot(nodes.normal * (nodes.drive == drive)) > NO_FORCE).sum(axis=1) for drive in (True, False)]
    stiffness = {name: share * curves[name] for name in ("mesh_stiffness", "mesh_stiffness_tangent")}
    return stiffness | {"loaded_pairs": np.maximum(*loaded).astype(float)}


def warnings_of_face(face: Face, result: xr.Dataset) -> list[str]:
    """Where the recorded flanks leave much of the face without load in all steps; nothing where contact fields are not
    stored."""
    if not result.sizes.get("contact_time"):
        return []
    loads = result[f"{carrying_side(result)}line_load"].transpose(..., "face_position").values
    touched = (loads > NO_FORCE).reshape(-1, face.slices).any(axis=0)
    part = face.widths[touched].sum() / face.widths.sum()
    if not touched.any() or part >= NOTABLE_PART:
        return []
    begins, ends = face.positions - 0.5 * face.widths, face.positions + 0.5 * face.widths
    one_sided = touched[0] != touched[-1]
    where = f"at its {'left' if touched[0] else 'right'} end, " if one_sided else ""
    remedy = (
        "lower [misalignment], correct it by lead_modifications.pinion.helix_slope"
        if one_sided
        else "lower the crowning or the end relief"
    )
    coarse = (
        f"; {touched.sum()} of {face.slices} slices do not resolve how: raise accuracy.slices"
        if touched.sum() < FEWEST_TOUCHING
        else ""
    )
    return [
        f"the flanks touch over {part:.0%} of the face only, {where}from {begins[touched][0]:.3g} to"
        f" {ends[touched][-1]:.3g} mm of {begins[0]:.3g} to {ends[-1]:.3g} mm: {remedy}, or raise the torque{coarse}"
    ]
