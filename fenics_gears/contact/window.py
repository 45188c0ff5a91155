"""The contact grid of one tooth pair: where its contact nodes lie across the line of action.

A contact node is at an offset `y` from the line of action, positive towards the pinion's centre. The grid follows the
moving contact point. Where a tip or a form circle cuts the window, a node is exactly on that edge and moves with it.
Nodes then leave one by one at the far end of the window, which is open, and nothing jumps where the load is. Nodes are
closer near a tip, towards whose edge the contact pressure rises steeply.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import ceil

import numpy as np
from numba import njit

from fenics_gears.geometry.pair import GearPair

from .interpolation import AVERAGED

# Sizes of the cells next to an edge, in spacings: whole spacings together, so that the other nodes do not jump where an
# edge enters the window.
EDGE_CELLS = np.array([0.25, 0.25, 0.5])
NO_CELLS = np.empty(0)
# Offsets (mm) where the flanks end below the line of action (pinion's tip, wheel's form circle), and above it (pinion's
# form circle, wheel's tip).
Ends = tuple[tuple[float, float], tuple[float, float]]


@dataclass(frozen=True)
class ContactGrid:
    """Length of the contact window in mm, contact nodes in a whole window, and the name of their interpolation of the
    flanks.

    `closer_at_edges`: nodes are closer near a tip that cuts the window. `inner_length` (mm): where no edge is near,
    nodes further than half of it from the line of action are left out, since flanks touch far from the line at edges
    alone. None: none are.
    """

    length: float
    nodes: int
    interpolation: str = AVERAGED
    closer_at_edges: bool = False
    inner_length: float | None = None

    @property
    def spacing(self) -> float:
        """Distance of neighbouring contact nodes, mm."""
        return self.length / (self.nodes - 1)

    @property
    def most_nodes(self) -> int:
        """Contact nodes of a window that edges cut at both ends, at most."""
        return self.nodes + ceil(2.0 * (len(self.edge_cells) - self.edge_cells.sum()))

    @cached_property
    def edge_cells(self) -> np.ndarray:
        """Sizes of the cells next to an edge, in spacings."""
        return EDGE_CELLS if self.closer_at_edges else NO_CELLS

    @cached_property
    def evenly(self) -> np.ndarray:
        """Distances (nodes,), mm, of contact nodes from the first of a whole window."""
        return self.spacing * np.arange(self.nodes)

    @cached_property
    def from_an_edge(self) -> np.ndarray:
        """Distances (n,), mm, of contact nodes from an edge that cuts the window."""
        cells = self.edge_cells
        return np.concatenate([[0.0], self.spacing * np.cumsum(cells), self.evenly[round(cells.sum()) + 1 :]])


def contact_roll_angles(pair: GearPair, xi: float) -> tuple[float, float]:
    """Roll angles (rad) on pinion and wheel of the point of contact at `xi` (mm) from T1; model.md section 1."""
    return tuple(side.arm(xi) / side.gear.base_radius for side in pair.sides)


def coast_roll_angles(pair: GearPair, xi: float) -> tuple[float, float]:
    """The same for the coast flank of the pinion's tooth that touches at `xi`, and the wheel's coast flank that faces
    it: that of its tooth one base pitch behind.

    Mirrored at the line of centres coast flanks are drive flanks. A tooth whose drive flank is at roll angle v has its
    coast flank at 2 alpha_w + 2 psi_b - v there, psi_b being half its angle at the base circle. The wheel's point is
    the one that touches once a rotation of the wheel has closed the backlash, so that rb1 v1 + rb2 v2 = L. Before, the
    two are apart by the backlash (`tooth_pair.apart`).
    """
    pinion = pair.sides[0].gear
    turned = 2.0 * (pair.operating_pressure_angle + pinion.tooth_half_angle_at_base)
    return contact_roll_angles(pair, pinion.base_radius * turned - xi)


def flank_ends(pair: GearPair, contact_rolls: tuple[float, float]) -> Ends:
    """Offsets (mm) where the flanks end on the line of action of either gear's contact roll angle (rad)."""
    below, above = ends_of(pair, np.array(contact_rolls)[:, None])[0].tolist()
    return tuple(below), tuple(above)


def ends_of(pair: GearPair, contact_rolls: np.ndarray) -> np.ndarray:
    """The same (P, 2, 2) of many contact roll angles (2, P), rad."""
    ends = np.empty((contact_rolls.shape[1], 2, 2))
    for side, contact in zip(pair.sides, contact_rolls):
        gear = side.gear
        # The first gear's tip is below the line, and the second one's above it.
        for end, roll in zip((0, 1)[:: side.sense], (gear.tip_roll_angle, gear.form_roll_angle)):
            # As `flank_point`.
            turned = contact - roll
            height = gear.base_radius * (np.cos(turned) - roll * np.sin(turned))
            ends[:, end, side.number] = side.sense * (gear.base_radius - height)
    return ends


def windows(ends: np.ndarray, grid: ContactGrid) -> tuple[np.ndarray, np.ndarray]:
    """Offsets (P,), mm, between which flanks with many ends (P, 2, 2) exist in the grid's window; those of flanks that
    do not end too early."""
    half = 0.5 * grid.length
    return np.maximum(ends[:, 0].max(axis=1), -half), np.minimum(ends[:, 1].min(axis=1), half)


def exists(start, end, grid: ContactGrid):
    """Whether windows from `start` to `end` (mm) have a length."""
    return end - start > 1e-9 * grid.length


def node_offsets(ends: Ends, grid: ContactGrid) -> np.ndarray:
    """Offsets `y` (n,), mm, increasing, of the contact nodes of flanks with these ends; empty where they cannot touch.

    Nodes are closer near a tip that cuts the window, not near a form circle.
    """
    return offsets_of(np.array([ends]), grid)[0]


def offsets_of(ends: np.ndarray, grid: ContactGrid) -> tuple[np.ndarray, np.ndarray]:
    """The same of flanks with many ends (P, 2, 2), one after the other; and how many each has (P,)."""
    inner = np.inf if grid.inner_length is None else grid.inner_length
    sizes = grid.length, grid.spacing, max(0.5 * inner, grid.spacing)
    return _offsets(ends, sizes, grid.most_nodes, grid.edge_cells, grid.evenly, grid.from_an_edge)


@njit(cache=True)
def _offsets(ends, sizes, most, cells, evenly, from_an_edge):
    length, spacing, near = sizes
    half = 0.5 * length
    of_all = np.empty(most * len(ends))
    counts = np.zeros(len(ends), dtype=np.int64)
    last = 0
    for flank in range(len(ends)):
        below = ends[flank, 0]
        above = ends[flank, 1]
        start = max(below[0], below[1], -half)
        end = min(above[0], above[1], half)
        if not end - start > 1e-9 * length:
            continue
        tips = below[0] >= below[1], above[1] <= above[0]
        offsets = _in_window((start, end), tips, (half, spacing), (cells, evenly, from_an_edge))
        # Near an edge within the window: as far beyond it, or beyond the line.
        # A node by itself has no cell to average over.
        low = start if start > -half else min(-near, end - 2.0 * near)
        high = end if end < half else max(near, start + 2.0 * near)
        for offset in offsets:
            if low - 1e-9 * half <= offset <= high + 1e-9 * half:
                of_all[last] = offset
                last += 1
                counts[flank] += 1
    return of_all[:last].copy(), counts


@njit(cache=True)
def _in_window(window, tips, sizes, tables):
    """Offsets (n,), mm, of contact nodes between the ends of a window; `tips`: whether a tip is below and above it."""
    start, end = window
    half, spacing = sizes
    cells, evenly, from_an_edge = tables
    cut_low = start > -half
    cut_high = end < half
    length = end - start
    below = cells if tips[0] else cells[:0]
    above = cells if tips[1] else cells[:0]
    if cut_low and cut_high:
        even = int(np.rint(length / spacing - below.sum() - above.sum()))
        between = np.concatenate((below, np.ones(max(even, 0)), np.flip(above)))
        if even < 0 or not len(between):
            between = np.ones(max(1, int(np.rint(length / spacing))))
        return start + length / between.sum() * np.concatenate((np.zeros(1), np.cumsum(between)))
    # As far as the window reaches, one cell at least; the tolerance keeps the node count of an uncut window whole in
    # spite of round-off.
    distances = from_an_edge if cut_low and len(below) or cut_high and len(above) else evenly
    distances = distances[: np.searchsorted(distances, length * (1.0 + 1e-12), "right")]
    if len(distances) == 1:
        distances = np.array([0.0, length])
    return start + distances if cut_low else end - np.flip(distances)
