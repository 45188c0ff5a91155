"""Trains of REXS files whose power has several paths or ends. Gears of module 4 mm."""

import re
from math import pi

import pytest
from tests.extensions.rexs.planetary_model import Box
from tests.extensions.rexs.test_planetary import train_of

from fenics_gears import SceneError


def two_outputs():
    """Shaft 2 drives 3 and 4: one pinion of 20 teeth with mates of 40 and of 30 teeth; 4 drives 5 by 20/40 teeth."""
    box = Box().shaft(2, 1000).shaft(3).shaft(4).shaft(5)
    box.gear(11, 20, 2).gear(12, 40, 3, (0, 120)).gear(13, 30, 4, (100, 0)).stage(10, 11, 12, 120.0)
    box.stage(20, 11, 13, 100.0).gear(14, 20, 4, (100, 0)).gear(15, 40, 5, (220, 0))
    return box.stage(30, 14, 15, 120.0)


def test_a_gear_with_two_mates_drives_two_outputs(tmp_path):
    """Equilibrium: 100 N m on the input are 30 N m/2 for the first output, and what is left times 30/20 and 40/20."""
    train, found = train_of(tmp_path, two_outputs().load(91, 2, 100).load(92, 3, -30).load(93, 5))
    assert 'pinion = "stage_10.pinion"' in found.text
    assert 'carries = ["stage_20.wheel", "stage_30.pinion"]' in found.text
    assert train.input_torque == pytest.approx(100e3)
    assert train.output_torque == pytest.approx(85e3 * 1.5 * 2.0)
    assert [mesh.scene.load.wheel_torque for mesh in train.meshes] == pytest.approx([30e3, 85e3 * 1.5, 255e3])
    assert [mesh.direction * 180 / pi for mesh in train.meshes] == pytest.approx([90.0, 0.0, 0.0])


def test_torques_of_all_outputs_make_that_of_the_input(tmp_path):
    """30/2 + 255/3 N m."""
    train, _ = train_of(tmp_path, two_outputs().load(91, 2).load(92, 3, -30).load(93, 5, -255))
    assert train.input_torque == pytest.approx(100e3)


def test_the_call_gives_a_torque_that_is_lacking(tmp_path):
    """Of the last gear, beside the one that the file has."""
    box = two_outputs().load(92, 3, -30)
    with pytest.raises(SceneError, match="all but one must be known.*--wheel-torque"):
        train_of(tmp_path, box)
    assert train_of(tmp_path, box, wheel_torque="255 N m")[0].input_torque == pytest.approx(100e3)


def split(torque=400.0):
    """Shaft 2 drives 5, on one axis, through 3 to the right and 4 to the left, both with 20/40 and 20/40 teeth."""
    box = Box().shaft(2, 1000).shaft(3).shaft(4).shaft(5).load(91, 2, torque).gear(11, 20, 2).load(92, 5)
    for path, side in ((3, 1), (4, -1)):
        at = (120 * side, 0)
        box.gear(10 * path + 2, 40, path, at).stage(10 * path, 11, 10 * path + 2, 120.0)
        box.gear(10 * path + 5, 20, path, at)
    box.gear(60, 40, 5)
    return box.stage(33, 35, 60, 120.0).stage(43, 45, 60, 120.0)


def test_a_split_torque_is_imported(tmp_path):
    """Statics: two paths that half a turn takes onto each other carry half each."""
    train, found = train_of(tmp_path, split())
    assert train.output_torque == pytest.approx(4 * 400e3)
    assert sorted(mesh.scene.load.wheel_torque for mesh in train.meshes) == pytest.approx([400e3] * 2 + [800e3] * 2)
    assert len(re.findall("^carries", found.text, re.M)) == 2


def test_a_load_between_two_stages_is_taken_there(tmp_path):
    """A pump on the shaft between: of 100 N m times 40/20, 60 N m are taken and 140 N m go on."""
    box = Box().shaft(2, 1000).shaft(3).shaft(4).load(91, 2, 100).load(92, 3, 60).load(93, 4)
    box.pair(10, (2, 3), (20, 40), ((0, 0), (0, 120))).pair(20, (3, 4), (20, 40), ((0, 120), (0, 240)))
    train, _ = train_of(tmp_path, box)
    assert [mesh.scene.load.wheel_torque for mesh in train.meshes] == pytest.approx([200e3, 280e3])


def test_directions_of_several_mates_are_needed(tmp_path):
    """Mates of one gear would stand in one place."""
    box = two_outputs().load(91, 2, 100).load(92, 3, -30).load(93, 5)
    for each in box.components:
        each["attributes"] = [own for own in each["attributes"] if own["id"] != "support_vector"]
    with pytest.raises(SceneError, match="does not say in which directions they stand"):
        train_of(tmp_path, box)


def test_two_drives_are_refused(tmp_path):
    """Power comes in at the output too."""
    box = two_outputs().load(91, 2, 100).load(93, 5)
    output = next(each for each in box.components if each["id"] == 3)
    output["attributes"].append({"id": "rotational_speed", "unit": "1 / min", "value": 500.0})
    with pytest.raises(SceneError, match="has loads that drive the shafts of component"):
        train_of(tmp_path, box.load(92, 3, 30))
