"""The paper's Newton method with a merit function and a line search [Appendix B], on (24), (25) and (C.1).

Unknowns y = (u, p): relative displacement and contact forces of all nodes. With H1 = K u + p + f, and H2 the difference
of both sides of (24), (25), the merit is Phi = 1/2 H^T H. All parts of H are forces (r is a stiffness, one per node).
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

    `stiffness` (m, m), N/mm; `load` (m,), N; `gap` (n,), mm; `slip_before` (n,): w_old, mm, empty without friction; `r`
    (m,), N/mm.
    """

    stiffness: np.ndarray
    load: np.ndarray
    gap: np.ndarray
    slip_before: np.ndarray
    friction: float
    r: np.ndarray

    def status(self, displacement: np.ndarray, forces: np.ndarray) -> np.ndarray:
        """What each node does (n,), read off the projections."""
        normal, tangential, limit = self._projected(displacement, forces)
        if not len(self.slip_before):
            return np.where(normal > 0.0, SLIP_FORWARD, OPEN).astype(np.int8)
        slips = np.where(tangential > 0.0, SLIP_FORWARD, SLIP_BACKWARD)
        return np.where(normal > 0.0, np.where(np.abs(tangential) <= limit, STICK, slips), OPEN).astype(np.int8)

    def residual(self, displacement: np.ndarray, forces: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """H1 and H2 (m,), N."""
        normal, tangential, limit = self._projected(displacement, forces)
        demanded = np.concatenate([np.maximum(normal, 0.0), np.clip(tangential, -limit, limit)])
        return self.stiffness @ displacement + forces + self.load, forces - demanded

    def direction(self, displacement: np.ndarray, forces: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The search direction z of (u, p): H + H'(y; z) = 0. Raises numpy.linalg.LinAlgError where there is none."""
        n = len(self.gap)
        first, second = self.residual(displacement, forces)
        normal, tangential, limit = self._projected(displacement, forces)
        sticks = np.abs(tangential) <= limit
        held = np.concatenate([normal > 0.0, sticks])
        by_displacement, by_force = np.where(held, -self.r, 0.0), np.where(held, 0.0, 1.0)
        # z_p = -H1 - K z_u, inserted into the rows of H2'.
        matrix = np.diag(by_displacement) - by_force[:, None] * self.stiffness
        right_side = -second + by_force * first
        if len(self.slip_before):
            slope = np.where(sticks | (forces[:n] <= 0.0), 0.0, -self.friction * np.sign(tangential))
            matrix[n:] -= slope[:, None] * self.stiffness[:n]
            right_side[n:] += slope * first[:n]
        step = np.linalg.solve(matrix, right_side)
        return step, -first - self.stiffness @ step

    def _projected(self, displacement: np.ndarray, forces: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Normal and tangential forces (n,) that the projections cut off, and friction's limit (n,), N; the last two
        empty without friction."""
        n = len(self.gap)
        normal = forces[:n] + self.r[:n] * (displacement[:n] - self.gap)
        if not len(self.slip_before):
            return normal, self.slip_before, self.slip_before
        tangential = forces[n:] + self.r[n:] * (displacement[n:] + self.slip_before)
        return normal, tangential, self.friction * np.maximum(forces[:n], 0.0)


@dataclass(frozen=True)
class Iterate:
    """One iterate: displacement u (m,), mm, forces p (m,), N, its merit Phi (N^2) and the length of the step to it (0
    at the start)."""

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
    """The next iterate. Where no step fulfils the criterion the shortest is taken: the paper leaves that open, and this
    solves its pair."""
    step_u, step_p = equations.direction(present.displacement, present.forces)
    for halving in range(MOST_HALVINGS + 1):
        length = BETA**halving
        displacement, forces = present.displacement + length * step_u, present.forces + length * step_p
        value = merit(equations, displacement, forces)
        if value <= (1.0 - 2.0 * GAMMA * length) * present.merit:
            break
    return Iterate(displacement, forces, value, length)
