"""Interpolation of the flanks at contact nodes: displacements, gaps and positions averaged over functions of their own,
or taken at their points.

Contact force and gap use the same averages, so that energy and symmetry are kept: a nodal force acts as the line load
`p_j psi_j / integral(psi_j)`, and a nodal displacement or gap is `integral(psi_j u) / integral(psi_j)` (model.md
section 2).

On each cell `psi_j` is `2 hat_j - 1/2`, midway between the hat function and its dual `3 hat_j - 1` (B. I. Wohlmuth,
SIAM J. Numer. Anal. 38, 2000). Its integrals are the hat's and its sum over the nodes is one, so that an even pressure
is passed on exactly. Averages of parabolas over even cells are exact too. Hats would give a gap too large by h^2/(12 R)
for cells of h and flanks of relative radius R.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import accumulate

import numpy as np
from numba import njit

GAUSS_POINTS, GAUSS_WEIGHTS = np.polynomial.legendre.leggauss(4)
GAUSS_POINTS = 0.5 * (GAUSS_POINTS + 1.0)
GAUSS_WEIGHTS = 0.5 * GAUSS_WEIGHTS


@dataclass(frozen=True)
class FlankInterpolation:
    """Row `j` of `near` (n, w) takes the flank's dof nodes `first[j]` to `first[j] + w - 1` to the average of node `j`;
    `flank_nodes` of the flank."""

    # A node averages over a few flank nodes: whole rows would take several times the memory of the compliance.
    near: np.ndarray
    first: np.ndarray
    flank_nodes: int

    @property
    def weights(self) -> np.ndarray:
        """Weights of all of the flank's nodes (n, nodes of flank)."""
        whole = np.zeros((len(self.near), self.flank_nodes))
        np.put_along_axis(whole, self.first[:, None] + np.arange(self.near.shape[1]), self.near, axis=1)
        return whole


def hat_integrals(offsets: np.ndarray) -> np.ndarray:
    """Integral of each hat function (n,), mm: the length of flank of a contact node.

    >>> hat_integrals(np.array([0.0, 1.0, 3.0])).tolist()
    [0.5, 1.5, 1.0]
    """
    return hats_of(offsets, np.array([0, len(offsets)]))


def hats_of(offsets: np.ndarray, ends: np.ndarray) -> np.ndarray:
    """The same of the nodes of many pairs, each from its place in `ends` (P + 1,) on.

    >>> hats_of(np.array([0.0, 1.0, 3.0, 0.0, 1.0]), np.array([0, 3, 5])).tolist()
    [0.5, 1.5, 1.0, 0.5, 0.5]
    """
    cells = offsets[1:] - offsets[:-1]
    cells[ends[1:-1] - 1] = 0.0
    integrals = np.zeros(len(offsets))
    integrals[:-1] += 0.5 * cells
    integrals[1:] += 0.5 * cells
    return integrals


@njit(cache=True)
def node_function(hat):
    """A node's function on a cell, from its hat function there."""
    return 2.0 * hat - 0.5


def quadrature_offsets(offsets: np.ndarray) -> np.ndarray:
    """Gauss points (n - 1, points), mm, of the cells between contact nodes."""
    return offsets_of_cells(offsets, np.array([0, len(offsets)])).reshape(-1, len(GAUSS_POINTS))


@njit(cache=True)
def offsets_of_cells(offsets: np.ndarray, ends: np.ndarray) -> np.ndarray:
    """The same of the nodes of many pairs, each from its place in `ends` (P + 1,) on, one after the other."""
    points = np.empty((len(offsets) - len(ends) + 1, len(GAUSS_POINTS)))
    for pair in range(len(ends) - 1):
        for cell in range(ends[pair], ends[pair + 1] - 1):
            points[cell - pair] = offsets[cell] + (offsets[cell + 1] - offsets[cell]) * GAUSS_POINTS
    return points.ravel()


@njit(cache=True)
def node_average(offsets: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Average over each node's function (n,) of `values` given at `quadrature_offsets(offsets)`."""
    sums = np.zeros(len(offsets))
    integrals = np.zeros(len(offsets))
    for cell in range(len(offsets) - 1):
        width = offsets[cell + 1] - offsets[cell]
        integrals[cell] += 0.5 * width
        integrals[cell + 1] += 0.5 * width
        for point in range(len(GAUSS_POINTS)):
            scaled = values[cell, point] * GAUSS_WEIGHTS[point] * width
            sums[cell] += scaled * node_function(1.0 - GAUSS_POINTS[point])
            sums[cell + 1] += scaled * node_function(GAUSS_POINTS[point])
    return sums / integrals


@njit(cache=True)
def node_averages(offsets: np.ndarray, ends: np.ndarray, values: np.ndarray) -> np.ndarray:
    """The same (n,) of the nodes of many pairs, each from its place in `ends` (P + 1,) on, of values at the quadrature
    offsets of one pair after the other."""
    averages = np.empty(len(offsets))
    cells = values.reshape((-1, len(GAUSS_POINTS)))
    for pair in range(len(ends) - 1):
        begin = ends[pair]
        end = ends[pair + 1]
        averages[begin:end] = node_average(offsets[begin:end], cells[begin - pair : end - pair - 1])
    return averages


@njit(cache=True)
def _element(vertex_arc, arc, side):
    """The element at an arc length; at a vertex the one before it by "left", the one behind it by "right"."""
    return min(max(np.searchsorted(vertex_arc, arc, side) - 1, 0), len(vertex_arc) - 2)


@njit(cache=True)
def _averaging_weights(offsets, ends, rolls, contact_rolls, flank_rolls, flanks, gear, order):
    """Exact averages of the element's shape functions: Gauss on every piece between contact nodes and element vertices.

    Of the nodes of many pairs, from `ends` (P + 1,) on; `rolls`: roll angle of each contact node; `flank_rolls`: those
    of the nodes of one flank after the other, and `flanks` (2, P): where those of a pair's flank begin and their
    number; `gear`: base radius and sense of a `geometry.gear.Side`, with y = sense (rb - h). Returns weights node by
    node, the first flank node of each, and the width (P,) of weights.
    """
    pairs = len(contact_rolls)
    vertex_arcs = 0.5 * abs(gear[0]) * flank_rolls**2
    arcs = 0.5 * abs(gear[0]) * rolls**2
    lowest = np.empty(len(offsets), np.int64)
    widths = np.empty(pairs, np.int64)
    size = 0
    for pair in range(pairs):
        # In one piece: a search in an array with gaps copies it.
        vertices = vertex_arcs[flanks[0, pair] : flanks[0, pair] + flanks[1, pair] : order].copy()
        most = 0
        for node in range(ends[pair], ends[pair + 1]):
            neighbours = arcs[max(node - 1, ends[pair]) : min(node + 2, ends[pair + 1])]
            lowest[node] = _element(vertices, neighbours.min(), "right")
            most = max(most, _element(vertices, neighbours.max(), "left") - lowest[node] + 1)
        widths[pair] = order * most + 1
        size += (ends[pair + 1] - ends[pair]) * widths[pair]
    near = np.zeros(size)
    firsts = order * lowest
    begin = 0
    for pair in range(pairs):
        on_flank = vertex_arcs[flanks[0, pair] : flanks[0, pair] + flanks[1, pair]]
        own = slice(ends[pair], ends[pair + 1])
        end = begin + (ends[pair + 1] - ends[pair]) * widths[pair]
        firsts[own] = np.minimum(firsts[own], len(on_flank) - widths[pair])
        weights = near[begin:end].reshape((ends[pair + 1] - ends[pair], widths[pair]))
        arrays = offsets[own], arcs[own], on_flank[::order].copy()
        _add_weights(weights, firsts[own], arrays, (gear[0], gear[1], contact_rolls[pair]), order)
        begin = end
    return near, firsts, widths


@njit(cache=True)
def _add_weights(near, first, arrays, numbers, order):
    """Add the weights of one pair to `near` (n, w)."""
    offsets, arcs, vertex_arc = arrays
    base_radius, sense, contact_roll = numbers
    elements = len(vertex_arc) - 1
    for cell in range(len(offsets) - 1):
        size_of_cell = offsets[cell + 1] - offsets[cell]
        low = min(arcs[cell], arcs[cell + 1])
        high = max(arcs[cell], arcs[cell + 1])
        element = _element(vertex_arc, low, "right")
        start = low
        while start < high:
            end = high if element == elements - 1 else min(high, vertex_arc[element + 1])
            size = vertex_arc[element + 1] - vertex_arc[element]
            for point, share in zip(GAUSS_POINTS, GAUSS_WEIGHTS):
                arc = start + point * (end - start)
                roll = math.sqrt(2.0 * arc / abs(base_radius))
                sine = math.sin(0.5 * (contact_roll - roll))
                cosine = math.cos(0.5 * (contact_roll - roll))
                # Depth below the line of action: rb - rb cos(v_c - v) + rb v sin(v_c - v), without cancelling.
                depth = 2.0 * base_radius * sine * (sine + roll * cosine)
                right = (sense * depth - offsets[cell]) / size_of_cell
                # dy = cos(v_c - v) ds on an involute.
                measure = share * (end - start) * (1.0 - 2.0 * sine**2)
                local = (arc - vertex_arc[element]) / size
                for side in range(2):
                    node = cell + side
                    weight = measure * node_function(right if side == 1 else 1.0 - right)
                    base = order * element - first[node]
                    if order == 1:
                        near[node, base] += weight * (1.0 - local)
                        near[node, base + 1] += weight * local
                    else:
                        near[node, base] += weight * (1.0 - local) * (1.0 - 2.0 * local)
                        near[node, base + 1] += weight * 4.0 * local * (1.0 - local)
                        near[node, base + 2] += weight * local * (2.0 * local - 1.0)
            start = end
            element = min(element + 1, elements - 1)
    for node in range(len(offsets)):
        near[node] /= near[node].sum()  # constants are averaged exactly


@dataclass(frozen=True)
class GearContacts:
    """Contact nodes (n,) of many pairs on the flanks of one gear, of each pair from the place in `ends` (P + 1,) on.

    `offsets` (n,), mm; roll angles `rolls` (n,), rad, and of each pair that of contact, `contact_rolls` (P,), and those
    of its flank's nodes, `flank_rolls`; `sense` of the gear's side.
    """

    offsets: np.ndarray
    ends: np.ndarray
    rolls: np.ndarray
    contact_rolls: np.ndarray
    flank_rolls: Sequence[np.ndarray]
    base_radius: float
    sense: int
    element_order: int


def flank_interpolations(nodes: GearContacts) -> list[FlankInterpolation]:
    """Averaged trace of the flank's elements for the contact nodes of each pair."""
    # Most flanks are alike.
    distinct = {id(rolls): rolls for rolls in nodes.flank_rolls}
    begins = dict(zip(distinct, accumulate(map(len, distinct.values()), initial=0)))
    sizes = [len(rolls) for rolls in nodes.flank_rolls]
    near, first, widths = _averaging_weights(
        nodes.offsets, nodes.ends, nodes.rolls, nodes.contact_rolls, np.concatenate(list(distinct.values())),
        np.array([[begins[id(rolls)] for rolls in nodes.flank_rolls], sizes]),
        np.array([nodes.base_radius, nodes.sense]), nodes.element_order,
    )  # fmt: skip
    ends = nodes.ends.tolist()
    of_pairs = []
    begin = 0
    for size, width, start, end in zip(sizes, widths.tolist(), ends, ends[1:]):
        last = begin + (end - start) * width
        of_pairs.append(FlankInterpolation(near[begin:last].reshape(-1, width), first[start:end], size))
        begin = last
    return of_pairs


class Averages:
    """Averages over the function of each contact node, so that nothing jumps as it passes nodes of the flank. Nodes
    are of many pairs, of each from its place in `ends` (P + 1,) on.

    `places`: offsets at which nodes need values; `at_nodes`: values of the nodes from those there; `of_flank`: the
    weights of the flank's nodes; `points`: where the places of each pair begin and end.
    """

    places = staticmethod(offsets_of_cells)
    at_nodes = staticmethod(node_averages)
    of_flank = staticmethod(flank_interpolations)

    def points(self, ends: np.ndarray) -> np.ndarray:
        """Where they begin and end (P + 1,)."""
        return len(GAUSS_POINTS) * (ends - np.arange(len(ends)))


class Points:
    """Collocation: force, gap and displacement of a contact node are those at its own point."""

    def places(self, offsets: np.ndarray, ends: np.ndarray) -> np.ndarray:
        """The nodes' own offsets (n,), mm."""
        return offsets

    def points(self, ends: np.ndarray) -> np.ndarray:
        """Where they begin and end (P + 1,)."""
        return ends

    def at_nodes(self, offsets: np.ndarray, ends: np.ndarray, values: np.ndarray) -> np.ndarray:
        """The values (n,) themselves."""
        return values

    def of_flank(self, nodes: GearContacts) -> list[FlankInterpolation]:
        """The element's shape functions at the nodes' roll angles."""
        order = nodes.element_order
        of_pairs = []
        for flank_rolls, start, end in zip(nodes.flank_rolls, nodes.ends[:-1], nodes.ends[1:]):
            rolls = nodes.rolls[start:end], flank_rolls[::order]
            arc, places = (0.5 * abs(nodes.base_radius) * each**2 for each in rolls)
            element = np.clip(np.searchsorted(places, arc, side="right") - 1, 0, len(places) - 2)
            local = np.clip((arc - places[element]) / np.diff(places)[element], 0.0, 1.0)
            if order == 1:
                shapes = (1.0 - local, local)
            else:
                shapes = ((1.0 - local) * (1.0 - 2.0 * local), 4.0 * local * (1.0 - local), local * (2.0 * local - 1.0))
            of_pairs.append(FlankInterpolation(np.stack(shapes, axis=1), order * element, len(flank_rolls)))
        return of_pairs


# By their names in a scene.
AVERAGED = "averaged"
COLLOCATED = "collocated"
INTERPOLATIONS: dict[str, Averages | Points] = {AVERAGED: Averages(), COLLOCATED: Points()}
