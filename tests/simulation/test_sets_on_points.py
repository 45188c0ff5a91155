"""Planetary sets whose ring stands on points: against the body that is known tooth by tooth, in their limits, and what
is refused."""

from math import pi

import numpy as np
import pytest
from tests.planets import planetary_text

from fenics_gears import GearsError, simulate_train, train_from_text
from fenics_gears.contact.flank_forces import flank_rows
from fenics_gears.contact.row_in_plane import RowInPlane
from fenics_gears.contact.tooth_pair import node_slices
from fenics_gears.contact.whole_body_mesh import first_tooth
from fenics_gears.elasticity.cache import user_cache
from fenics_gears.model.train import train_model_of
from fenics_gears.results.sets_in_train import set_runs
from fenics_gears.simulation.together import can_be_solved_together
from fenics_gears.simulation.train import row_cycle
from fenics_gears.system.progress import SilentProgress

TEETH = (20, 16, 52)
PITCH = 360.0 / TEETH[2]
OUTER = 2.0 * TEETH[2] + 30.0
UNEVEN = 'angles = ["0 deg", "80 deg", "170 deg", "300 deg"]'


def on_points(points: str, radial: float = 2e5, tangential: float = 1e5, **options) -> str:
    stiffness = f'radial_stiffness = "{radial} N/mm", tangential_stiffness = "{tangential} N/mm"'
    return with_support(f"points = {{ {points}, {stiffness} }}", **options)


def with_support(support: str, cycles: int = 2, sections: str = "", **options) -> str:
    moving = f"{sections}\n[motion]\nmesh_cycles = {cycles}\n"
    text = planetary_text(**{"teeth": TEETH, "planets": "planets = 3", "sections": moving, **options})
    return text.replace('support = "held"', support)


def run(text: str):
    return simulate_train(train_from_text(text))


def test_at_each_step_the_ring_is_the_one_known_tooth_by_tooth():
    """Another route: the compliance between the contact nodes of all planets, from the blocks between any two teeth of
    the ring on points, which is that of finite elements of all of it at once (`test_ring_on_points`)."""
    (row,) = train_model_of(train_from_text(on_points(UNEVEN, planets='planet_angles = ["0 deg", "130 deg"]'))).rows
    cycle = row_cycle(row, SilentProgress(), user_cache())
    step = 7 * cycle.steps + 5
    position = cycle.position(step)
    with_ring = range(len(row.meshes))[row.shafts.carrier.meshes(1)]
    flanks = []
    for mesh in with_ring:
        own, first = position.of_meshes[mesh]
        of_mesh = cycle.meshes[mesh].cycle
        body = of_mesh.bodies[1]
        side = of_mesh.pair.sides[1]
        turned = body.first + first_tooth(side, 7)
        for nodes, pair in zip(node_slices(own.operator.pairs), own.operator.pairs):
            place = slice(first + nodes.start, first + nodes.stop)
            flanks.append((turned + pair.place.teeth[1], flank_rows(side, pair, False).toarray(), place))
    even = cycle.meshes[with_ring[0]].cycle.bodies[1]
    whole = even.counted_from(-even.first).by_teeth(even.offsets)
    there = cycle._alike(step).operator.compliance
    largest = np.abs(there).max()
    for tooth, rows, place in flanks:
        for other, loads, by in flanks:
            ahead = (tooth - other + 26) % 52 - 26
            differ = rows.T @ (whole.between(tooth, other) - even.between(ahead, 0)) @ loads / 40.0
            change = (position.operator.compliance - there)[place, by]
            assert np.abs(change - differ).max() < 1e-11 * largest
    assert np.abs(position.operator.compliance - there).max() > 0.01 * largest
    assert isinstance(cycle._compliance, RowInPlane)


def test_as_many_points_as_teeth_are_a_foundation_and_a_stiff_ring_is_held():
    """Limits: on an elastic foundation of the same stiffness per length, and rigid, within what pads of a pitch make of
    it. All mesh cycles are then alike."""
    per_area = TEETH[2] / (2.0 * pi * OUTER * 40.0)
    foundation = (
        f'support = {{ kind = "foundation", radial_stiffness = "{2e5 * per_area} N/mm^3",'
        f' tangential_stiffness = "{1e5 * per_area} N/mm^3" }}'
    )
    for stiffness, support in ((2e5, foundation), (1e12, 'support = "held"')):
        points, even = (
            run(text).overall_transmission_error.values
            for text in (on_points("count = 52", stiffness, 0.5 * stiffness), with_support(support))
        )
        assert np.abs(points - even).max() < 1e-3 * even.max()
        assert np.abs(points[12:] - points[:-12]).max() < 1e-10 * even.max()


def test_equal_points_take_over_from_each_other_and_carry_the_torque_of_the_ring():
    """Symmetry: after one spacing of four points, 13 mesh cycles, all is as it was, each point in the place of the
    next. Equilibrium: their tangential forces hold the ring's torque, within what coarse flanks move its forces."""
    found = run(on_points("count = 4", cycles=14))
    error = found.overall_transmission_error.values
    assert np.abs(error[156:] - error[:13]).max() < 1e-12 * error.max()
    assert np.ptp(error[1:].reshape(14, 12).mean(axis=1)) > 1e-3 * error.max()
    forces = found.ring_support_tangential.values
    assert np.abs(np.roll(forces[156:], -1, axis=1) - forces[:13]).max() < 1e-10 * np.abs(forces).max()
    torque = found.member_torque.sel(member="ring").values
    assert np.abs(OUTER * forces.sum(axis=1) / torque + 1.0).max() < 3e-3


def test_points_stand_where_the_scene_has_them_and_turn_with_the_ring():
    """Geometry: radially stiff points push inwards where planets push outwards, on the side of the line of action; as
    the carrier sees it the ring turns clockwise, by a pitch in each mesh cycle."""
    directions = np.array([0.0, 70.0, 210.0])
    planets = f"planet_angles = {[f'{each} deg' for each in directions]}"
    found = run(on_points("count = 52", 2e6, 1e4, planets=planets, cycles=7))
    steps = (found.sizes["time"] - 1) // 7
    for cycle in (0, 6):
        inwards = -found.ring_support_radial.values[cycle * steps]
        places = np.arange(52) * PITCH - cycle * PITCH
        for direction in directions:
            beside = (places - direction + 180.0) % 360.0 - 180.0
            near = np.abs(beside) < 35.0
            assert -25.0 < beside[near][inwards[near].argmax()] < 0.0
            assert inwards[near].max() > 700.0


def test_runs_are_solved_one_by_one_and_the_page_says_on_how_many_points():
    """A study's shortcut knows rings alone whose mesh cycles are alike; `gears check` says what holds the ring."""
    from fenics_gears.model.planetary_rows import set_rows
    from fenics_gears.results.planetary import OF_SETS

    held, points = (
        train_model_of(train_from_text(text)) for text in (with_support('support = "held"'), on_points(UNEVEN))
    )
    assert can_be_solved_together(held, OF_SETS) and not can_be_solved_together(points, OF_SETS)
    assert ("ring", "on 4 points of its outer circle", "") in set_rows(points.rows[0])


@pytest.mark.parametrize(
    "points, options, words",
    [
        ("radial = 3", {}, r"stages\.set\.ring\.points.*\n.*not a known field"),
        ("count = 1", {}, "from 2 to 200"),
        ('angles = ["10 deg", "-350 deg"]', {}, r"stages\.set\.ring\.points\.angles.*\n.*has a point twice"),
        ("count = 4", {"sections": "[friction]\ncoefficient = 0.1"}, r"not computed with \[friction\] yet"),
        ("count = 4", {"sections": "[inertia]"}, r"not computed with \[inertia\] yet"),
        ("count = 4", {"more": 'floating = ["ring"]'}, "cannot be floating too"),
        ("count = 4", {"more": 'helix_angle = "10 deg"'}, "over the face"),
        ("count = 4", {"more": 'ring_mesh = { misalignment = { in_plane = "1 um" } }'}, r"\[misalignment\]"),
    ],
)
def test_what_is_not_computed_is_refused_in_words(points, options, words):
    """A user's expectation: the message names the field and says what is allowed; nothing is computed."""
    with pytest.raises(GearsError, match=words):
        train_from_text(on_points(points, **options))


def test_another_support_beside_points_and_points_of_a_planet_are_refused():
    """A user's expectation, as of a pair."""
    twice = on_points("count = 4").replace("points = {", 'support = "held", points = {')
    with pytest.raises(GearsError, match=r"\[stages\.set\.ring\.points\], which says what holds"):
        train_from_text(twice)
    with pytest.raises(GearsError, match=r"stages\.set\.planet\.points"):
        train_from_text(planetary_text(teeth=TEETH).replace("planet = {", "planet = { points = { count = 3 },"))


def test_a_set_beside_another_has_its_points_as_alone():
    """A set in a train of two is the set alone, to the last digit; the other one, which is held, has no points."""
    alone = run(on_points("count = 4"))
    stages, rest = on_points("count = 4").split("[load]")
    held = with_support('support = "held"').split("[load]")[0]
    text = stages.replace("stages.set", "stages.one") + held.replace("stages.set", "stages.two") + "[load]" + rest
    one, two = set_runs(run(text))
    for name in ("ring_support_radial", "ring_support_tangential", "ring_deflection"):
        assert np.array_equal(one[name], alone[name]) and name not in two
    assert np.array_equal(one.ring_point, [1, 2, 3, 4])
