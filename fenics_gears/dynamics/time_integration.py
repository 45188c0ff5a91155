"""Methods of integration in time.

Average acceleration [14]: second order, no numerical dissipation. With x' and x'' at both ends of a step,

    x_1 = x_0 + dt/2 (x'_0 + x'_1),   x'_1 = x'_0 + dt/2 (x''_0 + x''_1)

the equation of motion M x'' + D x' + K x = F - G^T p at the end of the step reads

    (4/dt^2 M + 2/dt D + K) x_1 + G^T p = F + M (4/dt^2 x_0 + 4/dt x'_0 + x''_0) + D (2/dt x_0 + x'_0).

Without mass and damping this is the static equation at the end of the step: quasi-static scenes use the same march.

Backward Euler: for steps too long to hold any vibration of the drivetrain. Average acceleration neither damps nor
follows a vibration whose period is shorter than two steps: it turns its sign at every step, and every kink of the
static solution adds to it. Backward Euler forgets it within a step. With

    x'_1 = (x_1 - x_0)/dt,   x''_1 = (x'_1 - x'_0)/dt

the equation of motion at the end of the step reads

    (M/dt^2 + D/dt + K) x_1 + G^T p = F + M (x_0/dt^2 + x'_0/dt) + D x_0/dt.

First order in the terms of inertia and damping, which are small there; the static part is exact. E. Hairer and G.
Wanner, Solving Ordinary Differential Equations II, 1996, section IV.3: L-stable.

In a frame that turns, forces -S x' act besides, S being skew. They do no work, and turn velocities: before each step

    x' -> (M + dt/2 S)^-1 (M - dt/2 S) x',

which keeps the kinetic energy, whatever the step, and leaves the step's matrix symmetric (Strang, SIAM J. Numer. Anal.
5, 1968, 506-517: second order, the velocity at a step being that of its middle turn). The acceleration follows as the
damping of the turned velocity has it. On a speed ramp S and what is off the stiffness are those of a step's mean
speed.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from .drivetrain import Drivetrain

STATIC, AVERAGE_ACCELERATION, BACKWARD_EULER = range(3)


class State(NamedTuple):
    """Centre coordinates (k,), mm, their velocities, mm/s, and accelerations, mm/s^2."""

    position: np.ndarray
    velocity: np.ndarray
    acceleration: np.ndarray


class Scheme:
    """Effective stiffness and load of one step of a `drivetrain` of length `step` (s), by a `method`; STATIC without
    inertia. `speed`: of the step's frame over that at the start."""

    def __init__(self, drivetrain: Drivetrain, step: float, method: int = AVERAGE_ACCELERATION, speed: float = 1.0):
        self.drivetrain = drivetrain
        self.step = step
        self.method = STATIC if drivetrain.mass is None else method
        self.stiffness = drivetrain.stiffness
        self._frame = None
        if not self.inert:
            return
        mass = drivetrain.mass
        damping = drivetrain.damping if drivetrain.damping is not None else np.zeros_like(mass)
        self._history = history_of(method, step, mass, damping)
        self.stiffness = drivetrain.stiffness + self._history[0]
        frame = drivetrain.frame
        if frame is not None:
            self._frame = turned_velocities(step, mass, damping, speed * frame.gyroscopic)
            self.stiffness = self.stiffness + (1.0 - speed**2) * frame.softening

    @property
    def inert(self) -> bool:
        """Whether the scene has inertia."""
        return self.method != STATIC

    def lasting(self, step: float, speed: float) -> Scheme:
        """The same for steps of another length (s) and `speed`."""
        return Scheme(self.drivetrain, step, self.method, speed)

    def load(self, state: State, outer: np.ndarray) -> np.ndarray:
        """Right-hand side (k,), N, of the step that starts from `state`, under the forces `outer` (k,), N."""
        if not self.inert:
            return outer
        return with_history(outer, self._history, self._begun(state))

    def advance(self, state: State, position: np.ndarray) -> State:
        """The state at the end of the step, from its position (k,), mm."""
        return State(*advanced(self.method, self.step, self._begun(state), position))

    def _begun(self, state: State) -> np.ndarray:
        """The state (3, k) that a step starts from."""
        begun = np.array(state)
        return begun if self._frame is None else in_turned_frame(begun, self._frame)


@njit(cache=True)
def turned_velocities(step, mass, damping, gyroscopic):
    """How a frame that turns for a step takes velocities on, and what damping adds to accelerations by that: matrices
    (2, k, k) on velocities."""
    half = 0.5 * step * gyroscopic
    matrices = np.empty((2, *mass.shape))
    matrices[0] = np.linalg.inv(mass + half) @ (mass - half)
    matrices[1] = np.linalg.inv(mass) @ (damping @ (np.eye(len(mass)) - matrices[0]))
    return matrices


@njit(cache=True)
def in_turned_frame(states, frame):
    """Position, velocity and acceleration (3, k) as a step begins that `frame` (2, k, k) takes on."""
    turned = states.copy()
    turned[1] = frame[0] @ states[1]
    turned[2] += frame[1] @ states[1]
    return turned


@njit(cache=True)
def history_of(method, step, mass, damping):
    """What position, velocity and acceleration at the start of a step add to its load: matrices (3, k, k); the first is
    also what inertia and damping add to the stiffness."""
    matrices = np.zeros((3, *mass.shape))
    for i, j in np.ndindex(mass.shape):
        if method == AVERAGE_ACCELERATION:
            matrices[0, i, j] = 4.0 / (step * step) * mass[i, j] + 2.0 / step * damping[i, j]
            matrices[1, i, j] = 4.0 / step * mass[i, j] + damping[i, j]
            matrices[2, i, j] = mass[i, j]
        else:
            matrices[0, i, j] = mass[i, j] / (step * step) + damping[i, j] / step
            matrices[1, i, j] = mass[i, j] / step
    return matrices


@njit(cache=True)
def advanced(method, step, before, position):
    """Position, velocity and acceleration (3, k) at the end of a step from those `before` and the position (k,)."""
    after = before.copy()
    # By numbers: expressions of arrays take compiled code longer to load than they take to run.
    for c in range(len(position)):
        after[0, c], change, velocity = position[c], position[c] - before[0, c], before[1, c]
        if method == AVERAGE_ACCELERATION:
            after[1, c] = 2.0 / step * change - velocity
            after[2, c] = 2.0 / step * (2.0 / step * change - 2.0 * velocity) - before[2, c]
        elif method == BACKWARD_EULER:
            after[1, c] = change / step
            after[2, c] = (after[1, c] - velocity) / step
    return after


@njit(cache=True)
def with_history(load, history, states):
    """A load (k,) with what the states (3, k) at the start of a step add, by symmetric matrices `history` (3, k, k)."""
    result, rows, numbers, three = load.copy(), history.reshape(-1, len(load)), states.reshape(-1), np.uint64(3)
    # Three rows at a time, which are columns too: to write and read the result for each term takes longer than the
    # term. uint64 avoids numba's wraparound check.
    for j in range(np.uint64(0), np.uint64(len(numbers)), three):
        a, b, c = rows[j], rows[j + np.uint64(1)], rows[j + np.uint64(2)]
        of_a, of_b, of_c = numbers[j], numbers[j + np.uint64(1)], numbers[j + np.uint64(2)]
        for i in range(np.uint64(len(load))):
            result[i] = result[i] + a[i] * of_a + b[i] * of_b + c[i] * of_c
    return result
