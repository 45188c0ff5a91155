"""A march without gears: the flanks slide over one another at constant speed."""

from types import SimpleNamespace

import numpy as np

from fenics_gears.contact.mesh import MeshTraits
from fenics_gears.contact.mixed_form import StepEquations
from fenics_gears.contact.operator import Position, Stored
from fenics_gears.contact.step_solver import NEWTON, StepSolution, solve_step
from fenics_gears.dynamics.drivetrain import Drivetrain
from fenics_gears.dynamics.march import Marcher
from fenics_gears.dynamics.stepping import EquationsOfMotion
from fenics_gears.dynamics.steps import Record
from fenics_gears.dynamics.time_integration import State


class SlidingBlock:
    """The contact of a step problem at any time; a whole step slides by its `slip_before`. `solved`: length of every
    step tried."""

    traits = MeshTraits(divisible=True)
    face = None

    def __init__(self, problem: StepEquations):
        self.problem, self.steps, self.solved = problem, 100, []
        self.longest_lever = 0.0

    def build(self, steps):
        """Positions are made one by one."""

    def position(self, step):
        return self.between(step, step - 1)

    def between(self, step, before):
        problem, n = self.problem, len(self.problem.gap)
        operator = SimpleNamespace(
            nodes=n, compliance=problem.compliance, stored_jacobians=(problem.jacobian, None), gap=problem.gap,
            rigid_slip=(step - before) * problem.slip_before,
            previous_compliance=problem.compliance[n:], previous_jacobian=problem.jacobian[n:],
            stored=Stored(problem.compliance), stored_before=Stored(np.ascontiguousarray(problem.compliance[n:].T)),
        )  # fmt: skip
        self.solved.append(step - before)
        return Position(operator, np.arange(n))

    def solve(self, position, problem, status, last):
        return solve_step(problem, status)


def block_at_rest(problem: StepEquations, status: np.ndarray) -> tuple[Marcher, Record]:
    """A block whose first step of 1 ms is the problem, by its mass, and its state before: at rest, sets `status`
    (n,)."""
    step, k = 1e-3, len(problem.load)
    mass = 0.25 * step**2 * problem.stiffness
    names = ("rotation_2", "centre_x1", "centre_y1")[:k]
    block = Drivetrain(names, np.ones(k), np.zeros((k, k)), problem.load, mass, None)
    marcher = Marcher(SlidingBlock(problem), EquationsOfMotion(block, step, problem.friction))
    rest, nothing = np.zeros(k), np.zeros(len(problem.compliance))
    solution = StepSolution(nothing, rest, nothing, status, 0, NEWTON)
    return marcher, Record(0, State(rest, rest, rest), marcher.cycle.position(0), solution)
