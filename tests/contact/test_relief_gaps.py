"""Reliefs on the contact operators of another mesh cycle."""

from dataclasses import replace

import numpy as np
import pytest
from tests.stand_in import stand_in_body, stand_in_compliance

from fenics_gears.contact.face import Face, even_slices
from fenics_gears.contact.face_mesh import face_mesh
from fenics_gears.contact.interpolation import AVERAGED, COLLOCATED
from fenics_gears.contact.mesh import elastic_mesh
from fenics_gears.contact.mesh_cycle import Cycle, Gaps
from fenics_gears.contact.relief_gaps import profile_of
from fenics_gears.contact.tooth_pair import Flanks
from fenics_gears.contact.window import ContactGrid
from fenics_gears.geometry.pair import Helix


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
