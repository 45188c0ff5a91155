"""Row 2: single steps with random loads, gaps, slips and starts, friction up to 2; whole runs are judged in
`test_any_scene.py`."""

import pytest
from hypothesis import strategies as st
from tests.hard_cases.random_steps import judged_steps, steps

# Of hard_cases.md and model.md section 4.
LIMITS = {
    "cone": ("friction beyond mu p_n / largest force", 1e-6, ""),
    "stick": ("slip of a sticking node", 1e-4, "um"),
    "wrong_way": ("work of friction in the direction of slip / (force x length)", 1e-10, ""),
    "dissipation": ("energy gained by friction / (force x length)", 1e-10, ""),
}


@pytest.mark.parametrize("examples", [120, pytest.param(10000, marks=pytest.mark.nightly)])
def test_any_step_obeys_coulomb(measured, examples):
    """Coulomb's law, from forces and coordinates."""
    judged_steps(measured, steps(st.floats(1e-3, 2.0)), LIMITS, examples)
