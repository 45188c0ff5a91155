"""The mixed form of the contact equations: the linear system of given sets, for forces of contact nodes and centre
coordinates.

For the closed nodes (normals), the sticking ones (tangents) and all centre coordinates,

    K q + G^T p = F
    G q - C p   = gap        normal rows of closed nodes
    G q - C p   = -w_old     tangential rows of sticking nodes
    p_t = +-mu p_n           slipping nodes, inserted

Eliminating q first would divide by a stiffness that vanishes with growing time step (model.md section 4).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from fenics_gears.contact.formed_rows import form_rows
from fenics_gears.contact.laws import OPEN, SLIP_BACKWARD, SLIP_FORWARD, STICK

# Unknowns up to which elimination in compiled code is faster than LAPACK.
SMALL_SYSTEM = 40


class Equations(NamedTuple):
    """The mixed form at one position and time: `stiffness` K (k, k) and `load` F (k,) of the effective drivetrain;
    `compliance` C (m, m), `jacobian` G (m, k) and `gap` (n,) of the contact; `slip_before` (n,): w_old, empty without
    friction.

    `rows`: address of what forms the rows of nodes that are closed for the first time (`contact.formed_rows`), 0 where
    all are there. `free_motion` (k,): how the load moves the drivetrain where only contact holds it, in which case one
    node at least stays closed; empty where the drivetrain holds the load.
    """

    stiffness: np.ndarray
    load: np.ndarray
    compliance: np.ndarray
    jacobian: np.ndarray
    gap: np.ndarray
    slip_before: np.ndarray
    friction: float
    free_motion: np.ndarray
    rows: int = 0


class Iterate(NamedTuple):
    """Sets (n,), forces p (m,), coordinates q (k,) and relative displacement u (m,); each iteration overwrites them."""

    status: np.ndarray
    forces: np.ndarray
    coordinates: np.ndarray
    displacement: np.ndarray


@njit(cache=True)
def _slip_factor(status, friction):
    """Tangential force per normal force of a slipping node."""
    if status == SLIP_FORWARD:
        return friction
    if status == SLIP_BACKWARD:
        return -friction
    return 0.0


@njit(cache=True)
def solve_sets(equations, iterate):
    """Solve the linear system of the sets of an iterate for its forces and coordinates, in place.

    Raises numpy.linalg.LinAlgError where the sets leave the system singular.
    """
    stiffness, load, compliance, jacobian, gap, slip_before, friction, _, unformed = equations
    status, forces, coordinates, _ = iterate
    n, k, tangential = len(gap), len(load), len(slip_before) > 0
    closed = np.flatnonzero(status != OPEN)
    stick = np.flatnonzero(status == STICK) if tangential else closed[:0]
    if unformed != 0:
        form_rows(unformed, closed)
    n_closed, n_stick = len(closed), len(stick)
    rows = np.concatenate((closed, n + stick))
    size = n_closed + n_stick
    # Forces are carried as lengths, `unit` N each, so that all entries are of the size of a stiffness.
    unit = 1.0 / compliance[0, 0] if len(compliance) else 1.0
    matrix = np.empty((size + k, size + k))
    right_side = np.empty(size + k)
    factors = np.zeros(n_closed)
    if tangential:
        for b in range(n_closed):
            factors[b] = _slip_factor(status[closed[b]], friction)
    for a in range(size):
        row, values, entries = rows[a], compliance[rows[a]], matrix[a]
        for b in range(size):
            entries[b] = -values[rows[b]] * unit * unit
        if tangential:
            for b in range(n_closed):
                entries[b] -= factors[b] * values[n + closed[b]] * unit * unit
        for c in range(k):
            matrix[a, size + c] = jacobian[row, c] * unit
        right_side[a] = (gap[row] if row < n else -slip_before[row - n]) * unit
    for c in range(k):
        for b in range(size):
            entry = jacobian[rows[b], c]
            if tangential and b < n_closed:
                entry += factors[b] * jacobian[n + closed[b], c]
            matrix[size + c, b] = entry * unit
        for d in range(k):
            matrix[size + c, size + d] = stiffness[c, d]
        right_side[size + c] = load[c]
    solution = solved(matrix, right_side)
    forces[:] = 0.0
    for a in range(n_closed):
        node = closed[a]
        forces[node] = solution[a] * unit
        if tangential:
            forces[n + node] = factors[a] * forces[node]
    for a in range(n_stick):
        forces[n + stick[a]] = solution[n_closed + a] * unit
    coordinates[:] = solution[size:]


@njit(cache=True)
def solved(matrix, right_side):
    """Solution of a linear system, in place of both; small ones without LAPACK, whose call costs more than they do."""
    size = len(right_side)
    if size > SMALL_SYSTEM:
        return np.linalg.solve(matrix, right_side)
    for column in range(size):
        pivot, largest = column, abs(matrix[column, column])
        for row in range(column + 1, size):
            if abs(matrix[row, column]) > largest:
                pivot, largest = row, abs(matrix[row, column])
        if largest == 0.0:
            raise np.linalg.LinAlgError("Matrix is singular to machine precision.")
        if pivot != column:
            for other in range(column, size):
                matrix[column, other], matrix[pivot, other] = matrix[pivot, other], matrix[column, other]
            right_side[column], right_side[pivot] = right_side[pivot], right_side[column]
        for row in range(column + 1, size):
            factor = matrix[row, column] / matrix[column, column]
            if factor != 0.0:
                for other in range(column + 1, size):
                    matrix[row, other] -= factor * matrix[column, other]
                right_side[row] -= factor * right_side[column]
    for column in range(size - 1, -1, -1):
        for other in range(column + 1, size):
            right_side[column] -= matrix[column, other] * right_side[other]
        right_side[column] /= matrix[column, column]
    return right_side


@njit(cache=True)
def relative_displacement(equations, iterate, first, end):
    """u = G q - C p, mm, into rows `first` to `end` of the displacement; only loaded nodes are summed, by rows of the
    symmetric compliance."""
    # Taken out of the records once: in a loop that would cost more than the numbers.
    compliance, jacobian, displacement = equations.compliance, equations.jacobian, iterate.displacement
    forces, coordinates = iterate.forces, iterate.coordinates
    for i in range(first, end):
        displacement[i] = product(jacobian[i], coordinates)
    for j in np.flatnonzero(forces):
        row, force = compliance[j], forces[j]
        for i in range(first, end):
            displacement[i] -= row[i] * force


@njit(cache=True, inline="always")
def product(row, vector):
    """Product of two vectors."""
    total = 0.0
    for c in range(len(vector)):
        total += row[c] * vector[c]
    return total
