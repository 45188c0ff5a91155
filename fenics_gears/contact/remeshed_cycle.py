"""The mesh cycle of the reference route: both gears are meshed anew at every position, so that flank nodes meet pair by
pair."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

import numpy as np

from fenics_gears.contact.mesh_cycle import Cycle, CycleTraits, pair_places
from fenics_gears.contact.node_to_node import NodePairs, NodeResponse, by_direction, node_pairs, node_to_node_operator
from fenics_gears.contact.published_solver import PublishedSolver, RemeshedPosition
from fenics_gears.contact.tooth_pair import Removal
from fenics_gears.contact.window import ContactGrid
from fenics_gears.geometry.pair import GearPair

# A position needs its own compliance and that of the position before; positions are built in the order of time.
KEPT_COMPLIANCES = 3


def paired_nodes(
    pair: GearPair, removal: tuple[Removal | None, Removal | None], grid: ContactGrid, order: int, steps: int
) -> list[tuple[NodePairs, ...]]:
    """The contact nodes of every tooth pair at each position of a mesh cycle; `order`: of the finite element; `grid`
    spaces its vertices."""
    places = (pair_places(pair, grid, step / steps) for step in range(steps))
    found = ([node_pairs(pair, removal, grid, order, place) for place in each] for each in places)
    return [tuple(nodes for nodes in each if nodes is not None) for each in found]


class RemeshedCycle(Cycle):
    """Contact nodes that are nodes of both gears' meshes: `pairs` at each position, `grid` and `order` as of
    `paired_nodes`.

    `stiffness`: at each position that of pinion and wheel, N/mm per mm of face width, on the nodes of `loaded_teeth`;
    `coordinates`: which centre coordinates are unknowns; `tangential`: whether friction acts.
    """

    traits = CycleTraits(own_solver=True)

    def __init__(
        self,
        pair: GearPair,
        pairs: Sequence[tuple[NodePairs, ...]],
        stiffness: Sequence[tuple[np.ndarray, np.ndarray]],
        grid: ContactGrid,
        order: int,
        coordinates: list[int],
        tangential: bool,
    ):
        super().__init__(pair, ContactGrid(grid.length, order * (grid.nodes - 1) + 1), len(pairs))
        self._pairs, self._stiffness = dict(enumerate(pairs)), stiffness
        self._coordinates, self._tangential = coordinates, tangential
        self._compliances: dict[int, tuple[np.ndarray, np.ndarray]] = {}
        self._solver = PublishedSolver(coordinates)

    def solve(self, position: RemeshedPosition, problem, status, last):
        """Newton with line search [B]; the program's own Newton and its fallbacks where that finds no solution."""
        return self._solver(position, problem, status, last)

    def _position(self, index: int, pairs, previous, advance: float, carried: np.ndarray) -> RemeshedPosition:
        before = None
        if self._tangential:
            before = NodeResponse(previous, self._compliance((index - 1) % self.steps))
        operator = node_to_node_operator(
            self.pair,
            NodeResponse(pairs, self._compliance(index)),
            coordinates=self._coordinates,
            before=before,
            advance=advance,
        )
        return RemeshedPosition(operator, carried, index, partial(self._own_stiffness, index))

    def _own_stiffness(self, index: int) -> tuple[np.ndarray, np.ndarray]:
        pairs, width = self.pairs_at(index), self.pair.face_width
        return tuple(by_direction(width * self._stiffness[index][gear], pairs, gear) for gear in range(2))

    def _compliance(self, index: int) -> tuple[np.ndarray, np.ndarray]:
        """Flank compliance of either gear, hub held."""
        if index not in self._compliances:
            if len(self._compliances) >= KEPT_COMPLIANCES:
                del self._compliances[next(iter(self._compliances))]
            self._compliances[index] = tuple(_inverse(stiffness[:-3, :-3]) for stiffness in self._own_stiffness(index))
        return self._compliances[index]


def _inverse(stiffness: np.ndarray) -> np.ndarray:
    inverse = np.linalg.inv(stiffness)
    return 0.5 * (inverse + inverse.T)
