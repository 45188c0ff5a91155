"""A gear on an elastic shaft: a Timoshenko beam on its bearings, condensed onto the motions of the gear's middle.

The shaft is held where its gear sits, rigid over the gear's width, and either side of it is a cantilever whose
flexibility is integrated along the axis (virtual forces). The bearings' forces are then the only unknowns, so that no
stiffness of a short element stands beside that of a soft bearing: equilibrium holds to round-off whatever both are.

Motions of a place, and loads there, are ordered as MOTIONS: x along and y off the line of action, z along the axis,
tilts about x and y; mm and rad, N and N mm. Torsion does not act on them, since sections are round and bearings let the
shaft turn.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cache, cached_property
from itertools import pairwise
from math import inf
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from fenics_gears.dynamics.drivetrain import Drivetrain
    from fenics_gears.effects.bearings import Bearing
    from fenics_gears.effects.shafts import ShaftSection

# Names of the coordinates of a gear's middle, without its number; and the gears' numbers.
MOTIONS = ("centre_x", "centre_y", "axial_", "tilt_x", "tilt_y")
NUMBERS = {"pinion": "1", "wheel": "2"}
# Gauss points between two places of a shaft: exact for the polynomials of a cylinder, and for a cone, whose section is
# in the denominator: its flexibility is right to 1e-9 while its wall is nowhere more than ten times the thinnest.
OF_CYLINDER, OF_CONE, STEEPEST_CONE = 2, 30, 10.0
# Part of the largest stiffness, tilts taken over the shaft's length, below which a motion is free.
LEAST_HELD = 1e-12

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


def properties(sections: Sequence[ShaftSection], material: tuple[float, float], stops: Iterable[float]) -> Properties:
    """The flexibility along a shaft of `material` (Young's modulus, N/mm^2, and Poisson's ratio) at the points of a
    Gauss rule between all `stops` (mm, from its left end) and the ends of its sections."""
    parts, begin, stops = [], 0.0, sorted(stops)
    for section in sections:
        end = begin + section.length
        points, weights = gauss_rule(OF_CONE if section.tapered else OF_CYLINDER)
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


def carried(distance: float) -> np.ndarray:
    """Motions (5, 5) of a place at a distance (mm) along a rigid axis, per motion of its origin; its transpose takes
    loads back."""
    matrix = np.eye(len(MOTIONS))
    matrix[0, 4], matrix[1, 3] = distance, -distance
    return matrix


@dataclass(frozen=True)
class ElasticShaft:
    """The shaft of the "pinion" or the "wheel": its `sections` of one `material` (Young's modulus, N/mm^2, Poisson's
    ratio), the middle of the gear's seat, mm from the left end, the `seat`'s width, mm, where the torque is coupled,
    and the bearings."""

    gear: str
    sections: tuple[ShaftSection, ...]
    material: tuple[float, float]
    gear_at: float
    seat: float
    torque_at: float
    bearings: tuple[Bearing, ...]

    @property
    def length(self) -> float:
        """Length of the shaft, mm."""
        return sum(each.length for each in self.sections)

    @property
    def coordinates(self) -> tuple[str, ...]:
        """Names of the coordinates that the shaft's bending and its bearings act on."""
        return tuple(f"{name}{NUMBERS[self.gear]}" for name in MOTIONS)

    @property
    def _seat_ends(self) -> tuple[float, float]:
        return self.gear_at - 0.5 * self.seat, self.gear_at + 0.5 * self.seat

    def flexibility(self, places: Sequence[float], loaded: Sequence[float]) -> np.ndarray:
        """Motions (p, 5, l, 5) of places on the axis per load at the `loaded` ones, with the gear held."""
        along = properties(self.sections, self.material, {*places, *loaded, *self._seat_ends})
        found = np.zeros((len(places), len(MOTIONS), len(loaded), len(MOTIONS)))
        for place, at in enumerate(places):
            for load, from_load in enumerate(loaded):
                found[place, :, load] = _summed(self._between(along, at, from_load), at, from_load)
        return found

    @cached_property
    def torsional_stiffness(self) -> float:
        """Of the shaft between gear and coupling, N mm/rad; infinite where the torque is coupled within the seat."""
        whole = properties(self.sections, self.material, {*self._seat_ends, self.torque_at})
        along = self._between(whole, self.torque_at, self.torque_at)
        return 1.0 / float(along.weights @ along.torsion) if len(along.weights) else inf

    @cached_property
    def at_bearings(self) -> np.ndarray:
        """Motions (5 b, 5) of the shaft in its bearings per motion of the gear."""
        places = [each.at for each in self.bearings]
        size = len(MOTIONS) * len(places)
        yielding = self.flexibility(places, places).reshape(size, size) @ self._springs
        return np.linalg.solve(np.eye(size) + yielding, self._rigid(places))

    @cached_property
    def bearing_loads(self) -> np.ndarray:
        """Loads (5 b, 5) of the shaft on its bearings per motion of the gear."""
        return self._springs @ self.at_bearings

    @cached_property
    def stiffness(self) -> np.ndarray:
        """Of shaft and bearings at the gear's middle (5, 5): loads of the gear on its shaft per motion."""
        found = self._rigid([each.at for each in self.bearings]).T @ self.bearing_loads
        return 0.5 * (found + found.T)

    @cached_property
    def bearing_stiffness(self) -> np.ndarray:
        """The part (5, 5) of the stiffness whose energy is in the bearings."""
        return self.at_bearings.T @ self.bearing_loads

    def deflection(self, places: Sequence[float]) -> np.ndarray:
        """Motions (p, 5, 5) of places on the axis (mm from the left end) per motion of the gear."""
        loaded = [each.at for each in self.bearings]
        size = len(MOTIONS) * len(places)
        yielding = self.flexibility(places, loaded).reshape(size, -1) @ self.bearing_loads
        return (self._rigid(places) - yielding).reshape(len(places), len(MOTIONS), len(MOTIONS))

    def motions(self, drivetrain: Drivetrain, states: np.ndarray) -> np.ndarray:
        """Motions (..., 5) of the gear's middle at states (..., k) of the drivetrain."""
        return np.stack([drivetrain.value(states, name) for name in self.coordinates], axis=-1)

    def add_to(self, stiffness: np.ndarray, names: Sequence[str], part: np.ndarray) -> None:
        """Add a part (5, 5) of the stiffness to that of a drivetrain, in N, mm and rad, over coordinates of such
        names."""
        places = [names.index(name) for name in self.coordinates]
        stiffness[np.ix_(places, places)] += part

    def _between(self, along: Properties, place: float, other: float) -> Properties:
        """What of a shaft is between the seat and the nearer of two places; nothing where they are not on one side."""
        left, right = self._seat_ends
        low, high = (right, min(place, other)) if place > right else (max(place, other), left)
        between = (along.places > low) & (along.places < high)
        return Properties(*(each[between] for each in along))

    @property
    def _springs(self) -> np.ndarray:
        """Stiffness (5 b, 5 b) of all bearings."""
        size = len(MOTIONS)
        found = np.zeros((size * len(self.bearings),) * 2)
        for number, bearing in enumerate(self.bearings):
            own = slice(size * number, size * (number + 1))
            found[own, own] = bearing.matrix
        return found

    def _rigid(self, places: Iterable[float]) -> np.ndarray:
        """Motions (5 p, 5) of places on a rigid axis per motion of the gear."""
        return np.concatenate([carried(at - self.gear_at) for at in places])


def _summed(along: Properties, at: float, from_load: float) -> np.ndarray:
    """Motions (5, 5) of a place per load at another one, by what gives way between the seat and the nearer one."""
    to_place, to_load = at - along.places, from_load - along.places
    bent, first = along.weights * along.bending, along.weights * along.bending * to_place
    turned = bent.sum()
    found = np.diag([0.0, 0.0, along.weights @ along.axial, turned, turned])
    found[0, 0] = found[1, 1] = along.weights @ along.shear + first @ to_load
    found[0, 4] = first.sum()
    found[4, 0] = bent @ to_load
    found[1, 3], found[3, 1] = -found[0, 4], -found[4, 0]
    return found


def free_motions(shaft: ElasticShaft) -> list[str]:
    """The motions, in words, that a shaft's bearings leave free."""
    middle = sum(each.at for each in shaft.bearings) / len(shaft.bearings)
    scale = np.diag([1.0, 1.0, 1.0, 1.0 / shaft.length, 1.0 / shaft.length])
    held = sum(
        scale @ moved.T @ np.array(each.matrix) @ moved @ scale
        for each in shaft.bearings
        for moved in [carried(each.at - middle)]
    )
    values, vectors = np.linalg.eigh(held)
    free = vectors[:, values <= LEAST_HELD * max(values[-1], 0.0)]
    words = ("moves along x", "moves along y", "moves along its axis", "tilts about x", "tilts about y")
    return [word for word, part in zip(words, np.linalg.norm(free, axis=1)) if part > 0.1]
