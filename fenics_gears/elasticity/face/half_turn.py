"""Ring of swept sectors that half a turn about the tooth's centreline maps on themselves (theorem of `fold`).

It exchanges a sector's cuts. Of the ring, turning about a cut's own middle line therefore maps the sectors ahead on
those behind: with P what that does to a cut's dofs (an involution), the link between cuts has ``P ahead P = ahead^T``,
and the harmonics D of the ring (`elasticity.ring`) have ``P D P = conj(D)``. Over P's eigenvectors the blocks of D for
equal eigenvalues are real and those for opposite ones imaginary. Multiplied by i, the eigenvectors of one sign make D
real and symmetric, which takes a quarter of the operations of a complex matrix.

Half a turn about the tooth's own centreline exchanges the cuts too. Where the cuts move by u with a phase k between
them, the even motion of a sector is that of ``cos(k/2) u`` for eigenvectors of 1 and ``-sin(k/2) u`` for those of -1,
the odd one i times that of ``sin(k/2) u`` and ``cos(k/2) u``: both halves of a sector (`condensed`) enter a harmonic by
real matrices.
"""

import numpy as np
from scipy import sparse
from scipy.linalg import block_diag
from scipy.linalg.blas import dsyrk, dtrsm
from scipy.spatial import cKDTree

from fenics_gears.errors import ComputationError

from ..ring import Whitened, cyclic, definite_factor, harmonic_of, rotation
from ..triangle import symmetric
from .condensed import MISSING, SweptSector, spanned

# Of entries that the symmetry makes zero, in the largest entry.
ROUND_OFF = 1e-9
# Teeth of a ring that stands for a larger one reach so far, and are so many of all; what goes round it may miss this
# part.
FEWEST_OFFSETS, MOST_OF_TEETH, AROUND = 3, 0.35, 1e-13


def half_turn_basis(lower: np.ndarray) -> tuple[sparse.csr_matrix, int]:
    """Orthonormal eigenvectors (3k, 3k) of half a turn about a radial cut's middle line, and how many have the
    eigenvalue 1; they come first. lower: (k, 3), X, Y, z of the cut's nodes, those at opposite heights alike."""
    nodes = np.arange(len(lower))
    partner = cKDTree(lower).query(lower * [1.0, 1.0, -1.0])[1]
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


def half_turn_whitened(link: np.ndarray, basis: tuple[sparse.csr_matrix, int]) -> Whitened:
    """As `ring.whitened`, of a sector that half a turn maps on itself; `basis` of its lower cut. Raises
    ComputationError where it does not."""
    vectors, even = basis
    same, ahead = (vectors.T @ (vectors.T @ part.T).T for part in cyclic(link))
    real, imaginary = ahead + ahead.T, ahead - ahead.T
    off = (
        max(abs(part[:even, even:]).max() for part in (same, real)),
        max(abs(imaginary[:even, :even]).max(), abs(imaginary[even:, even:]).max()),
    )
    if max(off) > ROUND_OFF * abs(same).max():
        raise _not_mapped()
    across = np.ascontiguousarray(imaginary[:even, even:].T)

    def of_harmonic(angle: float, forces: np.ndarray) -> np.ndarray:
        lower, upper = np.vsplit(forces, 2)
        moved = vectors.T @ (lower + upper * np.exp(-1j * angle))
        moved[even:] *= -1j
        stiffness = same + np.cos(angle) * real
        np.multiply(across, -np.sin(angle), out=stiffness[even:, :even])
        # Transposed, it is in LAPACK's order, and its lower triangle alone is read.
        factor = definite_factor(stiffness.T, "a harmonic")
        columns = np.asfortranarray(np.hstack([moved.real, moved.imag]))
        solved = dtrsm(1.0, factor, columns, trans_a=1, overwrite_b=1)
        return solved[:, : moved.shape[1]] + 1j * solved[:, moved.shape[1] :]

    return of_harmonic


def ring_blocks(sector: SweptSector, teeth: int, offsets: int, comm=None) -> np.ndarray | None:
    """Flank compliance blocks (offsets + 1, f, f) of a ring of swept sectors, as `ring.ring_compliance`.

    comm: over whose ranks harmonics and offsets are shared out; every rank calls this, rank 0 gets the result, the
    others None. Raises ComputationError where half a turn does not map the ring on itself.
    """
    basis = half_turn_basis(sector.lower)
    over_cut = _over_cut(sector, teeth, basis)
    cuts = [over_cut.T @ (over_cut.T @ half.cut).T for half in (sector.even, sector.odd)]
    to_cuts = [(over_cut.T @ half.to_cut.T).T for half in (sector.even, sector.odd)]
    within = _joined_through_cuts(cuts, to_cuts, basis[1], teeth, offsets, comm)
    shapes = np.hstack([sector.even.shapes, sector.odd.shapes])
    if sector.coast is not None:
        shapes = np.vstack([shapes, sector.coast @ np.hstack([sector.even.shapes, -sector.odd.shapes])])
    rank, ranks = (0, 1) if comm is None else (comm.rank, comm.size)
    blocks = np.empty((offsets + 1 if rank == 0 else 1, len(shapes), len(shapes)))
    tried = 0
    for offset in range(rank, offsets + 1, ranks):
        # The farther a tooth, the fewer ways in which the flanks move each other.
        columns, rows = spanned(within[offset], tried, 0.01 * MISSING)
        tried = max(2 * columns.shape[1] // 3, 1)
        found = np.matmul(shapes @ columns, (shapes @ rows.T).T, out=blocks[offset if rank == 0 else 0])
        if rank > 0:
            comm.Send(found, 0, offset)
    if rank > 0:
        return None
    for offset in range(offsets + 1):
        if offset % ranks:
            comm.Recv(blocks[offset], offset % ranks, offset)
    blocks[0] += sector.held()
    symmetric(blocks[0])
    return blocks


def _over_cut(sector: SweptSector, teeth: int, basis: tuple[sparse.csr_matrix, int]) -> sparse.csr_matrix:
    """The basis of a lower cut as motions (c, c) of the upper cut, a pitch ahead, in the sector's frame. Raises
    ComputationError where half a turn does not bring them back."""
    vectors, even = basis
    pitch = sparse.kron(sparse.eye(vectors.shape[0] // 3), rotation(2.0 * np.pi / teeth, 3), format="csr")
    over_cut = pitch @ vectors
    signs = np.where(np.arange(vectors.shape[1]) < even, 1.0, -1.0)
    if abs(sector.lower_of_upper @ over_cut - vectors @ sparse.diags(signs)).max() > ROUND_OFF:
        raise _not_mapped()
    return over_cut


def _joined_through_cuts(
    cuts: list[np.ndarray], to_cuts: list[np.ndarray], even: int, teeth: int, offsets: int, comm=None
) -> np.ndarray:
    """What the ring adds to the compliance (offsets + 1, r, r) between the shapes of the even and of the odd half; on
    rank `offset` of a communicator (modulo its size) that offset alone.

    cuts: (c, c), to_cuts: (r, c), of both halves over the basis of a cut. With many teeth, all shapes in a ring of few
    teeth, which is right but for what goes round it; that takes few shapes, by which the farthest of these teeth move
    each other: with these the ring is joined again.
    """
    reach, first = max(offsets, FEWEST_OFFSETS), len(to_cuts[0])
    few = 2 * reach + 1
    if few > MOST_OF_TEETH * teeth:
        return _by_harmonics(cuts, to_cuts, even, teeth, offsets, comm)
    found = _by_harmonics(cuts, to_cuts, even, few, reach, comm)
    far, owner = None, 0 if comm is None else reach % comm.size
    if comm is None or comm.rank == owner:
        ends, last = (slice(0, first), slice(first, None)), found[reach]
        far = [spanned(np.hstack([last[end], last[:, end].T]), len(last) // 16, AROUND)[0] for end in ends]
    if comm is not None:
        far = comm.bcast(far, root=owner)
    around = _by_harmonics(cuts, [each.T @ to_cut for each, to_cut in zip(far, to_cuts)], even, teeth, offsets, comm)
    columns = block_diag(*far)
    for block, more in zip(found, around):
        block += columns @ (more - columns.T @ block @ columns) @ columns.T
    return found[: offsets + 1]


def _by_harmonics(
    cuts: list[np.ndarray], to_cuts: list[np.ndarray], even: int, teeth: int, offsets: int, comm=None
) -> np.ndarray:
    """The same by all harmonics. By block inversion (`ring.ring_compliance`), with each harmonic's Cholesky factor L:
    ``Y^T Y`` where ``L Y`` are the halves' motions by motions of the cut."""
    same, differing = cuts[0] + cuts[1], cuts[0] - cuts[1]
    differing[even:] *= -1.0
    across_signs = np.ascontiguousarray(differing[:even, even:].T)
    first, stiffness = len(to_cuts[0]), np.empty_like(same)
    motions = np.vstack(to_cuts).T
    # In LAPACK's order, as the products that are added.
    found = np.zeros((offsets + 1, motions.shape[1], motions.shape[1])).transpose(0, 2, 1)
    for harmonic in range(teeth // 2 + 1) if comm is None else range(comm.rank, teeth // 2 + 1, comm.size):
        angle, weight = harmonic_of(harmonic, teeth)
        np.multiply(differing, np.cos(angle), out=stiffness)
        stiffness += same
        np.multiply(across_signs, -np.sin(angle), out=stiffness[even:, :even])
        # Transposed, it is in LAPACK's order, and its lower triangle alone is read.
        factor = definite_factor(stiffness.T, "a harmonic", overwrite=True)
        own, across = np.cos(0.5 * angle), np.sin(0.5 * angle)
        moved = np.array(motions, order="F")
        moved[:even, :first] *= own
        moved[:even, first:] *= across
        moved[even:, :first] *= -across
        moved[even:, first:] *= own
        product = dsyrk(1.0, dtrsm(1.0, factor, moved, trans_a=1, overwrite_b=1), trans=1)
        for offset, block in enumerate(found):
            cosine, sine = weight * np.cos(offset * angle), weight * np.sin(offset * angle)
            block[:first, :first] += cosine * product[:first, :first]
            block[first:, first:] += cosine * product[first:, first:]
            block[:first, first:] += sine * product[:first, first:]
    if comm is not None:
        # Imported here: alone there is no need of it.
        from mpi4py import MPI

        for offset, block in enumerate(found):
            to = offset % comm.size
            comm.Reduce(MPI.IN_PLACE if comm.rank == to else block, block if comm.rank == to else None, root=to)
    for block in found:
        symmetric(block)
        block[first:, :first] *= -1.0
    return found


def _not_mapped() -> ComputationError:
    return ComputationError(
        "ring of sectors: half a turn about the tooth's centreline does not map the sector on itself"
    )
