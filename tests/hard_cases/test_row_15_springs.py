"""Row 15: shafts and bearings from far softer to far stiffer than the paper's."""

from dataclasses import replace

import numpy as np
import pytest
from tests.coarse import frictionless, quasi_static

from fenics_gears import simulate


def stiffened(scene, factor):
    return replace(
        scene,
        shafts=replace(scene.shafts, torsional_stiffness=factor * scene.shafts.torsional_stiffness),
        bearings=replace(scene.bearings, stiffness=factor * scene.bearings.stiffness),
    )


@pytest.mark.parametrize(
    "make",
    [quasi_static, pytest.param(lambda scene: frictionless(quasi_static(scene)), marks=pytest.mark.nightly)],
    ids=["friction", "frictionless"],
)
def test_stiff_springs_tend_to_the_rigid_drivetrain(make, coarse, measured):
    """Exact limit: the scene without shafts and bearings, as 1/k."""
    rigid = simulate(replace(make(coarse), shafts=None, bearings=None)).transmission_error.values
    distances = []
    for factor in (1e-3, 1.0, 1e3, 1e6, 1e9, 1e12):
        error = simulate(stiffened(make(coarse), factor)).transmission_error.values
        distances.append(np.abs(error - rigid).max() / np.abs(rigid).max())
    what = "relative difference from rigid shafts and bearings"
    measured(f"{what}, stiffness 1e-3 of nominal", distances[0], "decreases with stiffness")
    measured(f"{what}, nominal stiffness", distances[1], "decreases with stiffness")
    limit = "1e-9 of that with nominal stiffness, within 30 %"
    measured(f"{what}, stiffness 1e9 of nominal", distances[-2], limit)
    measured(f"{what}, stiffness 1e12 of nominal", distances[-1], 1e-10)
    assert np.all(np.diff(distances) <= 0.0)
    assert distances[2:5] == pytest.approx([distances[1] / 1e3, distances[1] / 1e6, distances[1] / 1e9], rel=0.3)
