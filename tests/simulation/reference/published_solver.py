"""A step of `condensation = "every step"` solved by the paper's Newton method, to be held against the program's."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from tests.simulation.reference.published_newton import Equations, Iterate, iterates
from tests.simulation.reference.relative_stiffness import RelativeStiffness

from fenics_gears.contact.laws import OPEN
from fenics_gears.contact.mixed_form import StepEquations
from fenics_gears.contact.operator import Position
from fenics_gears.contact.step_solver import NEWTON, StepSolution

MOST_ITERATIONS = 60
NO_DIRECTION = "no search direction"
TOO_MANY = "the merit function stays too large"
# The laws are piecewise linear: with the right sets one iteration leaves nothing but round-off.
SMALL = 1e-3


class PublishedSolver:
    """Newton with line search [B] on [24], [25] and [C.1].

    The equations are reduced to the relative displacement once for each position and effective stiffness.
    """

    def __init__(self, coordinates: list[int], stiffness: Callable[[int], tuple[np.ndarray, np.ndarray]]):
        """`stiffness(index)`: of either gear at a position, as of `RemeshedGears`."""
        self._coordinates = coordinates
        self._stiffness = stiffness
        self._reduced: dict[tuple[int, bytes], RelativeStiffness] = {}

    def __call__(
        self, position: Position, problem: StepEquations, status: np.ndarray, last: StepSolution | None
    ) -> StepSolution:
        """Solve a step from the last one's solution. Raises AssertionError where that finds no solution."""
        reduced = self.reduced(position, problem)
        equations = Equations(
            stiffness=reduced.stiffness,
            load=reduced.load(problem.load),
            gap=problem.gap,
            slip_before=problem.slip_before,
            friction=problem.friction,
            r=1.0 / np.diag(problem.compliance),
        )
        tried, outcome = _newton(equations, *_start(position, problem, status, last), problem.tolerance.force)
        assert not outcome, outcome
        final = tried[-1]
        sets = equations.status(final.displacement, final.forces)
        closed = sets != OPEN
        forces = np.where(np.tile(closed, len(final.forces) // len(closed)), final.forces, 0.0)
        coordinates = reduced.coordinates(problem.load, final.displacement)
        return StepSolution(forces, coordinates, final.displacement, sets, len(tried) - 1, NEWTON)

    def reduced(self, position: Position, problem: StepEquations) -> RelativeStiffness:
        """The equilibrium equations [C.1] of a position and an effective stiffness."""
        key = (position.index, problem.stiffness.tobytes())
        if key not in self._reduced:
            self._reduced[key] = RelativeStiffness(
                self._stiffness(position.index),
                problem.stiffness,
                self._coordinates,
                position.operator.sides,
                tangential=len(problem.slip_before) > 0,
            )
        return self._reduced[key]


def _start(
    position, problem: StepEquations, status: np.ndarray, last: StepSolution | None
) -> tuple[np.ndarray, np.ndarray]:
    """The last step's displacement and forces at the nodes that had the same place; at the very first, the closed nodes
    just touch."""
    n = len(problem.gap)
    m = len(problem.compliance)
    displacement = np.zeros(m)
    forces = np.zeros(m)
    if last is None:
        closed = np.flatnonzero(status != OPEN)
        displacement[closed] = problem.gap[closed]
        forces[closed] = problem.tolerance.force
        return displacement, forces
    node_before = position.node_before
    before = len(last.status)
    known = np.flatnonzero(node_before >= 0)
    for block in range(m // n):
        displacement[block * n + known] = last.displacement[block * before + node_before[known]]
        forces[block * n + known] = last.forces[block * before + node_before[known]]
    return displacement, forces


def _newton(equations: Equations, displacement, forces, force_tolerance: float) -> tuple[list[Iterate], str]:
    """Iterates, and why the last one is no solution; an empty text where it is."""
    tried: list[Iterate] = []
    try:
        for iterate in iterates(equations, displacement, forces):
            tried.append(iterate)
            if len(tried) > 1 and iterate.merit <= 0.5 * (SMALL * force_tolerance) ** 2:
                return tried, ""
            if len(tried) > MOST_ITERATIONS:
                # Round-off may leave a residual above SMALL times the tolerance.
                return tried, "" if iterate.merit <= 0.5 * force_tolerance**2 else TOO_MANY
    except np.linalg.LinAlgError:
        pass
    return tried, NO_DIRECTION
