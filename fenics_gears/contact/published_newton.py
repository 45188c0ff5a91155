"""The paper's Newton method with a merit function and a line search [Appendix B], on (24), (25) and (C.1).

Unknowns y = (u, p): relative displacement and contact forces of all nodes. With H1 = K u + p + f, and H2 the difference of both
sides of (24), (25), the merit is Phi = 1/2 H^T H. All parts of H are forces (r is a stiffness, one per node).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from fenics_gears.contact.laws import OPEN, SLIP_BACKWARD, SLIP_FORWARD, STICK

BETA, GAMMA, MOST_HALVINGS = 0.9, 0.1, 22


@dataclass(frozen=True)
class Equations:
    """[24], [25] and [C.1] for n nodes, m = n without friction, 2 n with it.

    `stiffness` (m, m), N/mm; `load` (m,), N; `gap` (n,), mm; `slip_before` (n,): w_old, mm, empty without friction; `r` (m,), N/mm.
    """

    stiffness: np.ndarray
    load: np.ndarray
    gap: np.ndarray
    slip_before: np.ndarray
    friction: float
    r: np.ndarray

    def status(self, displacement: np.ndarray, forces: np.ndarray) -> np.ndarray:
        """What each node does (n,), read off the projections."""
        n = len(self.gap)
        closed = forces[:n] + self.r[:n] * (displacement[:n] - self.gap) > 0.0
        if not len(self.slip_before):
            return np.where(closed, SLIP_FORWARD, OPEN).astype(np.int8)
        trial = forces[n:] + self.r[n:] * (displacement[n:] + self.slip_before)
        sticks = np.abs(trial) <= self.friction * np.maximum(forces[:n], 0.0)
        friction = np.where(sticks, STICK, np.where(trial > 0.0, SLIP_FORWARD, SLIP_BACKWARD))
        return np.where(closed, friction, OPEN).astype(np.int8)

    def residual(self, displacement: np.ndarray, forces: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """H1 and H2 (m,), N."""
        n = len(self.gap)
        asked = np.maximum(forces[:n] + self.r[:n] * (displacement[:n] - self.gap), 0.0)
        if len(self.slip_before):
            limit = self.friction * np.maximum(forces[:n], 0.0)
            trial = forces[n:] + self.r[n:] * (displacement[n:] + self.slip_before)
            asked = np.concatenate([asked, np.clip(trial, -limit, limit)])
        return self.stiffness @ displacement + forces + self.load, forces - asked

    def direction(self, displacement: np.ndarray, forces: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The search direction z of (u, p): H + H'(y; z) = 0. Raises numpy.linalg.LinAlgError where there is none."""
        n, m = len(self.gap), len(self.r)
        first, second = self.residual(displacement, forces)
        by_displacement, by_force, slope = np.zeros(m), np.ones(m), np.zeros(n)
        pressed = forces[:n] + self.r[:n] * (displacement[:n] - self.gap) > 0.0
        by_displacement[:n], by_force[:n] = np.where(pressed, -self.r[:n], 0.0), np.where(pressed, 0.0, 1.0)
        if len(self.slip_before):
            trial = forces[n:] + self.r[n:] * (displacement[n:] + self.slip_before)
            sticks = np.abs(trial) <= self.friction * np.maximum(forces[:n], 0.0)
            by_displacement[n:], by_force[n:] = np.where(sticks, -self.r[n:], 0.0), np.where(sticks, 0.0, 1.0)
            slope = np.where(sticks | (forces[:n] <= 0.0), 0.0, -self.friction * np.sign(trial))
        # z_p = -H1 - K z_u, inserted into the rows of H2'.
        matrix = np.diag(by_displacement) - by_force[:, None] * self.stiffness
        right_side = -second + by_force * first
        if len(self.slip_before):
            matrix[n:] -= slope[:, None] * self.stiffness[:n]
            right_side[n:] += slope * first[:n]
        step = np.linalg.solve(matrix, right_side)
        return step, -first - self.stiffness @ step


@dataclass(frozen=True)
class Iterate:
    """One iterate: displacement u (m,), mm, forces p (m,), N, its merit Phi (N^2) and the length of the step to it (0 at the start)."""

    displacement: np.ndarray
    forces: np.ndarray
    merit: float
    length: float


def iterates(equations: Equations, displacement: np.ndarray, forces: np.ndarray) -> Iterator[Iterate]:
    """The start, and one iterate after another without end.

    Raises numpy.linalg.LinAlgError where there is no search direction.
    """
    present = Iterate(displacement, forces, merit(equations, displacement, forces), 0.0)
    while True:
        yield present
        present = _line_search(equations, present)


def merit(equations: Equations, displacement: np.ndarray, forces: np.ndarray) -> float:
    """Phi = 1/2 H^T H, N^2."""
    first, second = equations.residual(displacement, forces)
    return 0.5 * float(first @ first + second @ second)


def _line_search(equations: Equations, present: Iterate) -> Iterate:
    """The next iterate. Where no step fulfils the criterion the shortest is taken: the paper does not say, and this solves its pair."""
    step_u, step_p = equations.direction(present.displacement, present.forces)
    for halving in range(MOST_HALVINGS + 1):
        length = BETA**halving
        displacement, forces = present.displacement + length * step_u, present.forces + length * step_p
        value = merit(equations, displacement, forces)
        if value <= (1.0 - 2.0 * GAMMA * length) * present.merit:
            break
    return Iterate(displacement, forces, value, length)
