"""MUMPS through PETSc: the Cholesky factor of a sparse matrix, solved for any load, and MUMPS's own Schur complement.

petsc4py (3.18 to 3.25) does not bind ``MatFactorSetSchurIS``; ctypes reaches it in the library that petsc4py has
loaded.
"""

import ctypes
from contextlib import closing

import numpy as np
from scipy import sparse

from fenics_gears.errors import ComputationError

from .petsc import PETSc

LIBRARY = ctypes.CDLL(PETSc.__file__)
# Right-hand sides solved at once; more take memory and save no time.
COLUMNS_AT_ONCE = 64
# Rows that are transposed at once.
ROWS_TRANSPOSED = 128


class Factor:
    """Cholesky factor of a symmetric matrix (scipy's, or PETSc's), positive definite on all dofs but `schur_dofs` (k,).

    `what`: the matrix's name in messages. Raises ComputationError where the factorisation fails. Release it by `close`.
    """

    def __init__(self, matrix: sparse.csr_matrix | PETSc.Mat, what: str, schur_dofs: np.ndarray | None = None):
        self._schur_size = 0 if schur_dofs is None else len(schur_dofs)
        self._what = what
        if sparse.issparse(matrix):
            matrix = _petsc_matrix(matrix)
        matrix.setOption(PETSc.Mat.Option.SPD, True)
        self._preconditioner = PETSc.PC().create(matrix.comm)
        self._preconditioner.setOperators(matrix)
        self._preconditioner.setType("cholesky")
        self._preconditioner.setFactorSolverType("mumps")
        self._preconditioner.setFactorSetUpSolverType()
        self._factor = self._preconditioner.getFactorMatrix()
        try:
            if schur_dofs is not None:
                indices = PETSc.IS().createGeneral(np.asarray(schur_dofs, dtype=PETSc.IntType), PETSc.COMM_SELF)
                _call("MatFactorSetSchurIS", _handle(self._factor), _handle(indices))
                indices.destroy()
            self._preconditioner.setUp()
            status = self._factor.getMumpsInfog(1)
            if status < 0:
                raise ComputationError(
                    f"MUMPS could not factorise {what} (INFOG(1) = {status}, INFOG(2) ="
                    f" {self._factor.getMumpsInfog(2)}); memory may be short, or the mesh has a part that nothing holds"
                )
        except PETSc.Error as error:
            self.close()
            raise ComputationError(f"PETSc could not factorise {what}: {error}") from error
        except ComputationError:
            self.close()
            raise

    def solve(self, loads: np.ndarray) -> np.ndarray:
        """Solution (n, k) for loads (n, k). Raises ComputationError where the Schur complement cannot be factorised."""
        result = np.empty_like(loads)
        for first in range(0, loads.shape[1], COLUMNS_AT_ONCE):
            part = slice(first, first + COLUMNS_AT_ONCE)
            solution = np.zeros_like(loads[:, part], order="F")
            right = np.asfortranarray(loads[:, part])
            left, dense = (
                PETSc.Mat().createDense(each.shape, array=each, comm=PETSc.COMM_SELF) for each in (solution, right)
            )
            left.assemble()
            dense.assemble()
            try:
                self._factor.matSolve(dense, left)
                result[:, part] = left.getDenseArray()
            except PETSc.Error as error:
                raise ComputationError(
                    f"PETSc could not solve with the factor of {self._what}: the stiffness of its outer dofs is not"
                    " positive definite, as where nothing holds a body or where it cannot change its volume (Poisson's"
                    f" ratio near 0.5): {error}"
                ) from error
            finally:
                left.destroy()
                dense.destroy()
        return result

    def schur(self) -> np.ndarray:
        """Dense stiffness (k, k) on the Schur dofs, all others in equilibrium without load."""
        schur = ctypes.c_void_p()
        entries = ctypes.c_void_p()
        status = ctypes.c_int()
        _call("MatFactorGetSchurComplement", _handle(self._factor), ctypes.byref(schur), ctypes.byref(status))
        _call("MatDenseGetArrayRead", schur, ctypes.byref(entries))
        size = self._schur_size
        values = np.ctypeslib.as_array((ctypes.c_double * size**2).from_address(entries.value)).reshape(size, size)
        # MUMPS gives the lower triangle by columns. A copy by PETSc would mirror it entry by entry, which takes longer.
        stiffness = symmetric(values.copy())
        _call("MatDenseRestoreArrayRead", schur, ctypes.byref(entries))
        _call("MatFactorRestoreSchurComplement", _handle(self._factor), ctypes.byref(schur), status)
        return stiffness

    def close(self) -> None:
        """Give the factor's memory back."""
        # PETSc 3.18 leaks the factor unless both are destroyed, in this order.
        self._preconditioner.destroy()
        self._factor.destroy()


def _petsc_matrix(matrix: sparse.csr_matrix) -> PETSc.Mat:
    matrix.sort_indices()
    csr = (matrix.indptr.astype(PETSc.IntType), matrix.indices.astype(PETSc.IntType), matrix.data)
    return PETSc.Mat().createAIJ(matrix.shape, csr=csr, comm=PETSc.COMM_SELF)


def schur_complement(matrix: sparse.csr_matrix | PETSc.Mat, dofs: np.ndarray) -> np.ndarray:
    """`Factor.schur` of a matrix on dofs (k,)."""
    with closing(Factor(matrix, "the body's stiffness", dofs)) as factor:
        return factor.schur()


def _handle(petsc_object):
    return ctypes.c_void_p(petsc_object.handle)


def _call(name: str, *arguments) -> None:
    error = getattr(LIBRARY, name)(*arguments)
    if error:
        raise ComputationError(f"{name} failed with PETSc error {error}")


def symmetric(upper: np.ndarray) -> np.ndarray:
    """The symmetric or Hermitian matrix whose upper triangle is given, in its place."""
    # Block by block: a transposed copy of a large matrix takes as long as a product of smaller ones.
    for first in range(0, len(upper), ROWS_TRANSPOSED):
        last = first + ROWS_TRANSPOSED
        upper[last:, first:last] = upper[first:last, last:].conj().T
        own = upper[first:last, first:last]
        own[:] = np.triu(own) + np.triu(own, 1).conj().T
    return upper
