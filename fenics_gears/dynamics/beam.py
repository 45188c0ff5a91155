"""A Timoshenko beam of round sections: its flexibility along the axis, and between places of a beam that is held.

Motions of a place, and loads there, are those of `elastic_shaft.MOTIONS` and the twist.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import cache
from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from fenics_gears.effects.shafts import ShaftSection

# Gauss points between two places of a shaft: exact for the polynomials of a cylinder, and for a cone, whose section is
# in the denominator: its flexibility is right to 1e-9 while its wall is nowhere more than ten times the thinnest.
OF_CYLINDER, OF_CONE, STEEPEST_CONE = 2, 30, 10.0
# The same of a shaft's mass within an element, exact for both.
MASS_POINTS = 5
SIX = 6  # MOTIONS and the twist

gauss_rule = cache(np.polynomial.legendre.leggauss)


class Properties(NamedTuple):
    """Flexibility per length at points (q,) of a shaft, whose `places` (mm) have the `weights` (mm): to shear (1/N), to
    axial force (1/N), to bending (1/(N mm^2)) and to torsion (1/(N mm^2))."""

    places: np.ndarray
    weights: np.ndarray
    shear: np.ndarray
    axial: np.ndarray
    bending: np.ndarray
    torsion: np.ndarray


def shear_coefficient(poissons_ratio: float, hollowness: np.ndarray) -> np.ndarray:
    """Timoshenko's shear coefficient of a circular section whose bore is so large a part of its diameter.

    G. R. Cowper, The shear coefficient in Timoshenko's beam theory, Journal of Applied Mechanics 33 (1966), table 1.
    """
    squared = hollowness**2
    both = (1.0 + squared) ** 2
    solid = (7.0 + 6.0 * poissons_ratio) * both
    return 6.0 * (1.0 + poissons_ratio) * both / (solid + (20.0 + 12.0 * poissons_ratio) * squared)


def properties(
    sections: Sequence[ShaftSection], material: tuple[float, float], stops: Iterable[float], points_of_each: int = 0
) -> Properties:
    """The flexibility along a shaft of `material` (Young's modulus, N/mm^2, and Poisson's ratio) at the points of a
    Gauss rule between all `stops` (mm, from its left end) and the ends of its sections; of so many points, if given."""
    parts, begin, stops = [], 0.0, sorted(stops)
    for section in sections:
        end = begin + section.length
        points, weights = gauss_rule(points_of_each or (OF_CONE if section.tapered else OF_CYLINDER))
        for left, right in pairwise([begin, *(each for each in stops if begin < each < end), end]):
            half = 0.5 * (right - left)
            places = left + half * (1.0 + points)
            diameters = section.diameter + (section.right_diameter - section.diameter) * (places - begin) / (
                end - begin
            )
            parts.append((places, half * weights, diameters, np.full(len(places), section.bore)))
        begin = end
    places, weights, outer, bore = (np.concatenate(each) for each in zip(*parts))
    modulus, ratio = material
    area, second = np.pi / 4.0 * (outer**2 - bore**2), np.pi / 64.0 * (outer**4 - bore**4)
    shear_modulus = modulus / (2.0 * (1.0 + ratio))
    shear_area = shear_coefficient(ratio, bore / outer) * area
    return Properties(
        places, weights, 1.0 / (shear_modulus * shear_area), 1.0 / (modulus * area), 1.0 / (modulus * second),
        1.0 / (shear_modulus * 2.0 * second),
    )  # fmt: skip


def beam_flexibility(
    along: Properties, places: Sequence[float], loaded: Sequence[float], held: tuple[float, float]
) -> np.ndarray:
    """Motions (p, 6, l, 6) of places per load at others of a shaft that is `held` from one place to another: over
    MOTIONS and the twist. What is beyond the nearer of two places, or on the other side of the hold, does nothing."""
    to_place, to_load = (np.asarray(each, dtype=float)[:, None] - along.places for each in (places, loaded))
    beside = np.where(along.places > held[1], 1.0, np.where(along.places < held[0], -1.0, 0.0))
    first, second = (np.where(arms * beside > 0.0, 1.0, 0.0) for arms in (to_place, to_load))
    first_arm, second_arm = first * to_place, second * to_load

    def summed(of: np.ndarray, left: np.ndarray = first, right: np.ndarray = second) -> np.ndarray:
        return (left * along.weights * of) @ right.T

    found = np.zeros((len(to_place), SIX, len(to_load), SIX))
    found[:, 0, :, 0] = found[:, 1, :, 1] = summed(along.shear) + summed(along.bending, first_arm, second_arm)
    found[:, 0, :, 4] = summed(along.bending, first_arm)
    found[:, 4, :, 0] = summed(along.bending, right=second_arm)
    found[:, 1, :, 3], found[:, 3, :, 1] = -found[:, 0, :, 4], -found[:, 4, :, 0]
    found[:, 2, :, 2], found[:, 5, :, 5] = summed(along.axial), summed(along.torsion)
    found[:, 3, :, 3] = found[:, 4, :, 4] = summed(along.bending)
    return found
