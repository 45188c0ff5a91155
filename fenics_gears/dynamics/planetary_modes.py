"""Natural frequencies of a planetary set whose members are lumped, sorted by what sun, ring and carrier do in them (Lin
and Parker, J. Vib. Acoust. 121, 1999, 316-321).

Coordinates in mm, in the frame of the carrier: x, y and the arc u of the ring, the carrier and the sun, then of each
planet outwards, along the circle of the planets, and the arc of its rotation. The arc of a gear is that of its base
circle, of the carrier that of the circle of the planets. Terms of the carrier's rotation are left out.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, pi, sin

import numpy as np
from scipy.linalg import block_diag

from .frequencies import modes_within

# What sun, ring and carrier do: only turn, only move aside, nothing, or both.
ROTATIONAL = "rotational"
TRANSLATIONAL = "translational"
PLANET = "planet"
MIXED = "mixed"
OF_A_MEMBER = 3
RING_AT, CARRIER_AT, SUN_AT, PLANETS_AT = (OF_A_MEMBER * each for each in range(4))
# Amplitudes below this part of the largest are none; eigenvalues of the projection below this are not in it.
NO_AMPLITUDE = 1e-6
IN_IT = 0.5


@dataclass(frozen=True)
class LumpedMember:
    """A member: `mass`, N s^2/mm, and `rotary_mass`, N s^2/mm: its moment of inertia over the square of the radius of
    its arc. Its springs, N/mm: `support` of the centre in all directions, None where that is held, of a planet none;
    `torsion` of the arc, None where it is held."""

    mass: float
    rotary_mass: float
    support: float | None = 0.0
    torsion: float | None = 0.0

    @property
    def masses(self) -> list[float]:
        return [self.mass, self.mass, self.rotary_mass]

    @property
    def springs(self) -> list[float]:
        """Of its three coordinates, zero where they are held."""
        return [self.support or 0.0, self.support or 0.0, self.torsion or 0.0]

    @property
    def held(self) -> list[bool]:
        return [self.support is None, self.support is None, self.torsion is None]


@dataclass(frozen=True)
class LumpedSet:
    """A planetary set of lumped members. `angles`, rad: directions of the planets; `pressure_angles`, rad, and
    `mesh_stiffness`, N/mm: of the meshes with the sun and with the ring; `pin_stiffness`, N/mm, in all directions."""

    sun: LumpedMember
    ring: LumpedMember
    carrier: LumpedMember
    planet: LumpedMember
    angles: tuple[float, ...]
    pressure_angles: tuple[float, float]
    mesh_stiffness: tuple[float, float]
    pin_stiffness: float

    @property
    def members(self) -> list[LumpedMember]:
        """Of all coordinates, three of each."""
        return [self.ring, self.carrier, self.sun, *[self.planet] * len(self.angles)]

    @property
    def mass(self) -> np.ndarray:
        """Mass (k, k), N s^2/mm."""
        return np.diag([each for member in self.members for each in member.masses])

    @property
    def stiffness(self) -> np.ndarray:
        """Stiffness (k, k), N/mm: a row of displacements for each spring."""
        found = np.diag([each for member in self.members for each in member.springs])
        for number in range(len(self.angles)):
            pin = self.pin_stiffness
            for row, spring in zip(self._rows(number), (*self.mesh_stiffness, pin, pin)):
                found += spring * np.outer(row, row)
        return found

    def _rows(self, number: int) -> np.ndarray:
        """Extension (4, k) of both meshes and of the pin, outwards and along the circle, of one planet."""
        angle = self.angles[number]
        sun, ring = self.pressure_angles
        own = PLANETS_AT + OF_A_MEMBER * number
        rows = np.zeros((4, PLANETS_AT + OF_A_MEMBER * len(self.angles)))
        rows[0, SUN_AT : SUN_AT + 3] = -sin(angle - sun), cos(angle - sun), 1.0
        rows[0, own : own + 3] = -sin(sun), -cos(sun), 1.0
        rows[1, RING_AT : RING_AT + 3] = -sin(angle + ring), cos(angle + ring), 1.0
        rows[1, own : own + 3] = sin(ring), -cos(ring), -1.0
        rows[2, CARRIER_AT : CARRIER_AT + 2] = cos(angle), sin(angle)
        rows[2, own] = -1.0
        rows[3, CARRIER_AT : CARRIER_AT + 3] = -sin(angle), cos(angle), 1.0
        rows[3, own + 1] = -1.0
        return rows

    @property
    def free(self) -> np.ndarray:
        """Directions (k, f) of the coordinates that are not held."""
        held = np.array([each for member in self.members for each in member.held])
        return np.eye(len(held))[:, ~held]

    @property
    def equally_spaced(self) -> bool:
        count = len(self.angles)
        wanted = [self.angles[0] + 2.0 * pi * number / count for number in range(count)]
        return bool(np.allclose(self.angles, wanted, rtol=0.0, atol=1e-9))


@dataclass(frozen=True)
class SetMode:
    """A natural frequency, Hz, of a set and its kind."""

    frequency: float
    kind: str


def set_modes(lumped: LumpedSet) -> list[SetMode]:
    """All modes of a set, by their frequencies. Planets at one spacing have modes of three kinds, each exactly, also
    where frequencies of two kinds coincide; otherwise the kind is read off each shape.

    >>> members = (LumpedMember(1e-3, 1e-3), LumpedMember(2e-3, 2e-3, 1e5, None), LumpedMember(5e-3, 5e-3))
    >>> angles = tuple(2.0 * pi * number / 4 for number in range(4))
    >>> found = set_modes(LumpedSet(*members, LumpedMember(1e-3, 1e-3), angles, (0.4, 0.4), (5e5, 5e5), 1e5))
    >>> [sum(each.kind == kind for each in found) for kind in (ROTATIONAL, TRANSLATIONAL, PLANET)]
    [5, 12, 3]
    """
    matrices = lumped.stiffness, lumped.mass
    if lumped.equally_spaced:
        parts = [(kind, basis) for kind, basis in _by_symmetry(lumped) if basis.shape[1]]
        found = [SetMode(each, kind) for kind, basis in parts for each in modes_within(basis, *matrices)[0].tolist()]
    else:
        frequencies, shapes = modes_within(lumped.free, *matrices)
        found = [SetMode(each, _kind_of(shape)) for each, shape in zip(frequencies.tolist(), shapes.T)]
    return sorted(found, key=lambda each: each.frequency)


def _by_symmetry(lumped: LumpedSet) -> list[tuple[str, np.ndarray]]:
    """The kinds and bases (k, f) of motions that a turn by one planet's spacing multiplies by exp(2 pi i m/N): m = 0
    rotational, 1 and N - 1 translational, others of the planets."""
    count = len(lumped.angles)
    turn = 2.0 * pi / count
    member = np.array([[cos(turn), -sin(turn), 0.0], [sin(turn), cos(turn), 0.0], [0.0, 0.0, 1.0]])
    planets = np.kron(np.roll(np.eye(count), 1, axis=0), np.eye(OF_A_MEMBER))
    turned = block_diag(member, member, member, planets)
    powers = [np.linalg.matrix_power(turned, power) for power in range(count)]
    found = []
    for harmonic in range(count // 2 + 1):
        both = {harmonic, (count - harmonic) % count}
        weights = [sum(np.exp(-2j * pi * each * power / count) for each in both).real / count for power in range(count)]
        projection = sum(weight * power for weight, power in zip(weights, powers))
        within = lumped.free.T @ projection @ lumped.free
        values, vectors = np.linalg.eigh(0.5 * (within + within.T))
        kind = ROTATIONAL if harmonic == 0 else TRANSLATIONAL if harmonic == 1 else PLANET
        found.append((kind, lumped.free @ vectors[:, values > IN_IT]))
    return found


def _kind_of(shape: np.ndarray) -> str:
    """The kind of one shape (k,)."""
    members = np.abs(shape[:PLANETS_AT].reshape(-1, OF_A_MEMBER)).max(axis=0)
    least = NO_AMPLITUDE * np.abs(shape).max()
    aside = bool(members[:2].max() > least)
    turns = bool(members[2] > least)
    return {(False, True): ROTATIONAL, (True, False): TRANSLATIONAL, (False, False): PLANET, (True, True): MIXED}[
        aside, turns
    ]
