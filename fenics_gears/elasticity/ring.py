"""A gear as a ring of equal tooth sectors, joined exactly.

Sector s + 1 is one pitch counter-clockwise of sector s; in the sectors' own frames its lower cut moves as ``u_upper[s]
= R u_lower[s + 1]`` with ``R`` the rotation by one pitch. A discrete Fourier transform over the sectors, ``u[s] = U_k
exp(i k s pitch)``, decouples the ring into one small system for each k = 0 ... teeth - 1.
"""

from collections.abc import Callable

import numpy as np
from scipy.linalg import block_diag, cho_solve, get_lapack_funcs
from scipy.linalg.blas import dsyrk, dtrsm, ztrsm

from fenics_gears.errors import ComputationError
from fenics_gears.geometry.outline import rotation

from .condensation import CondensedBody, by_radius, condense, held_nodes, line_of
from .elements import Element
from .mesh_data import BodyMesh
from .mumps import symmetric

# Response (c, c) of the cut m pitches ahead to forces on a cut, as a function of m.
CutResponse = Callable[[int], np.ndarray]
# Of a sector, what `between_cuts` gives.
Parts = tuple[np.ndarray, np.ndarray, np.ndarray]


def condensed_sector(
    mesh: BodyMesh, element: Element, poissons_ratio: float, flank: np.ndarray | None = None
) -> CondensedBody:
    """A sector condensed onto "flank", "lower", "upper" (the cuts without their hub nodes) and "hub".

    flank: (k, 2), mm, nodes to keep of the flank or flanks; all of the drive flank's, by radius, unless given.
    """
    points = {
        "flank": by_radius(mesh.edge_nodes("flank", element.order)) if flank is None else flank,
        "lower": line_of(mesh, "lower cut", element.order),
        "upper": line_of(mesh, "upper cut", element.order),
        **held_nodes(mesh, element.order),
    }
    return condense(mesh, element, poissons_ratio, points)


def check_congruent(lower: np.ndarray, upper: np.ndarray, teeth: int) -> None:
    """Raise ComputationError unless the upper cut's nodes (k, 2) or (k, 3) are the lower cut's turned by one pitch."""
    turn = rotation(2.0 * np.pi / teeth, lower.shape[1])
    slack = 1e-9 * np.abs(lower).max()
    if lower.shape != upper.shape or np.abs(lower @ turn.T - upper).max() > slack:
        raise ComputationError("ring of sectors: the two radial cuts of the sector do not match node for node")


def ring_compliance(sector: CondensedBody, teeth: int, offsets: int) -> np.ndarray:
    """Flank compliance blocks (offsets + 1, 2n, 2n) of the ring, hub held, Young's modulus 1 MPa; see FlankCompliance.

    With ``F`` the flank's and ``L`` the lower cut's dofs, harmonic k has the stiffness ``[[S_FF, B_k], [B_k^H, D_k]]``
    with ``B_k = S_FL + S_FU R e^{ik}`` and ``D_k = S_LL + R^T S_UU R + S_LU R e^{ik} + R^T S_UL e^{-ik}``. Its
    inverse's flank block is ``S_FF^-1 + X_k (D_k - B_k^H S_FF^-1 B_k)^-1 X_k^H`` with ``X_k = S_FF^-1 B_k``: one dense
    inverse of the flank, and for each harmonic one of the size of a cut. Back from harmonics to teeth, each power of
    e^{ik} is a shift by one tooth.
    """
    return joined_blocks(*between_cuts(sector, teeth), teeth, offsets)


def joined_blocks(held: np.ndarray, to_cuts: np.ndarray, link: np.ndarray, teeth: int, offsets: int) -> np.ndarray:
    """The same, of what `between_cuts` gives."""
    joint = cut_response(link, teeth, offsets + 1)
    blocks = np.stack([to_cuts @ sector_response(joint, offset) @ to_cuts.T for offset in range(offsets + 1)])
    blocks[0] += held
    blocks[0] = 0.5 * (blocks[0] + blocks[0].T)
    return blocks


def between_cuts(sector: CondensedBody, teeth: int) -> Parts:
    """Of a sector the flank's compliance with the cuts held, (minus) its motion per motion of the cuts, and the
    stiffness between these, the flank free; frames as in `sector_cuts`."""
    check_congruent(sector.points["lower"], sector.points["upper"], teeth)
    flank = len(sector.dofs("flank"))
    dofs = np.concatenate([sector.dofs(name) for name in ("flank", "lower", "upper")])
    stiffness = sector.stiffness[np.ix_(dofs, dofs)]
    turn_last(stiffness, len(sector.dofs("upper")), rotation(2.0 * np.pi / teeth))
    return flank_free(stiffness, flank)


def turn_last(stiffness: np.ndarray, last: int, turn: np.ndarray) -> None:
    """In place, the `last` dofs of a stiffness into a frame that is turned (c, c) from theirs."""
    size = len(turn)
    rows = stiffness[-last:].reshape(last // size, size, -1)
    rows[:] = turn.T @ rows
    columns = stiffness[:, -last:].reshape(len(stiffness), last // size, size)
    stiffness[:, -last:] = (columns @ turn).reshape(len(stiffness), last)


def flank_free(stiffness: np.ndarray, flank: int) -> Parts:
    """The same of a stiffness whose `flank` dofs come first and those of the cuts behind them."""
    factor, onto_cut, cut = _eliminated(stiffness, flank, "a flank")
    response = dtrsm(1.0, factor, onto_cut, overwrite_b=1)
    return inverse_of_factor(factor, "a flank"), response, cut


def without_first(stiffness: np.ndarray, count: int, what: str) -> np.ndarray:
    """A stiffness with its first dofs free. Raises ComputationError where that of `what` is not definite."""
    return _eliminated(stiffness, count, what)[2]


def _eliminated(stiffness: np.ndarray, first: int, what: str) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Of the first dofs the factor U^T U, U^-T times their stiffness onto the others, and what is left to these."""
    # Transposed, they are in LAPACK's order.
    factor = definite_factor(stiffness[:first, :first].T, what)
    onto_others = dtrsm(1.0, factor, stiffness[first:, :first].T, trans_a=1)
    return factor, onto_others, stiffness[first:, first:] - symmetric(dsyrk(1.0, onto_others, trans=1))


def sector_cuts(sector: CondensedBody, teeth: int) -> tuple[np.ndarray, np.ndarray]:
    """Dofs (2 c,) of a sector's lower and upper cut, and what turns them (2 c, 2 c): the upper cut's are in the
    frame of the next sector. Raises ComputationError for cuts that are not congruent."""
    check_congruent(sector.points["lower"], sector.points["upper"], teeth)
    lower = sector.dofs("lower")
    upper = sector.dofs("upper")
    turn = block_diag(np.eye(len(lower)), turned_nodes(teeth, len(sector.points["upper"])))
    return np.concatenate([lower, upper]), turn


def sector_response(joint: CutResponse, offset: int) -> np.ndarray:
    """Response (2 c, 2 c) of the cuts of the sector `offset` pitches ahead to forces on a sector's cuts; frames as in
    `sector_cuts`."""
    return np.block([[joint(offset), joint(offset - 1)], [joint(offset + 1), joint(offset)]])


def cyclic(link: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Of a ring of sectors between their cuts (2 c, 2 c): stiffness (c, c) of a cut, and force on it per motion of the
    cut ahead."""
    cut = len(link) // 2
    return link[:cut, :cut] + link[cut:, cut:], link[:cut, cut:]


def cyclic_motion(same: np.ndarray, ahead: np.ndarray, loads: np.ndarray) -> np.ndarray:
    """Displacement (teeth, c, k) of the cuts of a ring under loads (teeth, c, k) on them: of the cyclic system
    ``ahead^T u[s-1] + same u[s] + ahead u[s+1] = loads[s]``, by harmonics."""
    harmonics = np.fft.rfft(loads, axis=0)
    phase = np.exp(2j * np.pi * np.arange(len(harmonics)) / len(loads))
    for k, turn in enumerate(phase):
        # Transposed, the conjugate is in LAPACK's order.
        factor = definite_factor((same + ahead * np.conj(turn) + ahead.T * turn).T, "a harmonic")
        harmonics[k] = cho_solve((factor, False), harmonics[k], check_finite=False)
    return np.fft.irfft(harmonics, n=len(loads), axis=0)


def cut_response(link: np.ndarray, teeth: int, reach: int) -> CutResponse:
    """Response (c, c) of the cut m pitches ahead to forces on a cut, abs(m) <= reach; `link`: one sector between its
    cuts; `teeth`: negative of an internal gear, whose sectors go clockwise.

    The harmonics' stiffness is ``same + ahead e^{ik} + ahead^T e^{-ik}``, Hermitian; k and teeth - k are complex
    conjugates.
    """
    # D_k - B_k^H S_FF^-1 B_k of `ring_compliance`, by the powers 0 and 1 of e^{ik}; power -1 is the transpose of power
    # 1.
    count = abs(teeth)
    same, ahead = cyclic(link)
    responses = np.zeros((reach + 1, *same.shape))
    for harmonic in range(count // 2 + 1):
        angle, weight = harmonic_of(harmonic, count)
        phase = np.exp(1j * angle)
        inverse = definite_inverse(same + ahead * phase + ahead.T * np.conj(phase), "a harmonic")
        for offset in range(reach + 1):
            turned = weight * phase**offset
            responses[offset] += turned.real * inverse.real - turned.imag * inverse.imag
    return lambda offset: responses[offset] if offset >= 0 else responses[-offset].T


def harmonic_of(number: int, teeth: int) -> tuple[float, float]:
    """The angle (rad) by which a harmonic turns from tooth to tooth, and its share in a sum over all of them."""
    return 2.0 * np.pi * number / teeth, (1.0 if number == 0 or 2 * number == teeth else 2.0) / teeth


def ring_work(link: np.ndarray, teeth: int, reach: int, responding: np.ndarray, loaded: np.ndarray) -> np.ndarray:
    """Reciprocal work (2 reach + 1, k, j) in a ring of forces (2 c, k) on the cuts of the sector m pitches ahead, m
    from -reach to reach, and of forces (2 c, j) on a sector's cuts. `link`: a sector between its cuts. By harmonics,
    whose inverses need not be made: with ``U^H U`` the stiffness of one, its forces f enter by ``U^-H f``."""
    same, ahead = cyclic(link)
    offsets = np.arange(-reach, reach + 1)
    lower, upper = np.vsplit(np.hstack([responding, loaded]), 2)
    works = np.zeros((len(offsets), responding.shape[1], loaded.shape[1]))
    for harmonic in range(teeth // 2 + 1):
        angle, weight = harmonic_of(harmonic, teeth)
        back = np.exp(-1j * angle)
        # Transposed, the conjugate is in LAPACK's order.
        factor = definite_factor((same + ahead * back + ahead.T * np.conj(back)).T, "a harmonic")
        whitened = ztrsm(1.0, factor, lower + upper * back, trans_a=2)
        one, other = np.split(whitened, [responding.shape[1]], axis=1)
        product = one.conj().T @ other
        for offset, work in zip(offsets, works):
            work += weight * (np.cos(offset * angle) * product.real - np.sin(offset * angle) * product.imag)
    return works


def definite_inverse(matrix: np.ndarray, what: str) -> np.ndarray:
    """Inverse of a symmetric or Hermitian positive definite matrix, by Cholesky. Raises ComputationError as
    `definite_factor`."""
    return inverse_of_factor(definite_factor(matrix, what), what)


def inverse_of_factor(factor: np.ndarray, what: str) -> np.ndarray:
    """Inverse of the matrix that has this factor, which is overwritten. Raises as `definite_factor`."""
    upper, failed = get_lapack_funcs(("potri",), (factor,))[0](factor, overwrite_c=True)
    if failed:
        raise _not_definite(what)
    return symmetric(upper)


def definite_factor(matrix: np.ndarray, what: str, overwrite: bool = False) -> np.ndarray:
    """Cholesky factor, upper triangle (the lower one is not zero), of a symmetric or Hermitian positive definite
    matrix; with `overwrite` in its place, if it is in Fortran's order. Raises ComputationError where the stiffness of
    `what` is not definite."""
    upper, failed = get_lapack_funcs(("potrf",), (matrix,))[0](matrix, clean=False, overwrite_a=overwrite)
    if failed:
        raise _not_definite(what)
    return upper


def _not_definite(what: str) -> ComputationError:
    words = f"ring of sectors: the stiffness of {what} is not positive definite"
    return ComputationError(f"{words}; is the hub held, or is a web thinner than a thousandth of the face?")


def centre_motion(points: np.ndarray) -> np.ndarray:
    """Displacement (2n, 3) of points (n, 2) per unit rigid motion (dx, dy, phi) of the gear."""
    motion = np.empty((len(points), 2, 3))
    motion[:, :, :2] = np.eye(2)
    motion[:, 0, 2] = -points[:, 1]
    motion[:, 1, 2] = points[:, 0]
    return motion.reshape(-1, 3)


def turned_nodes(teeth: int, nodes: int) -> np.ndarray:
    """Rotation (2n, 2n) of the displacements of n nodes by one pitch."""
    return np.kron(np.eye(nodes), rotation(2.0 * np.pi / teeth))
