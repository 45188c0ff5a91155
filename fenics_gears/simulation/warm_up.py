"""Compile the hot kernels, or load them from disk, before the clock of the march starts.

`python -m fenics_gears.simulation.warm_up` compiles all of them into numba's files on disk: the launcher calls it as the last step of the set-up
and after each change of their sources, so that runs only load them.
"""

from __future__ import annotations

import time

import numpy as np

from fenics_gears.contact.compliance_product import compliance_product
from fenics_gears.contact.interpolation import flank_interpolation
from fenics_gears.contact.laws import SLIP_FORWARD, Tolerance
from fenics_gears.contact.step_solver import StepProblem, solve_step
from fenics_gears.dynamics.contact_work import compile_contact_work


def compile_kernels(tangential: bool) -> float:
    """Run every compiled kernel once on a problem of one contact node; returns the seconds it took."""
    begun = time.perf_counter()
    offsets, rolls = np.array([-0.1, 0.1]), np.array([0.5, 0.51])
    interpolation = flank_interpolation(offsets, rolls, 40.0, 0.5, 1.0, np.linspace(0.4, 0.6, 5), 1)
    directions = np.eye(2)[: 2 if tangential else 1]
    compliance_product(
        np.eye(10),
        interpolation.weights, interpolation.first, interpolation.last, directions,
        interpolation.weights, interpolation.first, interpolation.last, directions,
        np.zeros((len(directions), 2, len(directions), 2)),
    )  # fmt: skip
    unknowns = 2 if tangential else 1
    problem = StepProblem(
        stiffness=np.eye(1),
        load=np.ones(1),
        compliance=np.eye(unknowns),
        jacobian=np.eye(unknowns, 1),
        gap=np.zeros(1),
        slip_before=np.ones(1) if tangential else np.empty(0),
        friction=0.1,
        free_motion=np.empty(0),
        tolerance=Tolerance.of_load(1.0),
    )
    solve_step(problem, np.array([SLIP_FORWARD], dtype=np.int8))
    compile_contact_work()
    return time.perf_counter() - begun


if __name__ == "__main__":
    for with_friction in (True, False):
        compile_kernels(with_friction)
