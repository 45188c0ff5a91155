"""Contact of trains: meshes feel each other through the body of the gear between them."""

from dataclasses import replace

import numpy as np
import pytest
from tests.planets import planetary
from tests.trains import row

from fenics_gears.dynamics.stepping import Stepper
from fenics_gears.elasticity.cache import Cache
from fenics_gears.model.train import train_model_of
from fenics_gears.simulation.train import row_cycle
from fenics_gears.system.progress import SilentProgress

FRICTION = "[friction]\ncoefficient = 0.1"


@pytest.fixture(scope="module")
def cycle_of(tmp_path_factory):
    cache = Cache(tmp_path_factory.mktemp("gears"))

    def made(scene):
        (model,) = train_model_of(scene).rows
        return model, row_cycle(model, SilentProgress(), cache)

    return made


def overall_errors(model, cycle, steps) -> np.ndarray:
    """Transmission error (rad of the last shaft) at rest at places between steps, each by itself."""
    stepper = Stepper(cycle, model.equations_of_motion)
    found = []
    for step in steps:
        position = cycle.between(step, step - 1)
        record = stepper.in_balance(step, position)
        found.append(float(model.drivetrain.angle @ record.state.position))
    return np.array(found)


def test_a_train_driven_from_its_other_end_has_the_same_transmission_error(cycle_of):
    """Without friction the same flanks press whichever end drives. Mirrored, the reversed train is a train; its last
    mesh is at phase contact ratio - phase of the first. Phases, numbers of teeth and the coupling through the idler
    have to be right for this."""
    steps = np.array([3.0, 5.75, 10.0, 14.5, 17.25])
    model, cycle = cycle_of(row([24, 31, 40], [0, 60], 300))
    mirrored, reversed_cycle = cycle_of(row([40, 31, 24], [120, 180], 180))
    phase = mirrored.layout.phases[1]
    ahead = model.models[0].pair.contact_ratio - steps / cycle.steps - phase
    driven = overall_errors(model, cycle, steps) * 40 / 24
    driving = overall_errors(mirrored, reversed_cycle, (ahead % 1.0) * cycle.steps)
    assert driving == pytest.approx(driven, rel=1e-10)


def test_compliance_of_a_train_is_symmetric_and_positive(cycle_of):
    """Betti between the flanks of any meshes; springs store energy under any forces."""
    _, cycle = cycle_of(row([24, 31, 40, 25], [0, 60, 20], 300, more=FRICTION))
    for step in (0, 7, 19):
        compliance = cycle.position(step).operator.compliance
        assert np.array_equal(compliance, compliance.T)
        assert np.linalg.eigvalsh(compliance).min() > 0.0


def test_meshes_couple_through_their_common_gear_alone(cycle_of):
    """Gears 1, 2, 3, 4 in a row: meshes 1 and 2 have gear 2 in common, meshes 1 and 3 none. Each mesh by itself has
    the compliance of its pair."""
    _, cycle = cycle_of(row([24, 31, 40, 25], [0, 60, 20], 300))
    compliance = cycle.position(4).operator.compliance
    ends = np.cumsum([0, *(mesh.cycle.position(4).operator.nodes for mesh in cycle.meshes)])
    one, two, three = (slice(*each) for each in zip(ends, ends[1:]))
    assert np.abs(compliance[one, two]).max() > 0.01 * compliance[one, one].max()
    assert not compliance[one, three].any()
    for own, mesh in zip((one, two, three), cycle.meshes):
        assert np.array_equal(compliance[own, own], mesh.cycle.position(4).operator.compliance)


def test_uncoupled_teeth_leave_meshes_alone(cycle_of):
    """Where teeth of a gear do not feel each other, those of two meshes do not either."""
    _, cycle = cycle_of(row([24, 31, 40], [0, 60], 300, accuracy="elastic_teeth = 1"))
    compliance = cycle.position(4).operator.compliance
    first = cycle.meshes[0].cycle.position(4).operator.nodes
    assert not compliance[:first, first:].any()


def test_operators_that_planets_share_are_those_of_each_by_itself(cycle_of, tmp_path):
    """Meshes of planets pass the very same places; contact of all of them is the same where each mesh is built as if it
    were like no other, at steps and between them, with friction and pins beside their places."""
    pins = 'carrier = { pin_stiffness = "3e5 N/mm", pin_errors = ["15 um", "0 um", "-5 um"] }'
    model, shared = cycle_of(planetary(teeth=(17, 19, 55), planets="planets = 3", more=pins, sections=FRICTION))
    alone = replace(model, meshes=tuple(replace(mesh, like=None) for mesh in model.meshes))
    one_by_one = row_cycle(alone, SilentProgress(), Cache(tmp_path))
    shared.build(range(shared.steps))
    for step, before in [(0, -1), (7, 6), (shared.steps - 1, shared.steps - 2), (3.25, 2), (5, 4.5)]:
        found, expected = (cycle.between(step, before).operator for cycle in (shared, one_by_one))
        for name in ("compliance", "previous_compliance", "jacobian", "previous_jacobian", "gap", "rigid_slip"):
            values, of_each = (getattr(operator, name) for operator in (found, expected))
            assert np.abs(values - of_each).max() < 1e-10 * np.abs(of_each).max(), name
        assert [pair.place.index for pair in found.pairs] == [pair.place.index for pair in expected.pairs]
