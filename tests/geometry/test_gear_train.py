"""Phases and steps of gears in more than one mesh."""

from math import pi, tan

import pytest
from tests.trains import row

from fenics_gears.errors import GeometryError


def past_the_pitch_point(pair, phase: float) -> float:
    pitch_point = pair.base_radii[0] * tan(pair.operating_pressure_angle)
    return (pair.path_start + phase * pair.base_pitch - pitch_point) / pair.base_pitch


@pytest.mark.parametrize("teeth", [24, 31])
@pytest.mark.parametrize("angle", [-1.5, 0.0, 0.7])
def test_phases_of_an_idler_follow_from_its_tooth_thickness(teeth, angle):
    """Contact of a tooth whose centreline stands at `Theta` is z/(2 pi) (Theta - psi) + z s_w/(4 pi r_w) base pitches
    past the pitch point of a mesh in direction psi, where the gear pushes counter-clockwise (Parker 2000)."""
    train = row([20, teeth, 40], [0, 180.0 / pi * angle], 100)
    first, second = (mesh.pair for mesh in train.meshes)
    idler = second.pinion

    def half_tooth(pair) -> float:
        pressure_angle = pair.operating_pressure_angle
        return idler.tooth_half_angle_at_base - (tan(pressure_angle) - pressure_angle)

    # The idler turns clockwise: pushed in the first mesh, whose phase is the opposite, and pushing in the second.
    centreline = pi - (2.0 * pi / teeth) * past_the_pitch_point(first, 0.0) - half_tooth(first)
    expected = teeth / (2.0 * pi) * (-(centreline - angle) + half_tooth(second))
    found = past_the_pitch_point(second, train.layout.phases[1])
    assert (found - expected + 0.5) % 1.0 == pytest.approx(0.5, abs=1e-12)


def test_an_idler_between_opposite_gears_has_the_parity_of_its_teeth():
    """With teeth half a pitch thick, contact in line, the meshes of an even number of teeth are half a cycle apart at
    the pitch point, those of an odd number together."""
    apart = {}
    for teeth in (30, 31):
        train = row([20, teeth, 40], [0, 0], 100)
        first, second = (mesh.pair for mesh in train.meshes)
        apart[teeth] = past_the_pitch_point(second, train.layout.phases[1]) - past_the_pitch_point(first, 0.0)
    assert apart[30] % 1.0 == pytest.approx(0.5, abs=1e-12)
    assert (apart[31] + 0.5) % 1.0 == pytest.approx(0.5, abs=1e-12)


def test_gears_that_overlap_are_refused():
    """Two tip circles cannot lie in one another."""
    with pytest.raises(GeometryError, match="gears row.1 and row.3 overlap: their centres are.*computed"):
        row([24, 31, 40], [0, 170], 100)
