"""The compliance of two gears' bodies seen by contact nodes in slices of the face: `W M W^T`, with M between the flank
nodes that they see.

M is in the directions of contact: a flank node has as many displacements as a contact node, not three.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import accumulate, product
from typing import NamedTuple

import numpy as np
from numba import njit

from fenics_gears.contact.interpolation import FlankInterpolation


class Views(NamedTuple):
    """How groups (P,) of contact nodes see one gear: its `teeth`; their `slices`; how many flank nodes they see
    (`widths`), and their `places` among all that are seen; the first of their degrees of freedom in the body (`dofs`)
    and in its plane section (`plane_dofs`); the directions of contact in the
    tooth's frame (`axes`, (P, d, 3)) and in the section (`plane_axes`, (P, d, 2))."""

    teeth: np.ndarray
    slices: np.ndarray
    widths: np.ndarray
    places: np.ndarray
    dofs: np.ndarray
    plane_dofs: np.ndarray
    axes: np.ndarray
    plane_axes: np.ndarray


@dataclass(frozen=True)
class Seen:
    """Flank nodes that groups of contact nodes see, those of the pinion and then those of the wheel for each group.

    `weights`: (nodes, seen) of each group; `nodes`, `seen`: where its own stand among all; `firsts`, `widths`, `places`
        (2, P), of either gear: the first
    flank node that a group sees, how many it sees, and where they stand among all seen.
    """

    weights: list[np.ndarray]
    nodes: list[slice]
    seen: list[slice]
    firsts: np.ndarray
    widths: np.ndarray
    places: np.ndarray


def seen_by(groups: Sequence[tuple[FlankInterpolation, FlankInterpolation]]) -> Seen:
    """What groups of contact nodes see of pinion and wheel by their interpolations of either one."""
    weights, firsts, widths = [], [], []
    for views in groups:
        dense, lowest = zip(*map(_dense, views))
        weights.append(np.concatenate(dense, axis=1))
        firsts.append(lowest)
        widths.append([part.shape[1] for part in dense])
    first, width = (np.array(numbers, dtype=np.int64).reshape(-1, 2).T for numbers in (firsts, widths))
    seen = _one_after_the_other([part.shape[1] for part in weights])
    begin = np.array([part.start for part in seen], dtype=np.int64)
    return Seen(
        weights,
        _one_after_the_other([len(part) for part in weights]),
        seen,
        first,
        width,
        np.stack([begin, begin + width[0]]),
    )


def _dense(view: FlankInterpolation) -> tuple[np.ndarray, int]:
    """Weights (n, w) of the flank nodes from the lowest to the highest that any contact node sees, and the lowest."""
    lowest, (nodes, width) = int(view.first.min()), view.near.shape
    found = np.zeros((nodes, int(view.first.max()) - lowest + width))
    found[np.arange(nodes)[:, None], (view.first - lowest)[:, None] + np.arange(width)] = view.near
    return found, lowest


def _one_after_the_other(sizes: Sequence[int]) -> list[slice]:
    ends = list(accumulate(sizes, initial=0))
    return [slice(start, end) for start, end in zip(ends[:-1], ends[1:])]


@njit(cache=True)
def add_between_seen(blocks, sections, shares, rows, columns, symmetric, result):
    """Add to `result` (d, s, e, s'), mm/N, one gear's compliance between the flank nodes that groups `rows` and
    `columns` see.

    `blocks` (k, D, D), mm/N, of the body: that of tooth i under forces on tooth j is number (k - 1)/2 + i - j; less
    `sections` (k, D', D'), mm per N/mm, times `shares` (S,), 1/mm, for groups in the same slice. `symmetric`: rows and
    columns are the same; of two groups only the later one has rows.
    """
    offsets, along = (len(blocks) - 1) // 2, np.empty(3)
    for p in range(len(rows.teeth)):
        for q in range(p + 1 if symmetric else len(columns.teeth)):
            number = offsets + rows.teeth[p] - columns.teeth[q]
            block, section, share = blocks[number], sections[number], 0.0
            if rows.slices[p] == columns.slices[q]:
                share = shares[rows.slices[p]]
            for i in range(rows.widths[p]):
                row, plane_row, place = rows.dofs[p] + 3 * i, rows.plane_dofs[p] + 2 * i, rows.places[p] + i
                for d in range(rows.axes.shape[1]):
                    across, across_plane = rows.axes[p, d], rows.plane_axes[p, d]
                    for j in range(columns.widths[q]):
                        column, other = columns.dofs[q] + 3 * j, columns.places[q] + j
                        for b in range(3):
                            along[b] = (
                                across[0] * block[row, column + b]
                                + across[1] * block[row + 1, column + b]
                                + across[2] * block[row + 2, column + b]
                            )
                        for e in range(columns.axes.shape[1]):
                            axis = columns.axes[q, e]
                            value = along[0] * axis[0] + along[1] * axis[1] + along[2] * axis[2]
                            if share != 0.0:
                                at = columns.plane_dofs[q] + 2 * j
                                for b in range(2):
                                    in_plane = (
                                        across_plane[0] * section[plane_row, at + b]
                                        + across_plane[1] * section[plane_row + 1, at + b]
                                    )
                                    value -= share * in_plane * columns.plane_axes[q, e, b]
                            result[d, place, e, other] += value


def at_contact_nodes(between: np.ndarray, rows: Seen, columns: Seen, symmetric: bool = False) -> np.ndarray:
    """Compliance (d, n, e, m), mm/N, between contact nodes from that `between` (d, s, e, s') the flank nodes that they
    see.

    `symmetric`: rows and columns are the same, and of two groups `between` is known where the later one has the rows.
    """
    kinds, others = between.shape[0], between.shape[2]
    nodes, nodes_of_columns = (groups.nodes[-1].stop if groups.nodes else 0 for groups in (rows, columns))
    found, half = np.empty((kinds, nodes, others, nodes_of_columns)), np.empty((between.shape[1], nodes_of_columns))
    for d, e in np.ndindex(kinds, others):
        # From the columns' side first, so that rows of the result are written in one piece.
        for weights, own, seen in zip(columns.weights, columns.nodes, columns.seen):
            known = slice(seen.start if symmetric else 0, None)
            half[known, own] = between[d, known, e, seen] @ weights.T
        for weights, own, seen in zip(rows.weights, rows.nodes, rows.seen):
            np.matmul(
                weights,
                half[seen, : own.stop if symmetric else None],
                out=found[d, own, e, : own.stop if symmetric else None],
            )
    if symmetric:
        for (d, e), own in product(np.ndindex(kinds, others), rows.nodes):
            found[e, : own.start, d, own] = found[d, own, e, : own.start].T
    return found
