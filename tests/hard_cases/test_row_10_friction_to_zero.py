"""Row 10: as friction goes to zero its effect does, in proportion; without it nothing tangential exists."""

from dataclasses import replace

import numpy as np
import pytest
from tests.coarse import coarse_scene, quasi_static

from fenics_gears import simulate
from fenics_gears.effects.friction import Friction

SCENES = {"quasi-static": quasi_static, "200 Hz": lambda scene: scene}
COEFFICIENTS = (1e-2, 1e-3, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12)


@pytest.mark.parametrize("name", [pytest.param("quasi-static", marks=pytest.mark.nightly), "200 Hz"])
def test_effect_of_friction_is_of_its_order(name, paper_scene, measured):
    """Known order: the laws are piecewise linear in mu, so the difference over mu tends to a constant."""
    scene = SCENES[name](coarse_scene(paper_scene))

    def error_with(coefficient):
        friction = Friction(coefficient) if coefficient else None
        return simulate(replace(scene, friction=friction)).transmission_error.values

    is_of_its_order(name, error_with, measured)


def is_of_its_order(name, error_with, measured):
    """The transmission error of a coefficient of friction tends to that of 0 in proportion."""
    plain, rates = error_with(0.0), []
    scale = np.abs(plain).max()
    for coefficient in COEFFICIENTS:
        rates.append(np.abs(error_with(coefficient) - plain).max() / scale / coefficient)
    shown = ", ".join(f"{rate:.3g}" for rate in rates[:4])
    what = f"{name}: relative difference from mu = 0"
    measured(f"{what} / mu, for mu = 1e-2 to 1e-6", shown, "constant within 30 %", row=10)
    measured(f"{what} at mu = 1e-12", rates[-1] * COEFFICIENTS[-1], "2e-12", row=10)
    assert rates[:5] == pytest.approx([rates[2]] * 5, rel=0.3)
    for rate, coefficient in zip(rates, COEFFICIENTS):
        # Beside the effect itself, only the round-off of the transmission error.
        assert rate * coefficient <= 1.3 * rates[2] * coefficient + 1e-12
