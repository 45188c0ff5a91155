"""Which contact node each one was a step before."""

from __future__ import annotations

import numpy as np

from fenics_gears.contact.operator import count_of, node_slices
from fenics_gears.contact.tooth_pair import PairNodes


def nodes_before(pairs: tuple[PairNodes, ...], previous: tuple[PairNodes, ...], spacing: float) -> np.ndarray:
    """For each node the one of the same pair that it was a step before; -1 where there is none.

    Beside an edge, with which nodes move, it is the one with as many nodes between it and the edge; else the one at the
    same offset.
    """
    earlier = {_key(pair): (nodes.start, pair.offsets) for nodes, pair in zip(node_slices(previous), previous)}
    found = np.full(count_of(pairs), -1)
    for nodes, pair in zip(node_slices(pairs), pairs):
        if _key(pair) in earlier:
            first, offsets = earlier[_key(pair)]
            same = _same_nodes(pair.offsets, offsets, spacing)
            found[nodes] = np.where(same >= 0, first + same, -1)
    return found


def _same_nodes(now: np.ndarray, before: np.ndarray, spacing: float) -> np.ndarray:
    """For each node now, at offsets (n,), mm, the place of the same one among those before, -1 for none."""
    edges = _closer(now, spacing) & _closer(before, spacing)
    places = np.arange(len(now))
    if edges == {0}:
        return np.where(places < len(before), places, -1)
    if edges == {-1}:
        places = places + len(before) - len(now)
        return np.maximum(places, -1)
    nearest = np.abs(now[:, None] - before).argmin(axis=1)
    return np.where(np.abs(now - before[nearest]) <= 0.75 * spacing, nearest, -1)


def _closer(offsets: np.ndarray, spacing: float) -> set[int]:
    """The ends, 0 and -1, at which the nodes stand closer, since an edge is there."""
    if len(offsets) < 3:
        return set()
    return {
        end for end, cell in ((0, offsets[1] - offsets[0]), (-1, offsets[-1] - offsets[-2])) if cell < 0.5 * spacing
    }


def _key(pair: PairNodes) -> tuple[int, int, int]:
    return pair.place.flank, pair.place.index, pair.place.slice
