"""Row 1: single steps with random loads, gaps, friction and starts; whole runs are judged in `test_any_scene.py`."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.hard_cases.random_steps import solved, steps, violations

FRICTIONS = st.one_of(st.just(0.0), st.floats(1e-6, 2.0))
# Of hard_cases.md; what is left of the balance is round-off.
LIMITS = {
    "penetration": ("largest penetration", 1e-4, "um"),
    "tension": ("largest tension, of the largest force", 1e-6, ""),
    "complementarity": ("p_n gap, of force times length", 1e-10, ""),
    "balance": ("forces out of balance, of the largest term", 1e-12, ""),
}


def judged(measured, examples):
    worst, count = dict.fromkeys(LIMITS, 0.0), {"solved": 0, "typed": 0}

    @settings(max_examples=examples)
    @given(steps(FRICTIONS))
    def every_step(step):
        solution = solved(*step)
        count["solved" if solution is not None else "typed"] += 1
        if solution is None:
            return
        found = violations(step[0], solution)
        for name, (_, limit, _) in LIMITS.items():
            worst[name] = max(worst[name], found[name])
            assert found[name] <= limit, name

    try:
        every_step()
    finally:
        for name, (words, limit, unit) in LIMITS.items():
            measured(f"{words}, single steps", worst[name], f"{limit:g} {unit}".rstrip(), unit)
        measured("single steps drawn at random", f"{count['solved']} solved, {count['typed']} typed errors", "no other end")


def test_any_step_obeys_signorini(measured):
    """Authority: Signorini's law and equilibrium, from forces and coordinates; frictionless steps must be solved, being convex."""
    judged(measured, 300)


@pytest.mark.nightly
def test_many_steps_obey_signorini(measured):
    """Authority: as above, ten thousand times."""
    judged(measured, 10000)
