"""Tresca's fixed point: a convex quadratic programme for the forces with friction bounds frozen at s = mu p_n, then new
bounds.

With frozen bounds the step is the minimum of the energy (model.md section 4): over p and z, with K = L L^T,

    1/2 p^T C p + 1/2 z^T z + gap . p_n - w_old . p_t   subject to   L z + G^T p = F,  p_n >= 0,  |p_t| <= s

whose multipliers of the equality are the centre coordinates q, also where K is singular and only contact holds the
load. The sets that the programme settles on start Newton, so that the solution is as exact as by any other method.
Without friction there are no bounds, and one programme is enough; it also solves contact nodes so close that elasticity
hardly tells them apart, where Newton's sets alternate for ever.

A programme is posed for the nodes that were closed before; those that then penetrate join it until none does. What is
left out has no force and an open gap, as in the programme of all nodes, whose time grows with their cube.
"""

from __future__ import annotations

import logging
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.linalg import qr
from scipy.optimize import nnls

from .laws import OPEN, RESIDUAL_NAMES, SLIP_BACKWARD, SLIP_FORWARD, STICK, measure
from .mixed_form import Iterate
from .newton import CONVERGED, CYCLED, SINGULAR

LOGGER = logging.getLogger(__name__)
MOST_PROGRAMMES = 100
# Seconds of a programme by the cube of its nodes (measured on 40 to 240 of them). A fixed point that may take longer
# than the second number is told of, and none goes on for longer than the third.
NODES_CUBE, NOTABLE_SECONDS, MOST_SECONDS = 1.7e-8, 10.0, 60.0
# From this programme on only half of each change of the bounds is taken, so that bounds that alternate converge.
UNRELAXED = 20
# In the largest gaps and deflections: longer slips before a step are cut to this, for they decide the direction of
# friction alone. A run starts with millions of steps slid, beside which deflections are round-off.
LONGEST_SLIP = 1e3
# Nodes that are left out of a programme join it where they penetrate by more than this part of the tolerance.
NO_PENETRATION = 1e-2


@dataclass(frozen=True)
class Frozen:
    """Solution of the programme with frozen bounds: forces (m,), N, coordinates (k,), mm, and the sets (n,)."""

    forces: np.ndarray
    coordinates: np.ndarray
    sets: np.ndarray


class Work:
    """Counted seconds of a step's programmes; not those of a clock, so that every machine ends at the same one."""

    def __init__(self):
        self.seconds, self._told = 0.0, False

    def allows(self, nodes: int) -> bool:
        """Whether there is time for one more programme of so many nodes, which is counted; says so where it is long."""
        seconds = NODES_CUBE * nodes**3
        if seconds > NOTABLE_SECONDS and not self._told:
            self._told = True
            LOGGER.warning(
                "Newton's method does not solve a step. Its friction is now iterated as Tresca's, by quadratic"
                " programmes of %d contact nodes and about %.2g s each, for about %.2g s at most. The usual cause:"
                " contact nodes stand closer than the nodes of flank elements. Fewer accuracy.contact_nodes help, or a"
                " smaller accuracy.flank_element_size.",
                nodes,
                seconds,
                MOST_SECONDS,
            )
        self.seconds += seconds
        return self.seconds <= MOST_SECONDS


def tresca(problem, status: np.ndarray, polish: Callable):
    """The fixed point from no friction at all; `polish(sets)` solves from given sets, as `step_solver.run_newton` does.

    Returns what `step_solver.run_newton` returns, `polish`'s where it converges; iterations count programmes and
    Newton's together.
    """
    n, spent, relaxation, work = len(problem.gap), 0, 1.0, Work()
    history, sets, tried = [], [], set()
    bounds, before = np.zeros(n), status
    outcome = CYCLED
    for programme in range(MOST_PROGRAMMES):
        frozen = frozen_friction(problem, bounds, before != OPEN, work)
        spent += 1
        if frozen is None:
            outcome = SINGULAR if work.seconds <= MOST_SECONDS else CYCLED
            break
        displacement = problem.jacobian @ frozen.coordinates - problem.compliance @ frozen.forces
        history.append(np.zeros(len(RESIDUAL_NAMES)))
        measure(history[-1], problem, Iterate(frozen.sets, frozen.forces, frozen.coordinates, displacement))
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


def frozen_friction(problem, bounds: np.ndarray, first: np.ndarray, work: Work) -> Frozen | None:
    """The forces that minimise the energy with |p_t| <= `bounds` (n,), N; None where the programme has no solution, or
    no time is left. `first` (n,): nodes that the programme is posed for to begin with, besides those that may rub."""
    n, chosen = len(problem.gap), first | (bounds > 0.0)
    if not chosen.any():
        chosen[:] = True
    while work.allows(np.count_nonzero(chosen)):
        nodes = np.flatnonzero(chosen)
        rows = nodes if not len(problem.slip_before) else np.concatenate((nodes, n + nodes))
        programme = _programme(_of_nodes(problem, nodes, rows), bounds[nodes])
        if programme is None:
            if chosen.all():
                return None
            chosen[:] = True
            continue
        forces, sets = np.zeros(len(problem.compliance)), np.full(n, OPEN, dtype=np.int8)
        forces[rows], sets[nodes] = programme.forces, programme.sets
        displacement = problem.jacobian[:n] @ programme.coordinates - problem.compliance[:n] @ forces
        missed = (displacement - problem.gap > NO_PENETRATION * problem.tolerance.length) & ~chosen
        if not missed.any():
            return Frozen(forces, programme.coordinates, sets)
        chosen |= missed
    return None


def _of_nodes(problem, nodes: np.ndarray, rows: np.ndarray):
    """The step without the other contact nodes."""
    return problem._replace(
        compliance=problem.compliance[np.ix_(rows, rows)],
        jacobian=problem.jacobian[rows],
        gap=problem.gap[nodes],
        slip_before=problem.slip_before[nodes] if len(problem.slip_before) else problem.slip_before,
    )


def _programme(problem, bounds: np.ndarray) -> Frozen | None:
    n, soft = len(problem.gap), problem.compliance[0, 0]
    if not np.isfinite(problem.compliance).all():
        return None
    # Of the load, or of wedged flanks, which press each other by far more.
    force = max(np.abs(problem.load).max(initial=0.0), 1e3 * problem.tolerance.force, -problem.gap.min() / soft)
    # Tangents whose bounds are zero are left out.
    rubbing = np.flatnonzero(bounds > 1e-12 * force)
    rows = np.concatenate((np.arange(n), n + rubbing))
    root = _root(problem.stiffness * soft)
    size, tangents = len(rows), len(rubbing)
    energy = np.eye(size + root.shape[1])
    energy[:size, :size] = problem.compliance[np.ix_(rows, rows)] / soft
    distance = np.zeros(len(energy))
    longest = LONGEST_SLIP * (np.abs(problem.gap).max() + force * soft)
    slips = np.clip(problem.slip_before, -longest, longest)
    distance[:size] = np.concatenate((problem.gap, -slips))[rows] / (force * soft)
    limits = np.zeros((n + 2 * tangents, len(energy)))
    limits[:n, :n] = np.eye(n)
    limits[n : n + tangents, n:size], limits[n + tangents :, n:size] = -np.eye(tangents), np.eye(tangents)
    least = -np.concatenate((np.zeros(n), bounds[rubbing], bounds[rubbing])) / force
    balance = np.hstack((problem.jacobian[rows].T, root))
    minimum = _least(energy, distance, limits, least, balance, problem.load / force)
    if minimum is None:
        return None
    minimiser, held, multipliers = minimum
    forces = np.zeros(len(problem.compliance))
    forces[rows] = minimiser[:size] * force
    coordinates = multipliers * force * soft
    return Frozen(forces, coordinates, _sets(problem, forces, coordinates, rubbing, held > 0.0))


def _least(energy, linear, limits, least, balance, load) -> tuple[np.ndarray, np.ndarray, np.ndarray] | None:
    """The x that minimises 1/2 x^T `energy` x + `linear` . x with `limits` x >= `least` and `balance` x = `load`, and
    the multipliers of both; None where no x obeys them.

    The equalities are eliminated by an orthogonal basis of what they leave free. In y = U x + c, with U^T U the energy,
    what is left is the least distance from the origin, whose dual is a least-squares problem with unknowns >= 0
    (C. L. Lawson and R. J. Hanson, Solving Least Squares Problems, 1974, chapter 23): solved exactly, in finitely many
    steps.
    """
    basis, triangle = qr(balance.T)
    held, free = np.split(basis, [len(load)], axis=1)
    start = held @ np.linalg.lstsq(triangle[: len(load)].T, load, rcond=None)[0]
    values, vectors = np.linalg.eigh(free.T @ energy @ free)
    # Columns of `free` in which the energy is the identity; nodes that elasticity cannot tell apart keep a little.
    free = free @ (vectors / np.sqrt(np.maximum(values, 1e-15 * values.max(initial=0.0))))
    shift = free.T @ (energy @ start + linear)
    inner = limits @ free
    # Lengths are those of the unbounded minimum, which is far from the origin where slips are long.
    unit = max(np.linalg.norm(shift), 1.0)
    rows = np.vstack((inner.T, (least - limits @ start + inner @ shift) / unit))
    lengths = np.linalg.norm(rows, axis=0)
    lengths[lengths == 0.0] = 1.0
    target = np.zeros(len(rows))
    target[-1] = 1.0
    try:
        dual = nnls(rows / lengths, target, maxiter=30 * rows.shape[1])[0] / lengths
    except RuntimeError:
        return None
    nearest = rows @ dual - target
    if not nearest[-1] < 0.0:
        return None
    pressed = dual * (unit / -nearest[-1])
    minimiser = start + free @ (nearest[:-1] * (unit / -nearest[-1]) - shift)
    slope = energy @ minimiser + linear - limits.T @ pressed
    return minimiser, pressed, np.linalg.lstsq(balance.T, slope, rcond=None)[0]


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
