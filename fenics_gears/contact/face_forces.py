"""Forces on the flank nodes of a gear's three-dimensional body from forces at contact nodes."""

from __future__ import annotations

import numpy as np

from fenics_gears.contact.face import Face
from fenics_gears.contact.face_pairing import FacePair, directions_on_face
from fenics_gears.contact.flank_forces import centreline_mirror
from fenics_gears.contact.tooth_pair import COAST
from fenics_gears.geometry.gear import Gear


def slice_rows(gear: int, data: Gear, face: Face, pair: FacePair, tangential: bool) -> np.ndarray:
    """Forces (3 f, n or 2 n) of a slice on the flank nodes of its section, in the tooth's own frame, per unit force at
    the pair's contact nodes, normals first."""
    near, axes = pair.coarse[gear].weights, directions_on_face(pair.place, face, gear, tangential)
    if pair.place.flank == COAST:
        axes[:, :2] = axes[:, :2] @ centreline_mirror(data).T
    # A positive contact force pushes on the flank; that of friction acts against e_y.
    return -np.hstack([np.einsum("nf,d->fdn", near, axis).reshape(-1, len(near)) for axis in axes])
