"""Row 10: as friction goes to zero its effect does, in proportion; without it nothing tangential exists."""

from dataclasses import replace

import numpy as np
import pytest
from tests.coarse import coarse_scene, frictionless, quasi_static

from fenics_gears import simulate
from fenics_gears.effects.friction import Friction

SCENES = {"quasi-static": quasi_static, "200 Hz": lambda scene: scene}
COEFFICIENTS = (1e-2, 1e-3, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12)


@pytest.mark.parametrize("name", [pytest.param("quasi-static", marks=pytest.mark.nightly), "200 Hz"])
def test_effect_of_friction_is_of_its_order(name, paper_scene, measured):
    """Known order: the laws are piecewise linear in mu, so the difference over mu tends to a constant, until
    round-off."""
    scene = SCENES[name](coarse_scene(paper_scene))
    plain = simulate(frictionless(scene)).transmission_error.values
    scale, rates = np.abs(plain).max(), []
    for coefficient in COEFFICIENTS:
        error = simulate(replace(scene, friction=Friction(coefficient))).transmission_error.values
        rates.append(np.abs(error - plain).max() / scale / coefficient)
    shown = ", ".join(f"{rate:.3g}" for rate in rates[:4])
    measured(f"{name}: relative difference from mu = 0 / mu, for mu = 1e-2 to 1e-6", shown, "constant within 30 %")
    measured(f"{name}: relative difference from mu = 0 at mu = 1e-12", rates[-1] * COEFFICIENTS[-1], "2e-12")
    assert rates[:5] == pytest.approx([rates[2]] * 5, rel=0.3)
    for rate, coefficient in zip(rates, COEFFICIENTS):
        # Beside the effect itself, only the round-off of the transmission error.
        assert rate * coefficient <= 1.3 * rates[2] * coefficient + 1e-12
