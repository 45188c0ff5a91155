"""Internal gears in trains."""

import pytest
from tests.planets import written_out

from fenics_gears import GearsError


@pytest.mark.parametrize(("angle", "off"), [(180.0, 0.0), (144.0, 0.0), (100.0, 70.0 * 100.0 / 360.0 - 19.0)])
def test_planets_assemble_where_the_teeth_of_sun_and_ring_add_up(angle, off):
    """A planet fits where (z_s + z_r) psi/(2 pi) is whole; else its teeth stand beside those of the ring by what is
    left."""
    angles = [0.0, angle]
    if off == 0.0:
        left = [abs(each) for *_, each in written_out((17, 18, 53), angles).layout.not_closed()]
        assert max(left) < 1e-12
        return
    with pytest.raises(GearsError, match=rf"stand {abs(off - round(off)):.4g} pitches beside"):
        written_out((17, 18, 53), angles)


def test_an_internal_gear_turns_as_its_mate():
    """Counter-clockwise sun, clockwise planets and ring; turns by numbers of teeth."""
    scene = written_out((17, 18, 53), [0.0, 180.0])
    assert list(scene.graph.senses) == [1, -1, -1, -1]
    assert scene.turns == pytest.approx([1.0, 17 / 18, 17 / 18, 17 / 53])


def test_a_ring_of_another_centre_distance_is_refused():
    """Its planets have their centres elsewhere than those of the sun."""
    with pytest.raises(GearsError, match="is at two places"):
        written_out((17, 18, 54), [0.0, 180.0])
