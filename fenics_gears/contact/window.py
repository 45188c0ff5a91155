"""The contact grid of one tooth pair: where its contact nodes lie across the line of action.

A contact node sits at an offset `y` from the line of action, positive towards the pinion's centre. The grid follows
the moving contact point. Where a tip or a form circle cuts the window, a node sits exactly on that edge and moves with
it: nodes then leave one by one at the far end of the window, which is open, and nothing jumps where the load is. Nodes stand closer beside
such an edge, whose contact pressure rises steeply towards it.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import ceil, cos, sin

import numpy as np

from fenics_gears.contact.interpolation import AVERAGED
from fenics_gears.geometry.pair import GearPair

# Sizes of the cells beside an edge, in spacings: whole spacings together, so that the other nodes do not jump where an edge enters the window.
EDGE_CELLS, NO_CELLS = np.array([0.25, 0.25, 0.5]), np.empty(0)


@dataclass(frozen=True)
class ContactGrid:
    """Length of the contact window in mm, contact nodes in a whole window, and the name of their interpolation of the flanks.

    `closer_at_edges`: nodes stand closer beside an edge that cuts the window.
    """

    length: float
    nodes: int
    interpolation: str = AVERAGED
    closer_at_edges: bool = False

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
    """The same for the coast flank of the pinion's tooth that touches at `xi`, and the wheel's coast flank that faces it.

    Mirrored at the line of centres coast flanks are drive flanks: a tooth whose drive flank stands at roll angle v has its coast
    flank at 2 alpha_w + 2 psi_b - v there, psi_b being half its angle at the base circle. The flank that faces it is that of the
    wheel's tooth one base pitch behind. The two do not touch: rb1 v1 + rb2 v2 = L - backlash.
    """
    drive = contact_roll_angles(pair, xi)[0], contact_roll_angles(pair, xi - pair.base_pitch)[1]
    return tuple(
        2.0 * (pair.operating_pressure_angle + gear.tooth_half_angle_at_base) - roll
        for gear, roll in zip((pair.pinion, pair.wheel), drive)
    )


def flank_ends(pair: GearPair, contact_rolls: tuple[float, float]) -> tuple[tuple[float, float], tuple[float, float]]:
    """Offsets (mm) where the flanks end: below the line of action (pinion's tip, wheel's form circle), and above it (the others)."""
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


def flank_limits(pair: GearPair, contact_rolls: tuple[float, float]) -> tuple[float, float]:
    """Offsets (mm) between which both flanks exist: tips on one side, form circles on the other."""
    below, above = flank_ends(pair, contact_rolls)
    return max(below), min(above)


def node_offsets(pair: GearPair, contact_rolls: tuple[float, float], grid: ContactGrid) -> np.ndarray:
    """Offsets `y` (n,), mm, increasing, of the contact nodes of a pair; empty when it cannot touch.

    `contact_rolls` (rad): of either gear on the line of action.
    """
    (tip_1, form_2), (form_1, tip_2) = flank_ends(pair, contact_rolls)
    return offsets_between(max(tip_1, form_2), min(form_1, tip_2), grid, (tip_1 >= form_2, tip_2 <= form_1))


def offsets_between(lowest: float, highest: float, grid: ContactGrid, tips: tuple[bool, bool]) -> np.ndarray:
    """Offsets (n,), mm, increasing, of the contact nodes where the flanks exist between two offsets (mm).

    `tips`: whether it is a tip that ends them there, beside which nodes stand closer, and not a form circle.
    """
    half = 0.5 * grid.length
    start, end = max(lowest, -half), min(highest, half)
    length = end - start
    if length <= 1e-9 * grid.length:
        return np.empty(0)
    cut_low, cut_high = lowest > -half, highest < half
    if cut_low and cut_high:
        below, above = (grid.edge_cells if tip else NO_CELLS for tip in tips)
        even = round(length / grid.spacing - below.sum() - above.sum())
        cells = np.concatenate([below, np.ones(even), above[::-1]]) if even >= 0 else np.ones(max(1, round(length / grid.spacing)))
        return start + length / cells.sum() * np.concatenate([[0.0], np.cumsum(cells)])
    # As far as the window reaches, one cell at least; the tolerance keeps the node count of an uncut window whole in spite of round-off.
    distances = grid.beside_an_edge if cut_low and tips[0] or cut_high and tips[1] else grid.evenly
    distances = distances[: np.searchsorted(distances, length * (1.0 + 1e-12), "right")]
    if len(distances) == 1:
        distances = np.array([0.0, length])
    return start + distances if cut_low else end - distances[::-1]
