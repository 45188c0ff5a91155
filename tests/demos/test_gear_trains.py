"""The demonstration of gear trains."""

import pytest
from demos.gear_trains import trains

COARSE = '\n[accuracy]\nsteps_per_mesh_cycle = 40\nflank_element_size = "0.08 mm"\n'


@pytest.mark.nightly
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


@pytest.mark.nightly
def test_clocking_moves_the_share_evenly(tmp_path):
    """Two paths side by side are two springs: ahead and back by the same angle the share is as far above and below a
    half, whatever the phases of the meshes are."""
    text = (trains.HERE / "split_torque.toml").read_text().replace("steps_per_mesh_cycle = 50", "")
    text += 'steps_per_mesh_cycle = 20\nflank_element_size = "0.15 mm"\n'
    back, middle, ahead = trains.over_clockings(text, (-2.0, 0.0, 2.0))
    assert middle == pytest.approx(50.0, abs=0.1)
    assert ahead - 50.0 == pytest.approx(50.0 - back, rel=1e-2)
    assert ahead > 55.0
    chart = trains.chart_of_clockings((-2.0, 0.0, 2.0), [back, middle, ahead])
    assert [curve.y.sum() for curve in chart.curves] == pytest.approx([150.0, 150.0], abs=0.5)
