"""Backward Euler: the method for steps too long to hold any vibration of the drivetrain.

Average acceleration neither damps nor follows a vibration whose period is shorter than two steps: it turns its sign at
every step, and every kink of the static solution adds to it. Backward Euler forgets it within a step. With

    x'_1 = (x_1 - x_0)/dt,   x''_1 = (x'_1 - x'_0)/dt

the equation of motion at the end of the step reads

    (M/dt^2 + D/dt + K) x_1 + G^T p = F + M (x_0/dt^2 + x'_0/dt) + D x_0/dt.

First order in the terms of inertia and damping, which are small there; the static part is exact. E. Hairer and G.
Wanner, Solving Ordinary Differential Equations II, 1996, section IV.3: L-stable.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from .average_acceleration import Scheme


@njit(cache=True)
def history(step, mass, damping):
    """As `average_acceleration.history`."""
    found = np.zeros((3, *mass.shape))
    for i, j in np.ndindex(mass.shape):
        found[0, i, j] = mass[i, j] / (step * step) + damping[i, j] / step
        found[1, i, j] = mass[i, j] / step
    return found


@njit(cache=True)
def advanced(step, before, position):
    """As `average_acceleration.advanced`."""
    after = np.empty_like(before)
    for c in range(len(position)):
        after[0, c], after[1, c] = position[c], (position[c] - before[0, c]) / step
        after[2, c] = (after[1, c] - before[1, c]) / step
    return after


class BackwardEuler(Scheme):
    """This method."""

    _matrices, _advanced = staticmethod(history), staticmethod(advanced)
