"""A swept tooth sector condensed onto its flanks and cuts: each of the two halves that it is folded into."""

from dataclasses import dataclass
from time import perf_counter

import numpy as np
from scipy import sparse
from scipy.linalg.blas import dtrsm

from ..condensation import line_of
from ..mesh_data import BodyMesh
from ..ring import check_congruent, definite_factor
from .fold import EVEN, ODD, Fold
from .layers import Sweep
from .swept_stiffness import ELEMENT, SectionForms
from .tooth_and_body import condensed_halves

# Part of the motions of a flank by its cuts that may be missing, by their energy: the compliance then errs by 4e-12 of
# that within a tooth, and by 7e-11 of the largest entry between two teeth (measured).
MISSING = 1e-10
# Random columns that tell what is missing.
TRIED = 8


@dataclass(frozen=True)
class Half:
    """The even or the odd motions of a sector (`fold`): of the drive flank (f) and of the upper cut (c).

    flank: (f, f), compliance with the cuts held; empty on all ranks of a communicator but 0. shapes: (f, r),
    orthonormal, and to_cut: (r, c): (minus) the flank's motion per motion of the cut is shapes @ to_cut. cut: (c, c),
    stiffness with the flank free.
    """

    flank: np.ndarray
    shapes: np.ndarray
    to_cut: np.ndarray
    cut: np.ndarray


@dataclass(frozen=True)
class SweptSector:
    """A sector with its hub held, Young's modulus 1 MPa; dofs by height, radius, then x, y, z.

    lower: (c / 3, 3), X, Y, z of the lower cut's nodes. lower_of_upper: sparse (c, c), from motions of the upper cut to
    those of the lower cut, its image. coast: the same (f, f) from the drive to the coast flank, None where that is not
    loaded.
    """

    even: Half
    odd: Half
    lower: np.ndarray
    lower_of_upper: sparse.csr_matrix
    coast: sparse.csr_matrix | None
    timings: dict

    def held(self) -> np.ndarray:
        """Compliance of the drive flank, or of drive and coast flank, with the cuts held; on rank 0."""
        within = 0.5 * (self.even.flank + self.odd.flank)
        if self.coast is None:
            return within
        across = self.coast @ (0.5 * (self.even.flank - self.odd.flank))
        return np.block([[within, across.T], [across, self.coast @ (self.coast @ within).T]])


def condensed_swept_sector(
    mesh: BodyMesh, sweep: Sweep, poissons_ratio: float, centreline: float, teeth: int, both: bool = False, comm=None
) -> SweptSector:
    """A sector of a gear of `teeth`, its section symmetric about a line at the polar angle `centreline` (rad); `both`:
    with its coast flank.

    comm: communicator whose first two ranks share the work. Every rank calls this and gets the result, rank 0 alone the
    flank's compliances.
    """
    clock = perf_counter()
    section = SectionForms(mesh, poissons_ratio, sweep.web)
    compiled = perf_counter()
    fold = Fold(mesh, section.nodes.points, section.material(sweep), centreline)
    alone = comm is None or comm.size == 1
    signs = (EVEN, ODD) if alone else (EVEN, ODD)[comm.rank % 2 :][:1]
    pair, found = None if alone else comm.Split(min(comm.rank // 2, 1)), [None]
    if alone or comm.rank < 2:
        found = [in_shapes(*each) for each in condensed_halves(mesh, poissons_ratio, sweep, fold, signs, pair)]
    if not alone:
        found = [_of_rank(found[0], comm, rank) for rank in (0, 1)]
    timings = {
        "time_compile": compiled - clock,
        "unknowns": 2 * fold.unknowns,
        "condensed_unknowns": (2 if both else 1) * len(fold.flank) + 2 * len(fold.cut),
    }
    cuts = [line_of(mesh, f"{name} cut", ELEMENT.order) for name in ("lower", "upper")]
    check_congruent(cuts[0], cuts[1], teeth)
    places = np.tile(cuts[0], (fold.heights, 1)), np.repeat(sweep.heights, len(cuts[0]))
    lower = np.column_stack(places)[fold.on_cut]
    even, odd = found
    return SweptSector(even, odd, lower, fold.cut_turned, fold.flank_turned if both else None, timings)


def spanned(
    matrix: np.ndarray, tried_first: int = 0, part: float = MISSING, energy: np.ndarray | None = None
) -> tuple[np.ndarray, np.ndarray]:
    """Orthonormal columns (n, r), and what they are multiplied by (r, k), to give a matrix (n, k) but for a `part`.

    Products of the matrix with random columns span its range (Halko, Martinsson, Tropp 2011); others tell what is
    missing. tried_first: so many columns; a quarter of all when 0. energy: (k, k), upper triangle U; the part is then
    of ``matrix @ U^-1``.
    """
    # The same numbers in every run.
    generator, most = np.random.default_rng(0), min(matrix.shape)

    def random(count: int) -> np.ndarray:
        columns = generator.standard_normal((matrix.shape[1], count))
        return columns if energy is None else dtrsm(1.0, energy, columns)

    tried = random(TRIED)
    images = matrix @ tried
    columns, rows = np.empty((len(matrix), 0)), np.empty((0, matrix.shape[1]))
    size = tried_first or max(most // 4, 1)
    while columns.shape[1] + size < most:
        more = matrix @ random(size)
        for _ in range(2):
            more -= columns @ (columns.T @ more)
        more = np.linalg.qr(more)[0]
        columns, rows = np.hstack([columns, more]), np.vstack([rows, more.T @ matrix])
        missing = np.linalg.norm(images - columns @ (rows @ tried), axis=0)
        if missing.max() <= part * np.linalg.norm(images, axis=0).max():
            return columns, rows
        size = max(most // 40, 1)
    return np.eye(len(matrix)), matrix


def in_shapes(flank: np.ndarray, to_cut: np.ndarray, cut: np.ndarray, to_neck: np.ndarray | None = None) -> Half:
    """A half of the parts of `mirrored_ring.flank_free`; with the flank's motion `to_neck` (f, w), `to_cut` is the
    neck's (w, c).

    The ring adds to a flank's compliance ``response D^-1 response^T`` with D above the cut's own stiffness, so that
    motions of the cut count by the strain energy that they take: with ``cut = U^T U`` the shapes are those of
    ``response U^-1``, a quarter fewer than of the response itself.
    """
    energy = definite_factor(cut, "a cut")
    if to_neck is None:
        return Half(flank, *spanned(to_cut, energy=energy), cut)
    # As long as the flank's motions are, in fewer rows.
    columns, rows = np.linalg.qr(to_neck)
    shapes, to_cut = spanned(rows @ to_cut, 3 * len(rows) // 5, energy=energy)
    return Half(flank, columns @ shapes, to_cut, cut)


def _of_rank(half: Half | None, comm, rank: int) -> Half:
    """The half that a rank has, on all ranks; its flank's compliance on rank 0 alone."""
    own = comm.rank == rank
    sizes = comm.bcast({name: each.shape for name, each in vars(half).items()} if own else None, root=rank)
    found = {"flank": np.empty((0, 0))}
    for name, size in sizes.items():
        everywhere = name != "flank"
        if not (everywhere or own or comm.rank == 0):
            continue
        each = np.empty(size)
        if own:
            # mpi4py does not know the type of an array made from C's memory.
            each[:] = getattr(half, name)
        if everywhere:
            comm.Bcast(each, root=rank)
        elif rank > 0 and own:
            comm.Send(each, 0)
        elif rank > 0:
            comm.Recv(each, rank)
        if everywhere or comm.rank == 0:
            found[name] = each
    return Half(**found)
