"""The compliance of two gears' bodies between contact nodes in slices of the face: `W M W^T`, with M between the flank
nodes under them.

Indices: contact nodes come in groups, one for each tooth pair in a slice. Under a group lie some consecutive flank
nodes of the pinion and some of the wheel, in that slice; those of all groups stand one after the other, group by group,
the pinion's before the wheel's, and are the rows and columns of M. M is in the directions of contact: a flank node has
as many displacements as a contact node, not three. The weights W of a group have a row for each of its contact nodes
and a column for each flank node under it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import accumulate, product
from typing import NamedTuple

import numpy as np
from numba import njit

from fenics_gears.contact.interpolation import FlankInterpolation


class OnGear(NamedTuple):
    """Groups (P,) on one gear: its `teeth`; their `slices`; how many flank nodes lie under each (`widths`), and where
    these stand among those of all groups (`places`); the first of their degrees of freedom in the body (`dofs`) and in
    its plane section (`plane_dofs`); the directions of contact in the tooth's frame (`axes`, (P, d, 3)) and in the
    section (`plane_axes`, (P, d, 2))."""

    teeth: np.ndarray
    slices: np.ndarray
    widths: np.ndarray
    places: np.ndarray
    dofs: np.ndarray
    plane_dofs: np.ndarray
    axes: np.ndarray
    plane_axes: np.ndarray


@dataclass(frozen=True)
class Groups:
    """Groups (P,) of contact nodes and the flank nodes under them.

    `weights`: (nodes, flank nodes) of each group; `nodes`, `flank_nodes`: where its own stand among all; `first`,
    `widths`, `places` (2, P), of either gear: the first flank node under a group, how many there are, and where these
    stand among those of all groups.
    """

    weights: list[np.ndarray]
    nodes: list[slice]
    flank_nodes: list[slice]
    first: np.ndarray
    widths: np.ndarray
    places: np.ndarray

    @classmethod
    def of(cls, interpolations: Sequence[tuple[FlankInterpolation, FlankInterpolation]]) -> Groups:
        """The groups with these interpolations of pinion and wheel."""
        weights, firsts, widths = [], [], []
        for of_gears in interpolations:
            dense, lowest = zip(*map(_dense, of_gears))
            weights.append(np.concatenate(dense, axis=1))
            firsts.append(lowest)
            widths.append([part.shape[1] for part in dense])
        first, width = (np.array(numbers, dtype=np.int64).reshape(-1, 2).T for numbers in (firsts, widths))
        nodes, under = ([len(part) for part in weights], [part.shape[1] for part in weights])
        begin = np.array(list(accumulate(under, initial=0))[:-1], dtype=np.int64)
        places = np.stack([begin, begin + width[0]])
        return cls(weights, _one_after_the_other(nodes), _one_after_the_other(under), first, width, places)


@dataclass(frozen=True)
class Side:
    """Contact nodes as the rows or the columns of a compliance: their groups, on the pinion and on the wheel."""

    groups: Groups
    gears: tuple[OnGear, OnGear]

    @property
    def shape(self) -> tuple[int, int, int]:
        """Numbers of directions, of contact nodes and of flank nodes."""
        groups, kinds = self.groups, self.gears[0].axes.shape[1]
        return kinds, groups.nodes[-1].stop if groups.nodes else 0, groups.flank_nodes[-1].stop if groups.nodes else 0


def _dense(view: FlankInterpolation) -> tuple[np.ndarray, int]:
    """Weights (n, w) of the flank nodes from the lowest to the highest under any contact node, and the lowest."""
    lowest, (nodes, width) = int(view.first.min()), view.near.shape
    found = np.zeros((nodes, int(view.first.max()) - lowest + width))
    found[np.arange(nodes)[:, None], (view.first - lowest)[:, None] + np.arange(width)] = view.near
    return found, lowest


def _one_after_the_other(sizes: Sequence[int]) -> list[slice]:
    ends = list(accumulate(sizes, initial=0))
    return [slice(start, end) for start, end in zip(ends[:-1], ends[1:])]


def face_product(bodies: Sequence[tuple[np.ndarray, np.ndarray]], shares: np.ndarray, rows: Side, columns: Side):
    """Compliance (d, n, e, m), mm/N, between contact nodes: of the `bodies`, less what their plane sections give in
    each slice, as of `add_between`; symmetric where rows and columns are the same."""
    (kinds, _, under_rows), (others, _, under_columns) = rows.shape, columns.shape
    between = np.zeros((kinds, under_rows, others, under_columns))
    for (blocks, sections), own, other in zip(bodies, rows.gears, columns.gears):
        add_between(blocks, sections, shares, own, other, rows is columns, between)
    return _at_contact_nodes(between, rows, columns)


@njit(cache=True)
def add_between(blocks, sections, shares, rows, columns, symmetric, result):
    """Add to `result` (d, s, e, s'), mm/N, one gear's compliance between the flank nodes under groups `rows` and
    `columns` (OnGear).

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


def _at_contact_nodes(between: np.ndarray, rows: Side, columns: Side) -> np.ndarray:
    """Compliance (d, n, e, m), mm/N, between contact nodes from that `between` (d, s, e, s') their flank nodes.

    Where rows and columns are the same, of two groups `between` is known where the later one has the rows.
    """
    (kinds, nodes, under), (others, nodes_of_columns, _), symmetric = rows.shape, columns.shape, rows is columns
    found, half = np.empty((kinds, nodes, others, nodes_of_columns)), np.empty((under, nodes_of_columns))
    own, other = rows.groups, columns.groups
    for d, e in np.ndindex(kinds, others):
        # From the columns' side first, so that rows of the result are written in one piece.
        for weights, at, below in zip(other.weights, other.nodes, other.flank_nodes):
            known = slice(below.start if symmetric else 0, None)
            half[known, at] = between[d, known, e, below] @ weights.T
        for weights, at, below in zip(own.weights, own.nodes, own.flank_nodes):
            end = at.stop if symmetric else None
            np.matmul(weights, half[below, :end], out=found[d, at, e, :end])
    if symmetric:
        for (d, e), at in product(np.ndindex(kinds, others), own.nodes):
            found[e, : at.start, d, at] = found[d, at, e, : at.start].T
    return found
