"""Whether a frictional step has a solution, and only one: certificate and errors against exact and enumerated cases."""

import itertools
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from tests.contact.problems import all_open, random_problem

from fenics_gears.contact.errors import MoreThanOneSolution, SelfLocking
from fenics_gears.contact.existence import explained, locked_nodes, working
from fenics_gears.contact.laws import OPEN, SLIP_BACKWARD, SLIP_FORWARD, STICK, Tolerance
from fenics_gears.contact.mixed_form import Iterate, solve_sets
from fenics_gears.contact.step_solver import StepProblem, solve_step
from fenics_gears.contact.uniqueness import is_only_solution, uncertified


def solutions(problem, sigma):
    """Every solution that slips along `sigma` (n,), by trying each set of closed nodes."""
    n, found = len(sigma), []
    slips = np.where(sigma > 0, SLIP_FORWARD, SLIP_BACKWARD)
    for closed in itertools.product((False, True), repeat=n):
        forces, coordinates = np.zeros(2 * n), np.zeros(len(problem.load))
        try:
            sets = np.where(closed, slips, OPEN).astype(np.int8)
            solve_sets(problem.equations, Iterate(sets, forces, coordinates, np.zeros(2 * n)))
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
    """Brute force: with the slip directions given, all 2^4 sets of closed nodes of 1500 problems leave at most one
    solution where the
    certificate says so, and sometimes two where it does not."""
    most = {True: 0, False: 0}
    count = {True: 0, False: 0}
    for seed in range(1500):
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


@pytest.mark.parametrize("free", [False, True], ids=["held", "free"])
def test_solutions_judged_together_are_judged_as_each_by_itself(free):
    """Brute force: sets of any number of closed nodes, some alike, some with sticking nodes, counted one by one."""
    rng, friction, counts = np.random.default_rng(3), 0.8, []
    stiffness = random_problem(0, 6, friction, coordinates=2, free=free).stiffness
    for _ in range(20):
        solved = []
        for seed in range(6):
            problem, status = (
                random_problem(seed, 6, friction, coordinates=2, free=free),
                rng.choice([OPEN, STICK, SLIP_FORWARD, SLIP_BACKWARD], 6),
            )
            operator = SimpleNamespace(compliance=problem.compliance, jacobian=problem.jacobian)
            normal = rng.uniform(1.0, 2.0, 6)
            solved += [(operator, status.astype(np.int8), np.concatenate((normal, 0.5 * friction * normal)))] * (
                1 + seed % 2
            )
        alone = 0
        for operator, status, forces in solved:
            sigma = np.select([status == SLIP_BACKWARD, status == STICK], [-1.0, 0.5], 1.0)
            alone += not is_only_solution(
                stiffness, operator.compliance, operator.jacobian, friction, status != OPEN, sigma
            )
        assert uncertified(stiffness, friction, solved) == alone
        counts.append(alone)
    assert 0 < sum(counts) < 20 * 9


def test_a_load_held_by_contact_alone_is_the_limit_of_a_soft_spring():
    """Known limit: a singular stiffness has the certificate of a spring of 1e-6, and of 1e-9, of the others along the
    free motion."""
    verdicts = set()
    for seed in range(200):
        problem = random_problem(seed, 4, 0.4, coordinates=2, free=True)
        problem.jacobian[4:, 0] *= 0.3
        sigma = np.random.default_rng(seed).choice([-1.0, 1.0], 4)
        soft = [problem.stiffness + np.diag([spring, 0.0]) for spring in (1e-1, 1e-4)]
        verdict = certified(problem, sigma)
        assert [certified(problem, sigma, stiffness) for stiffness in soft] == [verdict, verdict]
        verdicts.add(verdict)
    assert verdicts == {True, False}


def one_node(friction, coupling=0.0, load=100.0, stiffness=0.0, arm=0.0, gap=0.0):
    """One node that slips backward, so far by 1 mm; `arm`: of friction against the load; `coupling`: elastic, normal to
    tangential."""
    free = stiffness == 0.0
    return StepProblem(
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


@pytest.mark.parametrize("friction", [0.1, 0.5, 0.9])
def test_friction_against_the_load_raises_the_normal_force(friction):
    """Exact: a node whose friction has the arm `a` against the load F carries F/(1 - mu a)."""
    problem = one_node(friction, arm=1.0)
    assert solve_step(problem, all_open(problem)).forces[0] == pytest.approx(100.0 / (1.0 - friction), rel=1e-12)


@pytest.mark.parametrize("friction", [1.0, 1.5, 2.0])
def test_friction_that_undoes_the_normal_force_locks(friction):
    """Exact: from mu a = 1 on the node sticks and jams, with the force that the slip asks for, 1 mm over 3e-6 mm/N, not
    the load."""
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
    """Of 100 000 random problems (test_step_solver) the 18 without a solution say self-locking; two of them, by either
    reason.

    The arms of forces say so by themselves: friction along the slip outweighs the normal forces.
    """
    problem = random_problem(seed, nodes, 2.0, coordinates=2, free=True)
    with pytest.raises(SelfLocking, match="self-locking: with a friction coefficient of 2 ") as failure:
        solve_step(problem, all_open(problem))
    assert words in failure.value.reason
    arms = problem.jacobian[nodes:, 0]
    assert np.any(1.0 - 2.0 * np.abs(arms) <= 0.0)


def test_two_solutions_are_not_certified():
    """Exact: where friction pulls the flanks together by more than the normal force parts them (mu c_nt > c_nn) an open
    gap of g
    has two solutions, p = 0 and p = g/(mu c_nt - c_nn - 1/k)."""
    problem = one_node(2.0, coupling=1.2, load=0.0, stiffness=1e9, gap=1e-3)
    problem = replace(problem, tolerance=Tolerance.of_load(1e3))
    assert not certified(problem, np.array([-1.0]))
    assert certified(replace(problem, friction=0.5), np.array([-1.0]))
    expected = 1e-3 / (2.4e-6 - 1e-6 - 1e-9)
    found = sorted(forces[0] for forces in solutions(problem, np.array([-1.0])))
    assert found == [0.0, pytest.approx(expected, rel=1e-9)]
    for start, force in ((OPEN, 0.0), (SLIP_BACKWARD, expected)):
        assert solve_step(problem, np.array([start], dtype=np.int8)).forces[0] == pytest.approx(force, rel=1e-9)
    slides = solve_step(replace(problem, gap=np.array([-1e-3]), friction=0.5), np.array([OPEN], dtype=np.int8))
    assert slides.forces[0] == pytest.approx(1e-3 / (1e-6 - 0.6e-6 + 1e-9), rel=1e-9)


def test_an_error_without_a_certificate_says_more_than_one_solution():
    """Message, on its own: no step of the search needs it, all 18 failures locking. Given to the explanation as failed,
    problems that
    have two solutions by enumeration, while no single node locks, are named for that."""
    named = 0
    for seed in range(1500):
        rng = np.random.default_rng(seed)
        problem = random_problem(seed, 4, float(rng.uniform(0.05, 1.5)), coordinates=2)
        sigma = rng.choice([-1.0, 1.0], 4)
        sets = np.where(sigma > 0, SLIP_FORWARD, SLIP_BACKWARD).astype(np.int8)
        failure = explained(problem, [("newton", "the sets repeat", np.zeros((1, 5)), sets[None])])
        if isinstance(failure, SelfLocking) or len(solutions(problem, sigma)) < 2:
            continue
        named += 1
        assert isinstance(failure, MoreThanOneSolution)
        assert failure.reason.startswith("more than one solution, or none: with a friction coefficient of ")
    assert named > 0
