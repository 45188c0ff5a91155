"""The layers that a section is swept through along the face, and the polynomials of a layer."""

from dataclasses import dataclass
from math import sqrt

import numpy as np
from scipy import sparse

from ..element_nodes import numbers_at

# Gauss's rule of three points on (-1, 1): exact to the fifth power, which the patch test of a twisted layer needs.
POINTS = (-sqrt(0.6), 0.0, sqrt(0.6))
WEIGHTS = (5.0 / 9.0, 8.0 / 9.0, 5.0 / 9.0)


# A layer's boundary that is closer to a side of the web than this part of a layer makes room for it.
NEAR_WEB = 0.2


@dataclass(frozen=True)
class SweptWeb:
    """Where the body between two radii (mm) is thinner than the face: from `low` to `high` (mm from mid-width)."""

    hub_radius: float
    rim_radius: float
    low: float
    high: float

    def outside(self, points: np.ndarray) -> np.ndarray:
        """Which points (k, 2), middles of cells, are of rim or hub."""
        radius = np.linalg.norm(points, axis=1)
        return (radius < self.hub_radius) | (radius > self.rim_radius)


@dataclass(frozen=True)
class Sweep:
    """How a section becomes a body: boundaries of the layers (layers + 1,), mm, increasing, and the twist, rad/mm,
    counter-clockwise along z; a web, whose sides are boundaries of layers."""

    boundaries: np.ndarray
    twist: float = 0.0
    web: SweptWeb | None = None

    @property
    def heights(self) -> np.ndarray:
        """z (2 layers + 1,), mm, of the nodes: boundaries and middles of the layers."""
        nodes = np.empty(2 * len(self.boundaries) - 1)
        nodes[::2] = self.boundaries
        nodes[1::2] = 0.5 * (self.boundaries[1:] + self.boundaries[:-1])
        return nodes

    @property
    def thicknesses(self) -> np.ndarray:
        """Thickness (layers,), mm; layers that differ by round-off have the same one."""
        thick = np.diff(self.boundaries)
        return np.round(thick / thick.max(), 12) * thick.max()

    @property
    def in_web(self) -> np.ndarray:
        """Which layers (layers,) have the whole section: all of a body without web."""
        if self.web is None:
            return np.ones(len(self.boundaries) - 1, dtype=bool)
        middles = self.heights[1::2]
        return (middles > self.web.low) & (middles < self.web.high)

    @property
    def kinds(self) -> list[tuple[float, bool]]:
        """Thickness of each layer, and whether it has the whole section."""
        return list(zip(self.thicknesses.tolist(), self.in_web.tolist()))


def layers_of_face(layers: int, width: float, overhang_layers: int = 0, overhang: float = 0.0) -> np.ndarray:
    """Boundaries, mm from mid-width, each the exact opposite of another: of layers of one thickness over a width (mm),
    and of `overhang_layers` over an `overhang` (mm) at either end."""
    inner = 0.5 * width * (np.arange(-layers, layers + 1, 2) / layers)
    beyond = 0.5 * width + overhang * np.arange(1, overhang_layers + 1) / max(overhang_layers, 1)
    return np.concatenate([-beyond[::-1], inner, beyond])


def layers_with_web(boundaries: np.ndarray, low: float, high: float) -> np.ndarray:
    """Boundaries of layers (mm) with the sides of a web among them, and at least two layers between these."""
    near, ends = NEAR_WEB * np.diff(boundaries).max(), boundaries[[0, -1]]
    slack = 1e-9 * (ends[1] - ends[0])
    nearest = [min(ends, key=lambda end: abs(end - side)) for side in (low, high)]
    sides = [end if abs(end - side) < slack else side for end, side in zip(nearest, (low, high))]
    inner = boundaries[1:-1]
    inner = inner[np.abs(inner[:, None] - sides).min(axis=1) > near]
    if not ((inner > low) & (inner < high)).any():
        inner = np.append(inner, 0.5 * (low + high))
    return np.unique(np.concatenate([ends, sides, inner]))


def shapes(place: float | np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Second-order shape functions (3, ...) of a layer's lower, middle and upper node in (-1, 1), and their
    derivatives."""
    values = np.array([0.5 * place * (place - 1.0), 1.0 - place**2, 0.5 * place * (place + 1.0)])
    return values, np.array([place - 0.5, -2.0 * place, place + 0.5])


def interpolation_along(boundaries: np.ndarray, places: np.ndarray) -> sparse.csr_matrix:
    """Values (p, 2 layers + 1) at places (p,), mm, of second-order functions of layers between boundaries, mm."""
    layer = np.clip(np.searchsorted(boundaries, places, "right") - 1, 0, len(boundaries) - 2)
    local = (places - boundaries[layer]) / np.diff(boundaries)[layer]
    values = shapes(2.0 * local - 1.0)[0].T
    columns = 2 * layer[:, None] + np.arange(3)
    rows = np.repeat(np.arange(len(places)), 3)
    return sparse.csr_matrix((values.ravel(), (rows, columns.ravel())), shape=(len(places), 2 * len(boundaries) - 1))


def swept_nodes(nodes: np.ndarray, line: np.ndarray, heights: int) -> np.ndarray:
    """Numbers (heights k,) of the body's nodes swept from nodes (k, 2) of the section (n, 2), by height."""
    return (len(nodes) * np.arange(heights)[:, None] + numbers_at(nodes, line)).ravel()
