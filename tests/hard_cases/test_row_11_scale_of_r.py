"""Row 11: the r of the projections [24], [25] scaled by 1e-6 ... 1e6. It steers which sets are tried, never what a
solution is."""

import numpy as np
import pytest
from tests.contact.problems import all_open, random_problem

from fenics_gears.contact.mesh import elastic_mesh
from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.contact.newton import CONVERGED
from fenics_gears.contact.step_solver import NEWTON, StepSolution, run_newton, solve_step
from fenics_gears.contact.window import ContactGrid
from fenics_gears.dynamics.march import Marcher
from fenics_gears.dynamics.stepping import EquationsOfMotion
from fenics_gears.model.drivetrain import drivetrain

SCALES = [1e-6, 1e-3, 1e3, 1e6]
PROBLEMS = 100


def scaled_step(problem, status, scale) -> StepSolution:
    """Newton with scaled r as the first method; the fallbacks where that ends without a solution."""
    (outcome, iterations, *solution), _ = run_newton(problem, status, 40, r_scale=scale)
    if outcome == CONVERGED:
        forces, coordinates, displacement, sets = solution
        return StepSolution(forces, coordinates, displacement, sets, iterations, NEWTON)
    return solve_step(problem, status)


class Scaled(Cycle):
    """A mesh cycle whose steps are solved with scaled r."""

    scale, by_itself = 1.0, 0

    def solve(self, position, problem, status, last):
        self.by_itself += run_newton(problem, status, 40, r_scale=self.scale)[0][0] == CONVERGED
        return scaled_step(problem, status, self.scale)


@pytest.mark.parametrize("friction", [0.0, 0.1])
@pytest.mark.parametrize("scale", SCALES)
def test_random_steps_do_not_depend_on_r(scale, friction, measured):
    """Exact: a solution is a fixed point of the projections for every r. Where scaled r finds none, a fallback does."""
    worst, by_itself = 0.0, 0
    for seed in range(PROBLEMS):
        problem = random_problem(seed, friction=friction)
        expected = solve_step(problem, all_open(problem))
        by_itself += run_newton(problem, all_open(problem), 40, r_scale=scale)[0][0] == CONVERGED
        found = scaled_step(problem, all_open(problem), scale)
        worst = max(
            worst, float(np.abs(found.forces - expected.forces).max() / np.abs(expected.forces).max(initial=1.0))
        )
    measured(f"r x {scale:g}, friction {friction:g}: difference of forces in {PROBLEMS} random steps", worst, "1e-9")
    measured(
        f"r x {scale:g}, friction {friction:g}: solved without fallbacks",
        f"{by_itself} of {PROBLEMS}",
        "the others by a fallback",
    )
    assert worst <= 1e-9


@pytest.mark.parametrize("scale", SCALES)
def test_the_paper_s_pair_does_not_depend_on_r(scale, paper_scene, paper_pair, stand_in_flanks, measured):
    """Exact: as above, at every step of a mesh cycle of the paper's pair with friction, on stand-in teeth."""
    shafts, marches = drivetrain(paper_scene, paper_pair), []
    for kind in (Cycle, Scaled):
        cycle = kind(elastic_mesh(stand_in_flanks, ContactGrid(1.5, 20)), 40, shafts.indices, tangential=True)
        cycle.scale = scale
        marches.append(
            Marcher(cycle, EquationsOfMotion(shafts, 1.0 / (200.0 * 40), paper_scene.friction.coefficient)).run(40, 41)
        )
    pairs = list(zip(*(march.records for march in marches)))
    worst = max(np.abs(a.solution.forces - b.solution.forces).max() / np.abs(a.solution.forces).max() for a, b in pairs)
    used = ", ".join(
        f"{count} by {rung}" for rung, count in marches[1].steps_by_method.items() if count and rung != NEWTON
    )
    # Newton solves the static start, three steps of its own, too.
    measured(f"r x {scale:g}, the paper's pair: difference of forces over 40 steps", worst, "1e-9")
    measured(
        f"r x {scale:g}, the paper's pair: solved without fallbacks",
        f"{cycle.by_itself} of 43" + (f" ({used})" if used else ""),
        "the others by a fallback",
    )
    assert worst <= 1e-9
    assert sum(marches[1].steps_by_method.values()) == 40
