"""Contact nodes over a face as rows and columns of their compliance; and what fine plane sections give of a row,
between the nodes in a slice."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numba import njit

from fenics_gears.elasticity.compliance import FlankCompliance
from fenics_gears.errors import ComputationError

from .compliance_product import add_multiple
from .interpolation import FlankInterpolation

# Of a group: its first node, its slice, the place of that node among those in the slice, and how many these are.
BEGIN, SLICE, IN_SLICE, OF_SLICE = range(4)
# Of a group on a gear: its tooth, how many flank nodes lie under it, their place among those under all groups; the
# body's section, by flank and slice, and the first of the flank nodes in it; and that in the plane section.
TOOTH, WIDTH, PLACE, SECTION, NODE, PLANE_NODE = range(6)


class SectionNodes(NamedTuple):
    """Contact nodes (n,) as rows or columns, in groups (P,).

    `group` (n,) of each node, and its offset (n,), mm, from the line of action; `first` (2, n): the first flank node of
    either gear that a node sees, among those under all groups, and `near` (2, n, w): weights from that one on. `groups`
    (4, P) and `on_gears` (2, 6, P): numbers of each group, as above. `axes` (2, P, d, 5): directions of contact in the
    tooth's frame, in the body (3) and in the section (2).

    On the fine sections: `flanks` (P,) of the teeth; `fine_first` (2, n) and `fine_near` of the FlankInterpolation, the
    weights of all groups one after the other, of each from its place in `fine_begins` (2, P) on, so many
    (`fine_widths`, (2, P)) for a node.
    """

    group: np.ndarray
    offsets: np.ndarray
    first: np.ndarray
    groups: np.ndarray
    on_gears: np.ndarray
    near: np.ndarray
    axes: np.ndarray
    flanks: np.ndarray
    fine_first: np.ndarray
    fine_near: np.ndarray
    fine_begins: np.ndarray
    fine_widths: np.ndarray


class Fine(NamedTuple):
    """Fine sections, mm per N/mm: `first` and `second`, of pinion and wheel, as `stacked`; `shares` (S,), 1/mm: what a
    section counts in its slice; `layers` (S,): of an own layer of each node; `ends` (S, F, E, 4): as of
    `face_ends.ends_of`."""

    first: np.ndarray
    second: np.ndarray
    shares: np.ndarray
    layers: np.ndarray
    ends: np.ndarray


def by_nodes(blocks: np.ndarray, components: int) -> np.ndarray:
    """Compliance (..., n, n', c^2) between flank nodes, with all components of a pair of nodes together, from blocks
    (..., c n, c n')."""
    *most, rows, columns = blocks.shape
    apart = blocks.reshape(*most, rows // components, components, columns // components, components).swapaxes(-3, -2)
    return np.ascontiguousarray(apart).reshape(*most, rows // components, columns // components, components**2)


def stacked(section: FlankCompliance) -> np.ndarray:
    """Compliance (2 k - 1, F, F, n, n, 4) of a flank `by_nodes`, by the teeth that it is ahead of the loaded one, from
    k - 1 behind on, and by both flanks; not a number where it is not known."""
    reach, sides, nodes = section.farthest, section.flanks, section.nodes
    found = np.full((2 * reach + 1, sides, sides, nodes, nodes, 4), np.nan)
    for number, side, other in np.ndindex(2 * reach + 1, sides, sides):
        try:
            found[number, side, other] = by_nodes(section.between(number - reach, 0, (side, other)), 2)
        except ComputationError:
            # Further apart than flanks that touch at a time.
            continue
    return found


def together(views: Sequence[tuple[FlankInterpolation, FlankInterpolation]], padded: bool = True):
    """Interpolations of both gears together: the first flank node (2, n), weights, and where those of a group begin and
    how many there are for a node (2, P).

    `padded`: weights are (2, n, w), with zeros behind the narrower ones; else those of one group after the other.
    """
    of_gears = list(zip(*views)) or [(), ()]
    widths = np.array([[view.near.shape[1] for view in own] for own in of_gears], dtype=np.int64)
    sizes = np.array([[view.near.size for view in own] for own in of_gears], dtype=np.int64)
    first = np.array([_joined([view.first for view in own], np.int64) for own in of_gears])
    flat = [_joined([view.near.ravel() for view in own], float) for own in of_gears]
    begins = (np.cumsum(sizes) - sizes.ravel()).reshape(2, -1)
    if not padded:
        return first, np.concatenate(flat), (begins, widths)
    near = np.zeros((2, first.shape[1], widths.max(initial=1)))
    for weights, width, size, values in zip(near, widths, sizes, flat):
        weights[np.arange(near.shape[2]) < np.repeat(width, size // width)[:, None]] = values
    return first, near, (begins, widths)


def _joined(arrays: Sequence[np.ndarray], kind) -> np.ndarray:
    return np.concatenate([np.empty(0, kind), *arrays]).astype(kind, copy=False)


def groups_of(begins: np.ndarray, counts: np.ndarray, slices: np.ndarray) -> np.ndarray:
    """Of groups of so many nodes that begin there among all: numbers (4, P) as of `fine_sections.SectionNodes`."""
    found = np.zeros((4, len(begins)), dtype=np.int64)
    found[BEGIN] = begins
    found[SLICE] = slices
    in_slice = np.zeros(slices.max(initial=-1) + 1, dtype=np.int64)
    for group, (number, count) in enumerate(zip(slices.tolist(), counts.tolist())):
        found[IN_SLICE, group] = in_slice[number]
        in_slice[number] += count
    found[OF_SLICE] = in_slice[slices]
    return found


@njit(cache=True)
def end_of(side, group):
    """Where the nodes of a group end."""
    groups = side.groups
    return groups[BEGIN, group + 1] if group + 1 < groups.shape[1] else len(side.group)


@njit(cache=True)
def end_in_group(side, nodes, begin):
    """The place after the last of some nodes, in increasing order, that are of one group, from a place on."""
    end = begin + 1
    while end < len(nodes) and side.group[nodes[end]] == side.group[nodes[begin]]:
        end += 1
    return end


@njit(cache=True)
def weights_of(side, gear, group):
    """Weights (n, w) of the nodes of a group on the fine section, and the first flank node (n,) of each."""
    begin, end = side.groups[BEGIN, group], end_of(side, group)
    place, width = side.fine_begins[gear, group], side.fine_widths[gear, group]
    near = side.fine_near[place : place + (end - begin) * width].reshape((end - begin, width))
    return near, side.fine_first[gear, begin:end]


@njit(cache=True)
def add_fine(found, of, group, nodes, begins):
    """Add what fine sections give of the compliance of some contact nodes of a group to `found` (e, m, r), mm/N; r as
    of `weighted`. `of`: rows, columns and the fine sections; `begins` (Q,): where there the columns' groups begin."""
    rows, columns, fine = of
    number, own = rows.groups[SLICE, group], nodes - rows.groups[BEGIN, group]
    for gear in range(2):
        blocks = fine.second if gear else fine.first
        near, first = weights_of(rows, gear, group)
        axes = fine.shares[number] * rows.axes[gear, group]
        weights, low = spread(near[own], first[own], blocks.shape[3])
        for q in np.flatnonzero(columns.groups[SLICE] == number):
            ahead = (len(blocks) - 1) // 2 + rows.on_gears[gear, TOOTH, group] - columns.on_gears[gear, TOOTH, q]
            block, across = blocks[ahead, rows.flanks[group], columns.flanks[q]], columns.axes[gear, q]
            loaded, firsts = weights_of(columns, gear, q)
            start = firsts.min()
            ends = 0, firsts.max() + loaded.shape[1] - start
            lines = np.zeros((len(weights), len(axes), len(across), ends[1]))
            add_section(lines, ends, block, (low, start), axes, across)
            displaced = weighted(lines, weights)
            for e in range(len(across)):
                add_seen(found[e, begins[q] : begins[q] + len(loaded)], loaded, firsts - start, displaced[e])


@njit(cache=True)
def spread(near, first, end):
    """Weights (i, n) of nodes on the flank nodes that they see, and which of these is the first; where `near` (n, w)
    reaches beyond the flank node before `end` it has zeros."""
    low, width = first.min(), near.shape[1]
    weights = np.zeros((min(first.max() + width, end) - low, len(near)))
    for node in range(len(near)):
        for k in range(min(width, end - first[node])):
            weights[first[node] + k - low, node] = near[node, k]
    return weights, low


@njit(cache=True)
def padded(rows):
    """That number of rows made one of groups of four."""
    return (rows + 3) // 4 * 4


@njit(cache=True)
def weighted(lines, weights):
    """Sums (e, r, j) of lines (i, d, e, j) by the weights (i, n) of nodes: rows r for each direction d of all nodes,
    and rows of zeros up to groups of four."""
    n, start = weights.shape[1], np.int64(0)
    found = np.zeros((lines.shape[2], padded(lines.shape[1] * n), lines.shape[3]))
    for e, d, node in np.ndindex((lines.shape[2], lines.shape[1], n)):
        for i in range(len(weights)):
            add_multiple(found[e, d * n + node], weights[i, node], lines[i, d, e], start)
    return found


@njit(cache=True)
def add_section(lines, ends, section, firsts, axes, across):
    """Add compliance `section` (n, n', 4) between flank nodes i and others, from the `firsts` on: by the last two
    components of directions `axes` (d, 5) and `across` (e, 5) to `lines` (i, d, e, j), from `ends[0]` to `ends[1]`."""
    # uint64 avoids numba's wraparound check.
    numbers, found, count = section.reshape(-1), lines.reshape(-1), np.uint64(ends[1] - ends[0])
    one, two, three, four = np.uint64(1), np.uint64(2), np.uint64(3), np.uint64(4)
    for d, e in np.ndindex((len(axes), len(across))):
        xx, xy = axes[d, 3] * across[e, 3], axes[d, 3] * across[e, 4]
        yx, yy = axes[d, 4] * across[e, 3], axes[d, 4] * across[e, 4]
        for i in range(len(lines)):
            at = np.uint64(((firsts[0] + i) * section.shape[1] + firsts[1]) * 4)
            place = np.uint64(((i * len(axes) + d) * len(across) + e) * lines.shape[3] + ends[0])
            for j in range(place, place + count):
                found[j] += (xx * numbers[at] + xy * numbers[at + one]) + (
                    yx * numbers[at + two] + yy * numbers[at + three]
                )
                at += four


@njit(cache=True)
def add_seen(found, near, first, values):
    """Add to `found` (m, r) what contact nodes see of `values` (r, s) of flank nodes; r as of `weighted`."""
    # One flank node's values beside each other; uint64 avoids numba's wraparound check; four sums are made
    # at a time.
    numbers, sums, weights = np.ascontiguousarray(values.T).reshape(-1), found.reshape(-1), near.reshape(-1)
    wide, width, zero, four = np.uint64(len(values)), np.uint64(near.shape[1]), np.uint64(0), np.uint64(4)
    one, two, three = np.uint64(1), np.uint64(2), np.uint64(3)
    for j in range(np.uint64(len(found))):
        own, at = j * width, np.uint64(first[j]) * wide
        for r in range(zero, wide, four):
            place, other = j * wide + r, at + r
            a, b, c, d = sums[place], sums[place + one], sums[place + two], sums[place + three]
            for k in range(own, own + width):
                weight = weights[k]
                a += weight * numbers[other]
                b += weight * numbers[other + one]
                c += weight * numbers[other + two]
                d += weight * numbers[other + three]
                other += wide
            sums[place], sums[place + one], sums[place + two], sums[place + three] = a, b, c, d


@njit(cache=True)
def surely_independent(side, group, softest, least):
    """Whether the compliance of a group's nodes in its slice surely has no eigenvalue below `least`.

    With the weights N of the nodes it is at least the sum over both gears of N N^T times the section's smallest
    eigenvalue, which is not below `softest` (2,).
    """
    n = end_of(side, group) - side.groups[BEGIN, group]
    lower = np.zeros((n, n))
    for gear in range(2):
        near, first = weights_of(side, gear, group)
        width = near.shape[1]
        for i in range(n):
            for j in range(i + 1):
                apart = first[i] - first[j]
                for k in range(max(0, -apart), min(width, width - apart)):
                    lower[i, j] += softest[gear] * near[i, k] * near[j, k + apart]
    for i in range(n):
        lower[i, i] -= least
        for j in range(i + 1):
            total = lower[i, j]
            for k in range(j):
                total -= lower[i, k] * lower[j, k]
            if i == j:
                if total <= 0.0:
                    return False
                lower[i, i] = np.sqrt(total)
            else:
                lower[i, j] = total / lower[j, j]
    return True
