"""Bodies of revolution by harmonics: finite elements of the meridian section, for what a gear's body does around its
axis as a whole.

A motion is ``u_r = u cos(n t)``, ``u_t = v sin(n t)``, ``u_z = w cos(n t)`` over the angle t, with u, v, w of second
order on the rectangles of a grid. Harmonic 1 has displacements along x and tilts about y; a quarter of a turn makes
displacements along y and tilts about x of them. In harmonic 0 v is a twist by itself, and u, w stretch the body. O. C.
Zienkiewicz, The Finite Element Method (1977), chapter 15.
"""

from collections.abc import Sequence
from itertools import pairwise, product
from math import ceil, pi
from typing import NamedTuple

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import splu

from .face.layers import shapes

POINTS, WEIGHTS = np.polynomial.legendre.leggauss(3)
# Simpson's rule, exact for what nodes of second order interpolate.
SIMPSON = np.array([1.0, 4.0, 1.0]) / 6.0
# Elements across the thinnest part; mm between nodes that are one but for round-off.
FEWEST = 2
ROUND_OFF = 1e-9


class Ring(NamedTuple):
    """A part of rectangular section: radii and heights, mm, Young's modulus, N/mm^2, and Poisson's ratio."""

    inner: float
    outer: float
    low: float
    high: float
    modulus: float
    ratio: float


class BodyOfRevolution:
    """A body of rings, whose elements are no larger than a size (mm); its dofs are u, v, w by node."""

    def __init__(self, rings: Sequence[Ring], size: float):
        edges = np.array(rings)
        radii, heights = (_divided(np.unique(edges[:, columns]), size) for columns in ([0, 1], [2, 3]))
        which = None
        r, z = (0.5 * (each[1:] + each[:-1]) for each in (radii, heights))
        which = np.full((len(r), len(z)), -1)
        for number, ring in enumerate(rings):
            within = (r > ring.inner) & (r < ring.outer), (z > ring.low) & (z < ring.high)
            which[np.ix_(*within)] = number
        row, column = np.nonzero(which >= 0)
        all_radii, all_heights = (np.sort(np.concatenate(each)) for each in ((radii, r), (heights, z)))
        one, other = (each.ravel() for each in np.indices((3, 3)))
        numbers = (2 * row[:, None] + one) * len(all_heights) + 2 * column[:, None] + other
        used, cells = np.unique(numbers, return_inverse=True)
        self.cells = cells.reshape(-1, 9)
        self.nodes = np.column_stack([all_radii[used // len(all_heights)], all_heights[used % len(all_heights)]])
        self.middles = r[row]
        self.halves = 0.5 * np.diff(radii)[row], 0.5 * np.diff(heights)[column]
        modulus, ratio = edges[which[row, column]][:, 4:].T
        self.shear = 0.5 * modulus / (1.0 + ratio)
        self.lame = 2.0 * ratio / (1.0 - 2.0 * ratio) * self.shear

    def stiffness(self, order: int) -> sparse.csc_matrix:
        """Stiffness (d, d), N/mm, of a harmonic."""
        blocks = np.zeros((len(self.cells), 27, 27))
        law = np.zeros((len(self.cells), 6, 6))
        law[:, :3, :3] = self.lame[:, None, None]
        law[:, range(6), range(6)] += self.shear[:, None] * np.array([2.0, 2.0, 2.0, 1.0, 1.0, 1.0])
        across, along = (half[:, None] for half in self.halves)
        for (x, of_x), (y, of_y) in product(zip(POINTS, WEIGHTS), repeat=2):
            in_x, by_x = shapes(x)
            in_y, by_y = shapes(y)
            radius = self.middles[:, None] + across * x
            around = np.outer(in_x, in_y).ravel() / radius
            by_r = np.outer(by_x, in_y).ravel() / across
            by_z = np.outer(in_x, by_y).ravel() / along
            strains = np.zeros((len(self.cells), 6, 9, 3))
            strains[:, 0, :, 0] = by_r
            strains[:, 1, :, 0] = around
            strains[:, 1, :, 1] = order * around
            strains[:, 2, :, 2] = by_z
            strains[:, 3, :, 0] = -order * around
            strains[:, 3, :, 1] = by_r - around
            strains[:, 4, :, 1] = by_z
            strains[:, 4, :, 2] = -order * around
            strains[:, 5, :, 0] = by_z
            strains[:, 5, :, 2] = by_r
            strains = strains.reshape(-1, 6, 27)
            volume = (pi if order else 2.0 * pi) * of_x * of_y * (across * along * radius)[:, :, None]
            blocks += np.swapaxes(strains, 1, 2) @ (law * volume) @ strains
        dofs = (3 * self.cells[:, :, None] + np.arange(3)).reshape(-1, 27)
        places = np.repeat(dofs, 27, axis=1).ravel(), np.tile(dofs, 27).ravel()
        return sparse.csc_matrix((blocks.ravel(), places), shape=(3 * len(self.nodes),) * 2)

    def of_section(self, height: float, outer: float, order: int) -> np.ndarray:
        """Rows (2, d) of the mean motions of a cross section within a radius. Harmonic 1: displacement along x and tilt
        about y; harmonic 0: displacement along the axis and twist."""
        radii, heights = self.nodes.T
        within = radii < outer + ROUND_OFF
        rows = np.zeros((2, 3 * len(self.nodes)))
        z = np.unique(heights[within])
        for place, share in zip(*_shares(z, height)):
            nodes = np.flatnonzero((heights == z[place]) & within)
            nodes = nodes[np.argsort(radii[nodes])]
            r = radii[nodes]
            weights = np.zeros(len(nodes))
            for first in range(0, len(nodes) - 2, 2):
                weights[first : first + 3] += (r[first + 2] - r[first]) * SIMPSON
            moved = weights * r / (weights @ r), weights * r**2 / (weights @ r**3)
            rows += share * self._rows(nodes, *moved, order)
        return rows

    def of_circles(self, radius: float, heights: np.ndarray, order: int) -> np.ndarray:
        """The same (2 h, d) of circles at heights (h,) on the cylinder of a radius."""
        nodes = np.flatnonzero(abs(self.nodes[:, 0] - radius) < ROUND_OFF)
        nodes = nodes[np.argsort(self.nodes[nodes, 1])]
        z = self.nodes[nodes, 1]
        rows = []
        for height in heights:
            places, shares = _shares(z, height)
            rows.append(self._rows(nodes[places], shares, shares / radius, order))
        return np.concatenate(rows)

    def _rows(self, nodes: np.ndarray, along: np.ndarray, turned: np.ndarray, order: int) -> np.ndarray:
        rows = np.zeros((2, 3 * len(self.nodes)))
        if order:
            rows[0, 3 * nodes] = 0.5 * along
            rows[0, 3 * nodes + 1] = -0.5 * along
            rows[1, 3 * nodes + 2] = -turned
        else:
            rows[0, 3 * nodes + 2] = along
            rows[1, 3 * nodes + 1] = turned
        return rows


def flexibility(stiffness: sparse.csc_matrix, held: np.ndarray, loaded: np.ndarray) -> np.ndarray:
    """Motions (l, l) of rows `loaded` (l, d) per load there, of a body in which rows `held` (h, d) do not move."""
    rows = sparse.csc_matrix(held)
    size = len(held)
    factor = splu(sparse.bmat([[stiffness, rows.T], [rows, None]], format="csc"))
    motions = loaded @ factor.solve(np.vstack([loaded.T, np.zeros((size, len(loaded)))]))[:-size]
    return 0.5 * (motions + motions.T)


def flexibility_outside(stiffness: sparse.csc_matrix, fixed: np.ndarray, loaded: np.ndarray) -> np.ndarray:
    """As `flexibility`, of a body whose nodes `fixed` (n,) do not move at all."""
    free = np.flatnonzero(~np.repeat(fixed, 3))
    motions = loaded[:, free] @ splu(stiffness[free][:, free].tocsc()).solve(loaded[:, free].T)
    return 0.5 * (motions + motions.T)


def _divided(stops: np.ndarray, size: float) -> np.ndarray:
    """Ends of elements no longer than a size, and at least FEWEST of them between two stops."""
    apart = [pair for pair in pairwise(stops) if pair[1] - pair[0] > ROUND_OFF]
    parts = [np.linspace(*each, max(ceil((each[1] - each[0]) / size - 1e-6), FEWEST) + 1)[:-1] for each in apart]
    return np.append(np.concatenate(parts), stops[-1])


def _shares(heights: np.ndarray, height: float) -> tuple[np.ndarray, np.ndarray]:
    """Places (3,) of the nodes of an element among heights (n,), increasing, and their shares in a height between."""
    first = 2 * int(np.clip(np.searchsorted(heights[::2], height) - 1, 0, len(heights) // 2 - 1))
    low, middle, high = heights[first : first + 3]
    return np.arange(first, first + 3), shapes((height - middle) / (0.5 * (high - low)))[0]
