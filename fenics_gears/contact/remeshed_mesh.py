"""The mesh of the reference route: both gears are meshed anew at every position, so that flank nodes meet pair by
pair."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fenics_gears.geometry.pair import GearPair

from .mesh import Mesh, nodes_at
from .node_to_node import NodeResponse, by_direction, node_pairs, node_to_node_response
from .operator import Passage, Response
from .places import pair_places
from .tooth_pair import PairNodes, Removal
from .window import ContactGrid

# A position needs its own compliance and that of the position before; positions are built in the order of time.
KEPT_COMPLIANCES = 3


def paired_nodes(
    pair: GearPair, removal: tuple[Removal | None, Removal | None], grid: ContactGrid, order: int, steps: int
) -> list[tuple[PairNodes, ...]]:
    """The contact nodes of every tooth pair at each position of a mesh cycle; `order`: of the finite element; `grid`
    spaces its vertices."""
    places = (pair_places(pair, grid, step / steps) for step in range(steps))
    return [nodes_at(each, lambda place: node_pairs(pair, removal, grid, order, place)) for each in places]


def remeshed_mesh(
    pair: GearPair,
    pairs: Sequence[tuple[PairNodes, ...]],
    stiffness: Sequence[tuple[np.ndarray, np.ndarray]],
    grid: ContactGrid,
    order: int,
) -> Mesh:
    """Contact nodes that are nodes of both gears' meshes: `pairs` at each position, `grid` and `order` as of
    `paired_nodes`.

    `stiffness`: at each position that of pinion and wheel, N/mm per mm of face width, on the nodes of `loaded_teeth`.
    """
    gears = RemeshedGears(pair, pairs, stiffness)
    return Mesh(
        pair,
        ContactGrid(grid.length, order * (grid.nodes - 1) + 1),
        lambda phases: [pairs[round(phase * len(pairs))] for phase in phases],
        lambda passages: [gears.response(passage) for passage in passages],
    )


class RemeshedGears:
    """How both gears respond at each position of a mesh cycle; arguments as of `remeshed_mesh`."""

    def __init__(self, pair: GearPair, pairs, stiffness):
        self._pair = pair
        self._pairs = pairs
        self._stiffness = stiffness
        self._compliances: dict[int, tuple[np.ndarray, np.ndarray]] = {}

    def stiffness(self, index: int) -> tuple[np.ndarray, np.ndarray]:
        """Stiffness of either gear, N/mm, (2n + 3, 2n + 3) over the contact nodes' normals and tangents and the centre
        (dx, dy, phi), in the gear's own frame."""
        pairs = self._pairs[index]
        each = zip(self._stiffness[index], self._pair.sides)
        return tuple(by_direction(self._pair.face_width * stiffness, pairs, side) for stiffness, side in each)

    def response(self, passage: Passage) -> Response:
        """How the contact nodes of a passage yield."""
        before = None
        if passage.previous is not None:
            before = NodeResponse(passage.previous, self._compliance(passage.index_before))
        now = NodeResponse(passage.pairs, self._compliance(passage.index))
        return node_to_node_response(self._pair, now, before, passage.advance)

    def _compliance(self, index: int) -> tuple[np.ndarray, np.ndarray]:
        """Flank compliance of either gear, hub held."""
        if index not in self._compliances:
            if len(self._compliances) >= KEPT_COMPLIANCES:
                del self._compliances[next(iter(self._compliances))]
            self._compliances[index] = tuple(_inverse(stiffness[:-3, :-3]) for stiffness in self.stiffness(index))
        return self._compliances[index]


def _inverse(stiffness: np.ndarray) -> np.ndarray:
    inverse = np.linalg.inv(stiffness)
    return 0.5 * (inverse + inverse.T)
