"""A step between rigid flanks, mostly in compiled code: of either side only the node with the smallest gap can touch.

All contact nodes of the drive flanks move alike with the gears, by the base radii and along the line of action; so do
those of the coast flanks. Where several pairs have the same gap, as true involutes do wherever two pairs are in mesh,
their shares of the force are not determined; without friction the whole force is put on the first of them.

Nor do rigid flanks determine which way they slide at the pitch point. By common practice friction is that of the
nominal motion: pairs that touch share the force evenly, and each has mu times its share, against the sliding of the
nominal motion; motion of bearings and shafts does not change its sign.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from .addresses import not_inlined
from .errors import MOVES_FREELY, NoStaticEquilibrium
from .laws import OPEN, SLIP_BACKWARD, SLIP_FORWARD, STICK
from .mixed_form import Iterate, StepEquations, product, solved, system_of
from .newton import CONVERGED, SINGULAR
from .operator import ContactOperator, Position
from .step_solver import NEWTON, StepSolution

# Gaps (mm) that differ by less are the same: the round-off of positions on the line of action.
SAME_GAP = 1e-10
# Drive and coast flanks hold the gears in different directions where their rows of G differ by more than round-off.
SAME_DIRECTION = 1e-9


class Sides(NamedTuple):
    """Contact nodes (n,) as of a ContactOperator; `sliding`: empty without friction."""

    on_drive_flanks: np.ndarray
    node_pair: np.ndarray
    sliding: np.ndarray


@njit(cache=True)
def rigid_step(equations, sides, iterate):
    """Solve a step with the first that holds the load: no node touching, the leading node of a side, or of both.

    Both sides touch where teeth are wider than the spaces between them and bearings let the centres move. The `iterate`
    becomes the solution. Returns (outcome, candidates tried), as `newton.newton`; SINGULAR where nothing holds the
    load.
    """
    not_inlined()
    status, forces, coordinates, displacement = iterate
    leaders = _leaders(equations.gap, sides.on_drive_flanks)
    candidates = 1 + len(leaders) + (1 if len(leaders) == 2 and not len(sides.sliding) else 0)
    for candidate in range(candidates):
        touching = leaders if candidate > 2 else leaders[max(candidate - 1, 0) : candidate]
        unit = _unit_forces(equations, sides, touching)
        if _solved(equations, touching, unit, forces, coordinates) and _obeys(
            equations, leaders, touching, forces, coordinates
        ):
            for row in range(len(displacement)):
                displacement[row] = product(equations.jacobian[row], coordinates)
            _set(status, unit)
            return CONVERGED, candidate + 1
    return SINGULAR, candidates


@njit(cache=True)
def _leaders(gap, on_drive_flanks):
    """The node with the smallest gap of the drive and of the coast flanks, as far as there are such nodes."""
    nodes = np.full(2, -1)
    for node in range(len(gap)):
        side = 0 if on_drive_flanks[node] else 1
        if nodes[side] < 0 or gap[node] < gap[nodes[side]]:
            nodes[side] = node
    return nodes[nodes >= 0]


@njit(cache=True)
def _unit_forces(equations, sides, touching):
    """Forces (t, m) per unit mesh force at each of the nodes `touching` (t,).

    With friction even shares on the nearest node of each pair that touches with it, and their friction.
    """
    gap, drive, pairs = equations.gap, sides.on_drive_flanks, sides.node_pair
    unit, n = np.zeros((len(touching), len(equations.compliance))), len(gap)
    for row in range(len(touching)):
        leader = touching[row]
        if not len(sides.sliding):
            unit[row, leader] = 1.0
            continue
        nearest = np.full(pairs.max() + 1, -1)
        for node in range(n):
            if drive[node] == drive[leader] and gap[node] <= gap[leader] + SAME_GAP:
                other = nearest[pairs[node]]
                if other < 0 or gap[node] < gap[other]:
                    nearest[pairs[node]] = node
        together = nearest[nearest >= 0]
        for node in together:
            unit[row, node] = 1.0 / len(together)
            unit[row, n + node] = equations.friction * sides.sliding[node] / len(together)
    return unit


@njit(cache=True)
def _solved(equations, touching, unit, forces, coordinates):
    """Fill forces (m,) and coordinates (k,) with some nodes touching; whether the drivetrain can be solved so."""
    not_inlined()
    stiffness, load, jacobian = equations.stiffness, equations.load, equations.jacobian
    k, t = len(load), len(touching)
    forces[:] = 0.0
    if not t and len(equations.free_motion):
        return False
    if t > 1 and not _independent(jacobian[touching[0]], jacobian[touching[1]]):
        return False
    # Forces are carried as lengths, by the largest stiffness, so that all entries of the matrix are of one size.
    largest, matrix, right = 0.0, system_of(k + t), np.empty(k + t)
    matrix[:] = 0.0
    for c in range(k):
        right[c] = load[c]
        for d in range(k):
            matrix[c, d], largest = stiffness[c, d], max(largest, abs(stiffness[c, d]))
    scale = largest if largest > 0.0 else 1.0
    for a in range(t):
        for c in range(k):
            matrix[k + a, c] = scale * jacobian[touching[a], c]
        right[k + a] = scale * equations.gap[touching[a]]
        for row in range(len(forces)):
            if unit[a, row] != 0.0:
                for c in range(k):
                    matrix[c, k + a] += scale * unit[a, row] * jacobian[row, c]
    # A number that is written out in the call has it compiled once more.
    no_forces = np.int64(0)
    try:
        solution = solved(matrix.copy(), right.copy(), no_forces)
        # Iterative refinement: where slow masses are hardly any stiffness, load over stiffness is a length beside which
        # the gap is round-off.
        if t:
            for a in range(k + t):
                right[a] -= product(matrix[a], solution)
            correction = solved(matrix, right, no_forces)
            for a in range(k + t):
                solution[a] += correction[a]
    except Exception:
        # A singular matrix; compiled code tells no kinds of errors apart.
        return False
    for c in range(k):
        coordinates[c] = solution[c]
    for a in range(t):
        for row in range(len(forces)):
            forces[row] += scale * solution[k + a] * unit[a, row]
    return True


@njit(cache=True)
def _independent(one, other):
    """Whether drive and coast flanks hold the gears in different directions; with fixed centres they do not."""
    part = product(other, one) / product(one, one)
    for c in range(len(one)):
        if abs(other[c] - part * one[c]) > SAME_DIRECTION:
            return True
    return False


@njit(cache=True)
def _obeys(equations, leaders, touching, forces, coordinates):
    """Whether nothing pulls and nothing penetrates."""
    for node in leaders:
        touches = False
        for other in touching:
            touches = touches or other == node
        if touches:
            if forces[node] < -equations.tolerance.force:
                return False
        elif product(equations.jacobian[node], coordinates) - equations.gap[node] > equations.tolerance.length:
            return False
    return True


@njit(cache=True)
def _set(status, unit):
    """The sets (n,) under forces `unit` (t, m), friction's sign being that of the slip."""
    n, m = len(status), unit.shape[1]
    status[:] = OPEN
    for row in range(len(unit)):
        for node in range(n):
            if unit[row, node] != 0.0:
                sense = unit[row, n + node] if m > n else 1.0
                status[node] = SLIP_FORWARD if sense > 0.0 else SLIP_BACKWARD if sense < 0.0 else STICK


def solve_rigid(
    position: Position, problem: StepEquations, status: np.ndarray, last: StepSolution | None
) -> StepSolution:
    """A step between rigid flanks, as `mesh.Mesh` solves one. Raises NoStaticEquilibrium where nothing holds the
    load."""
    operator = position.operator
    sliding = np.empty(0) if operator.sliding is None else operator.sliding
    sides = Sides(operator.on_drive_flanks, operator.node_pair, sliding)
    m = len(problem.compliance)
    iterate = Iterate(status, np.zeros(m), np.zeros(len(problem.load)), np.zeros(m))
    outcome, iterations = rigid_step(problem, sides, iterate)
    if outcome != CONVERGED:
        raise _no_equilibrium(operator, problem)
    return StepSolution(iterate.forces, iterate.coordinates, iterate.displacement, status, iterations, NEWTON)


def _no_equilibrium(operator: ContactOperator, problem: StepEquations) -> NoStaticEquilibrium:
    """The error of a load that no set of nodes holds."""
    drive = operator.on_drive_flanks
    reason = f"no equilibrium: neither the drive flanks nor the coast flanks hold the load: {MOVES_FREELY}"
    leaders = [nodes[np.argmin(problem.gap[nodes])] for nodes in map(np.flatnonzero, (drive, ~drive)) if len(nodes)]
    play = float(problem.gap[leaders].sum())
    if len(leaders) == 2 and play < 0.0 and np.linalg.matrix_rank(problem.jacobian[leaders], tol=1e-9) < 2:
        reason = (
            f"no equilibrium: rigid teeth are wedged between drive and coast flanks, by {-1e3 * play:.4g} um more than"
            " there is backlash: raise gears.centre_distance, lower the flank deviations, or make teeth or bearings"
            " elastic ([gears.material], [bearings])"
        )
    sets = np.full((1, len(problem.gap)), OPEN, dtype=np.int8)
    return NoStaticEquilibrium([("rigid flanks", "no solution", np.zeros((1, 5)), sets)], reason)
