"""Rigid flanks with friction, by common practice: tooth pairs that touch share the force evenly, and slide as in the
nominal motion.

Rigid flanks determine neither how pairs share a force nor, at the pitch point, which way they slide. Each pair's
friction is mu times its share of the force, against the sliding of the nominal motion; motion of bearings and shafts
does not change its sign.
"""

from __future__ import annotations

import numpy as np

from fenics_gears.contact.operator import ContactOperator, lines_of
from fenics_gears.contact.rigid_mesh import RigidSolver, pairs_that_touch
from fenics_gears.contact.step_solver import StepProblem
from fenics_gears.geometry.sliding import sliding_per_rotation


class RigidFriction(RigidSolver):
    """Solves a step between rigid flanks with friction."""

    def _candidates(self, leaders: list[int]) -> list[list[int]]:
        return [[], *([leader] for leader in leaders)]

    def _unit_forces(self, operator: ContactOperator, problem: StepProblem, touching: list[int]) -> np.ndarray:
        """Forces (2 n, t) per unit mesh force: even shares on the nearest node of each pair that touches with a leader,
        and their friction."""
        count, sliding = len(problem.gap), np.sign(self._sliding(operator))
        unit = np.zeros((2 * count, len(touching)))
        for column, leader in enumerate(touching):
            together = pairs_that_touch(operator, leader)
            for pair in together:
                nodes = np.flatnonzero(operator.node_pair == pair)
                node = leader if pair == operator.node_pair[leader] else nodes[np.argmin(problem.gap[nodes])]
                unit[node, column] = 1.0 / len(together)
                unit[count + node, column] = problem.friction * sliding[node] / len(together)
        return unit

    def _sliding(self, operator: ContactOperator) -> np.ndarray:
        """Sliding (n,) of the nominal motion at this position, mm per rad of the pinion."""
        lines = lines_of(operator.pairs, operator.base_radii)
        return lines.turn * sliding_per_rotation(self.pair, lines.friction_arms[0])
