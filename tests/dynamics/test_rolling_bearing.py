"""Rolling bearings."""

import numpy as np
import pytest
from scipy.optimize import root

from fenics_gears.dynamics.bearings import RollingBearing
from fenics_gears.dynamics.rolling_bearing import reaction, secant_stiffness


def deep_groove(clearance):
    return RollingBearing(number=7, diameter=11.5, pitch_diameter=43.5, clearance=clearance)


def displaced(rolling, load, free):
    def left(motion):
        whole = np.zeros(5)
        whole[free] = motion
        return (reaction(rolling, whole).loads - load)[free]

    found = np.zeros(5)
    found[free] = root(left, np.array([0.03, 0.0, 0.15, 0.0, 0.001])[free], tol=1e-12).x
    return found


@pytest.mark.parametrize(
    ("clearance", "direction", "um"),
    [(0.0, 0, 15.1101), (0.01, 0, 21.223), (0.0, 2, 133.5381), (0.01, 2, 149.1717)],
    ids=["radial", "radial with clearance", "axial", "axial with clearance"],
)
def test_a_deep_groove_bearing_gives_way_as_in_masta(clearance, direction, um):
    """MASTA's bearing 6305 under 1 kN, as printed in the tests of the public repository minzhun/ISO16281, to all
    digits."""
    found = displaced(deep_groove(clearance), 1000.0 * np.eye(5)[direction], [direction])
    assert 1e3 * found[direction] == pytest.approx(um, rel=2e-5)


def test_radial_axial_and_tilting_together_are_as_in_masta():
    """As above. Its moment has the lever arm of the balls' middles, as ISO/TS 16281; here that of the grooves, so
    that loads follow from an energy: 1 % of the tilt."""
    x, _, z, _, tilt = 1e3 * displaced(deep_groove(0.01), np.array([1000.0, 0.0, 1000.0, 0.0, 0.0]), [0, 2, 4])
    assert (x, z) == (pytest.approx(19.5923, rel=1e-4), pytest.approx(146.4603, rel=1e-4))
    assert tilt == pytest.approx(2.6872, rel=0.012)


@pytest.mark.parametrize(
    ("rolling", "integral"),
    [
        (RollingBearing(number=400, diameter=0.1, pitch_diameter=100.0), 0.2288),
        (RollingBearing(elements="rollers", number=400, diameter=0.1, pitch_diameter=100.0, length=5.0), 0.2453),
    ],
    ids=["balls", "rollers"],
)
def test_half_of_many_rolling_elements_carry_as_sjovall_has_it(rolling, integral):
    """Sjovall's integral J_r(1/2) (T. A. Harris, Rolling Bearing Analysis, table 7.1): F_r = Z Q_max J_r."""
    found = reaction(rolling, np.array([5e-4, 0.0, 0.0, 0.0, 0.0]))
    assert found.loads[0] / (rolling.number * found.largest) == pytest.approx(integral, rel=3e-3)


BEARINGS = {
    "balls": RollingBearing(
        number=9, diameter=12.7, pitch_diameter=65.0, contact_angle=0.3, preload=500.0, clearance=0.01
    ),
    "tapered rollers": RollingBearing(
        elements="rollers", number=14, diameter=9.0, pitch_diameter=63.5, length=13.6, contact_angle=-0.2, preload=300.0
    ),
    "long rollers": RollingBearing(elements="rollers", number=14, diameter=9.0, pitch_diameter=63.5, length=33.6),
}


@pytest.mark.parametrize("rolling", BEARINGS.values(), ids=BEARINGS)
def test_stiffness_is_the_derivative_of_loads_and_the_secant_gives_them(rolling):
    """Central differences, also of the energy; K_s u = F, symmetric, never negative."""
    motion, small = np.array([0.03, 0.01, 0.02, 1e-3, 5e-4]), np.array([1e-6, 1e-6, 1e-6, 1e-8, 1e-8])
    found = reaction(rolling, motion)
    differences = [
        (reaction(rolling, motion + step).loads - reaction(rolling, motion - step).loads) / (2.0 * step.sum())
        for step in np.diag(small)
    ]
    works = [
        (reaction(rolling, motion + step).energy - reaction(rolling, motion - step).energy) / (2.0 * step.sum())
        for step in np.diag(small)
    ]
    assert np.abs(works - found.loads).max() < 1e-7 * np.abs(found.loads).max()
    size = np.sqrt(np.maximum(np.diag(found.stiffness), 1.0))
    assert np.abs(np.stack(differences, axis=1) - found.stiffness).max() < 1e-8 * np.abs(found.stiffness).max()
    secant = secant_stiffness(rolling, motion)
    assert np.abs(secant @ motion - found.loads).max() < 1e-13 * np.abs(found.loads).max()
    assert np.linalg.eigvalsh(secant / np.outer(size, size))[0] > -1e-12
    assert np.abs(reaction(rolling, np.zeros(5)).loads).max() < 1e-9
