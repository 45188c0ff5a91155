"""Whole gearboxes of REXS files: where gears stand, idlers, what programs write where they have no value, and what is
left out. 20/40 teeth of module 4 mm in both stages, centres 120 mm apart, 100 N m and 1000 rpm on shaft 2."""

import re
from math import pi

import pytest
from tests.extensions.rexs.planetary_model import two_stages

from fenics_gears import SceneError, load_train
from fenics_gears.commands.cli import main
from fenics_gears.extensions.rexs.gearbox import imported_train
from fenics_gears.extensions.rexs.imported import imported_scene
from fenics_gears.scene.read import scene_from_text

BOX = two_stages()
ALONG_X = ("u_axis_vector", "mm", (1, 0, 0))


def attribute(name, unit, value):
    inner = "".join(f"<c>{each}</c>" for each in value) if isinstance(value, tuple) else value
    inner = f"<array>{inner}</array>" if isinstance(value, tuple) else inner
    return f'<attribute id="{name}" unit="{unit}">{inner}</attribute>'


def with_attributes(text, number, *attributes):
    """The file with more attributes of a component."""
    said = "".join(attribute(*each) for each in attributes)
    found = re.sub(rf'(<component id="{number}" type="\w+">)', rf"\1{said}", text)
    assert found != text
    return found


def related(text, kind, **roles):
    """The file with one more relation."""
    refs = "".join(f'<ref id="{number}" role="{role}"/>' for role, number in roles.items() if number)
    return text.replace("</relations>", f'<relation id="{len(text)}" type="{kind}">{refs}</relation></relations>')


def with_component(text, number, kind, shaft, *attributes):
    """The file with a part on a shaft."""
    said = "".join(attribute(*each) for each in attributes)
    text = related(text, "assembly", assembly=shaft, part=number)
    return text.replace("</components>", f'<component id="{number}" type="{kind}">{said}</component></components>')


def at(text, number, *place):
    return with_attributes(text, number, ("support_vector", "mm", place), ALONG_X)


def without_distance(text):
    return text.replace('<attribute id="center_distance" unit="mm">120.0</attribute>', "")


def idler_box():
    """Gear 6 meshes with 5 and with 52: no gear 51."""
    text = BOX.replace('<ref id="51" role="gear_1" />', '<ref id="6" role="gear_1" />')
    return text.replace('<ref id="51" role="part" />', '<ref id="7" role="part" />')


def written(tmp_path, text):
    file = tmp_path / "box.rexs"
    file.write_text(text)
    return file


def train_of(tmp_path, text, **options):
    """The train of a file, and what its import says."""
    found = imported_train(written(tmp_path, text), **options)
    (tmp_path / "box.toml").write_text(found.text)
    return load_train(tmp_path / "box.toml"), found


def degrees(train):
    return [mesh.direction * 180.0 / pi for mesh in train.meshes]


PLACES = {5: (0, 0, 0), 6: (0, 120, 0), 51: (50, 120, 0), 52: (50, 120, 120)}


@pytest.mark.parametrize(("torque", "expected"), [("100.0", [0.0, 90.0]), ("-100.0", [180.0, 90.0])])
def test_positions_give_directions(tmp_path, torque, expected):
    """Plane geometry: with w upwards, seen against u, v = w x u is to the right; from the other end to the left. A gear
    turns with the torque that drives it."""
    text = BOX.replace(">100.0<", f">{torque}<").replace(">1000.0<", f">{10 * float(torque)}<")
    for number, place in PLACES.items():
        text = at(text, number, *place)
    train, found = train_of(tmp_path, text)
    assert degrees(train) == pytest.approx(expected)
    assert "support_vector of components 5, 6" in found.text


def test_angles_of_stages_give_directions(tmp_path):
    """REXS counts them from the w axis about -u: 90 deg are to the right, seen against u; with the gears named the
    other way round they are from the wheel to the pinion."""
    angle = "rotating_angle_around_neg_u_axis", "deg"
    text = with_attributes(with_attributes(BOX, 4, (*angle, 90)), 50, (*angle, 30))
    assert degrees(train_of(tmp_path, text)[0]) == pytest.approx([0.0, 60.0])
    turned = text.replace('id="51" role="gear_1"', 'id="51" role="gear_2"')
    turned = turned.replace('id="52" role="gear_2"', 'id="52" role="gear_1"')
    assert degrees(train_of(tmp_path, turned)[0]) == pytest.approx([0.0, -120.0])


def test_a_direction_that_is_said_twice_differently_is_refused(tmp_path):
    """One of both is wrong, and the file does not say which."""
    text = at(at(BOX, 5, 0, 0, 0), 6, 0, 120, 0)
    text = with_attributes(text, 4, ("rotating_angle_around_neg_u_axis", "deg", 45))
    with pytest.raises(SceneError, match="has the wheel at 45 deg, but support_vector of components 5, 6 at 0 deg"):
        train_of(tmp_path, text)


def test_without_places_directions_are_left_out(tmp_path):
    """They are told as left out, and the scene has its own default."""
    train, found = train_of(tmp_path, BOX)
    assert degrees(train) == [0.0, 0.0]
    assert "directions of wheels from pinions, which the file does not say" in found.left_out


def test_positions_give_the_centre_distance(tmp_path):
    """Pythagoras over the axes: 72 and 96 mm are 120 mm apart, whatever the places along them; this goes before the
    distance that profile shifts leave no backlash at."""
    text = at(at(without_distance(BOX), 5, 7, 0, 0), 6, 31, 72.3, 96.4)
    scene = scene_from_text(imported_scene(written(tmp_path, text), stage=4).text)
    assert scene.gears.centre_distance == pytest.approx(120.5, rel=1e-12)


@pytest.mark.parametrize(("torque", "expected"), [("100.0", 4.0), ("-100.0", -4.0)])
def test_a_wheel_beside_its_pinion_has_an_offset(tmp_path, torque, expected):
    """Right is the end from which the pinion turns counter-clockwise: that of its axis where its torque is positive."""
    text = BOX.replace(">100.0<", f">{torque}<").replace(">1000.0<", f">{10 * float(torque)}<")
    text = at(at(text, 5, 10, 0, 0), 6, 14, 120, 0)
    scene = scene_from_text(imported_scene(written(tmp_path, text), stage=4).text)
    assert scene.gears.axial_offsets == pytest.approx((0.0, expected))


def test_gears_of_two_stages_are_idlers_of_a_row(tmp_path):
    """An idler hands its torque on: 100 N m on 20 teeth are 200 N m on 40 and on the next 40 teeth."""
    text = idler_box().replace(
        '<component id="50" type="cylindrical_stage">\n      <attribute id="center_distance" unit="mm">120.0',
        '<component id="50" type="cylindrical_stage">\n      <attribute id="center_distance" unit="mm">160.0',
    )
    angle = "rotating_angle_around_neg_u_axis", "deg"
    text = with_attributes(with_attributes(text, 4, (*angle, 90)), 50, (*angle, 30))
    train, found = train_of(tmp_path, text)
    assert [(mesh.pair.pinion.teeth, mesh.pair.wheel.teeth) for mesh in train.meshes] == [(20, 40), (40, 40)]
    assert [mesh.scene.load.wheel_torque for mesh in train.meshes] == pytest.approx([200e3, 200e3])
    assert [mesh.pair.centre_distance for mesh in train.meshes] == pytest.approx([120.0, 160.0])
    assert degrees(train) == pytest.approx([0.0, 60.0])
    assert train.rows == [[0, 1]]
    assert found.text.count("[[stages.stage_4.gears]]") == 3


def test_a_row_says_what_it_has_no_place_for(tmp_path):
    """Centre distances with backlash that differ, and reliefs of some of the flanks."""
    with pytest.raises(SceneError, match=r"120.4 mm .*give 120 mm without backlash.*--stage"):
        train_of(tmp_path, idler_box().replace('unit="mm">120.0', 'unit="mm">120.4', 1))
    sizes = ("tip_relief_depth", "mum", 20), ("tip_relief_datum_diameter", "mm", 86)
    relief = with_component(idler_box(), 70, "tip_relief", None, *sizes)
    for number in (7, 8):
        relief = related(relief, "reference", origin=number, referenced=70)
    relief = relief.replace("120.0", "160.0", 2).replace("160.0", "120.0", 1)
    with pytest.raises(SceneError, match="with tip_relief. A row of a scene has the same modifications in all"):
        train_of(tmp_path, relief)


def test_a_tip_circle_below_the_roots_is_no_tip_circle(tmp_path):
    """A program of 2022 writes 1 mm where it has none; 20 teeth of module 4 mm have 88 mm by ISO 53."""
    train, found = train_of(tmp_path, with_attributes(BOX, 51, ("tip_diameter", "mm", 1)))
    assert train.meshes[1].scene.gears.pinion.tip_diameter == pytest.approx(88.0)
    assert any("tip_diameter of component 51 is 1 mm, below the roots" in each for each in found.assumed)


@pytest.mark.parametrize(("diameter", "expected"), [(30, 30.0), (60, 28.0)])
def test_the_bore_is_the_shaft_there(tmp_path, diameter, expected):
    """A gear that is not said to have a bore sits on its shaft; where the shaft is nearly as thick as the roots
    (70 mm) both are one piece, and 0.4 of the root diameter is held."""
    text = at(at(BOX, 2, 10, 0, 0), 5, 60, 0, 0)
    for number, start in ((71, 0), (72, 40)):
        sizes = ("u_coordinate_on_shaft", start), ("length", 40), ("outer_diameter_begin", diameter - 72 + number)
        text = with_component(text, number, "shaft_section", 2, *((name, "mm", size) for name, size in sizes))
    scene = scene_from_text(imported_scene(written(tmp_path, text), stage=4).text)
    assert scene.gears.pinion.bore_diameter == pytest.approx(expected)


def test_what_is_on_shafts_is_left_out_by_name(tmp_path):
    """Nothing that loads a shaft goes without a word."""
    text = with_component(BOX, 71, "shaft_section", 2, ("length", "mm", 40))
    text = with_component(
        text, 73, "external_load", 3, ("force_v_direction", "N", 456), ("transmits_torque", "", "false")
    )
    text = with_component(text, 74, "concept_bearing", None)
    left_out = train_of(tmp_path, text)[1].left_out
    for said in ("shaft sections: component 71", "bearings: component 74", "forces on shafts: component 73"):
        assert said in left_out


def test_a_carrier_of_no_set_is_named(tmp_path):
    """A file that does not say which gears are its planets."""
    text = with_component(BOX, 75, "planet_carrier", 2)
    with pytest.raises(SceneError, match="component 75 .*is a part of no planetary_stage"):
        train_of(tmp_path, text)


def test_the_call_gives_torque_and_speed_of_a_train(tmp_path, capsys):
    """A file without loads asks for them by the options that its train takes: of the last and of the first gear."""
    file = written(tmp_path, BOX.replace('<attribute id="torque_around_u_axis" unit="N m">100.0</attribute>', ""))
    out = tmp_path / "box.toml"
    assert main(["import", str(file), "--train", "-o", str(out)]) == 2
    assert "--wheel-torque" in capsys.readouterr().err
    options = ["--wheel-torque", "400 N m", "--pinion-speed", "600 rpm"]
    assert main(["import", str(file), "--train", "-o", str(out), "-q", *options]) == 0
    train = load_train(out)
    assert train.output_torque == pytest.approx(400e3)
    assert train.input_torque == pytest.approx(100e3)
    assert train.input_speed == pytest.approx(10.0)
