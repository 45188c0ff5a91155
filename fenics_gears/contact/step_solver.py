"""One contact step, solved: Newton first, then its fallbacks one after the other (model.md section 4)."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from .addresses import form_rows, row_of
from .laws import OPEN, SLIP_FORWARD
from .mixed_form import Iterate, StepEquations
from .newton import (
    ALL_AT_ONCE,
    CONVERGED,
    FAILED,
    MOST_ITERATIONS,
    ONE_AT_A_TIME,
    OUTCOMES,
    THROUGH_STICK,
    newton_at,
    newton_solver,
)

NEWTON = "newton"
NEWTON_AND_FALLBACKS = (NEWTON, "slip through stick", "one change at a time", "Tresca fixed point")
# The march itself divides the step in two where all of these end without a solution.
HALVED = "step halved"
METHODS = (*NEWTON_AND_FALLBACKS, HALVED)


@dataclass(frozen=True)
class StepSolution:
    """Nodal forces (m,), N, centre coordinates (k,), mm, relative displacement (m,), mm, and the sets (n,).

    `iterations`: of Newton and all fallbacks together, but for those without friction that give sets to begin with;
    `method`: of METHODS the one that converged.
    """

    forces: np.ndarray
    coordinates: np.ndarray
    displacement: np.ndarray
    status: np.ndarray
    iterations: int
    method: str


def cold_start(gap: np.ndarray, node_pair: np.ndarray) -> np.ndarray:
    """Sets (n,) to begin with where nothing is known: the nearest node of each tooth pair is closed."""
    status = np.full(len(gap), OPEN, dtype=np.int8)
    for pair in np.unique(node_pair):
        nodes = np.flatnonzero(node_pair == pair)
        status[nodes[np.argmin(gap[nodes])]] = SLIP_FORWARD
    return status


def solve_step(problem: StepEquations, status: np.ndarray, max_iterations: int = MOST_ITERATIONS) -> StepSolution:
    """Solve one step from the sets `status` (n,) int8.

    Raises ContactNotConverged, of the kind that says why, with the history of every method when none converges.
    """
    attempts: list[tuple] = []
    spent = 0
    for method, attempt in _methods(problem, status, max_iterations):
        result, record = attempt()
        attempts.append((method, OUTCOMES[result[0]], *record))
        spent += result[1]
        if result[0] == CONVERGED:
            outcome, iterations, forces, coordinates, displacement, sets = result
            return StepSolution(forces, coordinates, displacement, sets, spent, method)
    # Of a step that no method solves.
    from .existence import explained

    _form_all(problem)
    raise explained(problem, attempts)


def _methods(problem: StepEquations, status: np.ndarray, max_iterations: int) -> Iterator[tuple[str, Callable]]:
    """The methods that apply, in the order of NEWTON_AND_FALLBACKS; without friction the first and the last two.

    Murty's rule stands before Tresca's fixed point: it costs about a hundredth, and its solutions are exact.
    """
    newton, through, one_by_one, fixed_point = NEWTON_AND_FALLBACKS
    yield newton, lambda: run_newton(problem, status, max_iterations)
    if len(problem.slip_before):
        yield through, lambda: run_newton(problem, status, max_iterations, rule=THROUGH_STICK)
    yield one_by_one, lambda: run_newton(problem, status, 10 * max_iterations, rule=ONE_AT_A_TIME)
    if len(problem.gap):
        # Imported where it is needed, which is rare.
        from .tresca import tresca

        _form_all(problem)
        yield (
            fixed_point,
            lambda: tresca(problem, status, lambda sets: run_newton(problem, sets, max_iterations, rule=THROUGH_STICK)),
        )


def _form_all(problem: StepEquations) -> None:
    """Form the whole compliance, which other methods than Newton's read, and what explains their failure."""
    form_rows(problem.rows, np.arange(len(problem.gap)))


def run_newton(
    problem: StepEquations, status: np.ndarray, max_iterations: int, *, r_scale: float = 1.0, rule: int = ALL_AT_ONCE
):
    """Newton from `status`; returns ((outcome, iterations, forces, coordinates, u, sets), (history, all sets))."""
    history = np.zeros((max_iterations, 5))
    sets = np.full((max_iterations, len(problem.gap)), -1, dtype=np.int8)
    m = len(problem.compliance)
    iterate = Iterate(status.copy(), np.zeros(m), np.zeros(len(problem.load)), np.zeros(m))
    arrays = (
        problem.stiffness, problem.load, problem.compliance, problem.jacobian, problem.gap, problem.slip_before,
        problem.free_motion, *iterate, history, sets,
    )  # fmt: skip
    (n, *addresses), held = row_of(len(problem.gap), arrays)
    sizes = n, m, len(problem.load), len(problem.free_motion), len(problem.slip_before), max_iterations
    numbers = np.array([*sizes, problem.rows, rule, *addresses])
    settings = np.array([problem.friction, r_scale, *problem.tolerance])
    outcome, done = newton_at(newton_solver().address, numbers, settings)
    # They are held as long as their addresses are used.
    del held
    if done == FAILED:
        done = int(np.sum(np.any(sets >= 0, axis=1)))
    result = outcome, done, iterate.forces, iterate.coordinates, iterate.displacement, iterate.status
    used = max(done, 1)
    return result, (history[:used], sets[:used])
