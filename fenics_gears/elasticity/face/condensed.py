"""A swept tooth sector condensed onto its flanks and cuts: each of the two halves that it is folded into."""

from __future__ import annotations

from dataclasses import dataclass
from time import perf_counter
from typing import Any

import numpy as np
from scipy import sparse

from fenics_gears.elasticity.condensation import by_radius, without
from fenics_gears.elasticity.face.fold import EVEN, ODD, Fold
from fenics_gears.elasticity.face.layers import Sweep
from fenics_gears.elasticity.face.swept_stiffness import ELEMENT, SectionForms, swept_stiffness
from fenics_gears.elasticity.mesh_data import BodyMesh
from fenics_gears.elasticity.mirrored_ring import Parts, flank_free
from fenics_gears.elasticity.mumps import Factor, distributed
from fenics_gears.elasticity.ring import check_congruent

# Part of a flank's motions that may be missing: between teeth the compliance then has an error of 1e-12 (measured),
# within a tooth of 1e-14.
MISSING = 1e-12
# Random columns that tell what is missing.
TRIED = 8


@dataclass(frozen=True)
class Half:
    """The even or the odd motions of a sector (`fold`): of the drive flank (f) and of the upper cut (c), in the
    section's frame turned with it.

    flank: (f, f), compliance with the cuts held. shapes: (f, r), orthonormal, and to_cut: (r, c): (minus) the flank's
    motion per motion of the cut is shapes @ to_cut; a cut moves the flank in fewer ways than either has dofs. cut: (c,
    c), stiffness with the flank free.
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
    heights: int
    timings: dict

    def held(self) -> np.ndarray:
        """Compliance of the drive flank, or of drive and coast flank, with the cuts held."""
        within = 0.5 * (self.even.flank + self.odd.flank)
        if self.coast is None:
            return within
        across = self.coast @ (0.5 * (self.even.flank - self.odd.flank))
        return np.block([[within, across.T], [across, self.coast @ (self.coast @ within).T]])


def condensed_swept_sector(
    mesh: BodyMesh,
    sweep: Sweep,
    poissons_ratio: float,
    centreline: float,
    teeth: int,
    both: bool = False,
    comm=None,
    iterative: bool = False,
) -> SweptSector:
    """A sector of a gear of `teeth`, its section symmetric about a line at the polar angle `centreline` (rad); `both`:
    with its coast flank.

    iterative: by conjugate gradients instead of MUMPS. comm: communicator whose ranks share the work: one half of them
    has the even motions, the other the odd ones, and each half shares out the heights. Every rank calls this and gets
    the result.
    """
    clock = perf_counter()
    section = SectionForms(mesh, poissons_ratio)
    compiled = perf_counter()
    heights = len(sweep.heights)
    fold = Fold(mesh, section.nodes.points, heights, centreline)
    group, signs = (
        (comm, (EVEN, ODD))
        if comm is None or comm.size == 1
        else (comm.Split(comm.rank % 2), (EVEN, ODD)[comm.rank % 2 :][:1])
    )
    own = (
        range(heights)
        if group is None
        else range(*np.linspace(0, heights, group.size + 1).astype(int)[[group.rank, group.rank + 1]])
    )
    rows = swept_stiffness(section, sweep, own, fold.standing)
    halves = [fold.folded(rows, own, sign) for sign in signs]
    del rows
    assembled = perf_counter()
    found: list[Any] = []
    while halves:
        parts = (
            _by_gradients(halves.pop(0), fold, own, sweep, group)
            if iterative
            else _condensed(halves.pop(0), fold, group)
        )
        found.append(None if parts is None else Half(parts[0], *spanned(parts[1]), parts[2]))
        del parts
    if len(signs) == 1:
        found = [_of_rank(found[0], comm, rank) for rank in (0, 1)]
    timings = {
        "time_compile": compiled - clock,
        "time_assemble": assembled - compiled,
        "time_schur": perf_counter() - assembled,
        "unknowns": 2 * fold.unknowns,
        "condensed_unknowns": (2 if both else 1) * len(fold.flank) + 2 * len(fold.cut),
    }
    cuts = [
        by_radius(without(mesh.edge_nodes(f"{name} cut", ELEMENT.order), mesh.edge_nodes("hub", ELEMENT.order)))
        for name in ("lower", "upper")
    ]
    check_congruent(cuts[0], cuts[1], teeth)
    lower = np.column_stack([np.tile(cuts[0], (heights, 1)), np.repeat(sweep.heights, len(cuts[0]))])
    even, odd = found
    return SweptSector(even, odd, lower, fold.cut_turned, fold.flank_turned if both else None, heights, timings)


def spanned(matrix: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Orthonormal columns (n, r), and what they are multiplied by (r, k), to give a matrix (n, k) but for `MISSING`.

    Products of the matrix with random columns span its range (Halko, Martinsson, Tropp 2011); others tell what is
    missing.
    """
    # The same numbers in every run.
    numbers, most = np.random.default_rng(0), min(matrix.shape)
    tried = numbers.standard_normal((matrix.shape[1], TRIED))
    images = matrix @ tried
    columns, rows = np.empty((len(matrix), 0)), np.empty((0, matrix.shape[1]))
    size = max(most // 3, 1)
    while columns.shape[1] + size < most:
        more = matrix @ numbers.standard_normal((matrix.shape[1], size))
        for _ in range(2):
            more -= columns @ (columns.T @ more)
        more = np.linalg.qr(more)[0]
        columns, rows = np.hstack([columns, more]), np.vstack([rows, more.T @ matrix])
        missing = np.linalg.norm(images - columns @ (rows @ tried), axis=0)
        if missing.max() <= MISSING * np.linalg.norm(images, axis=0).max():
            return columns, rows
        size = max(most // 40, 1)
    return np.eye(len(matrix)), matrix


def _condensed(rows: sparse.csr_matrix, fold: Fold, group) -> Parts | None:
    """One half; on the group's rank 0."""
    alone = group is None or group.size == 1
    factor = Factor(
        rows if alone else distributed(rows, group), "the body's stiffness", np.concatenate([fold.flank, fold.cut])
    )
    del rows
    try:
        condensed = factor.schur()
    finally:
        factor.close()
    return None if condensed is None else flank_free(condensed, len(fold.flank))


def _by_gradients(rows: sparse.csr_matrix, fold: Fold, own: range, sweep: Sweep, group) -> Parts:
    # Imported here: few bodies need it.
    from fenics_gears.elasticity.face.conjugate_gradients import flank_free_by_gradients, rigid_motions

    height, place = np.divmod(fold.kept, len(fold.nodes))
    return flank_free_by_gradients(
        rows, fold, own, rigid_motions(np.column_stack([fold.nodes[place], sweep.heights[height]]), sweep.twist), group
    )


def _of_rank(half: Half | None, comm, rank: int) -> Half:
    """The half that a rank has, on all ranks."""
    arrays = None if half is None else [np.ascontiguousarray(each) for each in vars(half).values()]
    shapes = comm.bcast(None if comm.rank != rank else [each.shape for each in arrays], root=rank)
    found = [np.empty(shape) for shape in shapes]
    for number, each in enumerate(found):
        # mpi4py does not know the type of an array made from C's memory.
        each[:] = arrays[number] if comm.rank == rank else 0.0
        comm.Bcast(each, root=rank)
    return Half(*found)
