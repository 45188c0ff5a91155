"""Limits that the drivetrain and the load must have (hard case 23), on the paper's pair at a coarse mesh."""

from dataclasses import replace

import pytest
from tests.coarse import coarse_scene, quasi_static

from fenics_gears.scene.data import Motion
from fenics_gears.simulation import simulate


@pytest.fixture(scope="module")
def coarse(paper_scene):
    return coarse_scene(paper_scene)


def test_fast_mesh_leaves_the_gears_where_they_are(coarse):
    """Row 23: at 20 kHz, far above every natural frequency, the gears keep their mean position: nothing rings, nothing separates."""
    result = simulate(replace(coarse, friction=None, motion=Motion(20e3, 30, 2)))
    static = simulate(replace(quasi_static(coarse), friction=None))
    assert result.attrs["peak_to_peak_transmission_error"] < 0.05 * static.attrs["peak_to_peak_transmission_error"]
    assert result.attrs["mean_transmission_error"] == pytest.approx(static.attrs["mean_transmission_error"], rel=0.01)
    assert "lose contact" not in result.attrs["warnings"]
