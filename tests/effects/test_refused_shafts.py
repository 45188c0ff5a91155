"""Elastic shafts and bearings that do not fit, and housings from files."""

import numpy as np
import pytest
from tests.elastic_shaft_scenes import CUT, ELASTIC, INERTIA, INPUT, PINION, PRESSED, ROLLING
from tests.helical import helical_scene

from fenics_gears import SceneError, model_of, scene_from_text
from fenics_gears.commands.cli import main

ONE = PINION[: PINION.index("[[bearings.pinion]]", 5)]
WEB = '[gears.wheel.web]\nrim_inner_diameter = "88 mm"\nhub_diameter = "60 mm"\nwidth = "6 mm"\n'
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
        (INPUT + PINION + PLACED, "bearings.places.pinion .* is given together with"),
        (INPUT + '[bearings]\nstiffness = "1e5 N/mm"\n' + PINION, "bearings.stiffness .* not clear whose"),
        (INPUT + "[bearings.pinion]\nstiffness = '1e5 N/mm'\n", "bearings.pinion.* is missing: nothing holds"),
        (PINION, "bearings.pinion.* are bearings of a shaft with sections"),
        (INPUT.replace('torque_at = "0 mm"', "") + PINION, "shafts.input.torque_at.* is missing"),
        (
            INPUT.replace("gear_at", 'torsional_stiffness = "1e8 N mm/rad"\ngear_at') + PINION,
            "shafts.input.sections .* is given together with torsional_stiffness",
        ),
        ('[shafts]\ntorsional_stiffness = "1e8 N mm/rad"\n' + INPUT + PINION, "shafts.torsional_stiffness .* whose"),
        ('[shafts.input]\ngear_at = "10 mm"\ntorsional_stiffness = "1e8 N mm/rad"', "gear_at .* has no effect"),
        (INPUT + PINION + "[shafts.output]\n", "shafts.output.torsional_stiffness.* is missing.* or sections"),
        (
            INPUT + PINION + "[shafts.output]\ntorsional_stiffness = '1e8 N mm/rad'\ngear_at = '5 mm'",
            "output.gear_at.* no effect",
        ),
        (ELASTIC + INERTIA, "shafts.input.material.density.* is missing: .* nothing gives its density"),
        (INPUT.replace("torque_at", 'seat = "loose"\ntorque_at') + PINION, "shafts.input.seat"),
        (INPUT.replace('"35 mm"', '"50 mm"') + PINION, "the shaft is 50 mm thick under the pinion's face, more than"),
        (ELASTIC.replace("torque_at", 'seat = "integral"\ntorque_at'), "output.seat .* two materials"),
        (CUT.replace('torque_at = "0 mm"', 'torque_at = "110 mm"'), "torque_at = 110 mm is within the face"),
        (CUT + WEB, 'output.seat = "integral": gears.wheel.web stands between teeth and shaft'),
        (
            PRESSED.replace('"22.36 mm"', '"23 mm"'),
            'input.seat = "press fit": the shaft is 23 mm thick under .* 22.362 mm',
        ),
        (
            PRESSED.replace(
                '"22.36 mm" }', '"22.36 mm" }, { length = "9 mm", diameter = "22.36 mm", bore = "5 mm" }'
            ).replace('"90 mm"', '"80 mm"'),
            "bore changes under the pinion's face",
        ),
        (PRESSED.replace('torque_at = "0 mm"', 'torque_at = "110 mm"'), "torque_at = 110 mm is within the face"),
        (CUT.replace('torque_at = "0 mm"', 'torque_at = "102 mm"'), "torque_at = 102 mm is within the face or at its"),
        (ROLLING.replace("number = 9,", ""), "bearings.pinion.* has no rolling.number at place 1"),
        (ROLLING.replace("number = 9,", "number = 2,"), "pinion = a list.*number = 2 at place 1.*to 500[^:]*$"),
        (ROLLING.replace("number = 9,", "number = 90,"), "place 1, has 90 balls .* do not fit on a pitch_diameter"),
        (ROLLING.replace('"85 mm"', '"12 mm"'), "place 2, stands where another one does, and one of them is rolling"),
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
    ],
)
def test_what_does_not_fit_is_refused_before_any_computation(more, said):
    """What is wrong, and where."""
    with pytest.raises(SceneError, match=f"(?s){said}"):
        model_of(helical_scene(more, accuracy=""))


HOUSING = INPUT.replace("torque_at", 'housing = "housing.txt"\ntorque_at') + PINION
SEATS = np.diag(np.tile([3e5, 2e5, 1e5, 1e8, 2e8, 0.0], 2))


def written(folder, matrix):
    rows = "\n".join(" ".join(f"{each:.9e}" for each in row) for row in matrix)
    (folder / "housing.txt").write_text(f"# of an export\n{rows}\n".replace("e+", "D+"))
    return helical_scene(INPUT + PINION, accuracy="").text.replace(INPUT + PINION, HOUSING)


def test_a_housing_from_a_file_is_in_series_with_the_bearings(tmp_path):
    """Identity: seats that do not hold each other are springs behind the bearings."""
    scene = scene_from_text(written(tmp_path, SEATS), directory=tmp_path)
    found = model_of(scene).drivetrain.systems[0]
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
    """Symmetric, positive, and of the seats that there are."""
    text = written(tmp_path, change(SEATS))
    with pytest.raises(SceneError, match=f"shafts.input.housing.*{said}"):
        model_of(scene_from_text(text, directory=tmp_path))
    with pytest.raises(SceneError, match="shafts.input.housing.*there is no such file"):
        model_of(scene_from_text(text, directory=tmp_path / "elsewhere"))


def test_a_shaft_that_is_not_as_thick_as_the_bore_is_told():
    """A shaft of 3 mm under a bore of 22.4 mm is said; one that fits is not, nor one that the teeth are cut into."""

    def said(more):
        return [each for each in model_of(helical_scene(more, accuracy="")).warnings if "face, whose bore" in each]

    thin = INPUT.replace('"35 mm"', '"3 mm"') + PINION
    assert "is 3 mm thick under the pinion's face, whose bore is 22.3" in said(thin)[0]
    fits = INPUT.replace('"35 mm"', f'"{float(0.4 * 54.0 / np.cos(np.radians(15.0)))!r} mm"') + PINION
    assert not said(fits) and not said(CUT)


def test_objections_to_a_whole_scene_stand_one_below_another_each_with_its_line(tmp_path, monkeypatch, capsys):
    """As of single fields: a person goes to the line and corrects a file once."""
    monkeypatch.chdir(tmp_path)
    text = helical_scene(INPUT + PINION, accuracy="").text.replace('torque_at = "0 mm"', 'torque_at = "131 mm"')
    lines = text.replace('at = "85 mm"', 'at = "110 mm"').splitlines()
    (tmp_path / "pair.toml").write_text("\n".join(lines))
    assert main(["check", "pair.toml"]) == 2
    torque, bearings = (1 + lines.index(each) for each in ('torque_at = "131 mm"', "[[bearings.pinion]]"))
    first, second, last = capsys.readouterr().err.splitlines()
    assert first.startswith(f"pair.toml:{torque}: shafts.input.torque_at = 131 mm: is beyond the shaft")
    assert second.startswith(f"pair.toml:{bearings}: bearings.pinion: the bearing at 110 mm, place 2, overlaps")
    assert last == "Nothing was computed or written."


def test_a_shaft_on_one_roller_is_refused():
    """Three rollers under a force along the line of action: one carries, and nothing holds the shaft across it."""
    text = """
        [gears]
        module = "1 mm"
        pressure_angle = "20 deg"
        backlash = "0 mm"
        face_width = "2 mm"
        material = "steel"
        pinion = { teeth = 54, profile_shift = 0, bore_diameter = "17 mm" }
        wheel = { teeth = 51, profile_shift = 0, bore_diameter = "36 mm" }
        [load]
        wheel_torque = "4 N m"
        [accuracy]
        slices = 5
        layers = 3
        [shafts.output]
        sections = [{ length = "11 mm", diameter = "36 mm" }]
        gear_at = "5.5 mm"
        torque_at = "0 mm"
        [[bearings.wheel]]
        at = "0.9 mm"
        axial_stiffness = "3e4 N/mm"
        rolling = { number = 3, diameter = "14 mm", pitch_diameter = "58 mm", elements = "rollers", length = "1 mm" }
        [[bearings.wheel]]
        at = "10 mm"
        radial_stiffness = "7e6 N/mm"
        """
    with pytest.raises(SceneError, match="bearings.wheel: under the load .* freely moves along y"):
        model_of(scene_from_text(text))
    assert model_of(scene_from_text(text.replace("number = 3", "number = 8"))).drivetrain.systems
