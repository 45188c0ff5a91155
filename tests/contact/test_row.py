"""Contact of trains: meshes feel each other through the body of the gear between them."""

from dataclasses import replace

import numpy as np
import pytest
from tests.planets import planetary
from tests.trains import COARSE, gear_text, helical_row, mate, row

from fenics_gears import SceneError, train_from_text
from fenics_gears.dynamics.stepping import Stepper
from fenics_gears.elasticity.cache import Cache
from fenics_gears.model.train import train_model_of
from fenics_gears.simulation.train import row_cycle
from fenics_gears.system.progress import SilentProgress

FRICTION = "[friction]\ncoefficient = 0.1"
COAST = "[stages.{}.coast_flanks]\n"
STEPS = np.array([3.0, 5.75, 10.0, 14.5, 17.25])


@pytest.fixture(scope="module")
def cycle_of(tmp_path_factory):
    cache = Cache(tmp_path_factory.mktemp("gears"))

    def made(scene):
        (model,) = train_model_of(scene).rows
        return model, row_cycle(model, SilentProgress(), cache)

    return made


def positions_at_rest(model, cycle, steps, sense: float = 1.0) -> np.ndarray:
    """Coordinates (steps, k) at rest at places between steps, each by itself; `sense` -1: the load drives."""
    equations = model.equations_of_motion
    drivetrain = replace(equations.drivetrain, load=sense * equations.drivetrain.load)
    stepper = Stepper(cycle, replace(equations, drivetrain=drivetrain))
    return np.array([stepper.in_balance(step, cycle.between(step, step - 1)).state.position for step in steps])


def overall_errors(model, cycle, steps) -> np.ndarray:
    """Transmission error (rad of the last shaft) at the same places."""
    return positions_at_rest(model, cycle, steps) @ model.drivetrain.angle


def mirrored_steps(model, cycle, steps) -> np.ndarray:
    """Where the coast flanks of the first mesh touch as its drive flanks do at such steps of the mirrored train."""
    pair = model.models[0].pair
    # The coast flank of the pinion's tooth at xi on the drive flanks' line stands at this less xi on its own.
    whole = 2.0 * pair.pinion.base_radius * (pair.operating_pressure_angle + pair.pinion.tooth_half_angle_at_base)
    return cycle.steps * (((whole - 2.0 * pair.path_start) / pair.base_pitch - steps / cycle.steps) % 1.0)


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


@pytest.mark.parametrize(
    ("teeth", "first", "second", "loads"),
    [
        ((24, 31, 40), (60.0, "82.5 mm"), ("wheel", -20.0, "106.75 mm"), "output_torque"),
        ((25, 31, 40), (0.0, "84 mm"), ("pinion", 155.0, "97.75 mm"), "torques"),
    ],
)
def test_a_train_on_its_coast_flanks_is_its_mirror_image(cycle_of, teeth, first, second, loads):
    """Exact symmetry: mirrored, a train driven from its load is the train driven forwards, of an idler and of a gear
    that drives two mates. Each mesh turns by its backlash more, here the second: the play of a mesh does not move
    the phase of those behind it."""

    def train(sense):
        (angle, distance), (shared, other_angle, other_distance) = first, second
        one, two, three = (gear_text(each, 3.0) for each in teeth)
        text = mate("a", one, two, sense * angle, 3.0, f'centre_distance = "{distance}"')
        text += mate("b", f'"a.{shared}"', three, sense * other_angle, 3.0, f'centre_distance = "{other_distance}"')
        both = '[{ on = "a.wheel", torque = "200 N m" }, { on = "b.wheel", torque = "300 N m" }]'
        load = f"[load]\n{loads} = {both if loads == 'torques' else chr(34) + '300 N m' + chr(34)}\n"
        return cycle_of(train_from_text(f"{text}{COAST.format('a')}{COAST.format('b')}{load}[accuracy]\n{COARSE}\n"))

    def errors(train, steps, sense):
        model, cycle = train
        found = positions_at_rest(model, cycle, steps, sense)
        each = zip(model.models, cycle.meshes)
        return np.array([[own.transmission_error(mesh.coordinates @ at) for at in found] for own, mesh in each])

    coasting, mirrored = train(1.0), train(-1.0)
    pairs = [own.pair for own in coasting[0].models]
    play = np.array([pair.backlash / abs(pair.wheel.base_radius) for pair in pairs])
    assert play[1] > 1e-3 and play[0] < 1e-12
    driven = errors(mirrored, mirrored_steps(*mirrored, STEPS), 1.0)
    found = errors(coasting, STEPS, -1.0)
    assert np.abs(found + driven + play[:, None]).max() < 1e-10 * np.abs(driven).max()


def test_coast_flanks_of_one_mesh_alone(cycle_of):
    """An idler with coast flanks in one of its meshes: what that mesh feels, of itself and of the other one, is what it
    feels in the row that has them in both, to the last digit. The elements of the last gear differ."""
    two_pairs = mate("a", gear_text(24, 3.0), gear_text(31, 3.0), 0.0, 3.0)
    two_pairs += mate("b", '"a.wheel"', gear_text(40, 3.0), 60.0, 3.0)
    load = f'[load]\noutput_torque = "300 N m"\n[accuracy]\n{COARSE}\n'
    (_, whole), (_, part) = (
        cycle_of(train_from_text(f"{two_pairs}{coast}{load}{FRICTION}"))
        for coast in (COAST.format("a") + COAST.format("b"), COAST.format("a"))
    )
    for step in (0, 7):
        expected, found = felt_by_the_first(whole, part, step)
        assert np.array_equal(found, expected)


def felt_by_the_first(whole, part, step: int) -> tuple[np.ndarray, np.ndarray]:
    """Rows of the first mesh of two trains of two meshes, of which the second one has no coast flanks in its second
    mesh: with friction the compliance by forces on the nodes that it has."""
    operators = [cycle.position(step).operator for cycle in (whole, part)]
    first = whole.meshes[0].cycle.position(step).operator.nodes
    on_coast = np.concatenate([[pair.place.flank == 1] * len(pair.offsets) for pair in operators[0].pairs])
    left = np.flatnonzero(~on_coast | (np.arange(len(on_coast)) < first))
    assert len(left) == operators[1].nodes < len(on_coast)
    numbers = left, np.arange(len(left))
    both = [(each.compliance, each.nodes, own) for each, own in zip(operators, numbers)]
    of_whole, of_part = (
        matrix[np.ix_([*range(first), *range(nodes, nodes + first)], [*own, *(nodes + own)])]
        for matrix, nodes, own in both
    )
    return of_whole, of_part


def test_compliance_of_a_train_is_symmetric_and_positive(cycle_of):
    """Betti between the flanks of any meshes; springs store energy under any forces."""
    _, cycle = cycle_of(row([24, 31, 40, 25], [0, 60, 20], 300, more=COAST.format("row") + FRICTION))
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


@pytest.mark.parametrize(
    "shaped",
    [
        'tip_relief = { depth = "10 um", start = "HPSTC" }\n',
        f"[stages.row.flank_errors.2]\nprofile_slope = {31 * ['4 um']}\n",
        '[stages.row.lead_modifications.pinion]\ncrowning = "5 um"\n',
    ],
)
def test_coast_flanks_that_are_drive_flanks_of_another_mesh_have_no_modifications(shaped):
    """Physics: one flank cannot have two shapes. Without them all is computed."""
    text = helical_row([24, 31, 40], [0, 60], 300, more=f"{shaped}{COAST.format('row')}").text
    with pytest.raises(SceneError, match=r"row.2: its coast flanks in row: gears .* are its drive flanks"):
        train_model_of(train_from_text(text))
    train_model_of(train_from_text(text.replace(shaped, "")))
