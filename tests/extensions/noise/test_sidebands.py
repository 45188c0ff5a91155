"""Sidebands of made-up signals."""

import numpy as np
import pytest
from scipy.special import jv

from fenics_gears.extensions.noise.sidebands import SIDEBANDS, sidebands
from fenics_gears.results.spectrum import order_lines

TEETH, PERIOD, STEPS = (16, 24), 48, 40


def test_phase_modulation_has_bessels_sidebands():
    """Exact (Jacobi, Anger): cos(omega t + b sin(Omega t)) has J_0(b) and J_k(b)."""
    depth = 0.8
    turns = np.arange(PERIOD * STEPS + 1) / (STEPS * TEETH[0])
    signal = np.cos(2.0 * np.pi * 32.0 * turns + depth * np.sin(2.0 * np.pi * turns))
    found = sidebands(order_lines(signal, PERIOD, TEETH), TEETH, 2)
    assert found.line == pytest.approx(jv(0, depth) ** 2, rel=1e-9)
    assert found.pinion == pytest.approx(2.0 * sum(jv(k, depth) ** 2 for k in range(1, SIDEBANDS + 1)), rel=1e-9)
    # Every second sideband of the pinion is the third of the wheel, and so on.
    assert found.wheel == pytest.approx(2.0 * sum(jv(k, depth) ** 2 for k in (2, 4)), rel=1e-9)
    assert found.all == pytest.approx(found.pinion, rel=1e-9)
