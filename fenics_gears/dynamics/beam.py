"""Timoshenko beams of round sections as elements of a shaft: their flexibility by virtual forces, exact also where the
section changes within, and their mass."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cache
from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from .shaft_elements import SIX, Element, Flexible, carried, motions_of

if TYPE_CHECKING:
    from .shafts import ShaftSection

# Gauss points between two places of a shaft: exact for the polynomials of a cylinder, and for a cone, whose section is
# in the denominator: its flexibility is right to 1e-9 while its wall is nowhere more than ten times the thinnest.
OF_CYLINDER = 2
OF_CONE = 30
STEEPEST_CONE = 10.0
# The same of a shaft's mass within an element, exact for both.
MASS_POINTS = 5

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
    parts = []
    begin = 0.0
    stops = sorted(stops)
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
    area = np.pi / 4.0 * (outer**2 - bore**2)
    second = np.pi / 64.0 * (outer**4 - bore**4)
    shear_modulus = modulus / (2.0 * (1.0 + ratio))
    shear_area = shear_coefficient(ratio, bore / outer) * area
    return Properties(
        places, weights, 1.0 / (shear_modulus * shear_area), 1.0 / (modulus * area), 1.0 / (modulus * second),
        1.0 / (shear_modulus * 2.0 * second),
    )  # fmt: skip


def flexibilities(along: Properties, ends: np.ndarray) -> np.ndarray:
    """Motions (n - 1, 6, 6) of the right end of each piece of a beam between `ends` (n,) per load there, its left end
    held."""
    own = np.searchsorted(ends, along.places) - 1
    inside = (own >= 0) & (own < len(ends) - 1)
    own = own[inside]
    arms = ends[own + 1] - along.places[inside]

    def summed(per_length: np.ndarray, power: int = 0) -> np.ndarray:
        return np.bincount(own, (along.weights * per_length)[inside] * arms**power, minlength=len(ends) - 1)

    flexibility = np.zeros((len(ends) - 1, SIX, SIX))
    flexibility[:, 0, 0] = flexibility[:, 1, 1] = summed(along.shear) + summed(along.bending, 2)
    flexibility[:, 0, 4] = flexibility[:, 4, 0] = summed(along.bending, 1)
    # A positive tilt about x moves what lies further along the axis to negative y.
    flexibility[:, 1, 3] = flexibility[:, 3, 1] = -flexibility[:, 0, 4]
    flexibility[:, 3, 3] = flexibility[:, 4, 4] = summed(along.bending)
    flexibility[:, 2, 2] = summed(along.axial)
    flexibility[:, 5, 5] = summed(along.torsion)
    return flexibility


@dataclass(frozen=True, eq=False)
class Beam(Element):
    """A piece of a shaft between two nodes, `length` mm apart: the `flexibility` (6, 6) of its right end with the left
    one held; its `mass` (12, 12), where it has one."""

    motions: tuple[str, ...]
    length: float
    flexibility: np.ndarray
    mass: np.ndarray | float = 0.0  # type: ignore[assignment]

    @property
    def stiffness(self) -> np.ndarray:
        return self.flexible.rows.T @ np.linalg.solve(self.flexibility, self.flexible.rows)

    @property
    def flexible(self) -> Flexible:
        return Flexible(np.concatenate([-carried(self.length), np.eye(SIX)], axis=1), self.flexibility)


def beams(shaft: str, nodes: Sequence[int], ends: np.ndarray, along: Properties, masses: Sequence = ()) -> list[Beam]:
    """The beams of a shaft between neighbouring nodes of such numbers, at `ends` (n,), mm; their `masses`."""
    pieces = []
    for number, flexibility in enumerate(flexibilities(along, ends)):
        motions = (*motions_of(shaft, nodes[number]), *motions_of(shaft, nodes[number + 1]))
        mass = masses[number] if len(masses) else 0.0
        pieces.append(Beam(motions, float(ends[number + 1] - ends[number]), flexibility, mass))
    return pieces


def masses(light: Properties, heavy: Properties, ends: np.ndarray, density: float) -> np.ndarray:
    """Consistent mass (n - 1, 12, 12), N, mm, s and rad, of the pieces of a beam between `ends` (n,), each with
    MASS_POINTS points: it bends as a `light` beam and has the area of a `heavy` one. `density`: over Young's modulus,
    s^2/mm^2."""
    lengths = np.diff(ends)
    shear, bending, weights = (of.reshape(-1, MASS_POINTS) for of in (light.shear, light.bending, heavy.weights))
    area, second = (1.0 / of.reshape(-1, MASS_POINTS) for of in (heavy.axial, heavy.bending))
    inertia = density * weights[..., None] * np.stack([area, area, area, second, second, 2.0 * second], axis=2)
    within = (light.places.reshape(-1, MASS_POINTS) - ends[:-1, None]) / lengths[:, None]
    give = 12.0 * shear.mean(axis=1) / (bending.mean(axis=1) * lengths**2)
    shape = motion_within(within, lengths[:, None], give[:, None])
    return np.einsum("eqi,eqia,eqib->eab", inertia, shape, shape, optimize=True)


def motion_within(within: np.ndarray, length: np.ndarray, give: np.ndarray) -> np.ndarray:
    """Motions (e, q, 6, 12) at points of elements per motion of both ends, at rest: points (e, q) in parts of the
    `length` (e, 1), which gives way to shear `give` (e, 1) times as much as to bending.

    J. S. Przemieniecki, Theory of Matrix Structural Analysis (1968), section 11.
    """
    x = within
    whole = 1.0 + give
    moved = np.stack([
        1.0 - 3.0 * x**2 + 2.0 * x**3 + give * (1.0 - x), length * (x - 2.0 * x**2 + x**3 + 0.5 * give * (x - x**2)),
        3.0 * x**2 - 2.0 * x**3 + give * x, length * (x**3 - x**2 - 0.5 * give * (x - x**2)),
    ]) / whole  # fmt: skip
    turned = np.stack([
        6.0 * (x**2 - x) / length, 1.0 - 4.0 * x + 3.0 * x**2 + give * (1.0 - x),
        6.0 * (x - x**2) / length, 3.0 * x**2 - 2.0 * x + give * x,
    ]) / whole  # fmt: skip
    motions = np.zeros((SIX, 2 * SIX, *x.shape))
    motions[0, [0, 4, 6, 10]] = moved
    motions[4, [0, 4, 6, 10]] = turned
    # A positive tilt about x moves what lies further along the axis to negative y.
    sense = np.array([1.0, -1.0, 1.0, -1.0])[:, None, None]
    motions[1, [1, 3, 7, 9]] = sense * moved
    motions[3, [1, 3, 7, 9]] = -sense * turned
    for motion in (2, 5):
        motions[motion, motion] = 1.0 - x
        motions[motion, motion + SIX] = x
    return np.moveaxis(motions, (0, 1), (2, 3))
