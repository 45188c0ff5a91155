"""Row 1: single steps with random loads, gaps, friction and starts; whole runs are judged in `test_any_scene.py`."""

import pytest
from hypothesis import strategies as st
from tests.hard_cases.random_steps import judged_steps, steps

FRICTIONS = st.one_of(st.just(0.0), st.floats(1e-6, 2.0))
# Of hard_cases.md; what is left of the balance is round-off.
LIMITS = {
    "penetration": ("largest penetration", 1e-4, "um"),
    "tension": ("largest tension / largest force", 1e-6, ""),
    "complementarity": ("p_n gap / (force x length)", 1e-10, ""),
    "balance": ("residual of the equilibrium / largest term", 1e-12, ""),
}


@pytest.mark.parametrize("examples", [120, pytest.param(10000, marks=pytest.mark.nightly)])
def test_any_step_obeys_signorini(measured, examples):
    """Signorini's law and equilibrium, from forces and coordinates; frictionless steps must be solved, being convex."""
    judged_steps(measured, steps(FRICTIONS), LIMITS, examples)
