"""A gear of symmetric tooth sectors, both of whose flanks are loaded: half a sector condensed, the other half by
symmetry.

Every motion is the sum of a symmetric and an antisymmetric one. These are uncoupled, and each has a stiffness of half
the size: on the centreline the symmetric one does not move across it, the antisymmetric one not along it. With v the
drive half's motion and v' the coast half's in the mirrored frame, the sector's energy is ``s^T S_s s + a^T S_a a``
where ``s = (v + v') / 2`` and ``a = (v - v') / 2``; any response is ``(R_s + R_a) / 2`` within a half and ``(R_s - R_a)
/ 2`` across.
"""

import numpy as np
from scipy.linalg.blas import dsyrk, dtrsm

from .compliance import Reach
from .condensation import CondensedBody, by_radius, condense, held_nodes, line_of
from .elements import Element
from .mesh_data import BodyMesh
from .mumps import symmetric
from .ring import cut_response, definite_factor, inverse_of_factor, sector_response, turned_nodes

# Compliance (f, f) of the flank with the cuts held, its response (f, c) to motions of the cut, stiffness (c, c) of the
# cut with the flank free.
Parts = tuple[np.ndarray, np.ndarray, np.ndarray]


def condensed_half(mesh: BodyMesh, element: Element, poissons_ratio: float) -> CondensedBody:
    """The sector's half (`sector_mesh.half_sector_mesh`) condensed onto "flank", "cut", "centreline" and "hub"."""
    points = {
        "flank": by_radius(mesh.edge_nodes("flank", element.order)),
        "cut": line_of(mesh, "upper cut", element.order),
        "centreline": line_of(mesh, "centreline", element.order),
        **held_nodes(mesh, element.order),
    }
    return condense(mesh, element, poissons_ratio, points)


def both_flanks_compliance(
    half: CondensedBody, axis: np.ndarray, teeth: int, reach: Reach
) -> tuple[np.ndarray, np.ndarray]:
    """Compliance of the ring, hub held, Young's modulus 1 MPa, like `ring.ring_compliance`: `blocks` and `across` of
    `BothFlanksCompliance`. axis: (2,), unit vector along the centreline."""
    along = np.asarray(axis)
    parts = [
        flank_free(_constrained(half, direction), len(half.dofs("flank")))
        for direction in (along, np.array([-along[1], along[0]]))
    ]
    (held, to_cut, cut), (held_cross, to_cut_cross, cut_cross) = within_and_across(*parts)
    nodes = len(half.points["cut"])
    turn = turned_nodes(teeth, nodes)
    mirror = np.kron(np.eye(nodes), 2.0 * np.outer(along, along) - np.eye(2))
    joint = cut_response(unfolded_link(cut, cut_cross, mirror, turn), teeth, reach.farthest + 1)
    drive = unfolded(to_cut, to_cut_cross, mirror, turn)
    coast = unfolded(to_cut_cross, to_cut, mirror, turn)

    first, last = reach.across
    blocks, across = (np.empty((count, *held.shape)) for count in (reach.same + 1, last - first + 1))
    for offset, block in enumerate(blocks):
        np.matmul(drive @ sector_response(joint, offset), drive.T, out=block)
    blocks[0] += held
    blocks[0] = 0.5 * (blocks[0] + blocks[0].T)
    for offset, block in enumerate(across, first):
        across_teeth = (drive @ sector_response(joint, offset)) @ coast.T
        block[:] = 0.5 * (across_teeth + across_teeth.T)
    if first <= 0 <= last:
        across[-first] += held_cross
    return blocks, across


def within_and_across(same: Parts, opposite: Parts) -> tuple[Parts, Parts]:
    """What a half has of itself and of the other half, from the parts (`flank_free`) of both kinds of motion."""
    within, across = (tuple(0.5 * (one + sign * other) for one, other in zip(same, opposite)) for sign in (1.0, -1.0))
    return within, across


def unfolded(own: np.ndarray, other: np.ndarray, image, turn) -> np.ndarray:
    """(Minus) a flank's motion (f, 2 c) per motion of the lower and the upper cut, from that per motion of the cut on
    its own side and on the other's.

    image: from motions of the upper cut to those of the lower one, its image; turn: of a pitch, into the frame of a
    lower cut.
    """
    return np.hstack([(image @ other.T).T, own @ turn])


def unfolded_link(cut: np.ndarray, cross: np.ndarray, image, turn) -> np.ndarray:
    """Stiffness (2 c, 2 c) between a sector's cuts, from that (c, c) of a half's cut and that between the halves'."""
    across = image @ (cross @ turn)
    return np.block([[image @ (image @ cut).T, across], [across.T, turn.T @ (cut @ turn)]])


def _constrained(half: CondensedBody, direction: np.ndarray) -> np.ndarray:
    """Stiffness (F + C, F + C) over flank and cut where the centreline moves along a direction (2,) only, free of
    force, hub held."""
    # Flank and cut come first.
    kept = slice(0, len(half.dofs("flank")) + len(half.dofs("cut")))
    line = half.dofs("centreline").reshape(-1, 2)
    stiffness = half.stiffness
    coupling = sum(direction[i] * stiffness[line[:, i], kept] for i in range(2))
    own = sum(
        direction[i] * direction[j] * stiffness[np.ix_(line[:, i], line[:, j])] for i in range(2) for j in range(2)
    )
    return stiffness[kept, kept] - coupling.T @ np.linalg.solve(own, coupling)


def flank_free(stiffness: np.ndarray, flank: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Compliance of the flank (its `flank` dofs come first), its response to motions of the cut, stiffness of the cut,
    the flank free."""
    # Transposed, they are in LAPACK's order.
    factor = definite_factor(stiffness[:flank, :flank].T, "a flank")
    onto_cut = dtrsm(1.0, factor, stiffness[flank:, :flank].T, trans_a=1)
    cut = stiffness[flank:, flank:] - symmetric(dsyrk(1.0, onto_cut, trans=1))
    response = dtrsm(1.0, factor, onto_cut, overwrite_b=1)
    return inverse_of_factor(factor, "a flank"), response, cut
