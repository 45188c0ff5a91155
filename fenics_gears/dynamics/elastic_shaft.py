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
from functools import cached_property
from math import inf
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from .beam import MASS_POINTS, beam_flexibility, properties

if TYPE_CHECKING:
    from fenics_gears.effects.bearings import Bearing
    from fenics_gears.effects.shafts import ShaftSection
    from fenics_gears.inputs.allowed import Matrix

    from .drivetrain import Drivetrain
    from .elastic_shaft_hub import Hub

# Names of the coordinates of a gear's middle, without its number; and the gears' numbers.
MOTIONS = ("centre_x", "centre_y", "axial_", "tilt_x", "tilt_y")
NUMBERS = {"pinion": "1", "wheel": "2"}
# The same of a place of the shaft.
AXES = ("x", "y", "z", "tilt_x", "tilt_y")
# mm/N that a place moves at least whose motions are coordinates: beside the seat it does as little as does not count.
LEAST_YIELDING = 1e-12
# Part of the largest stiffness, tilts taken over the shaft's length, below which a motion is free.
LEAST_HELD = 1e-12


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
    and the bearings; `integral`: whether the gear is cut into the shaft, of which `sections` then have its root
    diameter within the face, where it gives way as `elastic_shaft_seat` says; `hub`: with what it does so otherwise;
    `housing`: stiffness between the bearings' seats (5 b, 5 b), N, mm and rad, None where it is rigid. Of a shaft that
    vibrates: the sections by which it is `heavy`, where not those by which it bends, its `density`, N s^2/mm^4, and the
    frequency `up_to` which it has modes of its own, Hz.
    """

    gear: str
    sections: tuple[ShaftSection, ...]
    material: tuple[float, float]
    gear_at: float
    seat: float
    torque_at: float
    bearings: tuple[Bearing, ...]
    integral: bool = False
    housing: Matrix | None = None
    heavy: tuple[ShaftSection, ...] | None = None
    density: float = 0.0
    up_to: float = inf
    hub: Hub | None = None

    @property
    def yields_within(self) -> bool:
        """Whether flanks give way by what does so under the face."""
        return self.integral or self.hub is not None

    @property
    def length(self) -> float:
        """Length of the shaft, mm."""
        return sum(each.length for each in self.sections)

    @property
    def rolling(self) -> tuple[int, ...]:
        """Numbers of the rolling bearings, in which the shaft's motions are coordinates: their law is one of motions
        there."""
        return tuple(number for number, each in enumerate(self.bearings) if each.rolling is not None)

    @property
    def in_rolling(self) -> tuple[str, ...]:
        """Names of these coordinates."""
        return tuple(f"bearing_{axis}_{number + 1}_{self.gear}" for number in self.rolling for axis in AXES)

    @property
    def modes(self) -> tuple[str, ...]:
        """Names of the coordinates that contact does not move."""
        return self.in_rolling

    @property
    def mass_of_all(self) -> float:
        """Mass of the whole shaft, N s^2/mm."""
        along = properties(self.heavy or self.sections, self.material, (), MASS_POINTS)
        return self.density * float(along.weights @ (1.0 / along.axial)) / self.material[0]

    @property
    def coordinates(self) -> tuple[str, ...]:
        """Names of the coordinates that the shaft's bending and its bearings act on."""
        return (*(f"{name}{NUMBERS[self.gear]}" for name in MOTIONS), *self.modes)

    @property
    def seat_ends(self) -> tuple[float, float]:
        """Where the gear's face begins and ends, mm from the left end of the shaft."""
        return self.gear_at - 0.5 * self.seat, self.gear_at + 0.5 * self.seat

    def flexibility(self, places: Sequence[float], loaded: Sequence[float]) -> np.ndarray:
        """Motions (p, 5, l, 5) of places on the axis per load at the `loaded` ones, with the gear held."""
        along = properties(self.sections, self.material, {*places, *loaded, *self.seat_ends})
        return beam_flexibility(along, places, loaded, self.seat_ends)[:, : len(MOTIONS), :, : len(MOTIONS)]

    @cached_property
    def torsional_stiffness(self) -> float:
        """Of the shaft between gear and coupling, N mm/rad; infinite where the torque is coupled within the seat."""
        along = properties(self.sections, self.material, {*self.seat_ends, self.torque_at})
        twist = beam_flexibility(along, [self.torque_at], [self.torque_at], self.seat_ends)[0, -1, 0, -1]
        return 1.0 / twist if twist else inf

    @property
    def at_bearings(self) -> np.ndarray:
        """Motions (5 b, k) of the shaft in its bearings per coordinate."""
        return self._held.motions

    @cached_property
    def bearings_at_rest(self) -> np.ndarray:
        """Motions (5 b, 5) of the shaft in its bearings per motion of the gear, at rest."""
        yielding = self.held_flexibility @ self.springs
        return np.linalg.solve(np.eye(len(yielding)) + yielding, self.rigid_motions)

    @cached_property
    def held_flexibility(self) -> np.ndarray:
        """Motions (5 b, 5 b) of the shaft in its bearings per load on it there, with the gear held."""
        places = [each.at for each in self.bearings]
        return self.flexibility(places, places).reshape((len(MOTIONS) * len(places),) * 2)

    @property
    def rigid_motions(self) -> np.ndarray:
        """Motions (5 b, 5) of a rigid shaft in its bearings per motion of the gear."""
        return self._rigid([each.at for each in self.bearings])

    @cached_property
    def bearing_loads(self) -> np.ndarray:
        """Loads (5 b, k) of the shaft on its bearings per coordinate."""
        return self.springs @ self.at_bearings

    @cached_property
    def stiffness(self) -> np.ndarray:
        """Of shaft and bearings at the gear's middle (5, 5): loads of the gear on its shaft per motion."""
        return self.stiffness_beside(-1.0) + self.stiffness_beside(1.0)

    def stiffness_beside(self, side: float) -> np.ndarray:
        """The part (5, 5) of the stiffness at the gear's middle that is left (-1) or right (1) of the gear: neither
        gives way by what is on the other side."""
        own = [each.at for each in self.bearings if (each.at >= self.gear_at) == (side > 0.0)]
        rows = np.repeat([each.at in own for each in self.bearings], len(MOTIONS))
        found = self._rigid(own).T @ self._loads_at_rest[rows]
        return 0.5 * (found + found.T)

    @cached_property
    def bearing_stiffness(self) -> np.ndarray:
        """The part (k, k) of the stiffness whose energy is in the bearings."""
        return self.at_bearings.T @ self.bearing_loads

    def deflection(self, places: Sequence[float]) -> np.ndarray:
        """Motions (p, 5, k) of places on the axis (mm from the left end) per coordinate."""
        flexible = self.flexibility(places, [each.at for each in self.bearings])
        moved = -flexible.reshape(len(MOTIONS) * len(places), -1) @ self._held.loads
        moved[:, : len(MOTIONS)] += self._rigid(places)
        return moved.reshape(len(places), len(MOTIONS), -1)

    def motions(self, drivetrain: Drivetrain, states: np.ndarray) -> np.ndarray:
        """The shaft's coordinates (..., c) at states (..., k) of the drivetrain."""
        return np.stack([drivetrain.value(states, name) for name in self.coordinates], axis=-1)

    def add_to(self, stiffness: np.ndarray, names: Sequence[str], part: np.ndarray) -> None:
        """Add a part (c, c) of the stiffness to that of a drivetrain, in N, mm and rad, over coordinates of such
        names."""
        places = [names.index(name) for name in self.coordinates]
        stiffness[np.ix_(places, places)] += part

    @property
    def own_stiffness(self) -> np.ndarray:
        """Of shaft and bearings over the coordinates (k, k)."""
        if not self.rolling:
            return self.stiffness
        rows = self._rows_of_rolling
        loads = self.rigid_motions.T @ self._held.loads
        found = np.concatenate([loads, -self._held.loads[rows]])
        found = 0.5 * (found + found.T)
        found[len(MOTIONS) :, len(MOTIONS) :] += self.springs[np.ix_(rows, rows)]
        return found

    @cached_property
    def _held(self) -> Held:
        """The shaft at rest over MOTIONS of the gear and the motions in rolling bearings."""
        if not self.rolling:
            return Held(self.bearings_at_rest, self._loads_at_rest)
        rows, springs, flexible = self._rows_of_rolling, self.fixed_springs, self.held_flexibility
        yielding = np.linalg.solve(
            np.eye(len(flexible)) + flexible @ springs, np.concatenate([self.rigid_motions, flexible], axis=1)
        )
        followed = yielding[:, : len(MOTIONS)]
        pushed = yielding[:, len(MOTIONS) :][:, rows]
        own = pushed[rows]
        own = own + np.diag(np.maximum(LEAST_YIELDING - np.diag(own), 0.0))
        forces = np.linalg.solve(own, np.concatenate([-followed[rows], np.eye(len(rows))], axis=1))
        motions = np.pad(followed, ((0, 0), (0, len(rows)))) + pushed @ forces
        motions[rows] = np.eye(len(rows), motions.shape[1], len(MOTIONS))
        loads = springs @ motions
        loads[rows] -= forces
        return Held(motions, loads)

    @property
    def _rows_of_rolling(self) -> np.ndarray:
        return (len(MOTIONS) * np.array(self.rolling, dtype=int)[:, None] + np.arange(len(MOTIONS))).ravel()

    @cached_property
    def fixed_springs(self) -> np.ndarray:
        """Stiffness (5 b, 5 b) of the bearings that have one whatever their load."""
        found = self.springs.copy()
        found[self._rows_of_rolling] = found[:, self._rows_of_rolling] = 0.0
        return found

    @cached_property
    def _loads_at_rest(self) -> np.ndarray:
        """Loads (5 b, 5) of the shaft on its bearings per motion of the gear, at rest."""
        return self.springs @ self.bearings_at_rest

    @cached_property
    def springs(self) -> np.ndarray:
        """Stiffness (5 b, 5 b) of all bearings in their housing."""
        found = np.zeros((len(MOTIONS) * len(self.bearings),) * 2)
        for number, bearing in enumerate(self.bearings):
            own = slice(len(MOTIONS) * number, len(MOTIONS) * (number + 1))
            found[own, own] = bearing.matrix
        return found if self.housing is None else in_series(found, np.array(self.housing))

    def _rigid(self, places: Iterable[float]) -> np.ndarray:
        """Motions (5 p, 5) of places on a rigid axis per motion of the gear."""
        return np.concatenate([np.empty((0, len(MOTIONS))), *(carried(at - self.gear_at) for at in places)])


class Held(NamedTuple):
    """Motions (5 b, k) of a shaft at rest in its bearings per coordinate, and its loads (5 b, k) on them."""

    motions: np.ndarray
    loads: np.ndarray


def in_series(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """Stiffness (n, n) of two springs one behind the other, A (A + B)^-1 B; what neither holds is free.

    No difference of large numbers is taken: it is right however much stiffer one is. W. N. Anderson and R. J. Duffin,
    Series and parallel addition of matrices, Journal of Mathematical Analysis and Applications 26 (1969).
    """
    size = np.sqrt(np.diag(first) + np.diag(second))
    size = np.outer(*2 * [np.where(size > 0.0, size, 1.0)])
    found = first @ (np.linalg.pinv((first + second) / size, hermitian=True) / size) @ second
    return 0.5 * (found + found.T)


def free_motions(shaft: ElasticShaft) -> list[str]:
    """The motions, in words, that a shaft's bearings leave free."""
    middle = sum(each.at for each in shaft.bearings) / len(shaft.bearings)
    scale = np.diag([1.0, 1.0, 1.0, 1.0 / shaft.length, 1.0 / shaft.length])
    moved = np.concatenate([carried(each.at - middle) @ scale for each in shaft.bearings])
    held = moved.T @ shaft.springs @ moved
    values, vectors = np.linalg.eigh(held)
    free = vectors[:, values <= LEAST_HELD * max(values[-1], 0.0)]
    words = ("moves along x", "moves along y", "moves along its axis", "tilts about x", "tilts about y")
    return [word for word, part in zip(words, np.linalg.norm(free, axis=1)) if part > 0.1]
