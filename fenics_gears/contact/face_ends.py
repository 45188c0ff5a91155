"""What the free ends of a face add to the compliance between the contact nodes of a slice
(`elasticity.face.free_end`)."""

from __future__ import annotations

from math import atan

import numpy as np
from numba import njit

from fenics_gears.elasticity.face_compliance_data import FaceCompliance

from .face import Face
from .fine_sections import BEGIN, SLICE, end_of

# Of an end of a gear: its softness, mm^2/N, how near and how far from it a slice is along the line of contact, mm, and
# the reach (mm) of what is added.
SOFTNESS, NEAR, FAR, REACH = range(4)
# Slices that are so many times the reach away get nothing: there less than 0.01 of kappa is left.
FARTHEST = 7.0


def ends_of(face: Face, bodies: tuple[FaceCompliance, FaceCompliance]) -> np.ndarray:
    """Of each slice and flank the ends of both gears (S, F, 4, 4), by the numbers above; softness is 0 of those that
    are far away."""
    found = np.zeros((face.slices, bodies[0].flanks, 4, 4))
    for gear, body in enumerate(bodies):
        if body.ends is None:
            continue
        places = face.positions - face.middles[gear]
        for end, inwards in enumerate((1.0, -1.0)):
            middles = inwards * (places - body.heights[-end])
            near, far = (np.maximum(middles + side * face.widths, 0.0) / face.cosine for side in (-0.5, 0.5))
            for flank in range(body.flanks):
                softness = np.where(near < FARTHEST * body.ends.reach, body.ends.of_flank(flank)[end], 0.0)
                found[:, flank, 2 * gear + end, SOFTNESS] = softness
                found[:, flank, 2 * gear + end, NEAR : REACH + 1] = np.column_stack(
                    [near, far, np.full(len(near), body.ends.reach)]
                )
    return found


@njit(cache=True)
def add_ends(found, rows, fine, group, nodes, place):
    """Add what free ends give along the normals between nodes of a group, which are rows and columns, to `found`
    (e, m, r), mm/N, where those of the group begin at a `place`."""
    number, begin = rows.groups[SLICE, group], rows.groups[BEGIN, group]
    ends = fine.ends[number, rows.flanks[group]]
    for end in ends:
        if end[SOFTNESS] != 0.0:
            for row, node in enumerate(nodes):
                for other in range(begin, end_of(rows, group)):
                    apart = rows.offsets[node] - rows.offsets[other]
                    found[0, place + other - begin, row] += fine.shares[number] * displacement_beside(end, apart)


@njit(cache=True)
def displacement_beside(end, apart):
    """Displacement (mm per N/mm), averaged over a slice, at an offset `apart` (mm) from a line load."""
    own, coarse = apart**2, apart**2 + end[REACH] ** 2
    added = 0.0
    for place, sign in ((end[FAR], 1.0), (end[NEAR], -1.0)):
        added += sign * (_integral(place, coarse) - _integral(place, own))
    return 0.5 * end[SOFTNESS] * added / (end[FAR] - end[NEAR])


@njit(cache=True)
def _integral(place, square):
    """Integral from 0 to `place` of ln(l^2 + square)."""
    if place == 0.0:
        return 0.0
    root = np.sqrt(square)
    turned = 2.0 * root * atan(place / root) if root > 0.0 else 0.0
    return place * (np.log(place**2 + square) - 2.0) + turned
