"""Half a swept sector by conjugate gradients with algebraic multigrid (PETSc): for bodies whose Cholesky factor memory
does not hold.

Every force on the flank and every motion of the cut takes a solution of its own. A neighbour's solution as a first
guess saves nothing (measured).
"""

from __future__ import annotations

import numpy as np
from mpi4py import MPI
from scipy import sparse

from fenics_gears.elasticity.face.fold import Fold
from fenics_gears.elasticity.mumps import distributed
from fenics_gears.elasticity.petsc import PETSc
from fenics_gears.errors import ComputationError

# Of the error's energy norm, as the preconditioner sees it; compliances then agree with those of a factorisation to
# some 1e-10 (measured).
TOLERANCE, MOST_ITERATIONS = 1e-11, 400
PREFIX = "gears_body_"
# Incomplete Cholesky factors smooth within the part of a rank: half the time of Jacobi's smoothing, and of hypre's
# BoomerAMG.
OPTIONS = {
    "ksp_type": "cg",
    "ksp_norm_type": "natural",
    "pc_type": "gamg",
    "mg_levels_ksp_type": "chebyshev",
    "mg_levels_ksp_max_it": "1",
    "mg_levels_pc_type": "bjacobi",
    "mg_levels_sub_pc_type": "icc",
    "mg_levels_sub_pc_factor_shift_type": "positive_definite",
}


def flank_free_by_gradients(
    rows: sparse.csr_matrix, fold: Fold, own: range, motions: np.ndarray, group=None
) -> tuple[np.ndarray, np.ndarray, np.ndarray] | None:
    """As `mirrored_ring.flank_free` of half a sector's Schur complement; on the group's rank 0.

    rows: this rank's rows, of `own` heights. motions: (3 m, 6), rigid ones of all kept nodes, which multigrid must
    know.
    Raises ComputationError where the iteration does not converge.
    """
    inner = np.ones(fold.unknowns, dtype=bool)
    inner[fold.cut] = False
    places = fold.places(own)
    here = slice(3 * places.start, 3 * places.stop)
    free = np.flatnonzero(inner[here])
    coupling = rows[free][:, fold.cut].tocsc()
    # This rank's rows of flank and cut.
    flank, cut = ((dofs >= here.start) & (dofs < here.stop) for dofs in (fold.flank, fold.cut))
    on_flank = np.searchsorted(free, fold.flank[flank] - here.start)
    forces = sparse.csc_matrix(
        (np.ones(len(on_flank)), (on_flank, np.flatnonzero(flank))), shape=(len(free), len(fold.flank))
    )
    held, to_cut = (np.zeros((len(fold.flank), count)) for count in (len(fold.flank), len(fold.cut)))
    stiffness = np.zeros((len(fold.cut), len(fold.cut)))
    stiffness[cut] = rows[fold.cut[cut] - here.start][:, fold.cut].toarray()
    solver = _Solver(rows[free][:, inner], motions[here][free], group)
    try:
        for column in range(len(fold.flank)):
            held[flank, column] = solver.solved(forces[:, column])[on_flank]
        for column in range(len(fold.cut)):
            moved = solver.solved(coupling[:, column])
            to_cut[flank, column] = moved[on_flank]
            stiffness[:, column] -= coupling.T @ moved
    finally:
        solver.close()
    if group is not None:
        for each in (held, to_cut, stiffness):
            group.Allreduce(MPI.IN_PLACE, each)
    return 0.5 * (held + held.T), to_cut, 0.5 * (stiffness + stiffness.T)


def rigid_motions(points: np.ndarray, twist: float) -> np.ndarray:
    """The six rigid motions (3 k, 6) of points (k, 3), X, Y, z, as dofs in the section's frame turned with it."""
    angle = twist * points[:, 2]
    axes = np.zeros((len(points), 3, 3))
    axes[:, 0, 0] = axes[:, 1, 1] = np.cos(angle)
    axes[:, 0, 1], axes[:, 1, 0], axes[:, 2, 2] = np.sin(angle), -np.sin(angle), 1.0
    return np.concatenate([axes, np.cross(axes, points[:, :, None], axis=1)], axis=2).reshape(-1, 6)


class _Solver:
    """Solves a symmetric positive definite system of which every rank has rows (k, n), three for each node; `motions`
    (k, 6) are those rows'."""

    def __init__(self, rows: sparse.csr_matrix, motions: np.ndarray, group):
        comm = PETSc.COMM_SELF if group is None else group
        self._matrix = distributed(rows, comm)
        self._matrix.setBlockSize(3)
        self._matrix.setOption(PETSc.Mat.Option.SPD, True)
        near = [PETSc.Vec().createWithArray(motion.copy(), bsize=3, comm=comm) for motion in np.linalg.qr(motions)[0].T]
        self._matrix.setNearNullSpace(PETSc.NullSpace().create(vectors=near, comm=comm))
        options = PETSc.Options(PREFIX)
        for name, value in OPTIONS.items():
            options[name] = value
        self._solver = PETSc.KSP().create(comm)
        self._solver.setOptionsPrefix(PREFIX)
        self._solver.setTolerances(rtol=TOLERANCE, max_it=MOST_ITERATIONS)
        self._solver.setOperators(self._matrix)
        self._solver.setFromOptions()
        self._found, self._load = self._matrix.createVecs()

    def solved(self, load: sparse.csc_matrix) -> np.ndarray:
        """This rank's rows (k,) of the solution for a load of which it has a column (k, 1)."""
        self._load.setArray(load.toarray().ravel())
        self._solver.solve(self._load, self._found)
        if self._solver.getConvergedReason() < 0:
            raise ComputationError(
                f"conjugate gradients: a gear's body did not converge to {TOLERANCE:g} in"
                f" {self._solver.getIterationNumber()} iterations (PETSc's reason {self._solver.getConvergedReason()});"
                " take elements less slender (accuracy.layers, accuracy.body_element_size), or allow the memory for a"
                " factorisation by FENICS_GEARS_MEMORY"
            )
        return self._found.getArray()

    def close(self) -> None:
        """Give the memory back."""
        for each in (self._solver, self._matrix, self._found, self._load):
            each.destroy()
