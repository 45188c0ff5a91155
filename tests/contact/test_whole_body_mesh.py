"""Mesh cycles of gears whose teeth are not alike."""

import numpy as np
import pytest
from tests.stand_in import stand_in_compliance

from fenics_gears.contact.mesh import elastic_mesh
from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.contact.tooth_pair import Flanks
from fenics_gears.contact.whole_body_mesh import first_tooth, whole_body_mesh
from fenics_gears.contact.window import ContactGrid
from fenics_gears.elasticity.compliance import FlankCompliance
from fenics_gears.elasticity.whole_body.compliance import WholeBodyCompliance

STEPS, GRID, ROTATIONS = 12, ContactGrid(3.0, 15), [2, 5]


def whole(
    ring: FlankCompliance,
    teeth: int,
    softer: dict[int, float] | None = None,
    other_nodes: dict[int, FlankCompliance] | None = None,
):
    """A body with teeth of a ring, some softer by a factor, some with a compliance and nodes of their own."""
    softer, other_nodes, blocks, rolls = softer or {}, other_nodes or {}, [], []
    for tooth in range(teeth):
        own = other_nodes.get(tooth, ring)
        rolls.append(own.roll_angle)
        row = [softer.get(tooth, 1.0) * own.block(0)]
        for ahead in range(1, ring.offsets + 1):
            there = other_nodes.get((tooth + ahead) % teeth, ring)
            row.append(ring.block(ahead) if there is own is ring else np.zeros((2 * there.nodes, 2 * own.nodes)))
        blocks.append(tuple(row))
    return WholeBodyCompliance(tuple(rolls), ring.element_order, tuple(blocks))


@pytest.fixture(scope="module")
def rings(paper_pair):
    return tuple(stand_in_compliance(gear) for gear in (paper_pair.pinion, paper_pair.wheel))


def cycle(paper_pair, bodies, tangential=True):
    flanks = Flanks(paper_pair, bodies)
    alike = all(body.alike for body in bodies)
    mesh = elastic_mesh(flanks, GRID) if alike else whole_body_mesh(flanks, GRID, STEPS)
    return Cycle(mesh, STEPS, ROTATIONS, tangential)


def meshes_of(found) -> int:
    return len(found.mesh.of_cycle.__self__.meshes)


def same(one, other) -> bool:
    names = ("compliance", "jacobian", "gap", "rigid_slip", "previous_compliance", "previous_jacobian")
    return np.array_equal(one.node_before, other.node_before) and all(
        np.array_equal(getattr(one.operator, name), getattr(other.operator, name)) for name in names
    )


@pytest.mark.parametrize("meshed", [(True, False), (False, True), (True, True)])
def test_equal_teeth_have_one_cycle_to_the_last_bit(paper_pair, rings, meshed):
    """Exact identity: the operators of the ring of sectors, and only one set of them."""
    bodies = tuple(whole(ring, teeth) if own else ring for ring, teeth, own in zip(rings, (16, 24), meshed))
    found, expected = cycle(paper_pair, bodies), cycle(paper_pair, rings)
    for step in [*range(-1, 2 * STEPS), 40 * STEPS + 3]:
        assert same(found.position(step), expected.position(step))
    assert same(found.between(STEPS + 0.5, STEPS - 0.25), expected.between(STEPS + 0.5, STEPS - 0.25))
    assert meshes_of(found) == 1 and found.traits.divisible and found.grid is GRID
    assert found.pair_number(STEPS, 0) == 1


@pytest.mark.parametrize("gear", [0, 1])
def test_a_softer_tooth_is_met_in_its_turn(paper_pair, rings, gear):
    """The pinion's teeth come clockwise, the wheel's counter-clockwise, tooth 0 first: the operator has the softer
    tooth in cycle `number` and a turn later, and in no other."""
    teeth, number, factor = (16, 24)[gear], 5, 2.0
    tooth = first_tooth(paper_pair.sides[gear], number) % teeth
    assert tooth == ((11, 5)[gear])
    bodies = list(rings)
    bodies[gear] = whole(rings[gear], teeth, {tooth: factor})
    found, healthy = (cycle(paper_pair, tuple(bodies), tangential=False), cycle(paper_pair, rings, tangential=False))
    phase = STEPS // 2
    for turned in range(-2, teeth + 8):
        operator, expected = (each.position(turned * STEPS + phase).operator for each in (found, healthy))
        for place, pair in enumerate(operator.pairs):
            nodes = operator.node_pair == place
            changed = not np.array_equal(
                operator.compliance[np.ix_(nodes, nodes)], expected.compliance[np.ix_(nodes, nodes)]
            )
            assert changed == ((turned - pair.place.index - number) % teeth == 0)
    # Its own cycles are those in which it can touch: at this grid pairs -1 to 2, and one more for the step before.
    assert 1 < meshes_of(found) <= 6


def test_friction_knows_the_teeth_of_the_step_before(paper_pair, rings):
    """Exact identity: the cycle of their own alone."""
    bodies = (whole(rings[0], 16, {11: 2.0, 12: 3.0}), rings[1])
    found = cycle(paper_pair, bodies)
    for number in (3, 4, 5, 6, 7):
        shifted = whole(rings[0], 16, {(11 + number) % 16: 2.0, (12 + number) % 16: 3.0})
        expected = cycle(paper_pair, (shifted, rings[1]))
        for step in (0, 1):
            assert same(found.position(number * STEPS + step), expected.position(step))
