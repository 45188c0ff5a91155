"""Coast flanks of helical gears, against the helicoids; as mirrored drive flanks: simulation/test_mirrored_pairs.py."""

import numpy as np
import pytest
from tests.helical import helical_scene, on_stand_in_bodies

from fenics_gears.contact.face_mesh import face_mesh, opening_over_face
from fenics_gears.contact.kinematics import displacement_jacobian
from fenics_gears.contact.mesh_cycle import Cycle, Gaps
from fenics_gears.contact.tooth_pair import COAST, Flanks
from fenics_gears.contact.window import ContactGrid
from fenics_gears.model.model import model_of

BOTH = "[coast_flanks]\n"


def coasting(hand="right", more=""):
    model = model_of(helical_scene(BOTH + more, hand=hand, offset=2.0))
    bodies, own = on_stand_in_bodies(model), model.drivetrain.indices
    flanks, solids = Flanks(model.pair, tuple(body.section for body in bodies)), tuple(body.solid for body in bodies)
    cycle = Cycle(face_mesh(flanks, solids, model.face, ContactGrid(2.0, 13)), 16, own, False)
    opening = opening_over_face(cycle, model.face_opening, model.coast_face_opening)
    return model, cycle.with_gaps(Gaps(openings=(opening,)))


def coast_helicoid(pair, angle, height, position):
    """A point (3,) of the pinion's coast flank: a string unwound from the base circle, its direction turned by
    `angle`, `position` long at height 0."""
    radius, double = pair.pinion.base_radius, 2.0 * pair.operating_pressure_angle
    turned = angle + double
    # Turned by twice the pressure angle the drive flanks' line is the coast flanks' one, and is walked backwards.
    across, along = np.array([-np.sin(turned), np.cos(turned)]), -np.array([np.cos(turned), np.sin(turned)])
    section = -radius * across * np.array([1.0, 1.0])
    return np.array([*section, height]) + np.array([*((position + radius * angle - pair.slope * height) * along), 0.0])


@pytest.mark.parametrize("hand", ["right", "left"])
def test_normals_are_the_helicoids(hand):
    """Brute force: position and normal from the flank's surface by differences, and the kinematics of rigid bodies."""
    model, cycle = coasting(hand)
    pair, step = model.pair, 1e-5
    operator = cycle.position(5).operator
    rows = displacement_jacobian(operator.lines, False)
    centre, node, seen = (
        np.array([pair.line_of_action_length, -pair.pinion.base_radius - pair.wheel.base_radius, 0.0]),
        0,
        0,
    )
    for nodes in operator.pairs:
        for arm in nodes.friction_arms[0]:
            # A few suffice.
            if nodes.place.flank == COAST and node % 5 == 0:
                height = nodes.place.height
                places = [(step, height), (-step, height), (0.0, height + step), (0.0, height - step)]
                points = [coast_helicoid(pair, angle, z, arm + pair.slope * height) for angle, z in places]
                touched = coast_helicoid(pair, 0.0, height, arm + pair.slope * height)
                normal = np.cross(points[0] - points[1], points[2] - points[3])
                normal /= np.linalg.norm(normal)
                normal *= np.sign(normal @ rotated(np.array([-1.0, 0.0, 0.0]), 2.0 * pair.operating_pressure_angle))
                expected = []
                for sense, middle, radius in zip((1.0, -1.0), (0.0, 1.0), pair.base_radii):
                    arms = touched - middle * centre - np.array([0.0, 0.0, operator.face.middles[int(middle)]])
                    moment = np.cross(arms, normal)
                    expected.append(
                        sense
                        * np.array([*normal[:2], moment[2] / radius, normal[2], moment[0] / radius, moment[1] / radius])
                    )
                of_pinion, of_wheel = rows[node, [0, 1, 2, 7, 8, 9]], rows[node, [3, 4, 5, 10, 11, 12]]
                assert of_pinion == pytest.approx(expected[0], abs=1e-7) and of_wheel == pytest.approx(
                    expected[1], abs=1e-7
                )
                seen += 1
            node += 1
    assert seen > 10


def rotated(vector, angle):
    return np.array(
        [
            vector[0] * np.cos(angle) - vector[1] * np.sin(angle),
            vector[0] * np.sin(angle) + vector[1] * np.cos(angle),
            vector[2],
        ]
    )
