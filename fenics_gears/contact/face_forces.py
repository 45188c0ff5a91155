"""Forces on the flank nodes of a gear's three-dimensional body from forces at contact nodes."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fenics_gears.contact.face import Face
from fenics_gears.contact.face_pairing import FacePair, directions_on_face
from fenics_gears.contact.flank_forces import centreline_mirror, sector_of
from fenics_gears.contact.tooth_pair import COAST
from fenics_gears.elasticity.slice_averages import slice_averages
from fenics_gears.geometry.gear import Gear


def slice_rows(gear: int, data: Gear, face: Face, pair: FacePair, tangential: bool) -> np.ndarray:
    """Forces (3 f, n or 2 n) of a slice on the flank nodes of its section, in the tooth's own frame, per unit force at
    the pair's contact nodes, normals first."""
    near, axes = pair.coarse[gear].weights, directions_on_face(pair.place, face, gear, tangential)
    if pair.place.flank == COAST:
        axes[:, :2] = axes[:, :2] @ centreline_mirror(data).T
    # A positive contact force pushes on the flank; that of friction acts against e_y.
    return -np.hstack([np.einsum("nf,d->fdn", near, axis).reshape(-1, len(near)) for axis in axes])


def face_forces(
    gear: int, data: Gear, face: Face, heights: np.ndarray, pairs: Sequence[FacePair], forces: Sequence[np.ndarray]
) -> dict[int, np.ndarray]:
    """Forces (flanks, h, f, 3), N, on the flank nodes of a gear's loaded teeth, in each tooth's own frame at that
    height.

    `heights` (h,), mm from the gear's mid-width, of second-order layers; `forces`: of each pair's contact nodes in its
    slice, (n,) or (2 n,) with friction's, N. Teeth go by `sector_of`. A slice moves as the average over its width; its
    force spreads over the layers' nodes accordingly.
    """
    both = any(pair.place.flank == COAST for pair in pairs)
    weights = slice_averages(heights, 2, face.positions - face.middles[gear], face.widths)
    result: dict[int, np.ndarray] = {}
    for pair, force in zip(pairs, forces):
        if not force.any():
            continue
        section = (slice_rows(gear, data, face, pair, len(force) > len(pair.offsets)) @ force).reshape(-1, 3)
        total = result.setdefault(sector_of(gear, pair), np.zeros((2 if both else 1, len(heights), *section.shape)))
        total[pair.place.flank if both else 0] += weights[pair.place.slice][:, None, None] * section
    return result
