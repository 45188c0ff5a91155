"""Corner contact, against the exact outlines and identities."""

from dataclasses import replace

import numpy as np
import pytest
from tests.contact.outlines import centres, distance, placed, rotation_to_touch

from fenics_gears.contact.corner import corner_contact, corner_place
from fenics_gears.contact.mesh import contact_operators, elastic_mesh
from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.contact.operator import Passage
from fenics_gears.contact.tooth_pair import coast_place, drive_place, tooth_pairs
from fenics_gears.contact.window import ContactGrid

GRID = ContactGrid(length=2.5, nodes=26)
FINE = ContactGrid(length=0.002, nodes=201)
ALL = list(range(7))
STEPS = 25
RADII = [0.0, 0.1, 0.3]
# The gear whose tip is beyond the path, and where the pair then stands: before its start or after its end.
TIPS = [0, 1]


def beyond(pair, tip, by):
    """The place of a pair whose pinion's (0) or wheel's (1) tip is `by` mm beyond the path."""
    return drive_place(pair, 0, pair.path_end + by if tip == 0 else pair.path_start - by)


@pytest.mark.parametrize("radius", RADII)
@pytest.mark.parametrize("tip", TIPS)
@pytest.mark.parametrize("by", [0.1, 0.5, 1.0, 2.0])
def test_the_mate_turned_by_the_gap_touches_the_tip(by, tip, radius, stand_in_flanks, paper_pair):
    """Brute force: the mate's outline turned until it meets the tip's edge."""
    check_gap(stand_in_flanks, corner_contact(paper_pair, radius), beyond(paper_pair, tip, by), tip)


def check_gap(flanks, corner, place, tip):
    (nodes,) = corner.pairs(flanks, FINE, [place])
    mate, curves = 1 - tip, placed(flanks.pair, corner.edges, place)
    turn = rotation_to_touch(curves[mate], curves[tip], centres(flanks.pair)[mate])
    base = (flanks.pair.pinion, flanks.pair.wheel)[mate].base_radius
    assert nodes.gap.min() == pytest.approx(base * turn, rel=2e-4, abs=1e-7)


@pytest.mark.parametrize("by", [0.1, 0.5, 1.0])
def test_the_wheel_turned_by_the_gap_touches_the_edge_of_an_undercut_flank(by, stand_in_flanks, paper_pair):
    """Brute force: before the path of contact the edge at an undercut pinion's form circle meets the wheel."""
    pinion = replace(
        paper_pair.pinion, teeth=12, profile_shift=0.0, tip_radius=31.5, root_radius=21.375, bore_radius=10.0
    )
    pair = replace(paper_pair, pinion=pinion, centre_distance=82.0)
    assert pinion.undercut and pair.path_start > pair.tip_positions[0] + 1.0
    flanks, place = replace(stand_in_flanks, pair=pair), drive_place(pair, 0, pair.path_start - by)
    check_gap(flanks, corner_contact(pair), place, tip=0)


@pytest.mark.parametrize("radius", RADII)
@pytest.mark.parametrize("tip", TIPS)
def test_rigid_motions_change_the_gap_as_the_outlines_say(tip, radius, stand_in_flanks, paper_pair):
    """Brute force: differences of the least distance between both outlines."""
    corner, place = corner_contact(paper_pair, radius), beyond(paper_pair, tip, 0.9)
    cycle = Cycle(elastic_mesh(stand_in_flanks, GRID, corner), STEPS, ALL, tangential=False)
    pairs = tuple(corner.pairs(stand_in_flanks, GRID, [place]))
    passage = Passage(pairs)
    (operator,) = contact_operators(paper_pair, [passage], ALL, cycle.mesh.responses([passage]))
    row = operator.jacobian[0]
    radii, step, expected = (paper_pair.pinion.base_radius, paper_pair.wheel.base_radius), 1e-3, np.empty(6)
    for column in range(6):
        gear, axis = divmod(column, 3)
        gaps = []
        for sign in (1.0, -1.0):
            moved = np.zeros((2, 3))
            moved[gear, axis] = sign * step / (radii[gear] if axis == 2 else 1.0)
            gaps.append(distance(placed(paper_pair, corner.edges, place, 8001, moved)))
        expected[column] = -(gaps[0] - gaps[1]) / (2.0 * step)
    assert row[:6] == pytest.approx(expected, abs=2e-5)
    assert abs(row[1]) > 0.02  # off the line of action indeed


def test_on_the_path_of_contact_nothing_changes(stand_in_flanks, paper_pair):
    """Exact: with sharp tips, pairs on the path have the same equations without corner contact."""
    corner = corner_contact(paper_pair)
    for xi in np.linspace(paper_pair.path_start + 1e-9, paper_pair.path_end - 1e-9, 9):
        place = drive_place(paper_pair, 0, xi)
        (with_corner,) = corner.pairs(stand_in_flanks, GRID, [place])
        (plain,) = tooth_pairs(stand_in_flanks, GRID, [place])
        assert with_corner.place == plain.place
        for name in ("offsets", "lengths", "gap", "friction_arms", "rolls"):
            assert getattr(with_corner, name) == pytest.approx(getattr(plain, name), rel=1e-11, abs=1e-11)
        for ours, theirs in zip(with_corner.interpolation, plain.interpolation):
            assert ours.weights == pytest.approx(theirs.weights, abs=1e-11)


@pytest.mark.parametrize("radius", RADII)
@pytest.mark.parametrize("tip", TIPS)
def test_nothing_jumps_where_the_edge_leaves_the_path(tip, radius, stand_in_flanks, paper_pair):
    """Limit: gap, arms and direction are continuous where the edge's arc begins to carry."""
    corner, gears = corner_contact(paper_pair, radius), (paper_pair.pinion, paper_pair.wheel)
    roll, base = corner.edges[tip].flank_roll, gears[tip].base_radius
    xi = base * roll if tip == 0 else paper_pair.line_of_action_length - base * roll
    before, after = (
        corner.pairs(stand_in_flanks, GRID, [drive_place(paper_pair, 0, xi + sign * 1e-7)])[0] for sign in (-1.0, 1.0)
    )
    assert (before.place.line is None) != (after.place.line is None)
    assert len(before.offsets) == len(after.offsets)
    for name in ("offsets", "gap", "friction_arms"):
        assert getattr(before, name) == pytest.approx(getattr(after, name), abs=1e-5)
    assert np.array(before.place.axes) == pytest.approx(np.array(after.place.axes), abs=1e-6)
    for line in (before.place.line_in(paper_pair), after.place.line_in(paper_pair)):
        assert line.lever_arms == pytest.approx([gear.base_radius for gear in gears], abs=1e-5)


@pytest.fixture(scope="module")
def cycle(stand_in_flanks, paper_pair):
    return Cycle(elastic_mesh(stand_in_flanks, GRID, corner_contact(paper_pair, 0.1)), STEPS, ALL, tangential=True)


def corner_steps(cycle):
    return [step for step in range(STEPS) if any(pair.place.line for pair in cycle.position(step).operator.pairs)]


def test_action_equals_reaction_off_the_line_of_action(cycle, paper_pair):
    """Newton's third law: no force on both gears together, and no moment about any point."""
    radii = np.array([paper_pair.pinion.base_radius, paper_pair.wheel.base_radius])
    for step in corner_steps(cycle):
        operator = cycle.position(step).operator
        forces = np.random.default_rng(step).uniform(0.5, 1.5, 2 * operator.nodes)
        on_gears = -(operator.jacobian.T @ forces)[:6].reshape(2, 3) * np.stack([np.ones(2), np.ones(2), radii], axis=1)
        (fx, fy, couple), (gx, gy, other) = on_gears
        apart = centres(paper_pair)[1] - centres(paper_pair)[0]
        assert [fx + gx, fy + gy] == pytest.approx([0.0, 0.0], abs=1e-10 * np.abs(forces).sum())
        assert couple + other + apart[0] * gy - apart[1] * gx == pytest.approx(
            0.0, abs=1e-10 * np.abs(forces).sum() * radii.sum()
        )


def test_coast_flanks_are_seen_in_the_mirror(paper_pair):
    """Exact: with contact rolls alike, a coast pair's corner line has the drive pair's arms, mirrored."""
    corner, place = corner_contact(paper_pair, 0.1), beyond(paper_pair, 0, 0.7)
    coast = replace(coast_place(paper_pair, 0, 0.0), contact_rolls=place.contact_rolls)
    drive_corner, coast_corner = corner_place(paper_pair, corner, place), corner_place(paper_pair, corner, coast)
    assert drive_corner.line == coast_corner.line and drive_corner.contact_rolls == coast_corner.contact_rolls
    mirror = np.array(coast.axes)
    assert np.array(coast_corner.axes) == pytest.approx(np.array(drive_corner.axes) @ mirror, abs=1e-14)


@pytest.mark.parametrize("place", [drive_place, coast_place])
def test_tips_that_would_turn_a_gear_away_have_no_contact_nodes(place, stand_in_flanks, paper_pair):
    """Exact: far beyond the path the tip's line passes the other side of a centre, where involutes have no points; all
    nodes that remain are on involutes, between form and tip circle."""
    wide = ContactGrid(length=16.0, nodes=41)
    corner = corner_contact(paper_pair, 0.1)
    ends = paper_pair.path_start - 40.0, paper_pair.path_end + 40.0
    places = [place(paper_pair, 0, xi) for xi in np.linspace(*ends, 161)]
    pairs = corner.pairs(stand_in_flanks, wide, places)
    assert 20 < len(pairs) < len(places)
    for nodes in pairs:
        for gear, rolls in zip((paper_pair.pinion, paper_pair.wheel), nodes.rolls):
            assert (gear.form_roll_angle - 1e-9 <= rolls).all() and (rolls <= gear.tip_roll_angle + 0.05).all()
