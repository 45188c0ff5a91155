"""Rigid flanks with friction, by common practice: tooth pairs that touch share the force evenly, and slide as in the nominal motion.

Rigid flanks determine neither how pairs share a force nor, at the pitch point, which way they slide. Each pair's friction is mu times its
share of the force, against the sliding of the nominal motion; motion of bearings and shafts does not change its sign.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from fenics_gears.contact.laws import SLIP_BACKWARD, SLIP_FORWARD, STICK
from fenics_gears.contact.operator import ContactOperator
from fenics_gears.contact.rigid_cycle import RigidCycle, RigidPosition, no_equilibrium, obeys, pairs_that_touch, tied, why_none_holds
from fenics_gears.contact.step_solver import NEWTON, StepProblem, StepSolution


class RigidFrictionCycle(RigidCycle):
    """Contact nodes on rigid flanks, with friction; arguments as of RigidCycle."""

    traits = replace(RigidCycle.traits, prescribes_friction=True)
    frictional = True

    def solve(self, position: RigidPosition, problem: StepProblem, status: np.ndarray, last: StepSolution | None) -> StepSolution:
        """The step with nothing touching, else with the leading drive flanks, else with the leading coast flanks.

        Raises ContactNotConverged where none of them holds the load.
        """
        operator, count = position.operator, len(problem.gap)
        leaders = [int(nodes[np.argmin(problem.gap[nodes])]) for nodes in position.sides if len(nodes)]
        for iterations, leader in enumerate([None, *leaders], 1):
            unit = np.zeros(2 * count) if leader is None else _shared(operator, problem, leader)
            forces, coordinates = _solved(problem, leader, unit)
            touching = [] if leader is None else [leader]
            if forces is not None and obeys(problem, leaders, touching, forces, coordinates):
                slips = np.where(unit[count:] > 0.0, SLIP_FORWARD, np.where(unit[count:] < 0.0, SLIP_BACKWARD, STICK))
                found = np.where(unit[:count] > 0.0, slips, 0).astype(np.int8)
                return StepSolution(forces, coordinates, problem.jacobian @ coordinates, found, iterations, NEWTON)
        raise no_equilibrium(why_none_holds(problem, leaders), count)


def _shared(operator: ContactOperator, problem: StepProblem, leader: int) -> np.ndarray:
    """Forces (2 n,) of a unit mesh force: even parts on the nearest node of each pair that touches, and their friction."""
    forces = np.zeros(2 * len(problem.gap))
    together = pairs_that_touch(operator, leader)
    for pair in together:
        nodes = np.flatnonzero(operator.node_pair == pair)
        node = leader if pair == operator.node_pair[leader] else nodes[np.argmin(problem.gap[nodes])]
        forces[node] = 1.0 / len(together)
        forces[len(problem.gap) + node] = problem.friction * np.sign(operator.rigid_slip[node]) / len(together)
    return forces


def _solved(problem: StepProblem, leader: int | None, unit: np.ndarray) -> tuple[np.ndarray | None, np.ndarray]:
    """Forces (2 n,) and coordinates (k,) with the leader touching or none; forces None where the drivetrain cannot be solved so."""
    k = len(problem.load)
    if leader is None:
        if len(problem.free_motion):
            return None, np.zeros(k)
        return unit, np.linalg.solve(problem.stiffness, problem.load)
    pressing, coordinates = tied(problem, problem.jacobian[[leader]], (problem.jacobian.T @ unit)[:, None], problem.gap[[leader]])
    return None if pressing is None else pressing[0] * unit, coordinates
