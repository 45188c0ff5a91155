"""Elements of shafts over named motions, and their sum: any number of gears and bearings, wherever there is a node.

A motion is named `shaft/node/motion`, the six of a node as MOTIONS: x along and y off the line of action, z along the
axis, tilts about x and y, and the turn about the axis; mm and rad, N and N mm. An element joins motions by its
stiffness K, mass M and damping C. To add a kind, write one class:

    @dataclass(frozen=True)
    class Damper(Element):
        motions: tuple[str, ...]
        viscosity: float

        @property
        def damping(self):
            return self.viscosity * np.eye(len(self.motions))
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from scipy.linalg import block_diag
from scipy.sparse import csc_matrix
from scipy.sparse.linalg import splu

MOTIONS = ("x", "y", "z", "tilt_x", "tilt_y", "turn")
SIX = len(MOTIONS)
# Size of a stiffness (N/mm) and lever arm (mm) of rotations by which equations are made comparable.
STIFFNESS = 1e6
ARM = 30.0
# Part of the largest principal stiffness of a spring below which it holds nothing.
NOTHING = 1e-14


def motions_of(shaft: str, node: str | int) -> tuple[str, ...]:
    """Names (6,) of the motions of a node.

    >>> motions_of("pinion", 3)[0]
    'pinion/3/x'
    """
    return tuple(f"{shaft}/{node}/{motion}" for motion in MOTIONS)


class Flexible(NamedTuple):
    """Deformations (r,), `rows` (r, n) times the motions of an element, per force (r,) in it: `flexibility` (r, r)."""

    rows: np.ndarray
    flexibility: np.ndarray


class Element:
    """Joins `motions` (n,) by matrices (n, n), those that it does not give being zero. With a flexibility in place of
    a stiffness it may also be rigid, or very stiff beside others: equilibrium holds to round-off."""

    motions: tuple[str, ...]

    @property
    def stiffness(self) -> np.ndarray:
        return self._nothing

    @property
    def mass(self) -> np.ndarray:
        return self._nothing

    @property
    def damping(self) -> np.ndarray:
        return self._nothing

    @property
    def flexible(self) -> Flexible | None:
        """How it gives way, where that stands for its stiffness."""
        return None

    @property
    def _nothing(self) -> np.ndarray:
        return np.zeros((len(self.motions),) * 2)


@dataclass(frozen=True, eq=False)
class Springs(Element):
    """A stiffness `of` (r, r), symmetric and not negative, against deformations that are `rows` (r, n) times the
    motions; against the motions themselves where None."""

    motions: tuple[str, ...]
    of: np.ndarray
    rows: np.ndarray | None = None

    @property
    def stiffness(self) -> np.ndarray:
        rows = self._rows
        return rows.T @ self.of @ rows

    @cached_property
    def flexible(self) -> Flexible:
        """Its principal deformations, as far as it holds them."""
        # Springs of all sizes are made alike, so that a soft one is not lost beside a stiff one.
        size = np.sqrt(np.diag(self.of))
        scale = np.where(size > 0.0, size, 1.0)
        values, vectors = np.linalg.eigh(self.of / np.outer(scale, scale))
        held = values > NOTHING * values[-1]
        return Flexible((vectors[:, held].T * scale) @ self._rows, np.diag(1.0 / values[held]))

    @property
    def _rows(self) -> np.ndarray:
        return np.eye(len(self.motions)) if self.rows is None else self.rows


@dataclass(frozen=True, eq=False)
class Link(Element):
    """Ties the first half of its motions to the other half: they move apart by `yielding` (mm/N) of the force."""

    motions: tuple[str, ...]
    yielding: float = 0.0

    @property
    def flexible(self) -> Flexible:
        half = np.eye(len(self.motions) // 2)
        return Flexible(np.concatenate([half, -half], axis=1), self.yielding * half)


class Assembly:
    """The sum of elements over all of their motions, `names` (n,), and over `more` that may have none."""

    def __init__(self, elements: Iterable[Element], more: Iterable[str] = ()):
        self.elements = tuple(elements)
        motions = (name for each in self.elements for name in each.motions)
        self.names = tuple(dict.fromkeys([*more, *motions]))
        self._numbers = {name: number for number, name in enumerate(self.names)}

    def __contains__(self, name: str) -> bool:
        return name in self._numbers

    def numbers(self, names: Iterable[str]) -> np.ndarray:
        """Numbers of motions among all."""
        return np.array([self._numbers[name] for name in names], dtype=int)

    def sum(self, kind: str) -> np.ndarray:
        """Sum (n, n) of "mass", "damping" or "stiffness" of all elements, but of the stiffness of flexible ones."""
        total = np.zeros((len(self.names),) * 2)
        for each in self.elements:
            if kind != "stiffness" or each.flexible is None:
                own = self.numbers(each.motions)
                total[np.ix_(own, own)] += getattr(each, kind)
        return total

    @cached_property
    def flexible(self) -> Flexible:
        """All elements that have a flexibility, one after the other."""
        parts = [(self.numbers(each.motions), each.flexible) for each in self.elements if each.flexible is not None]
        rows = np.zeros((sum(len(part.rows) for _, part in parts), len(self.names)))
        first = 0
        for own, part in parts:
            rows[first : first + len(part.rows), own] = part.rows
            first += len(part.rows)
        return Flexible(rows, block_diag(*(part.flexibility for _, part in parts)) if parts else np.zeros((0, 0)))

    def held(self, names: Sequence[str]) -> Held:
        """The assembly with motions of such names given, and all others as they follow at rest."""
        return Held(self, tuple(names))


class Held:
    """An assembly of which motions (h,) are given: K u + B^T f = load and B u - F f = 0, with the deformations B u of
    flexible elements and the forces f in them (O. C. Zienkiewicz and R. L. Taylor, The Finite Element Method, vol. 1,
    chapter on mixed formulations)."""

    def __init__(self, assembly: Assembly, names: tuple[str, ...]):
        self.assembly = assembly
        self.names = names
        self._given = assembly.numbers(names)
        self._free = np.setdiff1d(np.arange(len(assembly.names)), self._given)

    @cached_property
    def motions(self) -> np.ndarray:
        """Motions (n, h) per given one."""
        return self._at_rest[0]

    def motions_of(self, names: Iterable[str]) -> np.ndarray:
        """Motions (m, h) of such names per given one."""
        return self.motions[self.assembly.numbers(names)]

    @cached_property
    def stiffness(self) -> np.ndarray:
        """Loads (h, h) on the given motions per such motion."""
        motions, forces = self._at_rest
        loads = self._stiffness[self._given] @ motions + self.assembly.flexible.rows[:, self._given].T @ forces
        return 0.5 * (loads + loads.T)

    def loads_on(self, element: Element) -> np.ndarray:
        """Loads on an element over its own motions per given motion."""
        motions, forces = self._at_rest
        if element.flexible is None:
            return element.stiffness @ motions[self.assembly.numbers(element.motions)]
        before = self.assembly.elements[: self.assembly.elements.index(element)]
        first = sum(len(each.flexible.rows) for each in before if each.flexible is not None)
        rows = element.flexible.rows
        return rows.T @ forces[first : first + len(rows)]

    @cached_property
    def flexibility(self) -> np.ndarray:
        """Motions (n, n) per load, with the given ones held."""
        motions = np.zeros((len(self.assembly.names),) * 2)
        motions[np.ix_(self._free, self._free)] = self._solved(np.eye(len(self._scale), len(self._free)))[
            : len(self._free)
        ]
        return 0.5 * (motions + motions.T)

    @cached_property
    def _at_rest(self) -> tuple[np.ndarray, np.ndarray]:
        """Motions (n, h), and forces in flexible elements (f, h)."""
        rows = self.assembly.flexible.rows
        given = np.concatenate([self._stiffness[np.ix_(self._free, self._given)], rows[:, self._given]])
        solved = self._solved(-given)
        motions = np.zeros((len(self.assembly.names), len(self._given)))
        motions[self._given] = np.eye(len(self._given))
        motions[self._free] = solved[: len(self._free)]
        return motions, solved[len(self._free) :]

    @cached_property
    def _stiffness(self) -> np.ndarray:
        return self.assembly.sum("stiffness")

    @cached_property
    def _scale(self) -> np.ndarray:
        """Sizes of free motions and forces in elements."""
        rows, _ = self.assembly.flexible
        size = np.array([1.0 / ARM if _turns(name) else 1.0 for name in self.assembly.names]) / np.sqrt(STIFFNESS)
        forces = 1.0 / np.maximum(np.abs(rows * size).max(axis=1, initial=0.0), np.finfo(float).tiny)
        return np.concatenate([size[self._free], forces])

    @cached_property
    def _matrix(self) -> csc_matrix:
        rows, flexibility = self.assembly.flexible
        free = rows[:, self._free]
        whole = np.block([[self._stiffness[np.ix_(self._free, self._free)], free.T], [free, -flexibility]])
        return csc_matrix(self._scale[:, None] * whole * self._scale)

    def _solved(self, right: np.ndarray) -> np.ndarray:
        if not len(self._scale):
            return right
        right = self._scale[:, None] * right
        # Not kept: factors cannot be sent to another process.
        factors = splu(self._matrix)
        solution = factors.solve(right)
        # One step of refinement makes each equation right by itself (R. D. Skeel, Mathematics of Computation 35, 1980):
        # that of a soft bearing is not lost beside those of stiff beams.
        solution += factors.solve(right - self._matrix @ solution)
        return self._scale[:, None] * solution


def _turns(name: str) -> bool:
    """Whether a motion is a rotation."""
    return name.endswith(MOTIONS[3:])


def carried(distance: float) -> np.ndarray:
    """Motions (6, 6) of a node at a distance (mm) along a rigid axis, per motion of its origin; its transpose takes
    loads back."""
    matrix = np.eye(SIX)
    matrix[0, 4] = distance
    matrix[1, 3] = -distance
    return matrix
