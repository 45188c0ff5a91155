"""Gears on shafts that bend and vibrate, in whole runs on bodies without finite elements."""

from dataclasses import replace

import numpy as np
import pytest
from tests.beam_elements import assembled, condensed
from tests.elastic_shaft_scenes import (
    CUT,
    E_AXLE,
    ELASTIC,
    FEW,
    INERTIA,
    INPUT,
    OUTPUT,
    PINION,
    SKEWED,
    VIBRATING,
    WHEEL,
    largest_difference_of_slow_runs,
)
from tests.hard_cases.invariants import cycle_of, finished_helical_run, run_of
from tests.helical import helical_scene, on_stand_in_bodies

from fenics_gears import model_of, scene_from_text
from fenics_gears.dynamics.beam import shear_coefficient
from fenics_gears.dynamics.bearings import Bearing
from fenics_gears.dynamics.march import Marcher
from fenics_gears.dynamics.rolling_bearing import secant_stiffness
from fenics_gears.dynamics.shaft_at_work import even_load
from fenics_gears.model.description import describe
from fenics_gears.results.bent_shafts import OF_GEARS
from fenics_gears.results.recorder import Recorder
from fenics_gears.results.summary import summary_rows
from fenics_gears.scene.write import section_trees, text_of
from fenics_gears.show.bent_shafts import bent_shafts
from fenics_gears.show.plots import run_figures
from fenics_gears.show.run import ShownRun


def shear(outer, bore):
    return float(shear_coefficient(0.3, np.array(bore / outer)))


@pytest.fixture(
    scope="module",
    params=[(0.0, ELASTIC), (15.0, ELASTIC), (15.0, CUT), (15.0, SKEWED)],
    ids=["spur", "helical", "cut into shafts", "not alike"],
)
def run(request):
    helix, shafts = request.param
    more = shafts + "[friction]\ncoefficient = 0.05\n[lead_modifications.pinion]\ncrowning = '4 um'\n"
    found = finished_helical_run(more, helix=helix, offset=2.0, accuracy=FEW)
    return found.model, found.result


# Round-off of a motion (mm) that is zero, as along the axis of a spur gear.
ROUND_OFF = 1e-15


def near(found, wanted, part=1e-10):
    assert np.abs(found - wanted).max() <= part * np.abs(wanted).max() + ROUND_OFF


def test_bearings_carry_what_the_gear_puts_on_its_shaft(run):
    """Exact: bearings balance the contact's forces and moments; the torque is the load's."""
    model, result = run
    for shaft in model.drivetrain.elastic:
        own = [name.startswith(shaft.name) for name in result["bearing"].values]
        gear = result.sel(gear=shaft.name)
        force = {axis: result[f"bearing_force_{axis}"].values[:, own] for axis in "xyz"}
        arms = result["bearing_place"].values[own] - shaft.seats[0].at
        scale = np.abs(result["normal_force"].values).max()
        for axis in "xyz":
            assert np.abs(force[axis].sum(axis=1) - gear[f"reaction_{axis}"].values).max() <= 1e-10 * scale
        for axis, across, sense in (("x", "y", -1.0), ("y", "x", 1.0)):
            moment = result[f"bearing_moment_{axis}"].values[:, own] + sense * arms * force[across]
            difference = moment.sum(axis=1) - gear[f"reaction_moment_{axis}"].values
            assert np.abs(difference).max() <= 1e-10 * scale * 100.0
    assert np.abs(result["reaction_couple"].sel(gear="wheel").values) == pytest.approx(200e3, rel=1e-10)


def test_gears_move_by_the_compliance_of_elements_under_their_own_reactions(run):
    """Brute force: a textbook's elements under the recorded contact; the seat is extrapolated to rigid."""
    model, result = run
    for shaft in model.drivetrain.elastic:
        gear = result.sel(gear=shaft.name)
        names = ("reaction_x", "reaction_y", "reaction_z", "reaction_moment_x", "reaction_moment_y")
        loads = np.array([gear[name].values for name in names])
        stiffness = 2.0 * condensed(shaft, shear, 2e4) - condensed(shaft, shear, 1e4)
        moved = np.linalg.solve(stiffness, loads)
        for name, wanted in zip(("centre_x", "centre_y", "axial_position", "tilt_x", "tilt_y"), moved):
            near(gear[name].values, wanted, 1e-6)


def test_axes_and_lines_are_those_of_the_gears(run):
    """Identity: differences of both gears' tilts and displacements in the middle of the face; the energy account
    closes."""
    model, result = run
    assert np.abs(result["energy_defect"].values).max() <= 1e-9 * result["energy"].values.max()
    if model.drivetrain.elastic[0].seats[0].yields_within:
        return
    width, middles = model.pair.face_width, np.array(model.pair.gear_middles)
    tilt = {axis: result[f"tilt_{axis}"].values for axis in "xy"}
    near(result["axis_inclination_in_plane"].values, 1e3 * width * (tilt["y"][:, 1] - tilt["y"][:, 0]))
    near(result["axis_inclination_out_of_plane"].values, 1e3 * width * (tilt["x"][:, 0] - tilt["x"][:, 1]))
    along = result["centre_x"].values - middles * tilt["y"]
    near(result["axis_offset_in_plane"].values, 1e3 * (along[:, 1] - along[:, 0]))
    for shaft in model.drivetrain.elastic:
        gear = result.sel(gear=shaft.name)
        for axis in "xy":
            line = gear[f"shaft_deflection_{axis}"].values[-1]
            # Within the seat the shaft is straight.
            at_gear = np.interp(shaft.seats[0].at, gear["shaft_place"].values, line)
            assert at_gear == pytest.approx(gear[f"centre_{axis}"].values[-1], rel=1e-9)


def columns_of(drivetrain, names):
    return [drivetrain.coordinates.index(name) for name in names]


def on_secants(shaft, motions):
    """The shaft on matrices that give what its rolling bearings carry at motions (5 r,) in them."""
    left = motions.reshape(-1, 5).tolist()
    springs = [
        each
        if each.rolling is None
        else Bearing(each.at, stiffness_matrix=each.with_axial(secant_stiffness(each.rolling, np.array(left.pop(0)))))
        for each in shaft.bearings
    ]
    return replace(shaft, bearings=tuple(springs))


@pytest.mark.parametrize("shafts", [CUT, SKEWED, E_AXLE + OUTPUT + WHEEL], ids=["alike", "not alike", "rolling"])
def test_axes_lines_and_bearings_of_gears_cut_into_shafts_are_those_of_elements(shafts):
    """Brute force: a textbook's elements over the whole shaft, also under the face, on bearings of which some hold
    tilts and others roll or are not alike in all directions, loaded along the face by the recorded contact forces; axes
    are straight lines through what the slices do. Rolling bearings are springs that give their law's loads there."""
    shafts = shafts.replace('at = "110 mm"\nradial', 'at = "110 mm"\ntilting_stiffness = "1e8 N mm/rad"\nradial')
    found = finished_helical_run(shafts + "[friction]\ncoefficient = 0.05\n", offset=2.0, accuracy=FEW)
    model, axes, face = found.model, [], found.model.face
    result, record, drivetrain = found.result.isel(time=-1, contact_time=-1), found.records[-1], model.drivetrain
    operator, (points, weights) = record.position.operator, np.polynomial.legendre.leggauss(6)
    of_slice = np.tile(np.concatenate([[each.place.slice] * len(each.offsets) for each in operator.pairs]), 2)
    for shaft, middle in zip(drivetrain.elastic, model.pair.gear_middles):
        columns = [drivetrain.coordinates.index(name) for name in shaft.seats[0].of_gear]
        forces = -operator.jacobian[:, columns] * drivetrain.radii[columns] * record.solution.forces[:, None]
        of_teeth = np.array([forces[of_slice == each].sum(axis=0) for each in range(face.slices)])
        # About the slices' own heights.
        z = face.positions - middle
        of_teeth[:, 3:] += np.stack([z * of_teeth[:, 1], -z * of_teeth[:, 0]], axis=1)
        loaded = shaft.seats[0].at + z[:, None] + 0.5 * face.widths[:, None] * points
        if not shaft.seats[0].yields_within:
            axes.append(None)
            continue
        shaft = on_secants(shaft, record.state.position[columns_of(drivetrain, shaft.in_rolling)])
        gear, along = result.sel(gear=shaft.name), result["shaft_place"].sel(gear=shaft.name).values
        places, stiffness = assembled(shaft, shear, [*along, *loaded.ravel()])

        def nodes(wanted, places=np.array(places)):
            return np.abs(places - np.reshape(wanted, (-1, 1))).argmin(axis=1)

        load = np.zeros((len(places), 5))
        load[nodes(loaded)] = np.einsum("p,si->spi", 0.5 * weights, of_teeth).reshape(-1, 5)
        moved = np.linalg.solve(stiffness, load.ravel()).reshape(-1, 5)
        slices = np.einsum("p,spi->si", 0.5 * weights, moved[nodes(loaded)].reshape(face.slices, -1, 5))
        axes.append(np.polyfit(face.positions, slices[:, :2], 1, w=np.sqrt(face.widths)))
        own = [name.startswith(shaft.name) for name in result["bearing"].values]
        carried = np.array([each.matrix @ moved[nodes(each.at)[0]] for each in shaft.bearings])
        for axis, name in enumerate("xy"):
            near(gear[f"shaft_deflection_{name}"].values, moved[nodes(along), axis], 1e-4)
        for axis, name in enumerate(("force_x", "force_y", "force_z", "moment_x", "moment_y")):
            near(result[f"bearing_{name}"].values[own], carried[:, axis], 1e-7)
    if any(each is None for each in axes):
        return
    for name, wanted in zip(("inclination", "offset"), np.diff(axes, axis=0)[0] * [[model.pair.face_width], [1.0]]):
        for plane, each in zip(("in_plane", "out_of_plane"), wanted):
            near(result[f"axis_{name}_{plane}"].values, 1e3 * each, 1e-3)


def test_the_drawing_shows_gears_bearings_and_deflection_to_scale(run):
    """Identity: as long and thick as the scene's, off their axes by the magnified deflection."""
    model, result = run
    scale, *lines = bent_shafts(ShownRun(result))
    times = float(scale.caption.split("magnified ")[1].split()[0])
    shaft, _, bearings = scale.curves[:3]
    own = model.drivetrain.elastic[0]
    assert np.ptp(shaft.x) == pytest.approx(own.length)
    upper, lower = np.split(shaft.y[:-1], 2)
    assert upper - lower[::-1] == pytest.approx(np.repeat([28.0, 35.0], 9))
    axis = result["shaft_deflection_x"].sel(gear="pinion").values.mean(axis=0)
    assert 0.5 * (upper + lower[::-1])[[0, -1]] == pytest.approx(times * axis[[0, -1]])
    from_left = bearings.x - shaft.x.min()
    assert from_left == pytest.approx([12.0, 85.0])
    assert bearings.y / times == pytest.approx(np.interp(from_left, np.linspace(0.0, own.length, len(axis)), axis))
    assert lines[0].curves[0].y == pytest.approx(1e3 * axis)
    assert "shafts.png" in run_figures(result)


def test_the_scene_is_written_and_read_again():
    """Identity."""
    scene = helical_scene(ELASTIC, accuracy=FEW)
    scene.__dict__.pop("text")
    again = scene_from_text(text_of(scene), scene.name)
    assert (again.shafts, again.bearings) == (scene.shafts, scene.bearings)
    assert section_trees(again) == section_trees(scene)


def test_a_side_that_names_nothing_is_rigid():
    """docs/scene.md."""
    alone = model_of(helical_scene(INPUT + PINION, accuracy=FEW)).drivetrain
    of_pinion = {"centre_x1", "centre_y1", "axial_1", "tilt_x1", "tilt_y1", "rotation_1"}
    assert set(alone.coordinates) == of_pinion | {"rotation_2"}
    beside = '[shafts.output]\ntorsional_stiffness = "1e8 N mm/rad"\n[bearings.wheel]\nstiffness = "1e5 N/mm"\n'
    both = model_of(helical_scene(INPUT + PINION + beside, accuracy=FEW)).drivetrain
    assert set(both.coordinates) - set(alone.coordinates) == {"centre_x2", "centre_y2", "twist_2"}


@pytest.mark.parametrize("torque", [3e5, -3e5], ids=["drive", "coast"])
def test_the_even_load_is_the_force_of_a_run_on_the_flanks_that_carry(torque):
    """Statics: without friction forces have the direction of the flanks' normal."""
    model = model_of(helical_scene(ELASTIC + "\n[coast_flanks]\n", offset=2.0, accuracy=FEW, torque=torque))
    recorder = Recorder(model, cycle_of(model, on_stand_in_bodies(model)))
    Marcher(recorder.cycle, model.equations_of_motion).run(model.steps, 1, observe=recorder.take)
    recorder.finish()
    motions = np.stack([recorder.arrays[name][1:].mean(axis=0) for name in OF_GEARS])
    for number, shaft in enumerate(model.drivetrain.elastic):
        load = model.drivetrain.systems[number].gear_stiffness @ motions[:, number]
        even = even_load(shaft.name, model.pair, torque)
        # Each gear's tilts about the pitch point are what the line load makes of them.
        assert np.abs(even - load)[:3].max() <= 1e-4 * np.linalg.norm(load[:3])


def test_a_shaft_that_vibrates_keeps_the_balance_of_energy():
    """Exact: the account closes; the mesh's natural frequency is there."""
    more = VIBRATING + "[friction]\ncoefficient = 0.05\n[damping]\nratio = 0.05\n"
    found = finished_helical_run(more, offset=2.0, accuracy=FEW.replace("= 8", "= 64"), frequency=800.0)
    model, result = found.model, found.result
    assert any("_mode_" in name for name in model.drivetrain.coordinates)
    assert np.abs(result["energy_defect"].values).max() <= 1e-10 * result["energy"].values.max()
    assert result["energy_kinetic"].values.max() > 1e-3 * result["energy"].values.max()
    lines = result.attrs["natural_frequencies"].splitlines()
    assert sum("mesh springs" in line for line in lines) >= 1
    assert float(lines[-1].split()[0]) <= model.drivetrain.right_up_to


@pytest.mark.parametrize("load", ["", '[inertia.load]\nmoment_of_inertia = "0.5 kg m^2"\n'])
def test_what_is_said_where_the_input_shaft_alone_has_sections(load):
    """The rows of what there is: the load turns with the wheel, where there is one."""
    text = VIBRATING[: VIBRATING.index("[shafts.output]")] + INERTIA + load
    scene = helical_scene(text, accuracy=FEW, frequency=800.0)
    said = {label: (value, words) for _, rows in describe(scene) for label, value, words in rows}
    assert said.get("load moment of inertia") == ((pytest.approx(5e5), "kg mm^2, with the wheel") if load else None)
    assert "mass of the pinion's shaft" in said and "mass of the wheel's shaft" not in said


def test_what_is_said_of_shafts_that_vibrate():
    """Closed forms: density times volume, the reduced mass along the line of action, the condensed shaft's
    compliance."""
    scene = helical_scene(VIBRATING, accuracy=FEW, frequency=800.0)
    said = {label: value for _, rows in describe(scene) for label, value, _ in rows}
    volume = 0.25 * np.pi * ((28.0**2 - 8.0**2) * 40.0 + 35.0**2 * 90.0)
    assert said["mass of the pinion's shaft"] == pytest.approx(7.85e-6 * volume, rel=1e-12)
    model = model_of(scene)
    along = [2000.0 / getattr(model.pair, gear).base_radius ** 2 for gear in ("pinion", "wheel")]
    reduced = said["reduced mass J1 J2/(J1 rb2^2 + J2 rb1^2)"]
    assert reduced == pytest.approx(along[0] * along[1] / sum(along), rel=1e-12)
    per_newton = np.linalg.inv(model.drivetrain.systems[0].gear_stiffness)
    words = said["its stiffness at the pinion"]
    assert [float(part.split()[0]) for part in words.split(", ")] == pytest.approx(
        [1e-3 / per_newton[axis, axis] for axis in range(3)], rel=1e-3
    )
    result = run_of(model, on_stand_in_bodies(model)).result
    result.attrs |= {"base_radius_wheel": model.pair.wheel.base_radius}
    printed = {label: value for label, value, *_ in summary_rows(result)}
    largest = np.sqrt(sum(result[f"bearing_force_{axis}"].values ** 2 for axis in "xyz")).max()
    assert float(printed["largest force of a bearing"].split()[0]) == pytest.approx(largest, rel=1e-3)
    lowest = result.attrs["natural_frequencies"].splitlines()[0].split()[0]
    assert float(printed["natural frequencies"].split()[0]) == pytest.approx(float(lowest), rel=1e-3)


def test_a_slow_run_with_inertia_is_the_quasi_static_one():
    """Limit: a hundredth of a mesh cycle a second."""
    assert largest_difference_of_slow_runs(VIBRATING) <= 1e-9


@pytest.mark.parametrize("more", ["", "[friction]\ncoefficient = 0.05\n"])
def test_steps_that_eliminate_modes_obey_the_equations_of_all_coordinates(more):
    """The equations of motion themselves, by compiled and by plain steps, which agree. An acceleration is a difference
    of positions over the square of a step, and as exact as they are."""
    model = model_of(helical_scene(VIBRATING + more, accuracy=FEW.replace("= 8", "= 64"), frequency=800.0))
    cycle, found, train = cycle_of(model, on_stand_in_bodies(model)), [], model.drivetrain
    size = np.abs(train.stiffness) + np.abs(train.mass) * (2.0 / model.equations_of_motion.time_step) ** 2
    for plain in (False, True):
        march = Marcher(cycle, model.equations_of_motion, plain=plain).run(model.steps, model.steps + 1)
        found.append(np.array([each.state.position for each in march.records]))
        for each in march.records[1:]:
            springs = train.stiffness @ each.state.position + train.mass @ each.state.acceleration
            left = springs + each.position.operator.jacobian.T @ each.solution.forces - train.load
            assert np.all(np.abs(left) <= 1e-11 * size @ np.abs(found[-1]).max(axis=0))
    assert train.modes > 3 and train.damping is None
    one, other = found
    np.testing.assert_allclose(one, other, rtol=0.0, atol=1e-12 * np.abs(other).max())
