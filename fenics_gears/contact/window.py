"""The contact grid of one tooth pair: where its contact nodes lie across the line of action.

A contact node sits at an offset `y` from the line of action, positive towards the pinion's centre. The grid follows the
moving contact point. Where a tip or a form circle cuts the window, a node sits exactly on that edge and moves with it:
nodes then leave one by one at the far end of the window, which is open, and nothing jumps where the load is. Nodes
stand closer beside a tip, towards whose edge the contact pressure rises steeply.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import ceil, cos, sin

import numpy as np

from fenics_gears.contact.interpolation import AVERAGED
from fenics_gears.geometry.pair import GearPair

# Sizes of the cells beside an edge, in spacings: whole spacings together, so that the other nodes do not jump where an
# edge enters the window.
EDGE_CELLS, NO_CELLS = np.array([0.25, 0.25, 0.5]), np.empty(0)
# Offsets (mm) where the flanks end below the line of action (pinion's tip, wheel's form circle), and above it (pinion's
# form circle, wheel's tip).
Ends = tuple[tuple[float, float], tuple[float, float]]


@dataclass(frozen=True)
class ContactGrid:
    """Length of the contact window in mm, contact nodes in a whole window, and the name of their interpolation of the
    flanks.

    `closer_at_edges`: nodes stand closer beside a tip that cuts the window. `inner_length` (mm): where no edge is near,
    nodes further than half of it from the line of action are left out, since flanks touch far from the line at edges
    alone; None: none are.
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
        """Sizes of the cells beside an edge, in spacings."""
        return EDGE_CELLS if self.closer_at_edges else NO_CELLS

    @cached_property
    def evenly(self) -> np.ndarray:
        """Distances (nodes,), mm, of contact nodes from the first of a whole window."""
        return self.spacing * np.arange(self.nodes)

    @cached_property
    def beside_an_edge(self) -> np.ndarray:
        """Distances (n,), mm, of contact nodes from an edge that cuts the window."""
        cells = self.edge_cells
        return np.concatenate([[0.0], self.spacing * np.cumsum(cells), self.evenly[round(cells.sum()) + 1 :]])


def contact_roll_angles(pair: GearPair, xi: float) -> tuple[float, float]:
    """Roll angles (rad) on pinion and wheel of the point of contact at `xi` (mm) from T1; model.md section 1."""
    return xi / pair.pinion.base_radius, (pair.line_of_action_length - xi) / pair.wheel.base_radius


def coast_roll_angles(pair: GearPair, xi: float) -> tuple[float, float]:
    """The same for the coast flank of the pinion's tooth that touches at `xi`, and the wheel's coast flank that faces
    it.

    Mirrored at the line of centres coast flanks are drive flanks: a tooth whose drive flank stands at roll angle v has
    its coast flank at 2 alpha_w + 2 psi_b - v there, psi_b being half its angle at the base circle. The flank that
    faces it is that of the wheel's tooth one base pitch behind. The two do not touch: rb1 v1 + rb2 v2 = L - backlash.
    """
    drive = contact_roll_angles(pair, xi)[0], contact_roll_angles(pair, xi - pair.base_pitch)[1]
    return tuple(
        2.0 * (pair.operating_pressure_angle + gear.tooth_half_angle_at_base) - roll
        for gear, roll in zip((pair.pinion, pair.wheel), drive)
    )


def flank_ends(pair: GearPair, contact_rolls: tuple[float, float]) -> Ends:
    """Offsets (mm) where the flanks end on the line of action of either gear's contact roll angle (rad)."""
    pinion, wheel = pair.pinion, pair.wheel
    roll_1, roll_2 = contact_rolls

    def height(gear, roll, contact_roll):
        # As `flank_point`; of single numbers numpy would take five times as long.
        turned = contact_roll - roll
        return gear.base_radius * (cos(turned) - roll * sin(turned))

    below = (
        pinion.base_radius - height(pinion, pinion.tip_roll_angle, roll_1),
        height(wheel, wheel.form_roll_angle, roll_2) - wheel.base_radius,
    )
    above = (
        pinion.base_radius - height(pinion, pinion.form_roll_angle, roll_1),
        height(wheel, wheel.tip_roll_angle, roll_2) - wheel.base_radius,
    )
    return below, above


def window(ends: Ends, grid: ContactGrid) -> tuple[float, float] | None:
    """Offsets (mm) between which flanks with these ends exist in the grid's window; None where they do not."""
    half = 0.5 * grid.length
    start, end = max(*ends[0], -half), min(*ends[1], half)
    return (start, end) if end - start > 1e-9 * grid.length else None


def node_offsets(ends: Ends, grid: ContactGrid) -> np.ndarray:
    """Offsets `y` (n,), mm, increasing, of the contact nodes of flanks with these ends; empty where they cannot touch.

    Nodes stand closer beside a tip that cuts the window, not beside a form circle.
    """
    inside = window(ends, grid)
    if inside is None:
        return np.empty(0)
    offsets = _in_window(inside, ends, grid)
    if grid.inner_length is None:
        return offsets
    # Beside an edge within the window: as far beyond it, or beyond the line.
    # A node by itself has no cell to average over.
    near, half = max(0.5 * grid.inner_length, grid.spacing), 0.5 * grid.length
    low = inside[0] if inside[0] > -half else min(-near, inside[1] - 2.0 * near)
    high = inside[1] if inside[1] < half else max(near, inside[0] + 2.0 * near)
    return offsets[(offsets >= low - 1e-9 * half) & (offsets <= high + 1e-9 * half)]


def _in_window(inside: tuple[float, float], ends: Ends, grid: ContactGrid) -> np.ndarray:
    """Offsets (n,), mm, of contact nodes between the ends of a window."""
    (start, end), ((tip_1, form_2), (form_1, tip_2)) = inside, ends
    half, length = 0.5 * grid.length, end - start
    cut_low, cut_high = start > -half, end < half
    below, above = (grid.edge_cells if tip else NO_CELLS for tip in (tip_1 >= form_2, tip_2 <= form_1))
    if cut_low and cut_high:
        even = round(length / grid.spacing - below.sum() - above.sum())
        cells = np.concatenate([below, np.ones(max(even, 0)), above[::-1]])
        if even < 0 or not len(cells):
            cells = np.ones(max(1, round(length / grid.spacing)))
        return start + length / cells.sum() * np.concatenate([[0.0], np.cumsum(cells)])
    # As far as the window reaches, one cell at least; the tolerance keeps the node count of an uncut window whole in
    # spite of round-off.
    distances = grid.beside_an_edge if cut_low and len(below) or cut_high and len(above) else grid.evenly
    distances = distances[: np.searchsorted(distances, length * (1.0 + 1e-12), "right")]
    if len(distances) == 1:
        distances = np.array([0.0, length])
    return start + distances if cut_low else end - distances[::-1]
