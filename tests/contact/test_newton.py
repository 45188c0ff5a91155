"""The contact step against other methods."""

import itertools

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import nnls
from tests.contact.laws_of_contact import law_residual
from tests.contact.problems import all_open, random_problem

from fenics_gears.contact.laws import OPEN, SLIP_BACKWARD, SLIP_FORWARD, STICK, Tolerance
from fenics_gears.contact.mixed_form import Iterate, solve_sets
from fenics_gears.contact.step_solver import StepProblem, solve_step


@given(st.integers(0, 10**9), st.integers(1, 12))
def test_frictionless_step_is_the_minimum_of_the_energy(seed, nodes):
    """SciPy's NNLS: with q eliminated, p solves min 1/2 p^T W p - p^T d over p >= 0."""
    problem = random_problem(seed, nodes)
    flexibility = problem.jacobian @ np.linalg.solve(problem.stiffness, problem.jacobian.T) + problem.compliance
    drive = problem.jacobian @ np.linalg.solve(problem.stiffness, problem.load) - problem.gap
    root = np.linalg.cholesky(flexibility)
    expected, _ = nnls(root.T, np.linalg.solve(root, drive))
    solution = solve_step(problem, all_open(problem))
    assert solution.forces == pytest.approx(expected, rel=1e-7, abs=1e-7 * (1.0 + np.abs(expected).max()))


def test_frictional_step_against_enumeration_of_all_sets():
    """Brute force: of all 4^4 sets one satisfies every law; with small friction only one does."""
    for seed in range(12):
        problem = random_problem(seed, nodes=4, friction=0.05)
        found = []
        for sets in itertools.product((OPEN, SLIP_FORWARD, SLIP_BACKWARD, STICK), repeat=4):
            status = np.array(sets, dtype=np.int8)
            forces, q = np.zeros(8), np.zeros(3)
            solve_sets(problem.equations, Iterate(status, forces, q, np.zeros(8)))
            u = problem.jacobian @ q - problem.compliance @ forces
            residual = law_residual(forces, u, problem.gap, problem.slip_before, problem.friction)
            slip = u[4:] + problem.slip_before
            # law_residual calls "inside the cone" sticking; sets of zero force are told apart by the slip's sign.
            if max(residual.values()) < 1e-9 and np.all(forces[4:] * slip >= -1e-9):
                found.append(forces)
        solution = solve_step(problem, all_open(problem))
        assert found
        assert all(solution.forces == pytest.approx(forces, abs=1e-6) for forces in found)


def test_warm_start_at_the_solution_takes_one_iteration():
    """A set that repeats is the exact solution."""
    problem = random_problem(3, friction=0.1)
    solution = solve_step(problem, all_open(problem))
    again = solve_step(problem, solution.status)
    assert again.iterations == 1
    assert np.array_equal(again.forces, solution.forces)


def test_frictionless_cycle_is_solved_one_change_at_a_time():
    """NNLS: nearly dependent nodes make all-at-once changes cycle; Murty's rule ends."""
    solved_by_last = 0
    for seed in range(40):
        rng = np.random.default_rng(seed)
        n, coarse = 20, 5
        weights = np.maximum(0.0, 1.0 - np.abs(np.linspace(0.0, coarse - 1, n)[:, None] - np.arange(coarse)))
        problem = StepProblem(
            stiffness=np.array([[1e4]]),
            load=np.array([1e3]),
            compliance=1e-6 * (weights @ weights.T + 1e-3 * np.eye(n)),
            jacobian=np.ones((n, 1)),
            gap=1e-3 * rng.random(n),
            slip_before=np.empty(0),
            friction=0.0,
            free_motion=np.empty(0),
            tolerance=Tolerance.of_load(1e3),
        )
        start = rng.integers(0, 2, n).astype(np.int8)
        solution = solve_step(problem, start)
        solved_by_last += solution.method == "one change at a time"
        root = np.linalg.cholesky(problem.compliance + 1e-4)
        expected, _ = nnls(root.T, np.linalg.solve(root, 0.1 - problem.gap))
        assert solution.forces == pytest.approx(expected, rel=1e-6, abs=1e-3)
    assert solved_by_last > 0
