"""Closed forms that the benchmarks over the face compare with."""

from dataclasses import replace
from math import cos, radians

import numpy as np
import pytest
from tests.benchmarks.third_dimension.misaligned import face_load_factor, foundation
from tests.benchmarks.third_dimension.pairs import standard_gear, standard_pair

from fenics_gears.geometry.iso_6336 import single_stiffness

WIDTH, STIFFNESS, MEAN = 24.0, 13e3, 200.0


@pytest.mark.parametrize("misalignment", (5e-3, 0.03, 0.08))
def test_the_foundation_carries_the_load_and_follows_the_misalignment(misalignment):
    """Exact: the springs' loads add up to the force, differ by c f dz/b where they touch, and are the closed form's at most."""
    z = (np.arange(200_000) + 0.5) / 200_000 * WIDTH - 0.5 * WIDTH
    load = foundation(z, WIDTH, STIFFNESS, misalignment, MEAN)
    assert load.mean() == pytest.approx(MEAN, rel=1e-4)
    assert load.max() / MEAN == pytest.approx(face_load_factor(0.5 * STIFFNESS * misalignment / MEAN), rel=1e-4)
    assert np.gradient(load, z)[10] == pytest.approx(-STIFFNESS * misalignment / WIDTH, rel=1e-6)


def test_a_helical_pair_has_the_equivalent_spur_pairs_stiffness_turned_into_the_transverse_plane():
    """Standard: ISO 6336-1, 9.3: z_n = z/cos^3(beta) in the formula of c'th, and c' with cos(beta) (both numbers chosen so that z_n are whole)."""
    angle, (first, second) = radians(60.0), (3, 5)
    helical = standard_pair(WIDTH, angle)
    helical = replace(helical, pinion=standard_gear(first, angle, bore=0.5), wheel=standard_gear(second, angle, bore=0.5))
    spur = replace(helical, helix_angle=0.0, pinion=standard_gear(8 * first, 0.0, bore=0.5), wheel=standard_gear(8 * second, 0.0, bore=0.5))
    theoretical, adjusted = single_stiffness(helical)
    assert theoretical == pytest.approx(single_stiffness(spur)[0])
    assert adjusted == pytest.approx(single_stiffness(spur)[1] * cos(angle))


