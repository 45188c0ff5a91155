"""Contact of gears in a row over the face: meshes feel each other through the body of the gear between them."""

import numpy as np
import pytest
from tests.contact.test_row import COAST, felt_by_the_first, mirrored_steps, overall_errors, positions_at_rest
from tests.trains import gear_text, helical_row, mate

from fenics_gears import ComputationError, train_from_text
from fenics_gears.contact.gear_over_face import GearOverFace, MeshOfGear
from fenics_gears.contact.mixed_form import SMALL_SYSTEM
from fenics_gears.contact.row_in_plane import GearInPlane
from fenics_gears.dynamics.stepping import Stepper
from fenics_gears.elasticity.cache import Cache
from fenics_gears.elasticity.face_compliance_data import BetweenMates
from fenics_gears.geometry.gear_train import SharedGear
from fenics_gears.model.train import train_model_of
from fenics_gears.model.train_cost import WITH_FACTORS, row_cost
from fenics_gears.simulation.train import row_cycle
from fenics_gears.system.progress import SilentProgress

FRICTION = "[stages.row.friction]\ncoefficient = 0.1\n"
LEVEL = '[stages.row.misalignment]\nin_plane = "0 um"\n'
STEPS = np.array([1.0, 3.5, 9.25])


@pytest.fixture(scope="module")
def cache(tmp_path_factory):
    return Cache(tmp_path_factory.mktemp("gears"))


@pytest.fixture(scope="module")
def cycle_of(cache):
    def made(scene):
        (model,) = train_model_of(scene).rows
        return model, row_cycle(model, SilentProgress(), cache)

    return made


def one_end_relieved(gear: str) -> str:
    """Of one gear of each mesh, at the right end alone."""
    return f'[stages.row.lead_modifications.{gear}]\ncrowning = "4 um"\nhelix_slope = "12 um"\n'


WEB = 'web = { width = "4 mm", hub_diameter = "45 mm", rim_inner_diameter = "72 mm", axial_offset = "3 mm" }'


@pytest.mark.parametrize("hand, web", [("left", ""), pytest.param("right", WEB, marks=pytest.mark.nightly)])
def test_a_train_driven_from_its_other_end_has_the_same_transmission_error(cycle_of, hand, web):
    """As in the plane. The mirrored train has gears of the other hand and the same right end, where flanks stand back
    and beside which the idler's web stands: hands, the order of slices, and drive and coast flanks of the idler have to
    be right for this. Both trains leave out other motions of the idler, of 1e-6 of the largest."""
    other = {"left": "right", "right": "left"}[hand]

    def train(teeth, directions, torque, hand, relieved):
        text = helical_row(teeth, directions, torque, hand=hand, more=one_end_relieved(relieved)).text
        return cycle_of(train_from_text(text.replace("teeth = 31,", f"teeth = 31, {web}," if web else "teeth = 31,")))

    model, cycle = train([24, 31, 40], [0, 60], 300, hand, "pinion")
    mirrored, reversed_cycle = train([40, 31, 24], [120, 180], 180, other, "wheel")
    phase = mirrored.layout.phases[1]
    ahead = model.models[0].pair.contact_ratio - STEPS / cycle.steps - phase
    driven = overall_errors(model, cycle, STEPS) * 40 / 24
    driving = overall_errors(mirrored, reversed_cycle, (ahead % 1.0) * cycle.steps)
    assert driving == pytest.approx(driven, rel=2e-7)


def test_a_train_on_its_coast_flanks_is_itself_turned_over(cycle_of):
    """Exact symmetry: driven from its load and turned over about its line of centres a helical train is the train
    driven forwards, with teeth of the same hand. Both leave out the same motions of the idler."""
    coast = COAST.format("row")
    coasting, turned = (cycle_of(helical_row([24, 31, 40], [0, sense * 60], 300, more=coast)) for sense in (1.0, -1.0))
    driven = overall_errors(*turned, mirrored_steps(*turned, STEPS))
    found = positions_at_rest(*coasting, STEPS, -1.0) @ coasting[0].drivetrain.angle
    assert found == pytest.approx(-driven, rel=1e-10)


def test_coast_flanks_of_one_mesh_alone(cycle_of):
    """As in the plane, but for the joint motions that flanks feel of each other, known to 1e-8 of the largest."""
    stages = [mate(*each, module=3.0, more='helix_angle = "15 deg"') for each in (
        ("a", gear_text(24, 3.0), gear_text(31, 3.0), 0.0), ("b", '"a.wheel"', gear_text(40, 3.0), 60.0),
    )]  # fmt: skip
    coarse = 'slices = 4\nlayers = 2\nbody_element_size = "4 mm"\nsteps_per_mesh_cycle = 12\n'
    load = f'[load]\noutput_torque = "300 N m"\n[accuracy]\n{coarse}flank_element_size = "0.2 mm"\n[friction]\n'
    (_, whole), (_, part) = (
        cycle_of(train_from_text("".join(stages) + coast + load + "coefficient = 0.1\n"))
        for coast in (COAST.format("a") + COAST.format("b"), COAST.format("a"))
    )
    expected, found = felt_by_the_first(whole, part, 5)
    assert np.abs(found - expected).max() < 1e-8 * np.abs(expected).max()


def test_compliance_is_symmetric_and_positive_and_of_pairs(cycle_of):
    """Betti between the flanks of any meshes; springs store energy under any forces; each mesh by itself has the
    compliance of its pair; meshes without a common gear do not feel each other."""
    _, cycle = cycle_of(helical_row([24, 31, 24, 31], [0, 60, 20], 300, more=FRICTION + COAST.format("row")))
    for step in (0, 7):
        compliance = cycle.position(step).operator.compliance
        largest = np.abs(compliance).max()
        assert np.abs(compliance - compliance.T).max() < 1e-14 * largest
        assert np.linalg.eigvalsh(compliance).min() > 0.0
        counts = [mesh.cycle.position(step).operator.nodes for mesh in cycle.meshes]
        ends = np.cumsum([0, *counts])
        rows = [np.concatenate([np.arange(*each), ends[-1] + np.arange(*each)]) for each in zip(ends, ends[1:])]
        one, two, three = rows
        assert np.abs(compliance[np.ix_(one, two)]).max() > 0.01 * largest
        assert not compliance[np.ix_(one, three)].any()
        for own, mesh in zip(rows, cycle.meshes):
            alone = mesh.cycle.position(step).operator.compliance
            assert np.array_equal(compliance[np.ix_(own, own)], alone)


def test_meshes_one_by_one_give_what_all_rows_together_give(cycle_of):
    """numpy's solution of the whole system of the same sets with all rows, for three meshes that two gears couple.
    Until they are asked for no rows of all meshes are formed, but of few closed nodes."""
    model, cycle = cycle_of(helical_row([24, 31, 24, 31], [0, 60, 20], 300))
    stepper = Stepper(cycle, model.equations_of_motion)
    for step in (2, 9):
        position = cycle.position(step)
        solution = stepper.in_balance(step, position).solution
        operator = position.operator
        assert operator.__dict__["compliance"].formed.sum() <= SMALL_SYSTEM
        closed, stiffness = np.flatnonzero(solution.status), stepper.static.stiffness
        assert len(closed) > SMALL_SYSTEM
        compliance, jacobian = operator.compliance, operator.jacobian
        whole = np.block([[-compliance[np.ix_(closed, closed)], jacobian[closed]], [jacobian[closed].T, stiffness]])
        found = np.linalg.solve(whole, np.concatenate([operator.gap[closed], stepper.load(step)]))
        forces = np.zeros(operator.nodes)
        forces[closed] = found[: len(closed)]
        displacement = jacobian @ found[len(closed) :] - compliance @ forces
        for own, expected in ((solution.forces, forces), (solution.displacement, displacement)):
            np.testing.assert_allclose(own, expected, rtol=0.0, atol=1e-11 * np.abs(expected).max())


def test_a_spur_row_that_does_not_vary_along_the_face_is_the_plane_row(cycle_of):
    """Without Poisson's effect a spur body under an even load is in plane strain: over the face and in the plane are
    the same, but for what the coarse section misses between both meshes."""
    plane, over_face = (
        overall_errors(
            *cycle_of(helical_row([24, 31, 24], [0, 60], 300, helix=0.0, poissons_ratio=0.0, more=more)), [5]
        )
        for more in ("", LEVEL)
    )
    assert over_face == pytest.approx(plane, rel=2e-3)


@pytest.mark.parametrize("more", ["", FRICTION])
def test_expected_memory_of_operators_is_that_of_their_arrays(cycle_of, more):
    """Counted arrays: of all meshes together, with their factors, and of each mesh beside them. A run that passes each
    position once keeps those of each mesh alone."""
    once, _ = cycle_of(helical_row([24, 31, 24], [0, 60], 300, more=more))
    model, cycle = cycle_of(helical_row([24, 31, 24], [0, 60], 300, more=f"{more}\n[motion]\nmesh_cycles = 2"))
    steps = range(cycle.steps)
    together = sum(cycle.position(step).bytes for step in steps)
    alone = sum(mesh.cycle.position(step).bytes for mesh in cycle.meshes for step in steps)
    # Without friction each mesh is solved by itself.
    both = WITH_FACTORS * together + alone if more else alone
    assert row_cost(model).operators == pytest.approx(both, rel=0.3)
    assert row_cost(once).operators == pytest.approx(alone, rel=0.3)


def test_flanks_beyond_what_is_known_are_refused():
    """Compiled code would read beyond the body's numbers."""
    counted = SharedGear((0, 1), (1, 0), 12)
    known = {(0, 1): (8, np.zeros((5, 1, 2))), (0, 0): (3, np.arange(8.0).reshape(2, 2, 2))}
    gear = GearOverFace(31, (MeshOfGear(0, 1), MeshOfGear(1, 0, counted)), BetweenMates((), known), ())
    one, other = np.array([0]), np.array([-9])
    assert gear.response((0, 1), one, other).shape == (1, 1, 1, 2)
    assert gear.response((1, 0), other, one).shape == (1, 1, 2, 1)
    # Of like flanks one way round the gear is the other one's transpose.
    ahead, behind = (gear.response((0, 0), np.array([each]), one)[0, 0] for each in (4, -4))
    assert np.array_equal(ahead, behind.T)
    assert np.array_equal(gear.response((0, 0), np.array([27]), one)[0, 0], behind)
    for kinds in ((0, 1), (0, 0)):
        with pytest.raises(ComputationError, match="further apart"):
            gear.response(kinds, one, one)


def test_an_idler_counts_the_teeth_of_both_meshes():
    """The mirror counts the other way; a tooth ahead round the gear is one behind the other way round."""
    idler = GearInPlane(31, SharedGear((0, 1), (1, 0), 12), None, 1.0)
    assert idler.gear.flank(0, (2, 0)) == (2, 0)
    assert idler.gear.flank(1, (2, 0)) == (10, 1)
    assert idler.ahead(2, 10, 5) == 23
    assert idler.ahead(2, 10, -20) == -8
