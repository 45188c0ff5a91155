"""How contact nodes see the flanks: displacements, gaps and positions averaged over functions of their own, or taken at
their points.

Contact force and gap use the same averages, so that energy and symmetry are kept: a nodal force acts as the line load
`p_j psi_j / integral(psi_j)`, and a nodal displacement or gap is `integral(psi_j u) / integral(psi_j)` (model.md
section 2).

On each cell `psi_j` is `2 hat_j - 1/2`, midway between the hat function and its dual `3 hat_j - 1` (B. I. Wohlmuth,
SIAM J. Numer. Anal. 38, 2000). Its integrals are the hat's and its sum over the nodes is one, so that an even pressure
is passed on exactly; but averages of parabolas over even cells are exact too, while hats see a gap too large by h^2/(12
R) for cells of h and flanks of relative radius R.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numba import njit

GAUSS_POINTS, GAUSS_WEIGHTS = np.polynomial.legendre.leggauss(4)
GAUSS_POINTS = 0.5 * (GAUSS_POINTS + 1.0)
GAUSS_WEIGHTS = 0.5 * GAUSS_WEIGHTS


@dataclass(frozen=True)
class FlankInterpolation:
    """Row `j` of `near` (n, w) takes the flank's dof nodes `first[j]` to `first[j] + w - 1` to the average of node `j`;
    `flank_nodes` of the flank."""

    # A node sees a few flank nodes: whole rows would take several times what the compliance between contact nodes does.
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
    """Integral of each hat function (n,), mm: the length of flank that a contact node stands for.

    >>> hat_integrals(np.array([0.0, 1.0, 3.0])).tolist()
    [0.5, 1.5, 1.0]
    """
    cells = offsets[1:] - offsets[:-1]
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
    return offsets[:-1, None] + (offsets[1:] - offsets[:-1])[:, None] * GAUSS_POINTS


@njit(cache=True)
def node_average(offsets: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Average over each node's function (n,) of `values` given at `quadrature_offsets(offsets)`."""
    sums, integrals = np.zeros(len(offsets)), np.zeros(len(offsets))
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
def _element(vertex_arc, arc, side):
    """The element at an arc length; at a vertex the one before it by "left", the one behind it by "right"."""
    return min(max(np.searchsorted(vertex_arc, arc, side) - 1, 0), len(vertex_arc) - 2)


@njit(cache=True)
def _averaging_weights(offsets, rolls, base_radius, contact_roll, sense, flank_rolls, order):
    """Exact averages of the element's shape functions: Gauss on every piece between contact nodes and element vertices.

    `rolls`: roll angle of each contact node; `sense`: -1 on the pinion, where y = rb - h, +1 on the wheel, y = h - rb.
    """
    vertex_arc = 0.5 * base_radius * flank_rolls[::order] ** 2
    n, elements = len(offsets), len(vertex_arc) - 1
    arcs = 0.5 * base_radius * rolls**2
    lowest, highest = np.empty(n, dtype=np.int64), np.empty(n, dtype=np.int64)
    for node in range(n):
        beside = arcs[max(node - 1, 0) : node + 2]
        lowest[node], highest[node] = (
            _element(vertex_arc, beside.min(), "right"),
            _element(vertex_arc, beside.max(), "left"),
        )
    width = order * (highest - lowest + 1).max() + 1
    near, first = np.zeros((n, width)), np.minimum(order * lowest, len(flank_rolls) - width)
    for cell in range(n - 1):
        size_of_cell = offsets[cell + 1] - offsets[cell]
        low, high = min(arcs[cell], arcs[cell + 1]), max(arcs[cell], arcs[cell + 1])
        element = _element(vertex_arc, low, "right")
        start = low
        while start < high:
            end = high if element == elements - 1 else min(high, vertex_arc[element + 1])
            size = vertex_arc[element + 1] - vertex_arc[element]
            for point, share in zip(GAUSS_POINTS, GAUSS_WEIGHTS):
                arc = start + point * (end - start)
                turn = contact_roll - math.sqrt(2.0 * arc / base_radius)
                roll = contact_roll - turn
                # Height above the line of action: rb cos(v_c - v) - rb v sin(v_c - v) - rb, without cancelling.
                rise = -base_radius * (2.0 * math.sin(0.5 * turn) ** 2 + roll * math.sin(turn))
                right = (sense * rise - offsets[cell]) / size_of_cell
                measure = share * (end - start) * math.cos(turn)  # dy = cos(v_c - v) ds on an involute
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
    for node in range(n):
        near[node] /= near[node].sum()  # constants are averaged exactly
    return near, first


def flank_interpolation(
    offsets: np.ndarray,
    rolls: np.ndarray,
    base_radius: float,
    contact_roll: float,
    sense: float,
    flank_rolls: np.ndarray,
    element_order: int,
) -> FlankInterpolation:
    """Averaged trace of the flank's elements for contact nodes at `offsets` (n,), mm, roll angles `rolls` (n,), rad."""
    near, first = _averaging_weights(offsets, rolls, base_radius, contact_roll, sense, flank_rolls, element_order)
    return FlankInterpolation(near, first, len(flank_rolls))


class Averages:
    """A contact node sees averages over its function, so that nothing jumps as it passes nodes of the flank.

    `places`: offsets at which nodes need the values that they see; `seen`: what they see of values there; `of_flank`:
    the weights of the flank's nodes.
    """

    places, seen, of_flank = (
        staticmethod(quadrature_offsets),
        staticmethod(node_average),
        staticmethod(flank_interpolation),
    )


class Points:
    """Collocation: a contact node sees the values at its own point, of force, gap and displacement alike."""

    def places(self, offsets: np.ndarray) -> np.ndarray:
        """The nodes' own offsets (n,), mm."""
        return offsets

    def seen(self, offsets: np.ndarray, values: np.ndarray) -> np.ndarray:
        """The values (n,) themselves."""
        return values

    def of_flank(
        self, offsets, rolls, base_radius, contact_roll, sense, flank_rolls, element_order
    ) -> FlankInterpolation:
        """The element's shape functions at the nodes' roll angles; arguments as of `flank_interpolation`."""
        arc, places = 0.5 * base_radius * rolls**2, 0.5 * base_radius * flank_rolls[::element_order] ** 2
        element = np.clip(np.searchsorted(places, arc, side="right") - 1, 0, len(places) - 2)
        local = np.clip((arc - places[element]) / np.diff(places)[element], 0.0, 1.0)
        if element_order == 1:
            shapes = (1.0 - local, local)
        else:
            shapes = ((1.0 - local) * (1.0 - 2.0 * local), 4.0 * local * (1.0 - local), local * (2.0 * local - 1.0))
        return FlankInterpolation(np.stack(shapes, axis=1), element_order * element, len(flank_rolls))


# By their names in a scene.
AVERAGED, COLLOCATED = "averaged", "collocated"
INTERPOLATIONS = {AVERAGED: Averages(), COLLOCATED: Points()}
