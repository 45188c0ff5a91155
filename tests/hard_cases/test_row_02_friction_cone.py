"""Row 2: single steps with random loads, gaps, slips and starts, friction up to 2; whole runs are judged in
`test_any_scene.py`."""

import numpy as np
import pytest
from hypothesis import strategies as st
from tests.contact.problems import all_open, random_problem
from tests.hard_cases.random_steps import judged_steps, steps

from fenics_gears.contact.step_solver import solve_step

# Of hard_cases.md and model.md section 4.
LIMITS = {
    "cone": ("friction beyond mu p_n / largest force", 1e-6, ""),
    "stick": ("slip of a sticking node", 1e-4, "um"),
    "wrong_way": ("work of friction in the direction of slip / (force x length)", 1e-10, ""),
    "dissipation": ("energy gained by friction / (force x length)", 1e-10, ""),
}


def test_any_step_obeys_coulomb(measured):
    """Authority: Coulomb's law, from forces and coordinates."""
    judged_steps(measured, steps(st.floats(1e-3, 2.0)), LIMITS, 120)


@pytest.mark.nightly
def test_many_steps_obey_coulomb(measured):
    """Authority: as above, ten thousand times."""
    judged_steps(measured, steps(st.floats(1e-3, 2.0)), LIMITS, 10000)


def test_friction_dissipates_what_it_bounds(measured):
    """Exact: a node loses mu p_n per length that it slips, no less and no more; one that sticks has no slip to lose it
    by."""
    worst = 0.0
    for seed in range(200):
        problem = random_problem(seed, 6, friction=0.2)
        solution = solve_step(problem, all_open(problem))
        slip = (problem.jacobian @ solution.coordinates - problem.compliance @ solution.forces)[
            6:
        ] + problem.slip_before
        lost = solution.forces[6:] * slip
        full = 0.2 * solution.forces[:6] * np.abs(slip)
        scale = np.abs(solution.forces).max() * np.abs(slip).max()
        worst = max(worst, float(np.abs(lost - full).max() / scale) if scale else 0.0)
    measured("friction loss of a node, difference from mu p_n slip", worst, "1e-10 of force x slip")
    assert worst <= 1e-10
