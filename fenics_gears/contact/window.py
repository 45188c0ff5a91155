"""The contact grid of one tooth pair: where its contact nodes lie across the line of action.

A contact node sits at an offset `y` from the line of action, positive towards the pinion's centre. The grid follows
the moving contact point. Where a tip or a form circle cuts the window, a node sits exactly on that edge and moves with
it: nodes then leave at the far, open end of the window one by one, and nothing jumps where the load is.

Nodes may stand closer at such an edge. A pair that comes or goes touches with the edge alone, and the gap opens in proportion to the distance
from it: averaged over half a hat function of width h it is too wide by a third of h times that slope, which is an error of first order.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fenics_gears.contact.interpolation import AVERAGED
from fenics_gears.geometry.involute import flank_point
from fenics_gears.geometry.pair import GearPair


# Cells next to an edge where a flank ends, in parts of the spacing, from the edge on. With this one node more T_E of the paper's pair without
# friction errs by 1.6, 0.41, 0.11, 0.026 % with 1, 2, 4, 8 nodes in a half-width, and by 4.5, 1.7, 0.63, 0.28 % with even cells; more nodes
# gain little, and soon stand closer than the elements of the flank can tell apart.
EDGE_CELLS, EVEN = (0.125, 0.875), (1.0,)
# A window of fewer cells for each edge is one that has just opened, far from the load.
FEWEST_CELLS = 2


@dataclass(frozen=True)
class ContactGrid:
    """What spans the contact nodes: window length in mm, nodes in a whole window, and by its name how they see the flanks.

    `edge_cells`: lengths of the cells next to an edge, in parts of the spacing, from the edge on; together 1.
    """

    length: float
    nodes: int
    interpolation: str = AVERAGED
    edge_cells: tuple[float, ...] = EVEN

    @property
    def spacing(self) -> float:
        """Distance of neighbouring contact nodes, mm."""
        return self.length / (self.nodes - 1)

    @property
    def most_nodes(self) -> int:
        """Contact nodes of a pair at most: those of a whole window, and those next to two edges."""
        return self.nodes + 2 * (len(self.edge_cells) - 1)


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
        return flank_point(gear.base_radius, roll, contact_roll)[1]

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
    return float(max(below)), float(min(above))


def node_offsets(pair: GearPair, contact_rolls: tuple[float, float], grid: ContactGrid) -> np.ndarray:
    """Offsets `y` (n,), mm, increasing, of the contact nodes of a pair; empty when it cannot touch.

    `contact_rolls` (rad): of either gear on the line of action.
    """
    return offsets_between(*flank_limits(pair, contact_rolls), grid)


def offsets_between(lowest: float, highest: float, grid: ContactGrid) -> np.ndarray:
    """Offsets (n,), mm, increasing, of the contact nodes where the flanks exist between two offsets (mm)."""
    half = 0.5 * grid.length
    start, end = max(lowest, -half), min(highest, half)
    length = end - start
    if length <= 1e-9 * grid.length:
        return np.empty(0)
    cut_low, cut_high = lowest > -half, highest < half
    if cut_low and cut_high:
        even = np.linspace(start, end, max(1, round(length / grid.spacing)) + 1)
        return even if len(even) <= 2 * FEWEST_CELLS else -_graded(-_graded(even, grid)[::-1], grid)[::-1]
    # The tolerance keeps the node count of an uncut window whole in spite of round-off.
    cells = max(1, int(np.floor(length / grid.spacing * (1.0 + 1e-12))))
    steps = min(grid.spacing, length / cells if cells == 1 else grid.spacing) * np.arange(cells + 1)
    if cut_low:
        return _graded(start + steps, grid)
    return -_graded(steps - end, grid)[::-1] if cut_high else (end - steps)[::-1]


def _graded(offsets: np.ndarray, grid: ContactGrid) -> np.ndarray:
    """Offsets with the first cell, which begins at an edge, made finer towards it."""
    if len(offsets) <= FEWEST_CELLS:
        return offsets
    cell = offsets[1] - offsets[0]
    return np.concatenate([offsets[:1], offsets[0] + cell * np.cumsum(grid.edge_cells[:-1]), offsets[1:]])
