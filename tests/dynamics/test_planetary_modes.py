"""Natural frequencies of planetary sets of lumped members."""

from dataclasses import replace
from math import pi, radians, sqrt

import numpy as np
import pytest

from fenics_gears.dynamics.planetary_modes import (
    MIXED,
    PLANET,
    ROTATIONAL,
    TRANSLATIONAL,
    LumpedMember,
    LumpedSet,
    set_modes,
)

# Lin and Parker 1999, tables 1 and 2, with kg in N s^2/mm and N/m in N/mm.
OH_58 = LumpedSet(
    sun=LumpedMember(0.4e-3, 0.39e-3, 1e5),
    ring=LumpedMember(2.35e-3, 3.00e-3, 1e5, 1e6),
    carrier=LumpedMember(5.43e-3, 6.29e-3, 1e5),
    planet=LumpedMember(0.66e-3, 0.61e-3),
    angles=(),
    pressure_angles=(radians(24.6), radians(24.6)),
    mesh_stiffness=(5e5, 5e5),
    pin_stiffness=1e5,
)
# Cooley and Parker 2012, tables 1 and 2.
COOLEY = LumpedSet(
    sun=LumpedMember(3.0e-3, 1.75e-3, 20e3, 20e3),
    ring=LumpedMember(7.64e-3, 8.09e-3, 100e3, 100e3),
    carrier=LumpedMember(12.0e-3, 6.80e-3, 50e3, 100e3),
    planet=LumpedMember(1.86e-3, 1.25e-3),
    angles=(),
    pressure_angles=(radians(20.0), radians(20.0)),
    mesh_stiffness=(100e3, 100e3),
    pin_stiffness=10e3,
)


def spaced(lumped: LumpedSet, count: int) -> LumpedSet:
    return replace(lumped, angles=tuple(2.0 * pi * number / count for number in range(count)))


def of_kind(lumped: LumpedSet, kind: str) -> list[float]:
    return [each.frequency for each in set_modes(lumped) if each.kind == kind]


@pytest.mark.parametrize(
    ("count", "rotational", "translational", "planet"),
    [
        (3, [0, 1475.7, 1930.3, 2658.3, 7462.8, 11775.3], [743.2, 1102.4, 1896.0, 2276.4, 6986.3, 9647.9], []),
        (
            4,
            [0, 1536.6, 1970.6, 2625.7, 7773.6, 13071.1],
            [727.0, 1091.0, 1892.8, 2342.5, 7189.9, 10437.6],
            [1808.2, 5963.8, 6981.7],
        ),
    ],
)
def test_frequencies_of_lin_and_parker(count, rotational, translational, planet):
    """Printed in J. Vib. Acoust. 121 (1999), table 2: single, double and N - 3 fold, within 4e-4 of themselves."""
    lumped = spaced(OH_58, count)
    assert of_kind(lumped, ROTATIONAL) == pytest.approx(rotational, rel=4e-4, abs=0.01)
    assert of_kind(lumped, TRANSLATIONAL) == pytest.approx(np.repeat(translational, 2).tolist(), rel=4e-4)
    assert of_kind(lumped, PLANET) == pytest.approx(np.repeat(planet, max(count - 3, 0)).tolist(), rel=1e-4)


def test_frequencies_of_cooley_and_parker():
    """Printed in J. Vib. Acoust. 134 (2012), table 2, four planets, over that of a planet on its pin."""
    lumped = spaced(COOLEY, 4)
    unit = sqrt(lumped.pin_stiffness / lumped.planet.mass) / (2.0 * pi)
    assert unit == pytest.approx(369.0, abs=0.05)
    printed = {
        ROTATIONAL: [0.9077, 1.046, 1.317, 2.013, 5.809, 8.383],
        TRANSLATIONAL: np.repeat([0.7199, 1.001, 1.317, 1.481, 5.153, 6.488], 2).tolist(),
        PLANET: [0.9617, 4.320, 5.672],
    }
    for kind, wanted in printed.items():
        assert np.array(of_kind(lumped, kind)) / unit == pytest.approx(wanted, rel=5e-4)


@pytest.mark.parametrize("count", [3, 5, 8])
def test_how_many_modes_are_of_each_kind(count):
    """Six rotational, six double translational and three (N - 3)-fold planet modes, which do not depend on N (Lin and
    Parker 1999)."""
    lumped = spaced(OH_58, count)
    assert len(of_kind(lumped, ROTATIONAL)) == 6
    pairs = np.array(of_kind(lumped, TRANSLATIONAL)).reshape(-1, 2)
    assert len(pairs) == 6
    np.testing.assert_allclose(pairs[:, 0], pairs[:, 1], rtol=1e-9)
    planet = of_kind(lumped, PLANET)
    assert planet == pytest.approx(np.repeat(of_kind(spaced(OH_58, 4), PLANET), count - 3).tolist(), rel=1e-9)


def test_torsion_of_kahraman():
    """Held centres, pins that do not give way and a held ring leave rotations, with the frequencies of Kahraman (Mech.
    Mach. Theory 29, 1994) in closed form: zero, two roots, and (k_r + k_s)/m_p once for each other planet."""
    of_sun, of_ring = 4e5, 6e5
    held = replace(
        spaced(OH_58, 4),
        sun=LumpedMember(0.4e-3, 0.39e-3, None),
        ring=LumpedMember(2.35e-3, 3e-3, None, None),
        carrier=LumpedMember(5.43e-3, 6.29e-3, None),
        # Base circles of sun and planet then touch, and their radii are that of the planets' circle.
        pressure_angles=(0.0, 0.0),
        mesh_stiffness=(of_sun, of_ring),
        pin_stiffness=1e12,
    )
    count = 4
    both = of_sun + of_ring
    sun = held.sun.rotary_mass
    planet = held.planet.rotary_mass
    carrier = held.carrier.rotary_mass + count * held.planet.mass
    squares = np.roots(
        [
            planet * carrier * sun,
            -(count * of_sun * planet * carrier + both * carrier * sun + count * both * planet * sun),
            count * of_ring * of_sun * (count * planet + carrier + 4.0 * sun),
        ]
    )
    wanted = [0.0, *np.sort(np.sqrt(squares) / (2.0 * pi)).tolist()]
    # Springs of pins have frequencies far above.
    assert of_kind(held, ROTATIONAL)[:3] == pytest.approx(wanted, rel=1e-5, abs=1.0)
    assert of_kind(held, PLANET)[0] == pytest.approx(sqrt(both / planet) / (2.0 * pi), rel=1e-5)


def test_planets_at_unequal_angles():
    """Without a symmetry modes are mixed, and three planets have none of their own; frequencies are those of the same
    matrices."""
    angles = (0.0, 2.0, 4.1)
    found = set_modes(replace(OH_58, angles=angles))
    assert len(found) == 18
    assert {each.kind for each in found if each.frequency > 1.0} == {MIXED}
    assert [each.frequency for each in found] == sorted(each.frequency for each in found)
