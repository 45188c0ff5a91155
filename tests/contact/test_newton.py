"""The contact step against other methods, and whether a frictional one has a solution, and only one."""

import itertools
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import nnls
from tests.contact.problems import all_open, random_problem

from fenics_gears.contact.errors import SelfLocking
from fenics_gears.contact.existence import locked_nodes, working
from fenics_gears.contact.laws import OPEN, SLIP_BACKWARD, SLIP_FORWARD, STICK, Tolerance
from fenics_gears.contact.mixed_form import Iterate, StepEquations, product, solve_sets
from fenics_gears.contact.step_solver import solve_step
from fenics_gears.contact.uniqueness import is_only_solution


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
        problem = StepEquations(
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


def solutions(problem, sigma):
    n, found = len(sigma), []
    slips = np.where(sigma > 0, SLIP_FORWARD, SLIP_BACKWARD)
    for closed in itertools.product((False, True), repeat=n):
        forces, coordinates = np.zeros(2 * n), np.zeros(len(problem.load))
        try:
            sets = np.where(closed, slips, OPEN).astype(np.int8)
            solve_sets(problem, Iterate(sets, forces, coordinates, np.zeros(2 * n)))
        except np.linalg.LinAlgError:
            continue
        openings = problem.gap - (problem.jacobian @ coordinates - problem.compliance @ forces)[:n]
        balance = problem.stiffness @ coordinates + problem.jacobian.T @ forces - problem.load
        if forces[:n].min() >= 0.0 and openings.min() >= -1e-9 and np.abs(balance).max() <= 1e-6:
            found.append(forces)
    return found


def certified(problem, sigma, stiffness=None):
    stiffness = problem.stiffness if stiffness is None else stiffness
    closed = np.ones(len(sigma), dtype=bool)
    return is_only_solution(stiffness, problem.compliance, problem.jacobian, problem.friction, closed, sigma)


@pytest.mark.parametrize("free", [False, True], ids=["held", "free"])
def test_a_certified_solution_is_the_only_one(free):
    """Brute force: all 2^4 sets of closed nodes of 500 problems leave at most one solution where the certificate
    says so, and sometimes two where not."""
    most = {True: 0, False: 0}
    count = {True: 0, False: 0}
    for seed in range(500):
        rng = np.random.default_rng(seed)
        problem = random_problem(seed, 4, float(rng.uniform(0.05, 1.5)), coordinates=2, free=free)
        if free:
            # Arms of friction as gears have them: most of friction's moments are smaller than those of the normal
            # forces.
            problem.jacobian[4:, 0] *= 0.3
        sigma = rng.choice([-1.0, 1.0], 4)
        says = certified(problem, sigma)
        count[says] += 1
        most[says] = max(most[says], len(solutions(problem, sigma)))
    assert count[True] > 100 and count[False] > 100
    assert most[True] == 1 and most[False] >= 2


def one_node(friction, coupling=0.0, load=100.0, stiffness=0.0, arm=0.0, gap=0.0):
    """One node that slips backward; `arm`: of friction against the load; `coupling`: elastic, normal to tangential."""
    free = stiffness == 0.0
    return StepEquations(
        stiffness=np.array([[stiffness]]),
        load=np.array([load]),
        compliance=1e-6 * np.array([[1.0, coupling], [coupling, 2.0]]),
        jacobian=np.array([[1.0], [arm]]),
        gap=np.array([gap]),
        slip_before=np.array([-1.0]),
        friction=friction,
        free_motion=np.ones(1) if free else np.empty(0),
        tolerance=Tolerance.of_load(load),
    )


@pytest.mark.parametrize("friction", [1.0, 1.5, 2.0])
def test_friction_that_undoes_the_normal_force_locks(friction):
    """Exact: from mu a = 1 on the node jams, with 1 mm over 3e-6 mm/N, not the load."""
    problem = one_node(friction, arm=1.0)
    solution = solve_step(problem, all_open(problem))
    assert solution.status[0] == STICK
    assert solution.forces[0] == pytest.approx((1.0 + 2e-6 * 100.0) / 3e-6, rel=1e-12)
    weights = working(problem.jacobian, problem.free_motion, solution.forces)
    assert weights.normal[0] == 1.0
    assert weights.sliding[0] == pytest.approx(100.0 / solution.forces[0], rel=1e-9)
    slides = replace(solution, forces=np.array([1.0, -friction]))
    assert locked_nodes(working(problem.jacobian, problem.free_motion, slides.forces)).all()


@pytest.mark.parametrize(
    "seed, nodes, words",
    [
        (20067, 1, "no contact forces whose friction opposes the slip can balance the load"),
        (27458, 2, "the friction undoes 3.75 times"),
    ],
)
def test_a_step_that_locks_without_a_solution_is_named(seed, nodes, words):
    """The 18 of 100 000 random problems without a solution (test_step_solver) say self-locking; friction outweighs
    the normal forces."""
    problem = random_problem(seed, nodes, 2.0, coordinates=2, free=True)
    with pytest.raises(SelfLocking, match="self-locking: with a friction coefficient of 2 ") as failure:
        solve_step(problem, all_open(problem))
    assert words in failure.value.reason
    arms = problem.jacobian[nodes:, 0]
    assert np.any(1.0 - 2.0 * np.abs(arms) <= 0.0)


def test_two_solutions_are_not_certified():
    """Exact: for mu c_nt > c_nn an open gap of g has two solutions, p = 0 and p = g/(mu c_nt - c_nn - 1/k)."""
    problem = one_node(2.0, coupling=1.2, load=0.0, stiffness=1e9, gap=1e-3)
    problem = problem._replace(tolerance=Tolerance.of_load(1e3))
    assert not certified(problem, np.array([-1.0]))
    assert certified(problem._replace(friction=0.5), np.array([-1.0]))
    expected = 1e-3 / (2.4e-6 - 1e-6 - 1e-9)
    found = sorted(forces[0] for forces in solutions(problem, np.array([-1.0])))
    assert found == [0.0, pytest.approx(expected, rel=1e-9)]
    for start, force in ((OPEN, 0.0), (SLIP_BACKWARD, expected)):
        assert solve_step(problem, np.array([start], dtype=np.int8)).forces[0] == pytest.approx(force, rel=1e-9)
    slides = solve_step(problem._replace(gap=np.array([-1e-3]), friction=0.5), np.array([OPEN], dtype=np.int8))
    assert slides.forces[0] == pytest.approx(1e-3 / (1e-6 - 0.6e-6 + 1e-9), rel=1e-9)


def test_a_product_reads_no_further_than_both_vectors_go():
    """Identity: what lies behind the shorter one in memory may be no number."""
    numbers, padded = np.array([2.0, np.nan]), np.array([3.0, 0.0])
    assert product(padded, numbers[:1]) == product(numbers[:1], padded) == 6.0
