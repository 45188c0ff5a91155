"""A gear of several meshes that stands on points, in the plane without friction: the teeth that are in mesh at a step
say what its points change."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fenics_gears.elasticity.whole_body.ring_on_points import RingOnPoints

from .flank_forces import flank_rows
from .mesh_cycle import Cycle
from .operator import Position
from .tooth_pair import node_slices
from .whole_body_mesh import first_tooth

WHEEL = 1


class WheelOnPoints:
    """The wheel of some `meshes` of a row, by their numbers. The body of each cycle is counted from that mesh's own
    tooth 0."""

    def __init__(self, meshes: Sequence[int]):
        self.meshes = meshes
        # By mesh and place in its mesh cycle: the same in every one, but for the number of the first tooth.
        self._known: dict[tuple[int, float], np.ndarray] = {}

    def put_in(
        self, step: float, cycles: Sequence[Cycle], of_meshes: Sequence[tuple[Position, int]], even: np.ndarray
    ) -> np.ndarray:
        """Compliance (n, n), mm/N, between the nodes of all meshes at a step, from that of a wheel on `even` springs;
        `of_meshes`: the position of each, and its first node among all."""
        loosened = _body(cycles[self.meshes[0]]).loosened * cycles[self.meshes[0]].pair.face_width
        parts = []
        for mesh in self.meshes:
            cycle = cycles[mesh]
            position, first = of_meshes[mesh]
            tooth = first_tooth(cycle.pair.sides[WHEEL], int(step // cycle.steps))
            moved = np.roll(self._moved(mesh, cycle, position), tooth, axis=0).reshape(len(loosened), -1)
            parts.append((slice(first, first + position.operator.nodes), moved))
        found = even.copy()
        for own, moved in parts:
            forces = loosened @ moved
            for other, by_other in parts:
                found[other, own] -= by_other.T @ forces
        return found

    def _moved(self, mesh: int, cycle: Cycle, position: Position) -> np.ndarray:
        """Motions (teeth, 2, n), mm/N, of the outer circle on even springs by normal forces at the nodes of a mesh, in
        its first mesh cycle."""
        key = mesh, position.index
        if key not in self._known:
            side = cycle.pair.sides[WHEEL]
            body = _body(cycle)
            operator = position.operator
            moved = np.empty((2 * body.teeth, operator.nodes))
            for nodes, pair in zip(node_slices(operator.pairs), operator.pairs):
                on_flank = flank_rows(side, pair, False)
                moved[:, nodes] = body.moved(pair.place.teeth[WHEEL]) @ on_flank
            self._known[key] = moved.reshape(body.teeth, 2, -1) / cycle.pair.face_width
        return self._known[key]


def _body(cycle: Cycle) -> RingOnPoints:
    body = cycle.bodies[WHEEL]
    assert isinstance(body, RingOnPoints)
    return body
