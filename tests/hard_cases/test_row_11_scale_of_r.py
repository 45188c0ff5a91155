"""Row 11: the r of the projections [24], [25] steers which sets are tried, never what a solution is."""

import numpy as np
import pytest
from tests.contact.problems import all_open, random_problem

from fenics_gears.contact.newton import CONVERGED
from fenics_gears.contact.step_solver import NEWTON, StepSolution, run_newton, solve_step

SCALES = [1e-6, 1e-3, 1e3, 1e6]
PROBLEMS = 100


def scaled_step(problem, status, scale) -> StepSolution:
    """Newton with scaled r as the first method; the fallbacks where that ends without a solution."""
    (outcome, iterations, *solution), _ = run_newton(problem, status, 40, r_scale=scale)
    if outcome == CONVERGED:
        forces, coordinates, displacement, sets = solution
        return StepSolution(forces, coordinates, displacement, sets, iterations, NEWTON)
    return solve_step(problem, status)


@pytest.mark.parametrize("friction", [0.0, 0.1])
@pytest.mark.parametrize("scale", SCALES)
def test_random_steps_do_not_depend_on_r(scale, friction, measured):
    """Exact: a solution is a fixed point of the projections for every r."""
    problems = [random_problem(seed, friction=friction) for seed in range(PROBLEMS)]
    do_not_depend_on_r([(problem, all_open(problem)) for problem in problems], scale, "random steps", measured)


def do_not_depend_on_r(problems, scale, words, measured):
    """Problems with the sets that they start from have the same forces with another r."""
    worst, by_itself = 0.0, 0
    for problem, status in problems:
        expected = solve_step(problem, status)
        by_itself += run_newton(problem, status, 40, r_scale=scale)[0][0] == CONVERGED
        found = scaled_step(problem, status, scale)
        worst = max(
            worst, float(np.abs(found.forces - expected.forces).max() / np.abs(expected.forces).max(initial=1.0))
        )
    case = f"r x {scale:g}, friction {problems[0][0].friction:g}"
    measured(f"{case}: difference of forces in {len(problems)} {words}", worst, 1e-9, row=11)
    measured(f"{case}: solved without fallbacks", f"{by_itself} of {len(problems)}", "the others by a fallback", row=11)
