"""Shafts on rolling bearings, nonlinear springs of every step, at rest and with inertia."""

import numpy as np
import pytest
from tests.elastic_shaft_scenes import E_AXLE, FEW, OUTPUT, ROLLING, VIBRATING, WHEEL, largest_difference_of_slow_runs
from tests.hard_cases.invariants import cycle_of, finished_helical_run
from tests.helical import helical_scene, on_stand_in_bodies

from fenics_gears import SceneError, model_of, scene_from_text
from fenics_gears.contact.errors import ContactNotConverged
from fenics_gears.dynamics.march import Marcher
from fenics_gears.dynamics.rolling_bearing import reaction
from fenics_gears.dynamics.shaft_elements import carried
from fenics_gears.runs.simulate import simulate

INTEGRAL_ROLLING = ROLLING.replace("torque_at", 'seat = "integral"\ntorque_at')
VIBRATING_ROLLING, VIBRATING_E_AXLE = (
    each.replace('torque_at = "0 mm"', 'torque_at = "0 mm"\nmaterial = { density = "7.85 g/cm^3" }')
    + VIBRATING[VIBRATING.index("[shafts.output]") :]
    for each in (ROLLING, E_AXLE)
)


def rigid_motions(shaft):
    """Motions (5 b, 5) of a rigid shaft in its bearings per motion of the gear."""
    return np.concatenate([carried(each.at - shaft.seats[0].at)[:5, :5] for each in shaft.bearings])


@pytest.mark.parametrize("of_input", [ROLLING, INTEGRAL_ROLLING], ids=["rigid seat", "teeth cut in"])
def test_rolling_bearings_carry_by_their_law_at_every_step(of_input):
    """Statics and the bearings' own law: the gear's load by its contact forces is what bearings have in sum, and what
    they have is the law at the shaft's motions in them, which are those of the loaded beam; teeth cut into an overhung
    shaft change nothing."""
    model = model_of(helical_scene(of_input + OUTPUT + WHEEL, offset=2.0, accuracy=FEW))
    train, cycle = model.drivetrain, cycle_of(model, on_stand_in_bodies(model))
    shaft, names = train.elastic[0], train.coordinates
    march = Marcher(cycle, model.equations_of_motion).run(model.steps, model.steps + 1)
    gear = [names.index(name) for name in ("centre_x1", "centre_y1", "axial_1", "tilt_x1", "tilt_y1")]
    assert len(march.records) == model.steps + 1
    free, rigid = train.systems[0].free_of_rolling, rigid_motions(shaft)
    rows = free.assembly.numbers(train.systems[0].in_rolling_motions)
    flexible = free.flexibility[np.ix_(rows, rows)]
    for record in march.records:
        position, forces = record.state.position, record.solution.forces
        motions = position[[names.index(name) for name in shaft.in_rolling]]
        laws = [reaction(each.rolling, of).loads for each, of in zip(shaft.bearings, motions.reshape(2, 5))]
        on_bearings = np.concatenate(laws)
        loads = -(record.position.operator.jacobian.T @ forces)[gear] * train.radii[gear]
        size = np.abs(loads).max()
        assert np.abs(rigid.T @ on_bearings - loads).max() <= 1e-9 * size
        bent = rigid @ (position[gear] / train.radii[gear]) - flexible @ on_bearings
        assert motions == pytest.approx(bent, rel=1e-9, abs=1e-9 * np.abs(motions).max())


@pytest.mark.parametrize("of_input", [ROLLING, E_AXLE], ids=["rigid seat", "cut in between"])
def test_results_of_rolling_bearings_are_by_their_law(of_input):
    """Identity: loads of the result are in balance, energy is what bearings hold, and the largest force of a rolling
    element that under the mean loads."""
    found = finished_helical_run(of_input + OUTPUT + WHEEL, offset=2.0, accuracy=FEW)
    model, result = found.model, found.result
    normal = result["normal_force"].values[1:]
    across = np.hypot(*(result[f"bearing_force_{axis}"].values[1:, :2].sum(axis=1) for axis in "xy"))
    assert across == pytest.approx(normal * model.pair.cosine, rel=1e-9)
    train = model.drivetrain
    places = [train.coordinates.index(name) for name in train.elastic[0].in_rolling]
    motions = np.mean([each.state.position[places] for each in found.records[1:]], axis=0).reshape(2, 5)
    largest = max(reaction(each.rolling, of).largest for each, of in zip(train.elastic[0].bearings, motions))
    assert result.attrs["largest_rolling_element_force"] == pytest.approx(largest, rel=0.01)
    assert np.all(result["energy_bearings"].values > 0.0)


@pytest.mark.parametrize("shafts", [VIBRATING_ROLLING, VIBRATING_E_AXLE], ids=["rigid seat", "cut in between"])
def test_a_slow_run_on_rolling_bearings_is_the_quasi_static_one(shafts):
    """Limit: a hundredth of a mesh cycle a second. Without masses and modes equations are others."""
    assert largest_difference_of_slow_runs(shafts) <= 1e-8


def test_a_shaft_vibrates_on_rolling_bearings_as_on_their_tangents():
    """Another route: small motions about the place under load have the natural frequencies of the shaft on matrices
    with the derivatives of the law there."""
    model = model_of(helical_scene(VIBRATING_ROLLING, offset=2.0, accuracy=FEW, frequency=800.0))
    rolling = model.drivetrain.rolling
    text = VIBRATING_ROLLING[VIBRATING_ROLLING.index("[shafts.output]") :]
    matrices = [
        f'[[bearings.pinion]]\nat = "{bearing.at!r} mm"\nstiffness_matrix = {tangent.tolist()}\n'
        for bearing, tangent in zip(
            model.drivetrain.elastic[0].bearings,
            (reaction(each.rolling, rolling.reference[each.rows]).stiffness for each in rolling.springs),
        )
    ]
    head = VIBRATING_ROLLING[: VIBRATING_ROLLING.index("[[bearings.pinion]]")]
    linear = model_of(helical_scene(head + "".join(matrices) + text, offset=2.0, accuracy=FEW, frequency=800.0))
    one, other = ([each.frequency for each in of.vibrations[:8]] for of in (model, linear))
    assert one == pytest.approx(other, rel=1e-4)


def test_a_shaft_that_vibrates_on_rolling_bearings_obeys_its_equations():
    """The equations of motion with the law of the bearings in place of springs."""
    scene = helical_scene(VIBRATING_ROLLING, offset=2.0, accuracy=FEW.replace("= 8", "= 32"), frequency=800.0)
    model = model_of(scene)
    train, cycle = model.drivetrain, cycle_of(model, on_stand_in_bodies(model))
    march = Marcher(cycle, model.equations_of_motion).run(model.steps, model.steps + 1)
    size = np.abs(train.stiffness) + np.abs(train.mass) * (2.0 / model.equations_of_motion.time_step) ** 2
    largest = np.max([np.abs(each.state.position) for each in march.records], axis=0)
    for each in march.records[1:]:
        springs = train.elastic_forces(each.state.position) + train.mass @ each.state.acceleration
        left = springs + each.position.operator.jacobian.T @ each.solution.forces - train.load
        assert np.all(np.abs(left) <= 1e-10 * size @ largest)


def test_bearings_that_find_no_balance_leave_the_steps_before(monkeypatch):
    """What was computed is kept: the error carries the march so far, marked as failed."""
    monkeypatch.setattr("fenics_gears.dynamics.rolling_springs.MOST_ITERATIONS", 1)
    model = model_of(helical_scene(ROLLING + OUTPUT + WHEEL, offset=2.0, accuracy=FEW))
    with pytest.raises(ContactNotConverged, match="rolling bearings: .* still change by .* preload"):
        simulate(model, preparation=lambda *_: ((), cycle_of(model, on_stand_in_bodies(model))))


LIGHT = """
[gears]
module = "1 mm"
pressure_angle = "17.5 deg"
material = "tin bronze"
pinion = { teeth = 48, profile_shift = 0, bore_diameter = "9.6 mm", face_width = "1.2 mm" }
wheel = { teeth = 26, profile_shift = 0.8, bore_diameter = "4.6 mm", face_width = "2.2 mm" }
[load]
wheel_torque = "TORQUE"
[misalignment]
in_plane = "0 um"
[shafts.input]
sections = [{ length = "11.2 mm", diameter = "9.6 mm" }]
gear_at = "5.6 mm"
seat = "integral"
torque_at = "0 mm"
[bearings]
pinion = [
    { at = "0.9 mm", axial_stiffness = "17 N/um", rolling = { number = 5, ROLLERS } },
    { at = "10.3 mm", axial_stiffness = "17 N/um", rolling = { number = 10, clearance = "3.8 um", ROLLERS } },
]
""".replace("ROLLERS", 'elements = "rollers", diameter = "3.8 mm", length = "3.8 mm", pitch_diameter = "15.3 mm"')


@pytest.mark.parametrize(
    "torque", ["1e-4 N mm", "3e-4 N mm", "1e-6 N m", "1e-4 N m", "1e-2 N m", "1 N m", "1e3 N m", "1e6 N m"]
)
def test_any_load_finds_its_place_or_is_refused(torque):
    """Statics: in the place that is found the bearings have the load of the teeth in sum, by their law. Hardly loaded
    rollers may leave the shaft free, in words; the search ends."""
    scene = scene_from_text(LIGHT.replace("TORQUE", torque))
    try:
        train = model_of(scene).drivetrain
    except SceneError as refused:
        assert "N mm" in torque or float(torque.split()[0]) < 1e-5, str(refused)
        assert "bearings.pinion" in str(refused) and "rolling elements" in str(refused)
        return
    shaft, system = train.elastic[0], train.systems[0]
    motions = train.rolling.reference[[train.coordinates.index(name) for name in shaft.in_rolling]].reshape(2, 5)
    laws = [reaction(each.rolling, of).loads for each, of in zip(shaft.bearings, motions)]
    for each, loads, of in zip(shaft.bearings, laws, motions):
        loads[2] += each.axial_stiffness * of[2]
    load = np.array(system.load)
    assert np.abs(rigid_motions(shaft).T @ np.concatenate(laws) - load).max() <= 1e-8 * np.abs(load).max()
