"""Ring of swept sectors that half a turn about the tooth's centreline maps on themselves (theorem of `fold`).

It exchanges a sector's cuts. Of the ring, turning about a cut's own middle line therefore maps the sectors ahead on
those behind: with P what that does to a cut's dofs (an involution), the link between cuts has ``P ahead P = ahead^T``,
and the harmonics D of the ring (`elasticity.ring`) have ``P D P = conj(D)``. Over P's eigenvectors the blocks of D for
equal eigenvalues are real and those for opposite ones imaginary. Multiplied by i, the eigenvectors of one sign make D
real and symmetric, which takes a quarter of the operations of a complex matrix.
"""

from __future__ import annotations

import numpy as np
from scipy import sparse

from fenics_gears.elasticity.cut_chain import CutResponse
from fenics_gears.elasticity.ring import cyclic, definite_inverse, rotation
from fenics_gears.errors import ComputationError

# Of entries that the symmetry makes zero, in the largest entry.
ROUND_OFF = 1e-9


def half_turn_basis(lower: np.ndarray, heights: int) -> tuple[sparse.csr_matrix, int]:
    """Orthonormal eigenvectors (3k, 3k) of half a turn about a radial cut's middle line, and how many have the
    eigenvalue 1; they come first.

    lower: (k, 3), X, Y, z of the cut's nodes, by height and then along the cut; every height has the same section
    nodes.
    """
    along, nodes = len(lower) // heights, np.arange(len(lower))
    partner = along * (heights - 1 - nodes // along) + nodes % along
    alone, pair = nodes[nodes == partner], nodes[nodes < partner]
    angle = np.arctan2(lower[-1, 1], lower[-1, 0])
    frame = sparse.kron(sparse.eye(len(lower)), rotation(angle, 3), format="csc")
    halves = []
    for eigenvalue in (1.0, -1.0):
        vectors = []
        # Along the cut a displacement keeps its sign, across it and along z it changes.
        for component, sign in enumerate((eigenvalue, -eigenvalue, -eigenvalue)):
            own, image = (frame[:, 3 * each + component] for each in (pair, partner[pair]))
            vectors.append(0.5**0.5 * (own + sign * image))
            if sign > 0.0:
                vectors.append(frame[:, 3 * alone + component])
        halves.append(sparse.hstack(vectors, format="csr"))
    return sparse.hstack(halves, format="csr"), halves[0].shape[1]


def half_turn_response(
    link: np.ndarray, teeth: int, reach: int, basis: tuple[sparse.csr_matrix, int], comm=None
) -> CutResponse:
    """As `ring.cut_response`, of a sector that half a turn maps on itself; `basis` of its lower cut. Raises
    ComputationError where it does not.

    comm: communicator over whose ranks the harmonics are shared out; every rank calls this and gets the result.
    """
    vectors, even = basis
    same, ahead = (vectors.T @ (vectors.T @ part.T).T for part in cyclic(link))
    real, imaginary = ahead + ahead.T, ahead - ahead.T
    off = (
        max(abs(part[:even, even:]).max() for part in (same, real)),
        max(abs(imaginary[:even, :even]).max(), abs(imaginary[even:, even:]).max()),
    )
    if max(off) > ROUND_OFF * abs(same).max():
        raise ComputationError(
            "ring of sectors: half a turn about the tooth's centreline does not map the sector on itself"
        )
    responses = np.zeros((reach + 1, *same.shape))
    for harmonic in range(teeth // 2 + 1) if comm is None else range(comm.rank, teeth // 2 + 1, comm.size):
        angle = 2.0 * np.pi * harmonic / teeth
        stiffness = same + np.cos(angle) * real
        stiffness[:even, even:] = -np.sin(angle) * imaginary[:even, even:]
        stiffness[even:, :even] = stiffness[:even, even:].T
        inverse = definite_inverse(stiffness, "a harmonic")
        weight = (1.0 if harmonic == 0 or 2 * harmonic == teeth else 2.0) / teeth
        for offset, response in enumerate(responses):
            cosine, sine = weight * np.cos(offset * angle), weight * np.sin(offset * angle)
            response[:even, :even] += cosine * inverse[:even, :even]
            response[even:, even:] += cosine * inverse[even:, even:]
            response[:even, even:] += sine * inverse[:even, even:]
            response[even:, :even] -= sine * inverse[even:, :even]
    if comm is not None:
        # Imported here: alone there is no need of it.
        from mpi4py import MPI

        comm.Allreduce(MPI.IN_PLACE, responses)
    for response in responses:
        response[:] = vectors @ (vectors @ response.T).T
    return lambda offset: responses[offset] if offset >= 0 else responses[-offset].T


def ring_blocks(
    held: np.ndarray, to_cuts: np.ndarray, joint: CutResponse, offsets: int, comm=None
) -> np.ndarray | None:
    """Flank compliance blocks (offsets + 1, f, f) of a ring, as `ring.ring_compliance`, from a `condensed.SweptSector`
    and the response of its cuts.

    comm: communicator over whose ranks the products are shared out; every rank calls this, rank 0 gets the result, the
    others None.
    """
    rows = to_cuts if comm is None else np.array_split(to_cuts, comm.size)[comm.rank]
    (own_lower, own_upper), (lower, upper) = np.hsplit(rows, 2), np.hsplit(to_cuts, 2)
    own = np.empty((offsets + 1, len(rows), len(to_cuts)))
    # Response of the flanks to forces on the cuts m and m - 1 pitches behind; the latter is the former of the pitch
    # before.
    behind = own_lower @ joint(-1) + own_upper @ joint(0)
    for offset, block in enumerate(own):
        ahead = own_lower @ joint(offset) + own_upper @ joint(offset + 1)
        np.matmul(ahead, lower.T, out=block)
        block += behind @ upper.T
        behind = ahead
    parts = [own] if comm is None else comm.gather(own)
    if parts is None:
        return None
    blocks = np.concatenate(parts, axis=1)
    blocks[0] += held
    blocks[0] = 0.5 * (blocks[0] + blocks[0].T)
    return blocks
