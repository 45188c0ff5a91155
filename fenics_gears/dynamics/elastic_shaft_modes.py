"""An elastic shaft that vibrates: its mass, reduced to the gear's middle, the coupling and its own lowest modes.

R. R. Craig and M. C. C. Bampton, Coupling of substructures for dynamic analyses, AIAA Journal 6 (1968). The shaft moves
as it does at rest under motions of gear and coupling, and by modes in which both are held. Stiffness then falls apart:
that of rest, exact, and of each mode by itself. Mass is consistent: Timoshenko elements between places along the
shaft, whose motions follow from those of both ends as at rest. What is under the gear is rigid. Modes come from the
flexibility of these places, which stiff bearings do not spoil. Gyroscopic moments are left out, as for gears that
tilt.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise
from math import ceil

import numpy as np
from scipy.linalg import block_diag, eigh

from .beam import MASS_POINTS, SIX, beam_flexibility, properties
from .elastic_shaft import MOTIONS, NUMBERS, ElasticShaft

# Elements are no longer than this part of the shaft.
LONGEST_ELEMENT = 1.0 / 60.0
# Places (mm) that are no further apart are one but for round-off.
ROUND_OFF = 1e-9
TWIST, COUPLING = SIX - 1, SIX
KINDS = {"bending": [0, 1, 3, 4], "axial": [2], "torsion": [TWIST]}


@dataclass(frozen=True)
class VibratingShaft(ElasticShaft):
    """An elastic shaft with its own mass and modes.

    Its coordinates are those of the shaft at rest, then its modes, in mm: each has the mass of the shaft.
    """

    @cached_property
    def modes(self) -> tuple[str, ...]:  # type: ignore[override]
        """Names of the coordinates that contact does not move, the shaft's own modes last, by frequency."""
        motion = self._shapes.reshape(len(self._places), SIX, -1)
        energies = motion * (self._mass @ self._shapes).reshape(motion.shape)
        shares = np.array([energies[:, rows].sum(axis=(0, 1)) for rows in KINDS.values()])
        kinds = np.array(list(KINDS))[np.argmax(shares, axis=0)]
        own = (f"{kind}_mode_{number}_{self.gear}" for number, kind in enumerate(kinds.tolist(), 1))
        return (*self.in_rolling, *own)

    @cached_property
    def mass(self) -> np.ndarray:
        """Over MOTIONS, the gear's rotation, the coupling's, and other coordinates (7 + m, 7 + m), N, mm, s and rad;
        zero for a coupling within the seat, which turns with the gear."""
        found = np.concatenate([self._at_rest, self._shapes], axis=1)
        return found.T @ self._mass @ found

    def mass_over(self, names: Sequence[str]) -> np.ndarray:
        """The mass (k, k) over a drivetrain's coordinates of such names, in N, mm, s and rad."""
        moved = self._moved_by(names)
        return moved.T @ self.mass @ moved

    def turned_by_coupling(self, names: Sequence[str]) -> np.ndarray:
        """Momentum (k,) over such coordinates per speed (rad/s) of the prescribed rotation of the whole shaft, as far
        as it is not that of the gear; zero of an output shaft, whose rotation is not prescribed."""
        moved, rigid, free = self._moved_by(names), np.zeros(len(self.mass)), np.zeros(len(names))
        rigid[TWIST] = rigid[COUPLING] = 1.0
        if (rotation := f"rotation_{NUMBERS[self.gear]}") in names:
            free[names.index(rotation)] = 1.0
        return moved.T @ self.mass @ (rigid - moved @ free)

    def _moved_by(self, names: Sequence[str]) -> np.ndarray:
        """Motions (7 + m, k), as of `mass`, per coordinate of such names, in mm and rad: the input shaft's coupling
        turns as prescribed, the output shaft's with the wheel and the twist."""
        found = np.zeros((len(self.mass), len(names)))
        own = [*range(len(MOTIONS)), *range(SIX + 1, len(self.mass))]
        for row, name in zip(own, self.coordinates):
            found[row, names.index(name)] = 1.0
        turning = {f"rotation_{NUMBERS[self.gear]}": [TWIST]}
        if self.gear == "wheel":
            turning = {"rotation_2": [TWIST, COUPLING], "shaft_twist": [COUPLING]}
        for name, rows in turning.items():
            if name in names:
                found[rows, names.index(name)] = 1.0
        return found

    @property
    def own_stiffness(self) -> np.ndarray:
        """Of the coordinates (k, k): at rest, and of each mode."""
        return block_diag(super().own_stiffness, np.diag(self._vibrations[0]))

    @cached_property
    def at_bearings(self) -> np.ndarray:
        """Motions (5 b, k) of the shaft in its bearings per coordinate."""
        nodes = self._nodes([each.at for each in self.bearings])
        own = self._shapes.reshape(len(self._places), SIX, -1)[nodes, : len(MOTIONS)]
        return np.concatenate([super().at_bearings, own.reshape(len(MOTIONS) * len(nodes), -1)], axis=1)

    def deflection(self, places) -> np.ndarray:
        """Motions (p, 5, k) of places on the axis (mm from the left end) per coordinate."""
        own = [np.interp(places, self._places, shape) for shape in self._shapes.reshape(len(self._places), -1).T]
        own = np.reshape(own, (SIX, -1, len(places)))[: len(MOTIONS)]
        return np.concatenate([super().deflection(places), np.moveaxis(own, 2, 0)], axis=2)

    @cached_property
    def _places(self) -> np.ndarray:
        """Ends (n,) of the elements, mm from the left end."""
        stops = np.cumsum([0.0, *(each.length for each in self.sections)])
        for place in (*self.seat_ends, self.torque_at, *(each.at for each in self.bearings)):
            if np.abs(stops - place).min() > ROUND_OFF:
                stops = np.sort(np.append(stops, place))
        longest = LONGEST_ELEMENT * self.length
        parts = [np.linspace(a, b, ceil((b - a) / longest) + 1)[:-1] for a, b in pairwise(stops)]
        return np.append(np.concatenate(parts), stops[-1])

    def _nodes(self, places: Sequence[float]) -> np.ndarray:
        """Numbers (p,) of the ends of elements that are at places."""
        return np.abs(self._places - np.reshape(places, (-1, 1))).argmin(axis=1)

    @cached_property
    def _mass(self) -> np.ndarray:
        """Mass (6 n, 6 n) of all elements, over six motions of each place."""
        light, heavy = (
            properties(of, self.material, self._places, MASS_POINTS)
            for of in (self.sections, self.heavy or self.sections)
        )
        modulus, lengths = self.material[0], np.diff(self._places)
        shear, bending, weights = (of.reshape(-1, MASS_POINTS) for of in (light.shear, light.bending, heavy.weights))
        area, second = (1.0 / (modulus * of.reshape(-1, MASS_POINTS)) for of in (heavy.axial, heavy.bending))
        inertia = self.density * weights[..., None] * np.stack([area, area, area, second, second, 2.0 * second], axis=2)
        within = (light.places.reshape(-1, MASS_POINTS) - self._places[:-1, None]) / lengths[:, None]
        give = 12.0 * shear.mean(axis=1) / (bending.mean(axis=1) * lengths**2)
        shape = motion_within(within, lengths[:, None], give[:, None])
        found = np.zeros((SIX * len(self._places),) * 2)
        for number, element in enumerate(np.einsum("eqi,eqia,eqib->eab", inertia, shape, shape, optimize=True)):
            own = slice(SIX * number, SIX * (number + 2))
            found[own, own] += element
        return found

    @cached_property
    def _at_rest(self) -> np.ndarray:
        """Motions (6 n, 7 + r) of all places per motion of the gear, its rotation, the coupling's, and those in rolling
        bearings, at rest."""
        bent = super().deflection(self._places)
        found = np.zeros((len(self._places), SIX, bent.shape[2] + 2))
        found[:, : len(MOTIONS), [*range(len(MOTIONS)), *range(SIX + 1, found.shape[2])]] = bent
        found[:, TWIST, TWIST] = 1.0
        if not self.coupled_within:
            twist = self._flexibility[:, TWIST, :, TWIST]
            number = self._nodes([self.torque_at])[0]
            found[:, TWIST, COUPLING] = twist[:, number] / twist[number, number]
            found[:, TWIST, TWIST] -= found[:, TWIST, COUPLING]
        return found.reshape(SIX * len(self._places), -1)

    @property
    def coupled_within(self) -> bool:
        """Whether the torque is coupled within the gear's seat."""
        return self.seat_ends[0] <= self.torque_at <= self.seat_ends[1]

    @cached_property
    def _flexibility(self) -> np.ndarray:
        """Motions (n, 6, n, 6) of all places per load there, with the gear held and without bearings."""
        along = properties(self.sections, self.material, self._places)
        return beam_flexibility(along, self._places, self._places, self.seat_ends)

    @property
    def _shapes(self) -> np.ndarray:
        """Motions (6 n, m) of all places per mode."""
        return self._vibrations[1]

    @cached_property
    def _vibrations(self) -> tuple[np.ndarray, np.ndarray]:
        """Stiffness (m,), N/mm, and shapes (6 n, m) of the modes with gear, coupling and places in rolling
        bearings held, whose mass is the shaft's."""
        size = SIX * len(self._places)
        nodes = self._nodes([each.at for each in self.bearings])
        held = (SIX * nodes[:, None] + np.arange(len(MOTIONS))).ravel()
        flexible = self._flexibility.reshape(size, size)
        fixed = self.fixed_springs
        springs = np.linalg.solve(np.eye(len(held)) + fixed @ flexible[np.ix_(held, held)], fixed)
        flexible = flexible - flexible[:, held] @ springs @ flexible[held]
        if self.rolling:
            held = held[self._rows_of_rolling]
            held = held[np.diag(flexible)[held] > 0.0]
            flexible = flexible - flexible[:, held] @ np.linalg.solve(flexible[np.ix_(held, held)], flexible[held])
            flexible[held] = flexible[:, held] = 0.0
        if not self.coupled_within:
            coupling = SIX * int(self._nodes([self.torque_at])[0]) + TWIST
            flexible = flexible - np.outer(flexible[coupling], flexible[coupling]) / flexible[coupling, coupling]
            flexible[coupling] = flexible[:, coupling] = 0.0
        free = np.flatnonzero(np.diag(flexible) > 0.0)
        root = np.linalg.cholesky(self._mass[np.ix_(free, free)])
        flexible = root.T @ flexible[np.ix_(free, free)] @ root
        squares, found = eigh(0.5 * (flexible + flexible.T), subset_by_value=((2.0 * np.pi * self.up_to) ** -2, np.inf))
        own, shapes = self.mass_of_all, np.zeros((size, len(squares)))
        shapes[free] = np.sqrt(own) * np.linalg.solve(root.T, found)
        return own / squares[::-1], shapes[:, ::-1]


def add_masses(mass: np.ndarray, names: Sequence[str], shafts: Iterable[ElasticShaft]) -> np.ndarray:
    """Add the mass of shafts to that (k, k) of a drivetrain, in N, mm, s and rad; what their coupling's prescribed
    rotation gives it of momentum (k,), as of `turned_by_coupling`."""
    momentum = np.zeros(len(names))
    for shaft in shafts:
        if isinstance(shaft, VibratingShaft):
            mass += shaft.mass_over(names)
            momentum += shaft.turned_by_coupling(names)
    return momentum


def vibrating(shaft: ElasticShaft, density: float, up_to: float) -> VibratingShaft:
    """A shaft with its density, N s^2/mm^4, and its modes up to a frequency, Hz."""
    return VibratingShaft(**vars(replace(shaft, density=density, up_to=up_to)))


def motion_within(within: np.ndarray, length: np.ndarray, give: np.ndarray) -> np.ndarray:
    """Motions (e, q, 6, 12) at points of elements per motion of both ends, at rest: points (e, q) in parts of the
    `length` (e, 1), which gives way to shear `give` (e, 1) times as much as to bending.

    J. S. Przemieniecki, Theory of Matrix Structural Analysis (1968), section 11.
    """
    x, whole = within, 1.0 + give
    moved = np.stack([
        1.0 - 3.0 * x**2 + 2.0 * x**3 + give * (1.0 - x), length * (x - 2.0 * x**2 + x**3 + 0.5 * give * (x - x**2)),
        3.0 * x**2 - 2.0 * x**3 + give * x, length * (x**3 - x**2 - 0.5 * give * (x - x**2)),
    ]) / whole  # fmt: skip
    turned = np.stack([
        6.0 * (x**2 - x) / length, 1.0 - 4.0 * x + 3.0 * x**2 + give * (1.0 - x),
        6.0 * (x - x**2) / length, 3.0 * x**2 - 2.0 * x + give * x,
    ]) / whole  # fmt: skip
    found = np.zeros((SIX, 2 * SIX, *x.shape))
    found[0, [0, 4, 6, 10]], found[4, [0, 4, 6, 10]] = moved, turned
    # A positive tilt about x moves what lies further along the axis to negative y.
    sense = np.array([1.0, -1.0, 1.0, -1.0])[:, None, None]
    found[1, [1, 3, 7, 9]], found[3, [1, 3, 7, 9]] = sense * moved, -sense * turned
    for motion in (2, TWIST):
        found[motion, motion], found[motion, motion + SIX] = 1.0 - x, x
    return np.moveaxis(found, (0, 1), (2, 3))
