"""The contact grid."""

import numpy as np
import pytest

from fenics_gears.contact.window import ContactGrid, contact_roll_angles, flank_ends
from fenics_gears.contact.window import node_offsets as offsets_at
from fenics_gears.geometry.involute import flank_point

GRID = ContactGrid(length=3.0, nodes=61)


def node_offsets(pair, xi, grid):
    return offsets_at(flank_ends(pair, contact_roll_angles(pair, xi)), grid)


@pytest.mark.parametrize("shift", [-0.9, -0.3, 0.0, 0.2, 0.4])
def test_a_node_sits_on_the_tip_that_cuts_the_window(paper_pair, shift):
    """Exact: at the start of contact the wheel's tip circle, at the end the pinion's, is at the last node."""
    wheel, pinion = paper_pair.wheel, paper_pair.pinion
    xi = paper_pair.path_start + shift
    last = node_offsets(paper_pair, xi, GRID)[-1]
    x, _ = flank_point(wheel.base_radius, wheel.tip_roll_angle, paper_pair.wheel_roll_angle(xi))
    assert np.hypot(x, wheel.base_radius + last) == pytest.approx(wheel.tip_radius, rel=1e-12)
    xi = paper_pair.path_end + shift
    first = node_offsets(paper_pair, xi, GRID)[0]
    x, _ = flank_point(pinion.base_radius, pinion.tip_roll_angle, paper_pair.pinion_roll_angle(xi))
    assert np.hypot(x, pinion.base_radius - first) == pytest.approx(pinion.tip_radius, rel=1e-12)


def test_tips_pass_the_line_of_action_at_the_ends_of_the_path(paper_pair):
    """Definition of the path of contact."""
    assert min(flank_ends(paper_pair, contact_roll_angles(paper_pair, paper_pair.path_start))[1]) == pytest.approx(
        0.0, abs=1e-12
    )
    assert max(flank_ends(paper_pair, contact_roll_angles(paper_pair, paper_pair.path_end))[0]) == pytest.approx(
        0.0, abs=1e-12
    )


def test_grid_moves_continuously_with_the_position(paper_pair):
    """A small move of the contact point moves the node at the edge by as much."""
    positions = paper_pair.path_start + np.linspace(-1.0, 1.5, 2001)
    edges = np.array([node_offsets(paper_pair, xi, GRID)[-1] for xi in positions])
    assert np.abs(np.diff(edges)).max() < 2.0 * (positions[1] - positions[0])


def test_any_window_has_two_nodes_at_least(paper_pair):
    """What averages need, in a window shorter than the nodes' distance too."""
    for nodes, length, inner in ((2, 20.0, None), (2, 20.0, 0.1), (3, 6.0, 0.2), (4, 6.0, 0.2), (13, 3.0, 0.1)):
        grid = ContactGrid(length, nodes, closer_at_edges=True, inner_length=inner)
        for xi in np.linspace(paper_pair.path_start, paper_pair.path_end, 23)[1:-1]:
            offsets = node_offsets(paper_pair, xi, grid)
            assert len(offsets) >= 2 and np.all(np.diff(offsets) > 0.0)
