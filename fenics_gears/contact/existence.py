"""Why a contact step has no solution: by its load, its friction and the flexibility of the contact nodes.

Where only contact holds the load, contact forces must balance it along the motion f that nothing else holds: a normal
force p_n at a node with friction that opposes its slip (sign sigma) gives (a_n + sigma mu a_t) p_n along f, a = G f.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from .errors import MOVES_FREELY, ContactNotConverged, MoreThanOneSolution, NoStaticEquilibrium, SelfLocking
from .laws import OPEN, SLIP_BACKWARD, SLIP_FORWARD
from .newton import CYCLED, OUTCOMES
from .operator import ContactOperator
from .uniqueness import flexibility, is_only_solution

# A cycle of sets is rarely longer.
LAST_SETS = 6


@dataclass(frozen=True)
class Balance:
    """How much of the load along the free motion a unit normal force at each node balances, (n,).

    `normal`: by itself; `sliding`: with the friction that opposes the node's slip; `most`: with the friction that helps
    most.
    """

    normal: np.ndarray
    sliding: np.ndarray
    most: np.ndarray


def balance(jacobian: np.ndarray, motion: np.ndarray, friction: float, slip_sign: np.ndarray) -> Balance:
    """Balance along `motion` (k,); `jacobian` (m, k); `slip_sign` (n,), empty without friction."""
    along = jacobian @ motion
    n = len(along) - len(slip_sign)
    normal = along[:n]
    if not len(slip_sign):
        return Balance(normal, normal, normal)
    return Balance(normal, normal + friction * slip_sign * along[n:], normal + friction * np.abs(along[n:]))


def working(jacobian: np.ndarray, motion: np.ndarray, forces: np.ndarray) -> Balance:
    """Balance of the nodes that a solution, `forces` (m,), presses, with the friction that acts there; zero
    elsewhere."""
    along, n = jacobian @ motion, len(forces) // 2
    pressed = forces[:n] > 0.0
    normal = np.where(pressed, along[:n], 0.0)
    share = np.divide(forces[n:], forces[:n], out=np.zeros(n), where=pressed)
    return Balance(normal, normal + share * along[n:], normal)


def locked_nodes(weights: Balance) -> np.ndarray:
    """Nodes (n,) whose normal force holds the load while their friction cancels it or more."""
    return (weights.normal > 0.0) & (weights.sliding <= 0.0)


def _undone(weights: Balance) -> np.ndarray:
    """What part (n,) of the load that a node's normal force holds its friction cancels; 0 where it is not locked."""
    locked = locked_nodes(weights)
    return np.where(locked, 1.0 - weights.sliding / np.where(locked, weights.normal, 1.0), 0.0)


def locks(operator: ContactOperator, forces: np.ndarray, wheels: np.ndarray, nodes: Sequence[slice]) -> bool:
    """Whether friction at a closed node cancels more of the load on its wheel than its normal force holds. By mesh,
    `wheels` (f, k): how the coordinates move as the load turns the wheel; `nodes`: those of the mesh."""
    meshes = zip(wheels, nodes)
    return any(locked_nodes(working(operator.jacobian, wheel, forces))[own].any() for wheel, own in meshes)


def explained(problem, attempts) -> ContactNotConverged:
    """The error of a step that no method solved, of the kind that says why."""
    if not len(problem.gap):
        return NoStaticEquilibrium(
            attempts,
            "no equilibrium: no tooth pair can touch at this position, and nothing else holds the static load:"
            f" {MOVES_FREELY}",
        )
    motions = _free_motions(problem)
    weights = [balance(problem.jacobian, each, problem.friction, np.sign(problem.slip_before)) for each in motions]
    for motion, each in zip(motions, weights):
        if problem.load @ motion != 0.0 and each.most.max() <= 0.0:
            return NoStaticEquilibrium(
                attempts, f"no equilibrium: the static load pulls the flanks apart, all gaps open and {MOVES_FREELY}"
            )
    if len(problem.slip_before):
        visited = _visited(attempts)
        locking = _locking(problem, visited, weights)
        if locking:
            return SelfLocking(attempts, locking)
        several = _several(problem, visited)
        if several:
            return MoreThanOneSolution(attempts, several)
    return ContactNotConverged(attempts, _reason(problem, attempts))


def _free_motions(problem) -> np.ndarray:
    """The free motions (f, k) of a problem: one of each mesh that alone holds the load."""
    return problem.free_motion.reshape(-1, len(problem.load))


def _visited(attempts) -> np.ndarray:
    """The different sets (rows, n) that the attempts ended with."""
    rows = np.concatenate([sets[-LAST_SETS:] for _, _, _, sets in attempts])
    return np.unique(rows[np.any(rows >= 0, axis=1)], axis=0)


def _signs(problem, sets: np.ndarray) -> np.ndarray:
    """Direction of slip (n,) in given sets; where they leave it open, that of the slip so far."""
    return np.where(sets == SLIP_FORWARD, 1.0, np.where(sets == SLIP_BACKWARD, -1.0, np.sign(problem.slip_before)))


def _locking(problem, visited: np.ndarray, weights: Sequence[Balance]) -> str:
    start = f"self-locking: with a friction coefficient of {problem.friction:g} "
    if any(each.sliding.max() <= 0.0 for each in weights):
        return start + "no contact forces whose friction opposes the slip can balance the load"
    worst = ""
    for sets in visited:
        closed, signs = sets != OPEN, _signs(problem, sets)
        if weights:
            balances = [balance(problem.jacobian, each, problem.friction, signs) for each in _free_motions(problem)]
            locked = closed & np.any([locked_nodes(each) for each in balances], axis=0)
            ratio = max(np.max(_undone(each)[closed], initial=0.0) for each in balances)
            words = f"the friction undoes {ratio:.3g} times what the normal forces hold"
        else:
            locked = closed & (_own_response(problem, signs) <= 0.0)
            words = "the friction moves the flanks together by more than the normal force moves them apart"
        if locked.any():
            worst = f"{words} at {locked.sum()} of {closed.sum()} closed nodes"
    return start + worst if worst else ""


def _own_response(problem, signs: np.ndarray) -> np.ndarray:
    """How far a sliding node (n,) yields under its own normal force, mm/N."""
    n, matrix = len(signs), flexibility(problem.stiffness, problem.compliance, problem.jacobian)
    return np.diag(matrix)[:n] + problem.friction * signs * np.diag(matrix[:n, n:])


def _several(problem, visited: np.ndarray) -> str:
    for sets in visited:
        certified = is_only_solution(
            problem.stiffness,
            problem.compliance,
            problem.jacobian,
            problem.friction,
            sets != OPEN,
            _signs(problem, sets),
        )
        if not certified:
            return (
                f"more than one solution, or none: with a friction coefficient of {problem.friction:g} friction couples"
                " the closed nodes so strongly that the certificate, sym(W_nn + W_nt diag(sigma mu)) positive"
                " definite, fails"
            )
    return ""


def _reason(problem, attempts) -> str:
    if attempts[-1][1] == OUTCOMES[CYCLED]:
        return (
            "Newton and each of its fallbacks ended with sets that alternate. Where contact nodes stand closer than the"
            " nodes of flank elements, fewer accuracy.contact_nodes help, or a smaller accuracy.flank_element_size"
        )
    return (
        "the sets settle, but the equations cannot be solved within the tolerance: "
        "the scene's stiffnesses or loads differ by too many orders of magnitude"
    )
