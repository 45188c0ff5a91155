"""Row 19: contact nodes too few, in the same place, or closer than the elements can tell apart."""

from dataclasses import replace

import numpy as np
import pytest
from tests.coarse import coarse_scene, frictionless, teeth_alone
from tests.contact.problems import pressed

from fenics_gears import model_of, simulate
from fenics_gears.contact.mesh import contact_operators
from fenics_gears.contact.operator import Passage
from fenics_gears.contact.pairing import CompliancePairing
from fenics_gears.contact.tooth_pair import drive_place, tooth_pairs
from fenics_gears.simulation.routes import prepared
from fenics_gears.system.progress import SilentProgress

ROTATION_2 = [5]


@pytest.fixture(scope="module")
def scene(paper_scene):
    return frictionless(teeth_alone(coarse_scene(paper_scene)))


@pytest.fixture(scope="module")
def model(scene):
    return model_of(scene)


@pytest.fixture(scope="module")
def flanks(model):
    return prepared(model, SilentProgress(), None)[1].mesh.responses.__self__.flanks


def operator_of(flanks, pairs):
    """The contact equations of some tooth pairs."""
    passage = Passage(pairs)
    responses = CompliancePairing(flanks).responses([passage])
    return contact_operators(flanks.pair, [passage], ROTATION_2, responses)[0]


def only(operator, node):
    kept = slice(node, node + 1)
    return replace(
        operator,
        pairs=(replace(operator.pairs[0], offsets=operator.pairs[0].offsets[kept]),),
        compliance=np.ascontiguousarray(operator.compliance[kept, kept]),
        jacobian=np.ascontiguousarray(operator.jacobian[kept]),
        gap=operator.gap[kept],
    )


def test_one_contact_node(model, flanks, measured):
    """Exact: it carries T/rb2, and the wheel gives way by its gap and C_11 T/rb2."""
    pair, force = flanks.pair, model.drivetrain.load[-1]
    place = drive_place(pair, 0, pair.pitch_point)
    operator = operator_of(flanks, tuple(tooth_pairs(flanks, model.resolution.contact_grid, [place])))
    errors = []
    for node in (0, operator.nodes // 2, operator.nodes - 1):
        alone = only(operator, node)
        solution = pressed(alone, force)
        approach = alone.gap[0] + alone.compliance[0, 0] * force
        errors += [abs(solution.forces[0] / force - 1.0), abs(solution.coordinates[0] / approach - 1.0)]
    measured("one contact node: force and approach", max(errors), 1e-14)


def test_coincident_contact_nodes_share_alike(model, flanks, measured):
    """Exact by symmetry: the same nodes twice carry half each; the lost rank is counted."""
    pair, force = flanks.pair, model.drivetrain.load[-1]
    (nodes,) = tooth_pairs(flanks, model.resolution.contact_grid, [drive_place(pair, 0, pair.pitch_point)])
    once, twice = (operator_of(flanks, pairs) for pairs in ((nodes,), (nodes, nodes)))
    first, second = pressed(once, force), pressed(twice, force)
    half = second.forces.reshape(2, -1)
    split = np.abs(half[0] - half[1]).max() / half.max()
    together = np.abs(half.sum(axis=0) - first.forces).max() / first.forces.max()
    approach = abs(second.coordinates[0] / first.coordinates[0] - 1.0)
    measured("coincident nodes: relative difference of their forces", split, 1e-10)
    measured(
        "coincident nodes: difference of force and of approach from single nodes",
        f"{together:.1g}, {approach:.1g}",
        "1e-3, 1e-4",
    )
    measured("coincident nodes: dependent equations counted", float(twice.dependent_rows), f"{once.nodes}")
    assert (once.dependent_rows, twice.dependent_rows) == (0, once.nodes)
    assert together <= 1e-3
    assert approach <= 1e-4


@pytest.mark.parametrize(
    ("element", "nodes"),
    [
        ("P1", 101),
        ("P2", 201),
        *(pytest.param(*each, marks=pytest.mark.nightly) for each in (("P1", 201), ("P2", 101))),
    ],
)
def test_nodes_closer_than_elements_are_reported(element, nodes, scene, model, measured):
    """Rank checked, never silent; the force is carried to round-off."""
    dense = replace(scene, accuracy=replace(scene.accuracy, element=element, contact_nodes=nodes))
    usual, result = simulate(replace(scene, accuracy=replace(scene.accuracy, element=element))), simulate(dense)
    force = scene.load.wheel_torque / result.attrs["base_radius_wheel"]
    carried = np.abs(result.normal_force.values / force - 1.0).max()
    change = np.abs(result.transmission_error.values / usual.transmission_error.values - 1.0).max()
    spacing = dense.accuracy.contact_length / (nodes - 1) / dense.accuracy.flank_element_size
    measured(f"{element}, node spacing {spacing:.3g} of an element: error of the total force, change of the "
        f"transmission error", f"{carried:.1g}, {change:.1g}",
             "1e-11, recorded; warnings on rank and spacing")  # fmt: skip
    assert carried <= 1e-11
    assert "contact compliance is singular" in result.attrs["warnings"]
    assert "the pressure oscillates" in result.attrs["warnings"]
    assert "contact compliance is singular" not in usual.attrs["warnings"]
