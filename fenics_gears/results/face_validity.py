"""The warning of a finished run that its flanks touch over a part of the face only."""

from __future__ import annotations

import xarray as xr

from fenics_gears.contact.face import Face
from fenics_gears.contact.laws import NO_FORCE
from fenics_gears.results.pairs import carrying_side

# Part of the face that touches, below which there is a warning: end relief takes the load off less than the rest.
NOTABLE_PART = 0.75
# Slices that touch, below which their number does not resolve how.
FEWEST_TOUCHING = 3


def warnings_of_face(face: Face, result: xr.Dataset) -> list[str]:
    """Where the recorded flanks leave much of the face without load in all steps; nothing where contact fields are not stored."""
    if not result.sizes.get("contact_time"):
        return []
    loads = result[f"{carrying_side(result)}line_load"].transpose(..., "face_position").values
    touched = (loads > NO_FORCE).reshape(-1, face.slices).any(axis=0)
    part = face.widths[touched].sum() / face.widths.sum()
    if not touched.any() or part >= NOTABLE_PART:
        return []
    ends = [float(at[0] - 0.5 * face.widths[0]) for at in (face.positions[touched], face.positions)]
    ends += [float(at[-1] + 0.5 * face.widths[-1]) for at in (face.positions[touched], face.positions)]
    low, left, high, right = ends
    one_sided = touched[0] != touched[-1]
    where = f"at its {'left' if touched[0] else 'right'} end, " if one_sided else ""
    remedy = "lower [misalignment], correct it by lead_modifications.pinion.helix_slope" if one_sided else "lower the crowning or the end relief"
    coarse = f"; {touched.sum()} of {face.slices} slices do not resolve how: raise accuracy.slices" if touched.sum() < FEWEST_TOUCHING else ""
    return [
        f"the flanks touch over {part:.0%} of the face only, {where}from {low:.3g} to {high:.3g} mm of {left:.3g} to {right:.3g} mm: "
        f"{remedy}, or raise the torque{coarse}"
    ]
