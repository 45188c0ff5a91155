"""The mesh cycle of the reference route: both gears meshed anew at every position, so that flank nodes meet pair by pair."""

from __future__ import annotations

from functools import partial

import numpy as np

from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.contact.node_to_node import NodePairs, NodeResponse, by_direction, loaded_teeth, node_pairs, node_to_node_operator
from fenics_gears.contact.published_solver import PublishedSolver, RemeshedPosition
from fenics_gears.contact.tooth_pair import Place, Removal
from fenics_gears.contact.window import ContactGrid
from fenics_gears.elasticity.remeshed_gear import LoadedTooth
from fenics_gears.geometry.pair import GearPair

GEARS = (0, 1)
# A position needs its own and that of the one before; positions are built in the order of time.
KEPT_COMPLIANCES = 3


class RemeshedCycle(Cycle):
    """Contact nodes that are nodes of both gears' meshes; `order`: of the finite element; `grid` spaces its vertices.

    `coordinates`: which centre coordinates are unknowns; `tangential`: whether friction acts. Positions can be asked for once
    `stiffness` is set: for each position that of pinion and wheel, N/mm per mm of face width, on the nodes of `teeth`.
    """

    def __init__(
        self,
        pair: GearPair,
        removal: tuple[Removal | None, Removal | None],
        grid: ContactGrid,
        order: int,
        steps: int,
        coordinates: list[int],
        tangential: bool,
    ):
        super().__init__(pair, ContactGrid(grid.length, order * (grid.nodes - 1) + 1), steps)
        self.stiffness: list[tuple[np.ndarray, np.ndarray]] = []
        self._removal, self._vertices, self._order = removal, grid, order
        self._coordinates, self._tangential = coordinates, tangential
        self._compliances: dict[int, tuple[np.ndarray, np.ndarray]] = {}
        self._solver = PublishedSolver(coordinates)

    def solve(self, position: RemeshedPosition, problem, status, last):
        """Newton with line search [B], the program's own ladder where it finds no solution."""
        return self._solver(position, problem, status, last)

    def teeth(self, index: int) -> tuple[tuple[LoadedTooth, ...], tuple[LoadedTooth, ...]]:
        """The loaded teeth of pinion and wheel at position `index`, with the flank vertices that contact wants there."""
        return tuple(loaded_teeth(self.pairs_at(index), gear, self._order) for gear in GEARS)

    def _pair(self, place: Place) -> NodePairs | None:
        return node_pairs(self.pair, self._removal, self._vertices, self._order, place)

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
        pairs, widths = self.pairs_at(index), self.pair.face_widths
        return tuple(by_direction(widths[gear] * self.stiffness[index][gear], pairs, gear) for gear in GEARS)

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
