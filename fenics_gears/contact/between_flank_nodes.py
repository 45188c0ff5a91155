"""M, the compliance of a gear's body between the flank nodes under contact nodes, in the directions of contact, less
what its plane section gives in each slice.

Without friction it is found at once for all flank nodes of positions that are built together. They read the same of
the body's compliance, which is far larger than what a processor keeps at hand: two sections of it are read for one
position after the other.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numba import carray, njit

from fenics_gears.elasticity.slice_compliance import SliceCompliance

from .addresses import to_number
from .fine_sections import NODE, PLACE, PLANE_NODE, SECTION, SLICE, TOOTH, WIDTH, SectionNodes, add_section

# Of a group among those of several positions: after the numbers on a gear its slice and its position.
OF_SLICE, POSITION = range(6, 8)


class Between(NamedTuple):
    """M of both bodies at a position, as of `between_flank_nodes`, and addresses of the `functions` that solve by it:
    what subtracts displacements, multiplies by M, and forms the compliance between closed nodes."""

    matrices: tuple[np.ndarray, ...]
    functions: tuple[int, int, int]


def between_flank_nodes(
    body: SliceCompliance, sections: np.ndarray, shares: np.ndarray, sides: Sequence[SectionNodes], gear: int
) -> list[np.ndarray]:
    """M, mm/N, of a gear at each position, whose contact nodes the `sides` are, without friction: by rows, each up to
    the diagonal. `sections` (k, n, n, 4), mm per N/mm: of the body in plane strain; `shares` (S,), 1/mm: what one
    counts in its slice."""
    sizes = [int(side.on_gears[gear, WIDTH].sum()) for side in sides]
    ends = np.cumsum([size * (size + 1) // 2 for size in sizes])
    # In one piece, which the system hands out by large pages.
    numbers = np.empty(ends[-1])
    found = np.split(numbers, ends[:-1])
    groups = np.vstack(
        [
            np.hstack([side.on_gears[gear] for side in sides]),
            np.hstack([side.groups[SLICE] for side in sides]),
            np.repeat(np.arange(len(sides)), [side.groups.shape[1] for side in sides]),
        ]
    )
    order = np.lexsort((groups[POSITION], groups[SECTION]))
    groups = np.ascontiguousarray(groups[:, order].T)
    axes = np.concatenate([side.axes[gear, :, 0] for side in sides])[order]
    of_sections = np.searchsorted(groups[:, SECTION], np.arange(body.values.shape[1] + 1))
    addresses = np.array([each.ctypes.data for each in found])
    put_between(addresses, groups, of_sections, axes, body.values, sections, shares)
    return found


@njit(cache=True, nogil=True)
def put_between(addresses, groups, ends, axes, blocks, sections, shares):
    """Put the compliance between flank nodes of some positions to where their addresses are. The groups (P, 8) are in
    order of their sections, of which each ends at `ends` (s + 1,), then of their positions."""
    for own in range(len(ends) - 1):
        for other in range(own + 1):
            q = ends[other]
            for p in range(ends[own], ends[own + 1]):
                position = groups[p, POSITION]
                while q < ends[other + 1] and groups[q, POSITION] < position:
                    q += 1
                found = carray(to_number(addresses[position]), row_of(groups[p, PLACE] + groups[p, WIDTH]))
                at = q
                while at < ends[other + 1] and groups[at, POSITION] == position and (own != other or at <= p):
                    _put_pair(found, (groups[p], groups[at]), (axes[p], axes[at]), blocks, at == p)
                    if groups[p, OF_SLICE] == groups[at, OF_SLICE]:
                        share = shares[groups[p, OF_SLICE]]
                        _subtract_section(found, (groups[p], groups[at]), (axes[p], axes[at]), sections, share)
                    at += 1


@njit(cache=True)
def row_of(number):
    """Where a row of M begins."""
    return number * (number + 1) // 2


@njit(cache=True)
def _put_pair(found, groups, axes, blocks, same):
    """Put what is between the flank nodes of two groups into M, up to the diagonal where they are the `same`."""
    (own, other), (along, across), nodes = groups, axes, blocks.shape[3]
    tile = (blocks.shape[0] // 2 + own[TOOTH] - other[TOOTH]) * blocks.shape[1] + own[SECTION]
    tile = tile * blocks.shape[1] + other[SECTION]
    x, y, z = along[0], along[1], along[2]
    products = (
        x * across[0], x * across[1], x * across[2], y * across[0], y * across[1], y * across[2], z * across[0],
        z * across[1], z * across[2],
    )  # fmt: skip
    numbers, at = blocks.reshape(-1), ((tile * nodes + own[NODE]) * nodes + other[NODE]) * 9
    for i in range(own[WIDTH]):
        count = i + 1 if same else other[WIDTH]
        put_products(found, row_of(own[PLACE] + i) + other[PLACE], count, products, numbers, at)
        at += 9 * nodes


@njit(cache=True)
def _subtract_section(found, groups, axes, sections, share):
    """Subtract what the plane section gives between the flank nodes of two groups in a slice."""
    (own, other), (along, across) = groups, axes
    section = sections[len(sections) // 2 + own[TOOTH] - other[TOOTH]]
    for i in range(own[WIDTH]):
        row, place = own[PLACE] + i, row_of(own[PLACE] + i) + other[PLACE]
        for j in range(min(other[WIDTH], row + 1 - other[PLACE])):
            value = section[own[PLANE_NODE] + i, other[PLANE_NODE] + j]
            by_x, by_y = along[3] * value[0] + along[4] * value[2], along[3] * value[1] + along[4] * value[3]
            found[place + j] -= share * (by_x * across[3] + by_y * across[4])


@njit(cache=True)
def displaced_by(source, gear, group, low, count):
    """M of a gear by rows of some flank nodes of a group, from `low` on, under forces on those of all columns: (i, d,
    e, j), by directions of both. `source`: as of `formed_rows`."""
    rows, columns, sections = source.rows, source.columns, source.sections[gear]
    own, other, offsets = rows.on_gears[gear, :, group], columns.on_gears[gear], (len(sections) - 1) // 2
    axes, number = rows.axes[gear, group], rows.groups[SLICE, group]
    # Beyond the last flank node: narrow interpolations are as wide as the others, with weights of zero.
    room = other[WIDTH].sum() + columns.near.shape[2]
    lines = np.zeros((count, len(axes), columns.axes.shape[2], room))
    _put_body(lines, source.blocks[gear], own, other, low, (axes, columns.axes[gear]))
    for q in np.flatnonzero(columns.groups[SLICE] == number):
        ahead, ends = offsets + own[TOOTH] - other[TOOTH, q], (other[PLACE, q], other[PLACE, q] + other[WIDTH, q])
        firsts, share = (own[PLANE_NODE] + low, other[PLANE_NODE, q]), source.fine.shares[number]
        add_section(lines, ends, sections[ahead], firsts, -share * axes, columns.axes[gear, q])
    return lines


@njit(cache=True)
def _put_body(lines, blocks, own, other, low, directions):
    """Compliance of a body between flank nodes i of a group, the first of them `low`, and those under all groups: by
    `directions`, of the group (d, 5) and of all groups (Q, e, 5), into `lines` (i, d, e, j)."""
    (axes, across), (teeth, sections, _, nodes, _, size) = directions, blocks.shape
    numbers, found, products = blocks.reshape(-1), lines.reshape(-1), np.empty((len(across), size))
    for d, e in np.ndindex((len(axes), across.shape[1])):
        for q, a, b in np.ndindex((len(across), 3, 3)):
            products[q, 3 * a + b] = axes[d, a] * across[q, e, b]
        for i in range(len(lines)):
            line = ((i * len(axes) + d) * across.shape[1] + e) * lines.shape[3]
            for q in range(len(across)):
                tile = (teeth // 2 + own[TOOTH] - other[TOOTH, q]) * sections + own[SECTION]
                row = (tile * sections + other[SECTION, q]) * nodes + own[NODE] + low + i
                at = (row * nodes + other[NODE, q]) * size
                put_products(found, line + other[PLACE, q], other[WIDTH, q], products[q], numbers, at)


@njit(cache=True)
def put_products(found, place, count, weights, numbers, at):
    """Put products of nine weights with so many times nine numbers into place."""
    # uint64 avoids numba's wraparound check; three sums do not wait for each other.
    a, b, c, d, e, f, g, h, k = (weights[0], weights[1], weights[2], weights[3], weights[4], weights[5], weights[6],
                                 weights[7], weights[8])  # fmt: skip
    at, one, two, three, four = np.uint64(at), np.uint64(1), np.uint64(2), np.uint64(3), np.uint64(4)
    five, six, seven, eight, nine = np.uint64(5), np.uint64(6), np.uint64(7), np.uint64(8), np.uint64(9)
    for j in range(np.uint64(place), np.uint64(place) + np.uint64(count)):
        x = a * numbers[at] + b * numbers[at + one] + c * numbers[at + two]
        y = d * numbers[at + three] + e * numbers[at + four] + f * numbers[at + five]
        found[j] = x + y + (g * numbers[at + six] + h * numbers[at + seven] + k * numbers[at + eight])
        at += nine
