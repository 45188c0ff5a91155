"""What contact over a face has in the result besides the fields of its contact nodes."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from fenics_gears.contact.laws import NO_FORCE
from fenics_gears.results.side_by_side import SideBySide


def face_variables(nodes: SideBySide) -> dict[str, np.ndarray]:
    """Line load of each tooth pair on its drive flanks, and on its coast flanks where they can touch, over the slices of the face (steps, slots, slices), N/mm."""
    sides = {"line_load": nodes.drive} | ({"coast_line_load": ~nodes.drive} if nodes.cycle.coast_flanks else {})
    return {name: nodes.by_slice(nodes.normal * side) / nodes.cycle.face.widths for name, side in sides.items()}


def in_transverse_plane(curves: Mapping[str, np.ndarray], nodes: SideBySide) -> dict[str, np.ndarray]:
    """Mesh stiffness in the transverse plane, as ISO 6336-1 has it, from that along the contact normal; and the loaded tooth pairs, not their slices.

    A transverse approach of 1 mm is one of the cosine of the base helix angle along the normal, and of the force the transverse part is as large.
    """
    share = nodes.cycle.face.cosine**2
    loaded = [(nodes.by_slot(nodes.normal * (nodes.drive == drive)) > NO_FORCE).sum(axis=1) for drive in (True, False)]
    stiffness = {name: share * curves[name] for name in ("mesh_stiffness", "mesh_stiffness_tangent")}
    return stiffness | {"loaded_pairs": np.maximum(*loaded).astype(float)}
