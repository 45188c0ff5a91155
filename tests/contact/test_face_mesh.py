"""Mesh cycles over a face, and reliefs on the operators of another one."""

from dataclasses import replace

import numpy as np
import pytest
from tests.stand_in import stand_in_body, stand_in_compliance

from fenics_gears.contact.face import Face, even_slices
from fenics_gears.contact.face_mesh import face_mesh, opening_over_face
from fenics_gears.contact.interpolation import AVERAGED, COLLOCATED
from fenics_gears.contact.mesh import elastic_mesh
from fenics_gears.contact.mesh_cycle import Cycle, Gaps
from fenics_gears.contact.relief_gaps import profile_of
from fenics_gears.contact.tooth_pair import Flanks
from fenics_gears.contact.window import ContactGrid
from fenics_gears.dynamics.march import Marcher
from fenics_gears.geometry.gear_data import Helix
from fenics_gears.model.model import model_of

STEPS, WIDTH = 24, 15.0
GRID = ContactGrid(3.0, 45, closer_at_edges=True)


@pytest.fixture(scope="module", params=[False, True], ids=["frictionless", "friction"])
def model(request, paper_scene):
    alone = replace(paper_scene, inertia=None, damping=None, shafts=None, bearings=None)
    return model_of(alone if request.param else replace(alone, friction=None))


def face_of(slices, slope=0.0):
    return Face(*even_slices(WIDTH, slices), slope)


def no_opening(heights, positions):
    return np.zeros(len(heights))


def face_cycle(model, face, opening=no_opening, grid=GRID, steps=STEPS):
    gears = (model.pair.pinion, model.pair.wheel)
    flanks = Flanks(model.pair, tuple(map(stand_in_compliance, gears)))
    bodies = tuple(stand_in_body(gear, WIDTH) for gear in gears)
    mesh = face_mesh(flanks, bodies, face, grid)
    cycle = Cycle(mesh, steps, model.drivetrain.indices, model.scene.friction is not None)
    return cycle.with_gaps(Gaps(openings=(opening_over_face(cycle, opening),)))


def plane_cycle(model, grid=GRID):
    flanks = Flanks(model.pair, tuple(stand_in_compliance(gear) for gear in (model.pair.pinion, model.pair.wheel)))
    return Cycle(elastic_mesh(flanks, grid), STEPS, model.drivetrain.indices, model.scene.friction is not None)


def marched(model, cycle, steps=STEPS):
    return Marcher(cycle, model.equations_of_motion).run(steps, steps + 1).records


def errors(records):
    return np.array([record.state.position[0] for record in records])


def test_a_shorter_window_where_no_edge_is_near_changes_nothing(model):
    """Exact: flanks do not touch outside it."""
    face = face_of(5, slope=0.2)
    whole, inner = (
        marched(model, face_cycle(model, face, grid=grid)) for grid in (GRID, replace(GRID, inner_length=1.6))
    )
    assert inner[3].position.operator.nodes < 0.7 * whole[3].position.operator.nodes
    np.testing.assert_allclose(errors(inner), errors(whole), rtol=1e-11)


def by_slice(record, slices):
    operator = record.position.operator
    found = np.zeros(slices)
    for nodes, pair in enumerate(operator.pairs):
        found[pair.place.slice] += record.solution.forces[: operator.nodes][operator.node_pair == nodes].sum()
    return found


def test_any_start_and_a_whole_cycle_ahead(model):
    """Identity: ends that are whole mesh cycles apart have the same pairs, under other numbers."""
    positions = np.array([-7.25, 7.25])
    cycle = face_cycle(model, Face(positions, np.array([0.5, 0.5]), model.pair.base_pitch / np.ptp(positions)))
    by_slice = [[pair for pair in cycle.pairs_at(5) if pair.place.slice == number] for number in (0, 1)]
    assert [pair.place.index + 1 for pair in by_slice[1]] == [pair.place.index for pair in by_slice[0]]
    for one, other in zip(*by_slice):
        np.testing.assert_allclose(one.gap, other.gap, atol=1e-12)


def test_slices_refined(model):
    """Known order: the mean over slices is the midpoint rule."""
    if model.scene.friction is not None:
        pytest.skip("without friction")

    def mean(slices):
        # Steps of a fraction of the mesh cycle at which the slices' phases do not repeat.
        return errors(marched(model, face_cycle(model, face_of(slices, 0.3), grid=ContactGrid(3.0, 31)), 8)).mean()

    finest = mean(24)
    coarse, fine = abs(mean(3) - finest), abs(mean(6) - finest)
    assert fine < 0.4 * coarse


@pytest.mark.parametrize("coast", [False, True])
@pytest.mark.parametrize("interpolation", [AVERAGED, COLLOCATED])
def test_positions_are_those_of_a_mesh_cycle_of_the_same_flanks(paper_pair, coast, interpolation):
    """Exact identity, also where operators are made again for want of memory."""
    bodies = tuple(stand_in_compliance(gear, coast_flank=coast) for gear in (paper_pair.pinion, paper_pair.wheel))
    flanks, grid = Flanks(paper_pair, bodies, (lambda roll: 0.03 * roll**2, None)), ContactGrid(1.5, 20, interpolation)
    other = replace(flanks, removal=(lambda roll: 0.01 * roll, lambda roll: 0.02 * np.cos(roll)))
    alone, cycle = (Cycle(elastic_mesh(each, grid), 8, [2, 5], tangential=True) for each in (flanks, other))
    cycle.kept.most = 2.5 * cycle.position(0).bytes / 0.7
    modified = cycle.with_gaps(Gaps(profile_of(cycle, flanks.removal)[0]))
    pairs = [(modified.position(step), alone.position(step)) for step in (*range(10), *range(8))] + [
        (modified.between(place, 2.0), alone.between(place, 2.0)) for place in (2.5, 2.3)
    ]
    for ours, expected in pairs:
        for name in ("gap", "compliance", "jacobian", "rigid_slip", "previous_compliance", "node_pair"):
            assert np.array_equal(getattr(ours.operator, name), getattr(expected.operator, name)), name
        assert np.array_equal(ours.node_before, expected.node_before)
    assert not np.array_equal(modified.position(3).operator.gap, cycle.position(3).operator.gap)
    kept = [cycle.position(step) is cycle.position(step) for step in range(8)]
    assert 0 < sum(kept) < 8


def test_over_a_face_as_flanks_from_which_it_is_taken(paper_pair, stand_in_flanks):
    """Exact identity: gaps of flanks that are relieved themselves."""
    pair = replace(paper_pair, helix=Helix(np.deg2rad(20.0), "left"))
    face = Face(*even_slices(pair.face_width, 4), pair.slope, pair.gear_middles)
    bodies = tuple(stand_in_body(gear, width) for gear, width in zip((pair.pinion, pair.wheel), pair.face_widths))
    grid, removal = ContactGrid(2.0, 8), (lambda roll: 0.03 * roll**2, lambda roll: 0.02 * np.cos(roll))
    plain, alone = (
        Cycle(face_mesh(replace(stand_in_flanks, pair=pair, removal=each), bodies, face, grid), 10, [5], False)
        for each in ((None, None), removal)
    )
    modified = plain.with_gaps(Gaps(profile_of(plain, removal)[0]))
    for ours, expected in [
        (modified.position(3), alone.position(3)),
        (modified.between(2.5, 2), alone.between(2.5, 2)),
    ]:
        assert np.array_equal(ours.operator.gap, expected.operator.gap)
        assert not np.array_equal(ours.operator.gap, plain.position(3).operator.gap)
