"""Compliance between the contact nodes of each slice of a face, of fine plane sections: all slices in one call of
compiled code."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numba import njit

from fenics_gears.contact.compliance_product import compliance_product
from fenics_gears.contact.formed_rows import BEGIN, IN_SLICE, OF_SLICE, SLICE
from fenics_gears.contact.interpolation import FlankInterpolation
from fenics_gears.elasticity.compliance import FlankCompliance
from fenics_gears.errors import ComputationError


class OnSections(NamedTuple):
    """Contact nodes (n,) in groups (P,): `groups` (4, P) as of `formed_rows.Side`; `flanks` (P,) of the tooth and its
    place on either gear (`teeth`, (2, P)); `axes` (2, P, d, 2) of contact there.

    `first` (2, n) of their FlankInterpolation; its `near` of all groups one after the other, of each group from its
    place in `begins` (2, P) on, so many (`widths`, (2, P)) for a node.
    """

    groups: np.ndarray
    flanks: np.ndarray
    teeth: np.ndarray
    axes: np.ndarray
    first: np.ndarray
    near: np.ndarray
    begins: np.ndarray
    widths: np.ndarray

    @classmethod
    def of(
        cls,
        groups: np.ndarray,
        flanks: np.ndarray,
        teeth: np.ndarray,
        axes: np.ndarray,
        views: Sequence[Sequence[FlankInterpolation]],
    ) -> OnSections:
        """`views`: how the nodes of each group see pinion and wheel."""
        every = [view for gear in (0, 1) for view in (each[gear] for each in views)]
        near, sizes = (
            [view.near.ravel() for view in every],
            np.array([view.near.size for view in every], dtype=np.int64),
        )
        widths = np.array([view.near.shape[1] for view in every], dtype=np.int64)
        return cls(
            groups, flanks, teeth, axes,
            np.concatenate([np.empty(0, np.int64), *(view.first for view in every)]).astype(np.int64).reshape(2, -1),
            np.concatenate([np.empty(0), *near]),
            (np.cumsum(sizes) - sizes).reshape(2, -1), widths.reshape(2, -1),
        )  # fmt: skip


def stacked(section: FlankCompliance) -> np.ndarray:
    """Compliance (2 k - 1, F, F, 2 n, 2 n) of a flank, by the teeth that it is ahead of the loaded one, from k - 1
    behind on, and by both flanks; not a number where it is not known."""
    reach, sides, dofs = section.farthest, section.flanks, 2 * section.nodes
    found = np.full((2 * reach + 1, sides, sides, dofs, dofs), np.nan)
    for number, side, other in np.ndindex(2 * reach + 1, sides, sides):
        try:
            found[number, side, other] = section.between(number - reach, 0, (side, other))
        except ComputationError:
            # Further apart than flanks that touch at a time.
            continue
    return found


@njit(cache=True)
def fine_sections(blocks, now, before, begins, begins_before, numbers, by_earlier):
    """Compliance, mm per N/mm, between the nodes now of each slice (d, n, d, n) into `numbers` (zeros), from its place
    in `begins` on; and by forces `before` on the tangential displacement now, (2, n before, 1, n), into `by_earlier`.

    `blocks`: of either gear, as `stacked`. `now.axes`: with friction normal, tangent, and the tangent as it stood
    before. A slice with a place of -1 is left out. Where flanks are further apart than the sections' compliance is
    known, the slice's first number is not a number.
    """
    kinds, no_nodes = min(now.axes.shape[2], 2), 0
    for number in range(len(begins)):
        own, earlier_own = np.flatnonzero(now.groups[SLICE] == number), np.flatnonzero(before.groups[SLICE] == number)
        if begins[number] < 0 or not len(own):
            continue
        n = now.groups[OF_SLICE, own[0]]
        n_before = before.groups[OF_SLICE, earlier_own[0]] if len(earlier_own) else 0
        size, begin = (kinds * n) ** 2, begins[number]
        compliance, earlier = numbers[begin : begin + size].reshape((kinds, n, kinds, n)), np.zeros((1, n, 2, n_before))
        for gear in range(2):
            for p in own:
                row = _nodes(now, gear, p)
                nothing = no_nodes, row[1][:0], row[2][:0], row[3]
                for q in own:
                    if not _known(blocks[gear], gear, now, p, now, q):
                        numbers[begin] = np.nan
                    elif q <= p:
                        # The other half follows by symmetry.
                        loaded = _nodes(now, gear, q)
                        block = _block(blocks[gear], gear, now, p, now, q)
                        loaded = loaded[0], loaded[1], loaded[2], loaded[3][:kinds]
                        compliance_product(block, row, loaded, compliance, nothing, earlier)
                for q in earlier_own:
                    if not _known(blocks[gear], gear, now, p, before, q):
                        numbers[begin] = np.nan
                        continue
                    block = _block(blocks[gear], gear, now, p, before, q)
                    loaded = _nodes(before, gear, q)
                    loaded = loaded[0], loaded[1], loaded[2], loaded[3][:kinds]
                    compliance_product(block, row, nothing, compliance, loaded, earlier)
        place = begins_before[number]
        for d, i, j in np.ndindex((2, n_before, n)):
            by_earlier[place + (d * n_before + i) * n + j] = earlier[0, j, d, i]


@njit(cache=True)
def _nodes(nodes, gear, group):
    """A group's nodes on a gear as `compliance_product` takes them."""
    begin = nodes.groups[BEGIN, group]
    end = nodes.groups[BEGIN, group + 1] if group + 1 < nodes.groups.shape[1] else nodes.first.shape[1]
    place, width = nodes.begins[gear, group], nodes.widths[gear, group]
    near = nodes.near[place : place + (end - begin) * width].reshape((end - begin, width))
    return nodes.groups[IN_SLICE, group], near, nodes.first[gear, begin:end], nodes.axes[gear, group]


@njit(cache=True)
def _known(blocks, gear, responding, p, loaded, q):
    return abs(responding.teeth[gear, p] - loaded.teeth[gear, q]) <= (len(blocks) - 1) // 2


@njit(cache=True)
def _block(blocks, gear, responding, p, loaded, q):
    ahead = responding.teeth[gear, p] - loaded.teeth[gear, q]
    return blocks[(len(blocks) - 1) // 2 + ahead, responding.flanks[p], loaded.flanks[q]]
