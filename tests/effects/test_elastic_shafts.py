"""Gears on elastic shafts in whole runs, on bodies without finite elements: statics, the condensed compliance by hand,
and what is refused."""

import numpy as np
import pytest
from tests.beam_elements import condensed
from tests.hard_cases.invariants import cycle_of, run_of
from tests.helical import helical_scene, on_stand_in_bodies

from fenics_gears import SceneError, model_of, scene_from_text
from fenics_gears.dynamics.elastic_shaft import shear_coefficient
from fenics_gears.dynamics.march import Marcher
from fenics_gears.dynamics.rolling_bearing import reaction
from fenics_gears.dynamics.shaft_at_work import even_load
from fenics_gears.model.description import describe
from fenics_gears.results.dataset import RunResult
from fenics_gears.results.recorder import Recorder
from fenics_gears.results.summary import summary_rows
from fenics_gears.scene.write import section_trees, text_of
from fenics_gears.show.bent_shafts import bent_shafts
from fenics_gears.show.plots import run_figures
from fenics_gears.show.run import Run
from fenics_gears.simulation.bearings_at_work import mean_loads, with_bearings_at_work

FEW = "slices = 5\ncontact_nodes = 9\nsteps_per_mesh_cycle = 8"
INPUT = """
[shafts.input]
sections = [{ length = "40 mm", diameter = "28 mm", bore = "8 mm" }, { length = "90 mm", diameter = "35 mm" }]
gear_at = "114 mm"
torque_at = "0 mm"
"""
PINION = """
[[bearings.pinion]]
at = "12 mm"
radial_stiffness = "0.3e6 N/mm"
axial_stiffness = "0.1e6 N/mm"
[[bearings.pinion]]
at = "85 mm"
radial_stiffness = "0.4e6 N/mm"
tilting_stiffness = "1e7 N mm/rad"
"""
OUTPUT = """
[shafts.output]
sections = [{ length = "150 mm", diameter = "40 mm" }]
gear_at = "60 mm"
torque_at = "150 mm"
material = "ductile cast iron"
"""
ROWS = "[[3e5, 1e4, 0, 0, 2e5], [1e4, 3e5, 0, 1e5, 0], [0, 0, 2e5, 0, 0], [0, 1e5, 0, 1e7, 0], [2e5, 0, 0, 0, 1e7]]"
WHEEL = f"""
[[bearings.wheel]]
at = "20 mm"
stiffness_matrix = {ROWS}
[[bearings.wheel]]
at = "110 mm"
radial_stiffness = "0.4e6 N/mm"
"""
ELASTIC = INPUT + PINION + OUTPUT + WHEEL
# Teeth cut into both shafts, on bearings that are alike in all directions.
CUT = (
    (INPUT + PINION + OUTPUT + WHEEL)
    .replace("torque_at", 'seat = "integral"\ntorque_at')
    .replace(f"stiffness_matrix = {ROWS}", 'radial_stiffness = "0.3e6 N/mm"\naxial_stiffness = "0.2e6 N/mm"')
    .replace('material = "ductile cast iron"\n', "")
)
GEARS = ("pinion", "wheel")
INERTIA = '[inertia]\nmass = "2 kg"\nmoment_of_inertia = "0.002 kg m^2"\n'
# The same shafts with a density, and what vibrates.
VIBRATING = (
    ELASTIC.replace('torque_at = "0 mm"', 'torque_at = "0 mm"\nmaterial = { density = "7.85 g/cm^3" }').replace(
        '"ductile cast iron"', '{ name = "ductile cast iron", density = "7.2 g/cm^3" }'
    )
    + INERTIA
)


def shear(outer, bore):
    return float(shear_coefficient(0.3, np.array(bore / outer)))


@pytest.fixture(
    scope="module", params=[(0.0, ELASTIC), (15.0, ELASTIC), (15.0, CUT)], ids=["spur", "helical", "cut into shafts"]
)
def run(request):
    """The model of a run with friction on two elastic shafts, and its result."""
    helix, shafts = request.param
    more = shafts + "[friction]\ncoefficient = 0.05\n[lead_modifications.pinion]\ncrowning = '4 um'\n"
    model = model_of(helical_scene(more, helix=helix, offset=2.0, accuracy=FEW))
    found = run_of(model, on_stand_in_bodies(model))
    assert found.failure is None
    return model, found.result


def near(found, wanted, part=1e-10):
    assert np.abs(found - wanted).max() <= part * np.abs(wanted).max()


def test_bearings_carry_what_the_gear_puts_on_its_shaft(run):
    """Exact: forces and moments of all bearings of a shaft balance those of the contact on its gear, about its
    mid-width; the torque of the contact is the load's where nothing but friction and contact act on the wheel."""
    model, result = run
    for shaft in model.drivetrain.elastic:
        own = [name.startswith(shaft.gear) for name in result["bearing"].values]
        gear = result.sel(gear=shaft.gear)
        force = {axis: result[f"bearing_force_{axis}"].values[:, own] for axis in "xyz"}
        arms = result["bearing_place"].values[own] - shaft.gear_at
        scale = np.abs(result["normal_force"].values).max()
        for axis in "xyz":
            assert np.abs(force[axis].sum(axis=1) - gear[f"reaction_{axis}"].values).max() <= 1e-10 * scale
        for axis, across, sense in (("x", "y", -1.0), ("y", "x", 1.0)):
            moment = result[f"bearing_moment_{axis}"].values[:, own] + sense * arms * force[across]
            difference = moment.sum(axis=1) - gear[f"reaction_moment_{axis}"].values
            assert np.abs(difference).max() <= 1e-10 * scale * 100.0
    assert np.abs(result["reaction_couple"].sel(gear="wheel").values) == pytest.approx(200e3, rel=1e-10)


def test_gears_move_by_the_compliance_of_elements_under_their_own_reactions(run):
    """Brute force: the compliance of a textbook's elements, applied to the forces and moments of the recorded contact,
    gives the recorded motions of the gears. What the gear sits on is extrapolated to rigid."""
    model, result = run
    for shaft in model.drivetrain.elastic:
        gear = result.sel(gear=shaft.gear)
        names = ("reaction_x", "reaction_y", "reaction_z", "reaction_moment_x", "reaction_moment_y")
        loads = np.array([gear[name].values for name in names])
        stiffness = 2.0 * condensed(shaft, shear, 2e4) - condensed(shaft, shear, 1e4)
        moved = np.linalg.solve(stiffness, loads)
        for name, wanted in zip(("centre_x", "centre_y", "axial_position", "tilt_x", "tilt_y"), moved):
            near(gear[name].values, wanted, 1e-6)


def test_axes_and_lines_are_those_of_the_gears(run):
    """Identity: inclination and offset are the difference of both gears' tilts and displacements in the middle of the
    common face; the lines pass the gears' middles with the gears' displacement; the energy account closes."""
    model, result = run
    width, middles = model.pair.face_width, np.array(model.pair.gear_middles)
    tilt = {axis: result[f"tilt_{axis}"].values for axis in "xy"}
    near(result["axis_inclination_in_plane"].values, 1e3 * width * (tilt["y"][:, 1] - tilt["y"][:, 0]))
    near(result["axis_inclination_out_of_plane"].values, 1e3 * width * (tilt["x"][:, 0] - tilt["x"][:, 1]))
    along = result["centre_x"].values - middles * tilt["y"]
    near(result["axis_offset_in_plane"].values, 1e3 * (along[:, 1] - along[:, 0]))
    for shaft in model.drivetrain.elastic:
        gear = result.sel(gear=shaft.gear)
        for axis in "xy":
            line = gear[f"shaft_deflection_{axis}"].values[-1]
            # Within the seat the shaft is straight.
            at_gear = np.interp(shaft.gear_at, gear["shaft_place"].values, line)
            assert at_gear == pytest.approx(gear[f"centre_{axis}"].values[-1], rel=1e-9)
    assert np.abs(result["energy_defect"].values).max() <= 1e-9 * result["energy"].values.max()


def test_the_drawing_shows_gears_bearings_and_deflection_to_scale(run):
    """Identity: the drawn shafts are as long and as thick as the scene's, and off their axes by the magnified
    deflection; bearings stand on the lines, and a picture is drawn of it."""
    model, result = run
    scale, *lines = bent_shafts(Run(result))
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
    """Identity: a scene made of the data alone reads as the same."""
    scene = helical_scene(ELASTIC, accuracy=FEW)
    scene.__dict__.pop("text")
    again = scene_from_text(text_of(scene), scene.name)
    assert (again.shafts, again.bearings) == (scene.shafts, scene.bearings)
    assert section_trees(again) == section_trees(scene)


def test_a_shaft_that_vibrates_keeps_the_balance_of_energy():
    """Exact: the energy account of a run with inertia, friction and damping closes to round-off, and the result has
    natural frequencies, of which the mesh's is one."""
    more = VIBRATING + "[friction]\ncoefficient = 0.05\n[damping]\nratio = 0.05\n"
    model = model_of(helical_scene(more, offset=2.0, accuracy=FEW.replace("= 8", "= 64"), frequency=800.0))
    found = run_of(model, on_stand_in_bodies(model))
    assert found.failure is None
    assert any("_mode_" in name for name in model.drivetrain.coordinates)
    result = found.result
    assert np.abs(result["energy_defect"].values).max() <= 1e-10 * result["energy"].values.max()
    assert result["energy_kinetic"].values.max() > 1e-3 * result["energy"].values.max()
    lines = result.attrs["natural_frequencies"].splitlines()
    assert sum("mesh springs" in line for line in lines) >= 1
    assert float(lines[-1].split()[0]) <= model.drivetrain.right_up_to


def test_what_is_said_of_shafts_that_vibrate():
    """Authority: `gears check` has closed forms, density times volume and the reduced mass of two gears along the line
    of action, and the compliance of the condensed shaft; a summary has the numbers of its result."""
    scene = helical_scene(VIBRATING, accuracy=FEW, frequency=800.0)
    said = {label: value for _, rows in describe(scene) for label, value, _ in rows}
    volume = 0.25 * np.pi * ((28.0**2 - 8.0**2) * 40.0 + 35.0**2 * 90.0)
    assert said["mass of the pinion's shaft"] == pytest.approx(7.85e-6 * volume, rel=1e-12)
    model = model_of(scene)
    along = [2000.0 / getattr(model.pair, gear).base_radius ** 2 for gear in GEARS]
    reduced = said["reduced mass J1 J2/(J1 rb2^2 + J2 rb1^2)"]
    assert reduced == pytest.approx(along[0] * along[1] / sum(along), rel=1e-12)
    per_newton = np.linalg.inv(model.drivetrain.elastic[0].stiffness)
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
    """Limit: at a hundredth of a mesh cycle a second inertia does nothing."""
    runs = []
    for more in (VIBRATING, VIBRATING.replace(INERTIA, "")):
        model = model_of(helical_scene(more, offset=2.0, accuracy=FEW, frequency=0.01))
        runs.append(run_of(model, on_stand_in_bodies(model)).result)
    moving, still = runs
    for name in ("transmission_error", "bearing_force_x", "bearing_moment_y", "tilt_y", "shaft_deflection_x"):
        different = np.nanmax(np.abs(moving[name].values - still[name].values))
        assert different <= 1e-9 * np.nanmax(np.abs(still[name].values))


ROLLING = (
    INPUT
    + """
[[bearings.pinion]]
at = "12 mm"
rolling = { number = 9, diameter = "12.7 mm", pitch_diameter = "65 mm", clearance = "15 um" }
[[bearings.pinion]]
at = "85 mm"
[bearings.pinion.rolling]
elements = "rollers"
number = 14
diameter = "9 mm"
length = "10 mm"
pitch_diameter = "65 mm"
clearance = "20 um"
"""
)
ONE = PINION[: PINION.index("[[bearings.pinion]]", 5)]
PLACED = '[bearings.places]\npinion = ["-40 mm", "60 mm"]\n'


@pytest.mark.parametrize(
    ("more", "said"),
    [
        (INPUT.replace("114 mm", "125 mm") + PINION, "shafts.input.gear_at = 125 mm: .* reaches beyond the shaft"),
        (INPUT + ONE, "bearings.pinion: one bearing holds .* tilts about x and tilts about y: add a second bearing"),
        (INPUT + PINION.replace('axial_stiffness = "0.1e6 N/mm"', ""), "freely moves along its axis: give one"),
        (INPUT + PINION.replace("85 mm", "110 mm"), "the bearing at 110 mm, place 2, overlaps the gear"),
        (INPUT + PINION.replace("85 mm", "131 mm"), "the bearing at 131 mm, place 2, is beyond the shaft"),
        (
            INPUT.replace('40 mm"', '4 mm"').replace('90 mm"', '9 mm"') + PINION,
            "sections: are 13 mm long in all, shorter than the pinion's face of 24 mm",
        ),
        (INPUT.replace('"0 mm"', '"131 mm"') + PINION, "shafts.input.torque_at = 131 mm: is beyond"),
        (INPUT.replace('bore = "8 mm"', 'bore = "28 mm"') + PINION, "the bore of 28 mm at place 1 leaves nothing"),
        (
            INPUT.replace('bore = "8 mm"', 'bore = "8 mm", end_diameter = "9 mm"') + PINION,
            "the cone at place 1 .* divide",
        ),
        (INPUT + PINION.replace('radial_stiffness = "0.3e6 N/mm"', ""), "place 1, has no radial_stiffness"),
        (ELASTIC.replace("[3e5, 1e4, 0", "[3e5, 2e4, 0"), "stiffness_matrix .* is not symmetric: 20000 in row 1"),
        (ELASTIC.replace("[0, 0, 2e5", "[0, 0, -2e5"), "stiffness_matrix .* is not positive"),
        (ELASTIC.replace(", [2e5, 0, 0, 0, 1e7]", ""), "is not 5 rows of 5 numbers"),
        (
            ELASTIC.replace('at = "20 mm"\n', 'at = "20 mm"\naxial_stiffness = "1 N/mm"\n'),
            "beside its stiffness_matrix",
        ),
        (INPUT + PINION + PLACED, "bearings.places.pinion .* stands beside"),
        (INPUT + '[bearings]\nstiffness = "1e5 N/mm"\n' + PINION, "bearings.stiffness .* not clear whose"),
        (INPUT + "[bearings.pinion]\nstiffness = '1e5 N/mm'\n", "bearings.pinion.* is missing: nothing holds"),
        (PINION, "bearings.pinion.* are bearings of a shaft with sections"),
        (INPUT.replace('torque_at = "0 mm"', "") + PINION, "shafts.input.torque_at.* is missing"),
        (
            INPUT.replace("gear_at", 'torsional_stiffness = "1e8 N mm/rad"\ngear_at') + PINION,
            "shafts.input.sections .* stands beside torsional_stiffness",
        ),
        ('[shafts]\ntorsional_stiffness = "1e8 N mm/rad"\n' + INPUT + PINION, "shafts.torsional_stiffness .* whose"),
        ('[shafts.input]\ngear_at = "10 mm"\ntorsional_stiffness = "1e8 N mm/rad"', "gear_at .* has no effect"),
        (INPUT + PINION + "[shafts.output]\n", "shafts.output.torsional_stiffness.* is missing.* or sections"),
        (
            INPUT + PINION + "[shafts.output]\ntorsional_stiffness = '1e8 N mm/rad'\ngear_at = '5 mm'",
            "output.gear_at.* no effect",
        ),
        (ELASTIC + INERTIA, "shafts.input.material.density.* is missing: .* nothing tells how dense"),
        (INPUT.replace("torque_at", 'seat = "loose"\ntorque_at') + PINION, "shafts.input.seat"),
        (INPUT.replace('"35 mm"', '"50 mm"') + PINION, "the shaft is 50 mm thick under the pinion's face, more than"),
        (ELASTIC.replace("torque_at", 'seat = "integral"\ntorque_at'), "output.seat .* two materials"),
        (ELASTIC.replace("torque_at", 'seat = "integral"\ntorque_at'), "bearings.wheel has a stiffness_matrix"),
        (CUT.replace('torque_at = "0 mm"', 'torque_at = "110 mm"'), "torque_at = 110 mm is within the face"),
        (ROLLING.replace("number = 9,", ""), "bearings.pinion.* has no rolling.number at place 1"),
        (ROLLING.replace("number = 9,", "number = 2,"), "pinion = a list.*number = 2 at place 1.*to 500[^:]*$"),
        (ROLLING.replace("number = 9,", "number = 90,"), "place 1, has 90 balls .* do not fit on a pitch_diameter"),
        (ROLLING.replace('length = "10 mm"', ""), "place 2, has rollers without length"),
        (
            ROLLING.replace("rolling = {", 'radial_stiffness = "1 N/mm"\nrolling = {'),
            "radial_stiffness beside its rolling",
        ),
        (ROLLING.replace("number = 9,", 'number = 9, preload = "10 N",'), "has a preload without contact_angle"),
        (
            ROLLING.replace("number = 9,", 'number = 9, preload = "10 N", contact_angle = "15 deg",'),
            "preloads push the shaft with 10 N along its axis",
        ),
        (
            ROLLING.replace("gear_at", 'material = { density = "7.85 g/cm^3" }\ngear_at') + INERTIA,
            "bearings.pinion: rolling beside .inertia.: how stiff",
        ),
        (ROLLING.replace("torque_at", 'seat = "integral"\ntorque_at'), "has a stiffness_matrix or rolling"),
    ],
)
def test_what_does_not_fit_is_refused_before_any_computation(more, said):
    """Authority: the issue's list of bad input; each message names what is wrong, and where."""
    with pytest.raises(SceneError, match=f"(?s){said}"):
        model_of(helical_scene(more, accuracy=""))


HOUSING = INPUT.replace("torque_at", 'housing = "housing.txt"\ntorque_at') + PINION
SEATS = np.diag(np.tile([3e5, 2e5, 1e5, 1e8, 2e8, 0.0], 2))


def written(folder, matrix):
    """The text of a scene with a housing, whose file is written into a folder."""
    rows = "\n".join(" ".join(f"{each:.9e}" for each in row) for row in matrix)
    (folder / "housing.txt").write_text(f"# of an export\n{rows}\n".replace("e+", "D+"))
    return helical_scene(INPUT + PINION, accuracy="").text.replace(INPUT + PINION, HOUSING)


def test_a_housing_from_a_file_is_in_series_with_the_bearings(tmp_path):
    """Identity: two seats that do not hold each other are springs behind the bearings; the file is found beside the
    scene."""
    scene = scene_from_text(written(tmp_path, SEATS), directory=tmp_path)
    found = model_of(scene).drivetrain.elastic[0]
    wanted = [0.15e6, 0.12e6, 0.05e6, 0.0, 0.0, 0.4e6 * 0.3 / 0.7, 0.4e6 * 0.2 / 0.6, 0.0, 1e15 / 1.1e8, 2e15 / 2.1e8]
    assert found.springs == pytest.approx(np.diag(wanted), rel=1e-12)
    assert scene.shafts.input.housing.digest


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda matrix: matrix[:6, :6], "has 6 rows for 2 bearings; allowed are 12"),
        (lambda matrix: matrix[:-1], "is not 11 rows of 11 numbers"),
        (lambda matrix: matrix + np.eye(12, k=3) * 1e4, "is not symmetric: 10000 in row"),
        (lambda matrix: matrix - 2.0 * np.diag([0, 0, 1e5, *np.zeros(9)]), "is not positive"),
        (lambda matrix: matrix[:0], "has no numbers"),
    ],
)
def test_a_housing_that_is_none_is_refused(tmp_path, change, said):
    """Authority: the issue: symmetric, positive, and of the seats that there are."""
    text = written(tmp_path, change(SEATS))
    with pytest.raises(SceneError, match=f"shafts.input.housing.*{said}"):
        model_of(scene_from_text(text, directory=tmp_path))
    with pytest.raises(SceneError, match="shafts.input.housing.*there is no such file"):
        model_of(scene_from_text(text, directory=tmp_path / "elsewhere"))


def test_a_shaft_that_is_not_as_thick_as_the_bore_is_told():
    """The issue's sanity: a shaft of 3 mm under a bore of 22.4 mm is said before the run; one that fits is not, nor one
    that the teeth are cut into."""

    def said(more):
        return [each for each in model_of(helical_scene(more, accuracy="")).warnings if "face, whose bore" in each]

    thin = INPUT.replace('"35 mm"', '"3 mm"') + PINION
    assert "is 3 mm thick under the pinion's face, whose bore is 22.3" in said(thin)[0]
    fits = INPUT.replace('"35 mm"', f'"{float(0.4 * 54.0 / np.cos(np.radians(15.0)))!r} mm"') + PINION
    assert not said(fits) and not said(CUT)


def test_rolling_bearings_carry_by_their_law_in_the_run():
    """Authority: the bearings' own law at the motions of the shaft in the run, on the average; the run knows linear
    springs alone, which it repeats until they agree."""
    model = model_of(helical_scene(ROLLING + OUTPUT + WHEEL, offset=2.0, accuracy=FEW))
    bodies = on_stand_in_bodies(model)
    shaft = model.drivetrain.elastic[0]

    def marched(model, stage=""):
        recorder = Recorder(model, cycle_of(model, bodies))
        return recorder, Marcher(recorder.cycle, model.equations_of_motion).run(model.steps, 1, observe=recorder.take)

    recorder, march = with_bearings_at_work(model, marched)
    model, result = recorder.model, RunResult(recorder, march).dataset
    assert result.attrs["largest_rolling_element_force"] > 0.0
    working = model.drivetrain.elastic[0]
    gear = np.linalg.solve(working.stiffness, mean_loads(model, recorder)[0])
    for number, motion in enumerate((working.at_bearings @ gear).reshape(2, 5)):
        law = reaction(shaft.bearings[number].rolling, motion).loads
        for axis, load in zip("xyz", law):
            found = result[f"bearing_force_{axis}"].values[1:, number].mean()
            assert abs(found - load) <= 2e-4 * np.abs(law[:3]).max()


@pytest.mark.parametrize("torque", [3e5, -3e5], ids=["drive", "coast"])
def test_the_even_load_is_the_force_of_a_run_on_the_flanks_that_carry(torque):
    """Authority: statics; without friction forces have the direction of the flanks' normal, whatever the line load."""
    model = model_of(helical_scene(ELASTIC + "\n[coast_flanks]\n", offset=2.0, accuracy=FEW, torque=torque))
    recorder = Recorder(model, cycle_of(model, on_stand_in_bodies(model)))
    Marcher(recorder.cycle, model.equations_of_motion).run(model.steps, 1, observe=recorder.take)
    recorder.finish()
    for shaft, load in zip(model.drivetrain.elastic, mean_loads(model, recorder)):
        even = even_load(shaft, model.pair, torque)
        # Each gear's tilts about the pitch point are what the line load makes of them.
        assert np.abs(even - load)[:3].max() <= 1e-4 * np.linalg.norm(load[:3])


def test_a_side_that_names_nothing_is_rigid():
    """Authority: docs/scene.md. The other side may have sections, a torsional stiffness or a support of its own."""
    alone = model_of(helical_scene(INPUT + PINION, accuracy=FEW)).drivetrain
    of_pinion = {"centre_x1", "centre_y1", "axial_1", "tilt_x1", "tilt_y1", "rotation_1"}
    assert set(alone.coordinates) == of_pinion | {"rotation_2"}
    beside = '[shafts.output]\ntorsional_stiffness = "1e8 N mm/rad"\n[bearings.wheel]\nstiffness = "1e5 N/mm"\n'
    both = model_of(helical_scene(INPUT + PINION + beside, accuracy=FEW)).drivetrain
    assert set(both.coordinates) - set(alone.coordinates) == {"centre_x2", "centre_y2", "shaft_twist"}
