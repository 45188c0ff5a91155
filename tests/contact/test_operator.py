"""Contact operators, against dense products and the step before."""

from dataclasses import replace

import numpy as np
import pytest

from fenics_gears.contact.compliance_product import directions
from fenics_gears.contact.corner import corner_contact
from fenics_gears.contact.mesh import elastic_mesh
from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.contact.places import pair_places, touching
from fenics_gears.contact.tooth_pair import over_nodes
from fenics_gears.contact.window import ContactGrid

GRID = ContactGrid(length=2.5, nodes=26)
STEPS = 12
ALL = list(range(7))


@pytest.fixture(scope="module")
def cycle(stand_in_flanks):
    return Cycle(elastic_mesh(stand_in_flanks, GRID), STEPS, ALL, tangential=True)


def test_compliance_equals_the_dense_product(cycle):
    """Brute force: the sum over both gears of N R A R^T N^T."""
    operator = cycle.position(1).operator
    n = operator.nodes
    expected = np.zeros((2 * n, 2 * n))
    for gear, compliance in enumerate(cycle.bodies):
        rows = []
        for pair in operator.pairs:
            axes = directions(pair.place.contact_rolls[gear], True)
            weights = pair.interpolation[gear].weights
            rows.append([np.kron(weights, axis) for axis in axes])
        for a, pair_a in enumerate(operator.pairs):
            for b, pair_b in enumerate(operator.pairs):
                ahead = (pair_a.place.index - pair_b.place.index) * (1 if gear == 0 else -1)
                block = compliance.block(ahead) / cycle.pair.face_width
                for d in range(2):
                    for e in range(2):
                        first = d * n + np.searchsorted(operator.node_pair, a)
                        second = e * n + np.searchsorted(operator.node_pair, b)
                        part = rows[a][d] @ block @ rows[b][e].T
                        expected[first : first + len(part), second : second + part.shape[1]] += part
    assert len(operator.pairs) >= 2
    assert operator.compliance == pytest.approx(expected, rel=1e-11, abs=1e-11 * np.abs(expected).max())


def test_earlier_rigid_motion_is_that_of_the_same_material_points(cycle, paper_pair):
    """Exact: turned back by a step, a rotation moves the points by omega x r at their earlier place."""
    operator = cycle.position(5).operator
    advance = paper_pair.pinion.angular_pitch / STEPS
    for pair, arm, radius, sign, column, turn in (
        (paper_pair.pinion, 0, paper_pair.pinion.base_radius, -1.0, 2, advance),
        (paper_pair.wheel, 1, paper_pair.wheel.base_radius, 1.0, 5, -advance * paper_pair.rotation_ratio),
    ):
        offsets = np.concatenate([p.offsets for p in operator.pairs])
        now = over_nodes(operator.pairs, "friction_arms")[arm] - 1j * (radius + sign * offsets)
        earlier = now * np.exp(-1j * turn)
        assert operator.previous_jacobian[:, column] * radius == pytest.approx(earlier.real, rel=1e-12)


def test_without_motion_between_steps_the_earlier_displacement_is_the_present_one(stand_in_flanks):
    """Limit: E tends to the tangential rows of C and previous_jacobian to those of G, to first order."""
    differences = []
    for steps in (2000, 4000):
        fine = Cycle(elastic_mesh(stand_in_flanks, GRID), steps, ALL, tangential=True)
        operator = fine.position(3 * steps // 5).operator
        n = operator.nodes
        before = fine.position(3 * steps // 5 - 1).operator
        assert before.nodes == n
        differences.append(
            (
                np.abs(operator.previous_compliance - operator.compliance[n:]).max()
                / np.abs(operator.compliance).max(),
                np.abs(operator.previous_jacobian - operator.jacobian[n:]).max(),
            )
        )
    coarse, fine = np.array(differences)
    assert np.all(fine < 0.01)
    assert coarse / fine == pytest.approx([2.0, 2.0], rel=0.1)


def test_rigid_slip_over_a_step_is_exact(cycle, paper_pair):
    """Exact: the integral of the sliding speed, by 40 Gauss points."""
    advance = paper_pair.pinion.angular_pitch / STEPS
    back, weights = np.polynomial.legendre.leggauss(40)
    back, weights = 0.5 * advance * (back + 1.0), 0.5 * advance * weights
    for step in range(0, STEPS, 3):
        operator = cycle.position(step).operator
        arm_1, arm_2 = over_nodes(operator.pairs, "friction_arms")
        offset = over_nodes(operator.pairs, "offsets")
        height_1, height_2 = paper_pair.base_radii[0] - offset, paper_pair.base_radii[1] + offset
        slip, ratio = 0.0, paper_pair.rotation_ratio
        for angle, weight in zip(back, weights):
            # Speed across the line of action is the distance along it from the centre, a rotation earlier.
            slip = slip + weight * (arm_1 * np.cos(angle) - height_1 * np.sin(angle))
            slip = slip - weight * ratio * (arm_2 * np.cos(ratio * angle) + height_2 * np.sin(ratio * angle))
        assert operator.rigid_slip == pytest.approx(slip, abs=1e-13)


@pytest.mark.parametrize("coast", [False, True])
@pytest.mark.parametrize("corner", [False, True])
def test_reach_holds_between_steps_too(paper_pair, coast, corner):
    """Brute force: flanks that touch at any of 16 parts of a step, and up to a step before."""
    corner, steps, parts, found = corner_contact(paper_pair) if corner else None, 20, 16, {}
    places = {
        i: pair_places(paper_pair, GRID, i / (steps * parts) % 1.0, coast, corner) for i in range(-parts, steps * parts)
    }
    for i in range(steps * parts):
        for j in range(i - i % parts - (parts if i % parts == 0 else 0), i + 1):
            passed = 1 if j < 0 else 0
            for one in places[i]:
                for other in (*places[i], *(replace(place, index=place.index + passed) for place in places[j])):
                    for gear in range(2):
                        found.setdefault((one.flank, other.flank), set()).add(one.teeth[gear] - other.teeth[gear])
    ways = touching(paper_pair, GRID, steps, coast, corner)
    reach = ways.reach
    at_steps = [[place.index for place in places[i]] for i in range(0, steps * parts, parts)]
    assert ways.slots == max(max(indices) - min(indices) + 1 for indices in at_steps)
    assert ways.latest == max(map(max, at_steps))
    assert reach.same == max(max(found[sides]) for sides in found if sides[0] == sides[1])
    across = found.get((0, 1), set()) | {-ahead for ahead in found.get((1, 0), set())}
    assert reach.across == ((min(across), max(across)) if coast else None)


@pytest.mark.parametrize("tangential", [False, True])
@pytest.mark.parametrize("corner", [False, True])
def test_positions_built_together_are_those_built_one_by_one(paper_pair, stand_in_flanks, corner, tangential):
    """Exact identity, over the end of a mesh cycle and where none is kept: runs must not depend on what was built with
    what."""
    mesh = elastic_mesh(stand_in_flanks, GRID, corner_contact(paper_pair) if corner else None)
    one_by_one, together = (Cycle(mesh, STEPS, ALL, tangential) for _ in range(2))
    together.kept.most = 0.0
    together.build(range(-2, STEPS + 3))
    names = ["compliance", "jacobian", "gap", "on_drive_flanks", "node_pair"]
    if tangential:
        names += ["rigid_slip", "previous_compliance", "previous_jacobian"]
    for step in range(-2, STEPS - 2):
        ours, expected = together.position(step), one_by_one.position(step)
        assert np.array_equal(ours.node_before, expected.node_before)
        for name in names:
            assert np.array_equal(getattr(ours.operator, name), getattr(expected.operator, name)), (step, name)
        assert together.position(step).operator is ours.operator
