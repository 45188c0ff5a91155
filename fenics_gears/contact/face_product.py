"""The compliance of a gear's face seen by contact nodes in slices: `N B N^T` in the directions of the contact normal and of friction (compiled)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numba import njit


class Views(NamedTuple):
    """How groups (P,) of contact nodes see the nodes of a flank in their slice.

    `starts`, `counts`: their contact nodes among all; `teeth`: ordinal of their tooth; `dofs`: first degree of freedom that they see; `widths`: flank nodes
    that they see; `places`: where their weights (counts x widths) begin in `weights`; `directions` (P, d, 3) in the tooth's frame.
    """

    starts: np.ndarray
    counts: np.ndarray
    teeth: np.ndarray
    dofs: np.ndarray
    widths: np.ndarray
    places: np.ndarray
    weights: np.ndarray
    directions: np.ndarray


def views(interpolations: Sequence, teeth: Sequence[int], first_dofs: Sequence[int], directions: Sequence[np.ndarray]) -> Views:
    """The views of groups of contact nodes, one after the other: `interpolations` (FlankInterpolation) of the flank nodes of their slice, whose first
    degree of freedom is in `first_dofs`."""
    starts, dofs, widths, places, weights, counts, total, size = [], [], [], [], [], [], 0, 0
    for view, first in zip(interpolations, first_dofs):
        lowest, nodes = int(view.first.min()), len(view.near)
        width = int(view.first.max()) - lowest + view.near.shape[1]
        seen = np.zeros((nodes, width))
        np.put_along_axis(seen, (view.first - lowest)[:, None] + np.arange(view.near.shape[1]), view.near, axis=1)
        starts.append(total)
        counts.append(nodes)
        dofs.append(first + 3 * lowest)
        widths.append(width)
        places.append(size)
        weights.append(seen.ravel())
        total, size = total + nodes, size + seen.size
    shape = (0, 1, 3) if not len(directions) else (len(directions), *directions[0].shape)

    def integers(values: Sequence[int]) -> np.ndarray:
        return np.array(values, dtype=np.int64)

    return Views(
        integers(starts), integers(counts), integers(list(teeth)), integers(dofs), integers(widths), integers(places),
        np.concatenate(weights) if weights else np.empty(0), np.array(directions, dtype=float).reshape(shape),
    )  # fmt: skip


@njit(cache=True)
def face_product(blocks, rows, columns, result, symmetric):
    """Add `N_a B N_b^T` between the contact nodes a of `rows` and b of `columns` to `result` (d, n, e, m), mm/N.

    `blocks` (k, D, D), mm/N: the compliance between teeth; that of tooth i under forces on tooth j is number (k - 1)/2 + i - j. `symmetric`: rows and
    columns are the same; what follows by symmetry is not computed again.
    """
    offsets = (len(blocks) - 1) // 2
    most = 0
    for group in range(len(rows.counts)):
        most = max(most, rows.counts[group])
    widest = 0
    for group in range(len(columns.widths)):
        widest = max(widest, columns.widths[group])
    half = np.empty((most, widest))
    for p in range(len(rows.starts)):
        for q in range(p + 1 if symmetric else len(columns.starts)):
            block = blocks[offsets + rows.teeth[p] - columns.teeth[q]]
            for d in range(rows.directions.shape[1]):
                for e in range(columns.directions.shape[1]):
                    _between(block, rows, p, d, columns, q, e, half, result, symmetric)


@njit(cache=True)
def _between(block, rows, p, d, columns, q, e, half, result, symmetric):
    """The part of one group of rows and one of columns, in one direction of each."""
    across, along = rows.directions[p, d], columns.directions[q, e]
    n, m, wide, high = rows.counts[p], columns.counts[q], columns.widths[q], rows.widths[p]
    half[:n, :wide] = 0.0
    for i in range(high):
        row = rows.dofs[p] + 3 * i
        for j in range(wide):
            column, value = columns.dofs[q] + 3 * j, 0.0
            for a in range(3):
                for b in range(3):
                    value += across[a] * block[row + a, column + b] * along[b]
            for node in range(n):
                half[node, j] += rows.weights[rows.places[p] + node * high + i] * value
    for node in range(n):
        for other in range(m):
            value = 0.0
            for j in range(wide):
                value += half[node, j] * columns.weights[columns.places[q] + other * wide + j]
            here, there = rows.starts[p] + node, columns.starts[q] + other
            result[d, here, e, there] += value
            if symmetric and q < p:
                result[e, there, d, here] += value
