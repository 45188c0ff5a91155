"""Nodes that meet pair by pair, and the last step's displacement between them."""

import numpy as np
import pytest

from fenics_gears.contact.kinematics import CENTRE_COORDINATES
from fenics_gears.contact.mesh import contact_operators
from fenics_gears.contact.node_to_node import NodeResponse, node_pairs, node_to_node_response, roll_interpolation
from fenics_gears.contact.operator import Passage
from fenics_gears.contact.tooth_pair import drive_place
from fenics_gears.contact.window import ContactGrid
from fenics_gears.geometry.involute import canonical_point
from fenics_gears.geometry.outline import rotation

GRID = ContactGrid(1.5, 16)
NO_REMOVAL = (None, None)


def pairs_at(pair, phase, grid=GRID, order=1):
    positions = [(k, pair.path_start + (phase + k) * pair.base_pitch) for k in (0, 1)]
    return tuple(
        node_pairs(pair, NO_REMOVAL, grid, order, drive_place(pair, k, xi)) for k, xi in positions if xi < pair.path_end
    )


@pytest.mark.parametrize("falling", [False, True])
def test_interpolation_is_exact_for_linear_fields(falling):
    """Exact identity: [A.2], [A.3] reproduce a linear field."""
    known = np.array([0.31, 0.35, 0.36, 0.44])
    known = known[::-1] if falling else known
    rolls = np.array([0.31, 0.33, 0.355, 0.36, 0.43, 0.44])
    weights, reached = roll_interpolation(rolls, known)
    assert reached.all()
    assert weights @ (2.0 - 3.0 * known) == pytest.approx(2.0 - 3.0 * rolls, abs=1e-14)
    assert weights[3, np.argmin(np.abs(known - 0.36))] == 1.0


@pytest.mark.parametrize("order", [1, 2])
def test_nodes_of_both_gears_lie_on_one_line_along_the_line_of_action(order, paper_pair):
    """Exact geometry: both nodes have the same offset, [9] is their distance; a middle node lies on the chord,
    within its sagitta (Taylor: h^2/(8 rho))."""
    pair, nodes = paper_pair, pairs_at(paper_pair, 0.2, order=order)[0]
    points, sagitta = [], 1e-9
    for gear, rolls, contact in (
        (pair.pinion, nodes.rolls[0], nodes.place.contact_rolls[0]),
        (pair.wheel, nodes.rolls[1], nodes.place.contact_rolls[1]),
    ):
        vertices = canonical_point(gear.base_radius, rolls[::order]) @ rotation(contact).T
        placed = np.empty((len(rolls), 2))
        placed[::order] = vertices
        if order == 2:
            placed[1::2] = 0.5 * (vertices[1:] + vertices[:-1])
            lengths = np.linalg.norm(np.diff(vertices, axis=0), axis=1)
            sagitta += 1.1 * (lengths**2 / (8.0 * gear.base_radius * np.minimum(rolls[2::2], rolls[:-2:2]))).max()
        points.append(placed)
    pinion = points[0] + [0.0, pair.pinion.base_radius]
    wheel = [pair.line_of_action_length, 0.0] - (points[1] + [0.0, pair.wheel.base_radius])
    assert pinion[:, 1] == pytest.approx(nodes.offsets, abs=1e-9)
    assert wheel[:, 1] == pytest.approx(nodes.offsets, abs=1e-9)
    assert (wheel - pinion)[:, 0] == pytest.approx(nodes.gap, abs=sagitta)
    assert pinion[:, 0] == pytest.approx(nodes.friction_arms[0], abs=1e-9)


@pytest.mark.parametrize("order", [1, 2])
def test_forces_of_an_even_pressure(order, paper_pair):
    """Exact identity: the nodes' lengths integrate polynomials of the element's order + 1."""
    nodes = pairs_at(paper_pair, 0.5, order=order)[0]
    ends = nodes.offsets[[0, -1]]
    for power in range(order + 1 if order == 1 else 4):
        expected = (ends[1] ** (power + 1) - ends[0] ** (power + 1)) / (power + 1)
        assert nodes.lengths @ nodes.offsets**power == pytest.approx(expected, rel=1e-12, abs=1e-12)


def last_displacement(pair, spacing_cells, steps=40):
    """The operator of a step, and rigid rows and offsets of the step before, on rigid teeth."""
    grid = ContactGrid(1.5, spacing_cells + 1)
    now, before = (pairs_at(pair, phase, grid) for phase in (0.5, 0.5 - 1.0 / steps))
    nodes = [sum(len(p.offsets) for p in pairs) for pairs in (now, before)]
    soft = [tuple(np.zeros((2 * n, 2 * n)) for _ in range(2)) for n in nodes]
    was = NodeResponse(before, soft[1])
    response = node_to_node_response(pair, NodeResponse(now, soft[0]), was, 1.0 / steps)
    passage = Passage(now, before, advance=1.0 / steps)
    (operator,) = contact_operators(pair, [passage], list(range(len(CENTRE_COORDINATES))), [response])
    return operator, now, before


def test_last_rigid_displacement_of_the_same_material_points(paper_pair):
    """Exact kinematics [A.4]: a rotation moves a point at x by phi x along e_y; [A.2] is within (spacing of roll
    angles)^2/8 of the second derivative of x/rb, v cos(v_c - v) - sin(v_c - v)."""
    for cells in (12, 24):
        operator, now, before = last_displacement(paper_pair, cells)
        turned = paper_pair.pinion.angular_pitch / 40
        place = (
            canonical_point(paper_pair.pinion.base_radius, now[0].rolls[0])
            @ rotation(now[0].place.contact_rolls[0] - turned).T
        )
        exact = place[:, 0] / paper_pair.pinion.base_radius
        bound = np.abs(np.diff(before[0].rolls[0])).max() ** 2 / 8.0 * (now[0].rolls[0].max() + 0.05)
        assert 0.1 * bound < np.abs(operator.previous_jacobian[:, 2] - exact).max() < bound
        translation = operator.previous_jacobian[:, [1, 4]]
        assert translation == pytest.approx(np.tile([1.0, -1.0], (len(exact), 1)), abs=1e-13)
        assert np.all(operator.previous_jacobian[:, [0, 3, 6]] == 0.0)
