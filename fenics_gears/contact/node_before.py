"""Which contact node each one was a step before."""

from __future__ import annotations

import numpy as np
from numba import njit

from .operator import node_ends, over_nodes
from .tooth_pair import PairNodes


def nodes_before(pairs: tuple[PairNodes, ...], previous: tuple[PairNodes, ...], spacing: float) -> np.ndarray:
    """For each node the one of the same pair that it was a step before; -1 where there is none.

    Beside an edge, with which nodes move, it is the one with as many nodes between it and the edge; else the one at the
    same offset.
    """
    earlier = {_key(pair): place for place, pair in enumerate(previous)}
    same = np.array([earlier.get(_key(pair), -1) for pair in pairs], dtype=np.int64)
    now, before = ((over_nodes(each, "offsets"), node_ends(each)) for each in (pairs, previous))
    return _nodes_before(*now, *before, same, spacing)


@njit(cache=True)
def _nodes_before(offsets, ends, offsets_before, ends_before, same, spacing):
    """From offsets (n,), mm, and ends (P + 1,) of each pair's nodes, now and before; `same` (P,): the pair before, -1
    for none."""
    found = np.full(len(offsets), -1)
    for pair in range(len(same)):
        if same[pair] >= 0:
            first, last = ends_before[same[pair]], ends_before[same[pair] + 1]
            own = slice(ends[pair], ends[pair + 1])
            _same_nodes(found[own], offsets[own], offsets_before[first:last], spacing)
            for node in range(ends[pair], ends[pair + 1]):
                found[node] += first if found[node] >= 0 else 0
    return found


@njit(cache=True)
def _same_nodes(found, now, before, spacing):
    """For each node now, at offsets (n,), mm, the place of the same one among those before, -1 for none."""
    (low, high), (low_before, high_before) = _closer(now, spacing), _closer(before, spacing)
    low, high = low and low_before, high and high_before
    for node in range(len(now)):
        place = node
        if high and not low:
            place = node + len(before) - len(now)
        elif not low or high:
            place = np.abs(before - now[node]).argmin()
            if abs(now[node] - before[place]) > 0.75 * spacing:
                place = -1
        found[node] = place if place < len(before) else -1
        found[node] = max(found[node], -1)


@njit(cache=True)
def _closer(offsets, spacing):
    """Whether the nodes stand closer at the first and at the last end, since an edge is there."""
    if len(offsets) < 3:
        return False, False
    return offsets[1] - offsets[0] < 0.5 * spacing, offsets[-1] - offsets[-2] < 0.5 * spacing


def _key(pair: PairNodes) -> tuple[int, int, int]:
    return pair.place.flank, pair.place.index, pair.place.slice
