"""The numbers that a pair is judged by, from known curves."""

import numpy as np
import pytest

from fenics_gears.results.numbers import harmonics, shares_at


@pytest.mark.parametrize("cycles", [1, 3])
def test_harmonics_of_a_curve_that_is_made_of_them(cycles):
    """Exact; a tone between two harmonics leaves them."""
    phase = np.arange(40 * cycles) / 40
    amplitudes = np.array([3.0, 0.0, 1.5, 0.25, 0.125])
    curve = 7.0 + sum(a * np.cos(2.0 * np.pi * n * phase + n) for n, a in enumerate(amplitudes, 1))
    if cycles == 3:
        curve = curve + 0.5 * np.cos(2.0 * np.pi * phase / 3.0)
    assert harmonics(curve, cycles) == pytest.approx(amplitudes, abs=1e-12)


def test_shares_of_pairs_that_hand_over_in_a_straight_line():
    """Exact: a contact ratio of 1.5, from 1/3 to 2/3, 1 alone, and the other way."""
    phase = np.linspace(2.0, 4.0, 81)
    numbers = np.tile(np.arange(0, 5), (len(phase), 1))
    passed = phase[:, None] - numbers
    entering, leaving = (passed >= 0.0) & (passed <= 0.5), (passed >= 1.0) & (passed <= 1.5)
    share = np.where(entering, 1 / 3 + 2 / 3 * passed, np.where(leaving, 2 / 3 - 2 / 3 * (passed - 1.0), 0.0))
    share = np.where((passed > 0.5) & (passed < 1.0), 1.0, share)
    forces = 5000.0 * share * np.linspace(1.0, 2.0, len(phase))[:, None]
    found = shares_at([0.0, 0.25, 0.75, 1.25, 1.5, 9.0], phase, numbers, forces)
    assert found[:5] == pytest.approx([1 / 3, 0.5, 1.0, 0.5, 1 / 3], abs=1e-12) and np.isnan(found[5])
