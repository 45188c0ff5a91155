"""The demonstration of gear trains."""

import pytest
from demos.gear_trains import trains

COARSE = '\n[accuracy]\nsteps_per_mesh_cycle = 40\nflank_element_size = "0.08 mm"\n'


def test_a_pitch_of_the_idler_brings_the_same_again(tmp_path):
    """The idler turned by a tooth is the same idler, but for how far apart on it the two meshes are. Between, both
    meshes change pairs at other times, and their transmission errors add up to another span."""
    text = (trains.HERE / "idler.toml").read_text() + COARSE
    directions = trains.angles(31, 5)
    errors = trains.over_angles(tmp_path, text, directions)
    assert errors[0] == pytest.approx(errors[-1], rel=1e-3)
    assert max(errors) > 1.3 * min(errors)
    assert trains.chart(directions, errors).limits[0] == 0.0
    assert not list(tmp_path.iterdir())
