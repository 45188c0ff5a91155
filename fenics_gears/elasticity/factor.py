"""A sparse symmetric positive definite system factored once by PETSc, solved for any load."""

from __future__ import annotations

import numpy as np
from petsc4py import PETSc
from scipy import sparse

from fenics_gears.errors import ComputationError

# Right-hand sides solved at once; more take memory and save no time.
COLUMNS_AT_ONCE = 64


class Factor:
    """Cholesky factor of a sparse symmetric positive definite matrix by MUMPS; `what`: its name in messages."""

    def __init__(self, matrix: sparse.csr_matrix, what: str):
        matrix = matrix.tocsr()
        matrix.sort_indices()
        index = PETSc.IntType
        csr = (matrix.indptr.astype(index), matrix.indices.astype(index), matrix.data)
        self._matrix = PETSc.Mat().createAIJ(matrix.shape, csr=csr, comm=PETSc.COMM_SELF)
        self._matrix.setOption(PETSc.Mat.Option.SPD, True)
        self._preconditioner = PETSc.PC().create(PETSc.COMM_SELF)
        self._preconditioner.setOperators(self._matrix)
        self._preconditioner.setType("cholesky")
        self._preconditioner.setFactorSolverType("mumps")
        self._preconditioner.setFactorSetUpSolverType()
        self._factor = self._preconditioner.getFactorMatrix()
        try:
            self._preconditioner.setUp()
            status = self._factor.getMumpsInfog(1)
        except PETSc.Error as error:
            self.close()
            raise ComputationError(f"PETSc could not factorise {what}: {error}") from error
        if status < 0:
            self.close()
            raise ComputationError(f"MUMPS could not factorise {what} (INFOG(1) = {status}); memory may be short")

    def solve(self, loads: np.ndarray) -> np.ndarray:
        """Solution (n, k) for loads (n, k)."""
        result = np.empty_like(loads)
        for first in range(0, loads.shape[1], COLUMNS_AT_ONCE):
            part = slice(first, first + COLUMNS_AT_ONCE)
            result[:, part] = self._solved(np.asfortranarray(loads[:, part]))
        return result

    def _solved(self, loads: np.ndarray) -> np.ndarray:
        right = PETSc.Mat().createDense(loads.shape, array=loads, comm=PETSc.COMM_SELF)
        solution = np.zeros_like(loads, order="F")
        left = PETSc.Mat().createDense(loads.shape, array=solution, comm=PETSc.COMM_SELF)
        right.assemble()
        left.assemble()
        self._factor.matSolve(right, left)
        result = left.getDenseArray().copy()
        right.destroy()
        left.destroy()
        return result

    def close(self) -> None:
        """Give the factor's memory back."""
        # PETSc 3.18 leaks the factor unless both are destroyed, in this order.
        self._preconditioner.destroy()
        self._factor.destroy()
        self._matrix.destroy()
