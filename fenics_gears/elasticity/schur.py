"""MUMPS's own Schur complement of a PETSc matrix.

petsc4py (3.18 to 3.25) does not bind ``MatFactorSetSchurIS``; ctypes reaches it in the library that petsc4py has loaded.
"""

from __future__ import annotations

import ctypes

import numpy as np
from petsc4py import PETSc

from fenics_gears.errors import ComputationError


def schur_complement(matrix, dofs) -> np.ndarray:
    """Dense stiffness (k, k) on dofs (k,) with all other dofs in equilibrium without load; symmetrised.

    matrix: symmetric PETSc matrix of one process, positive definite on the other dofs.
    Raises ComputationError when the factorisation fails.
    """
    matrix.setOption(PETSc.Mat.Option.SPD, True)
    indices = PETSc.IS().createGeneral(np.asarray(dofs, dtype=PETSc.IntType), matrix.comm)
    preconditioner = PETSc.PC().create(matrix.comm)
    preconditioner.setOperators(matrix)
    preconditioner.setType("cholesky")
    preconditioner.setFactorSolverType("mumps")
    preconditioner.setFactorSetUpSolverType()
    factor = preconditioner.getFactorMatrix()
    try:
        _call("MatFactorSetSchurIS", _handle(factor), _handle(indices))
        preconditioner.setUp()
        status = factor.getMumpsInfog(1)
        if status < 0:
            raise ComputationError(
                f"MUMPS could not factorise the body's stiffness (INFOG(1) = {status}, INFOG(2) = {factor.getMumpsInfog(2)}); "
                "memory may be short, or the mesh has a part that nothing holds"
            )
        return _dense_schur(factor, len(dofs))
    except PETSc.Error as error:
        raise ComputationError(f"PETSc could not condense the body: {error}") from error
    finally:
        # PETSc 3.18 leaks the factor unless both are destroyed, in this order.
        preconditioner.destroy()
        factor.destroy()
        indices.destroy()


def _dense_schur(factor, size: int) -> np.ndarray:
    schur, entries = ctypes.c_void_p(), ctypes.c_void_p()
    _call("MatFactorCreateSchurComplement", _handle(factor), ctypes.byref(schur), None)
    _call("MatDenseGetArray", schur, ctypes.byref(entries))
    values = np.ctypeslib.as_array((ctypes.c_double * size**2).from_address(entries.value)).reshape(size, size)
    symmetric = 0.5 * (values + values.T)
    _call("MatDenseRestoreArray", schur, ctypes.byref(entries))
    _call("MatDestroy", ctypes.byref(schur))
    return symmetric


def _handle(petsc_object):
    return ctypes.c_void_p(petsc_object.handle)


def _call(name: str, *arguments) -> None:
    error = getattr(ctypes.CDLL(PETSc.__file__), name)(*arguments)
    if error:
        raise ComputationError(f"{name} failed with PETSc error {error}")
