"""Tresca's fixed point: a convex quadratic programme for the forces with friction bounds frozen at s = mu p_n, then new
bounds.

With frozen bounds the step is the minimum of the energy (model.md section 4): over p and z, with K = L L^T,

    1/2 p^T C p + 1/2 z^T z + gap . p_n - w_old . p_t   subject to   L z + G^T p = F,  p_n >= 0,  |p_t| <= s

whose multipliers of the equality are the centre coordinates q, also where K is singular and only contact holds the
load. The sets that the programme settles on start Newton, so that the solution is as exact as by any other method.
Without friction there are no bounds, and one programme is enough; it also solves contact nodes so close that elasticity
hardly tells them apart, where Newton's sets alternate for ever.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from fenics_gears.contact.laws import OPEN, SLIP_BACKWARD, SLIP_FORWARD, STICK
from fenics_gears.contact.newton import CONVERGED, CYCLED, SINGULAR

MOST_PROGRAMMES = 100
# From this programme on only half of each change of the bounds is taken, so that bounds that alternate converge.
UNRELAXED = 20
ACCURACY = {"show_progress": False, "abstol": 1e-13, "reltol": 1e-13, "feastol": 1e-11, "maxiters": 60}


@dataclass(frozen=True)
class Frozen:
    """Solution of the programme with frozen bounds: forces (m,), N, coordinates (k,), mm, and the sets (n,)."""

    forces: np.ndarray
    coordinates: np.ndarray
    sets: np.ndarray


def tresca(problem, status: np.ndarray, polish: Callable):
    """The fixed point from no friction at all; `polish(sets)` solves from given sets, as `step_solver.run_newton` does.

    Returns what `step_solver.run_newton` returns, `polish`'s where it converges; iterations count programmes and
    Newton's together.
    """
    n, spent, relaxation = len(problem.gap), 0, 1.0
    history, sets, tried = [], [], set()
    bounds, before = np.zeros(n), status
    outcome = CYCLED
    for programme in range(MOST_PROGRAMMES):
        frozen = frozen_friction(problem, bounds)
        spent += 1
        if frozen is None:
            outcome = SINGULAR
            break
        displacement = problem.jacobian @ frozen.coordinates - problem.compliance @ frozen.forces
        history.append(problem.residual(frozen.sets, frozen.forces, frozen.coordinates, displacement))
        sets.append(frozen.sets)
        key = frozen.sets.tobytes()
        if np.array_equal(frozen.sets, before) and key not in tried:
            tried.add(key)
            result, record = polish(frozen.sets)
            spent += result[1]
            if result[0] == CONVERGED:
                return (CONVERGED, spent, *result[2:]), record
        before = frozen.sets
        wanted = problem.friction * np.maximum(frozen.forces[:n], 0.0)
        if np.abs(wanted - bounds).max(initial=0.0) <= 1e-3 * problem.tolerance.force and key in tried:
            break
        relaxation = 1.0 if programme < UNRELAXED else 0.5
        bounds = bounds + relaxation * (wanted - bounds)
    m, k = len(problem.compliance), len(problem.load)
    rows = np.array(history).reshape(-1, 5), np.array(sets, dtype=np.int8).reshape(-1, n)
    return (outcome, spent, np.zeros(m), np.zeros(k), np.zeros(m), before), rows


def frozen_friction(problem, bounds: np.ndarray) -> Frozen | None:
    """The forces that minimise the energy with |p_t| <= `bounds` (n,), N; None where the programme has no solution."""
    from cvxopt import matrix, solvers

    n, force = len(problem.gap), max(np.abs(problem.load).max(initial=0.0), 1e3 * problem.tolerance.force)
    soft = problem.compliance[0, 0]
    # Bounds of zero leave the programme no interior: those tangents are left out.
    rubbing = np.flatnonzero(bounds > 1e-12 * force)
    rows = np.concatenate((np.arange(n), n + rubbing))
    root = _root(problem.stiffness * soft)
    size, extra, tangents = len(rows), root.shape[1], len(rubbing)
    energy = np.zeros((size + extra, size + extra))
    energy[:size, :size] = problem.compliance[np.ix_(rows, rows)] / soft
    energy[size:, size:] = np.eye(extra)
    distance = np.concatenate((problem.gap, -problem.slip_before))[rows] / (force * soft)
    limits = np.zeros((n + 2 * tangents, size + extra))
    limits[:n, :n] = -np.eye(n)
    limits[n : n + tangents, n:size], limits[n + tangents :, n:size] = np.eye(tangents), -np.eye(tangents)
    allowed = np.concatenate((np.zeros(n), bounds[rubbing], bounds[rubbing])) / force
    balance = np.hstack((problem.jacobian[rows].T, root))
    try:
        found = solvers.coneqp(
            matrix(energy), matrix(np.concatenate((distance, np.zeros(extra)))), matrix(limits), matrix(allowed),
            A=matrix(balance), b=matrix(problem.load / force), options=ACCURACY,
        )  # fmt: skip
    except (ValueError, ArithmeticError):
        return None
    if found["x"] is None or not np.all(np.isfinite(np.array(found["x"]))):
        return None
    if found["status"] != "optimal" and not found["primal infeasibility"] < 1e-6:
        return None
    primal, pressed, slack = (np.array(found[name]).ravel() for name in ("x", "z", "s"))
    forces = np.zeros(len(problem.compliance))
    forces[rows] = primal[:size] * force
    # The equality's multiplier has the sign that adds it to the energy.
    coordinates = -np.array(found["y"]).ravel() * force * soft
    active = pressed > slack
    return Frozen(forces, coordinates, _sets(problem, forces, coordinates, rubbing, active))


def _sets(problem, forces: np.ndarray, coordinates: np.ndarray, rubbing: np.ndarray, active: np.ndarray) -> np.ndarray:
    """What each node does; `active`: bounds that hold it, lower normals, then upper and lower tangents of the nodes
    `rubbing`."""
    n, tangents = len(problem.gap), len(rubbing)
    sets = np.full(n, SLIP_FORWARD, dtype=np.int8)
    if len(problem.slip_before):
        slip = problem.jacobian[n:] @ coordinates - problem.compliance[n:] @ forces + problem.slip_before
        sets[slip < 0.0] = SLIP_BACKWARD
    upper, lower = active[n : n + tangents], active[n + tangents :]
    sets[rubbing] = np.where(upper, SLIP_FORWARD, np.where(lower, SLIP_BACKWARD, STICK))
    sets[active[:n]] = OPEN
    return sets


def _root(stiffness: np.ndarray) -> np.ndarray:
    """L (k, r) with L L^T the stiffness and r its rank."""
    values, vectors = np.linalg.eigh(stiffness)
    kept = values > 1e-14 * max(values[-1], 1.0)
    return vectors[:, kept] * np.sqrt(values[kept])
