"""What MUMPS expects of the factor of a body: its symbolic analysis, on the program's own matrix, without factorising
it."""

from __future__ import annotations

import ctypes

import numpy as np
from petsc4py import PETSc

from fenics_gears.elasticity.face import condensed
from fenics_gears.elasticity.face.cost import expected_size
from fenics_gears.elasticity.mumps import _call, _handle, _petsc_matrix
from fenics_gears.model.face_resolution import face_discretisation
from fenics_gears.model.model import Model
from fenics_gears.simulation.face_route import gear_body


class _Analysed(Exception):
    """In place of the factors of a sector's halves: operations of both, bytes of one's entries; unknowns of both, size
    of one's Schur complement."""

    def __init__(self, matrix, what: str, dofs: np.ndarray):
        super().__init__(what)
        matrix = _petsc_matrix(matrix)
        matrix.setOption(PETSc.Mat.Option.SPD, True)
        preconditioner, retained = (
            PETSc.PC().create(matrix.comm),
            PETSc.IS().createGeneral(np.asarray(dofs, dtype=PETSc.IntType), matrix.comm),
        )
        preconditioner.setOperators(matrix)
        preconditioner.setType("cholesky")
        preconditioner.setFactorSolverType("mumps")
        preconditioner.setFactorSetUpSolverType()
        factor = preconditioner.getFactorMatrix()
        _call("MatFactorSetSchurIS", _handle(factor), _handle(retained))
        # MatFactorInfo, eleven numbers, which MUMPS does not read.
        _call("MatCholeskyFactorSymbolic", _handle(factor), _handle(matrix), None, (ctypes.c_double * 16)())
        # Negative: millions (MUMPS users' guide, INFOG(20)).
        entries = factor.getMumpsInfog(20)
        self.found = {
            "factor_operations": 2.0 * factor.getMumpsRinfog(1),
            "factor_array_bytes": 8.0 * (entries if entries > 0 else -1e6 * entries),
            "unknowns": 2 * matrix.size[0], "condensed_half": len(dofs),
        }  # fmt: skip
        preconditioner.destroy()
        factor.destroy()


def expected_by_mumps(model: Model) -> dict[str, float]:
    """Of the wheel's body: as a point has it."""
    usual, condensed.Factor = condensed.Factor, lambda *arguments: _raise(_Analysed(*arguments))
    try:
        gear_body(model, "wheel", model.touching.reach, None)
    except _Analysed as analysed:
        return analysed.found | {
            "condensed_unknowns": expected_size(model.pair.wheel, face_discretisation(model, 1))[1]
        }
    finally:
        condensed.Factor = usual
    raise RuntimeError("the body was condensed without a factor")


def _raise(error: Exception):
    raise error
