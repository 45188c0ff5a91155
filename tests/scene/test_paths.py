"""Mistakes in trains of several paths, told before anything is computed."""

import re
from math import asin, degrees, pi, radians, sin

import pytest
from tests.trains import gear_text, mate, row, split_text

from fenics_gears import GearsError, train_from_text
from fenics_gears.model.train import train_model_of

TWO = split_text()
SHAFT = '["in2.wheel", "out2.pinion"]'
CLOSE = '"210.0 deg"'.join(TWO.replace('"180.0 deg"', '"30.0 deg"', 1).rsplit('"0.0 deg"', 1))
TABLE = gear_text(20, 2.0)
LOAD = '[load]\noutput_torque = "400 N m"'


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (TWO.replace('"in1.pinion"', '"in1.pinon"'), 'no gear that a stage declares. Did you mean "in1.pinion"'),
        (TWO.replace('"in1.pinion"', '"in2.wheel"'), "no gear is its own mate"),
        (TWO.replace('"out1.wheel"', '"out1.pinion"'), "out2 closes locks: both of its gears"),
        (mate("in2", TABLE, TABLE, 0.0) + mate("b", '"in2.wheel"', '"in2.pinion"', 0.0) + LOAD, "in in2 already"),
        (TWO.replace(SHAFT, '["in2.wheel", "in1.wheel"]'), r'"in1.wheel"\n.*is on the shaft of \[shafts.path1\]'),
        (TWO.replace(SHAFT, '["in2.wheel"]'), '"in1.pinion" and "out2.pinion": two turns would be prescribed'),
        (TWO.replace(SHAFT, '["in2.wheel", "out2.pinion", "out1.wheel"]'), "mesh and stand on one shaft"),
        (TWO.replace(SHAFT, "[]"), "names no gear"),
        (TWO.replace('"in1.pinion"', TABLE), '"in1.pinion" and "in2.pinion": two turns would be prescribed'),
        (TWO[: TWO.index("[stages.out2]")] + LOAD, 'shafts of "in1.wheel" and "out1.wheel" drive no gear'),
        (
            mate("a", TABLE, TABLE, 0.0) + mate("b", '"a.pinion"', TABLE, 180.0) + LOAD,
            'load.torques\n.*"a.wheel" and "b.wheel" drive no gear, and each has a load. Allowed: torques of',
        ),
        (
            mate("a", TABLE, TABLE, 0.0) + mate("b", TABLE, TABLE, 0.0) + '[shafts.x]\ncarries = ["a.wheel"]\n' + LOAD,
            'in 2 parts that no mesh and no shaft joins: "a.wheel", "a.pinion" and "b.pinion", "b.wheel"',
        ),
        (TWO.replace("teeth = 40", "teeth = 42", 1), "locks: .* 0.238095 times .* 1/4 = 0.25 times"),
        (TWO.replace('"180.0 deg"', '"170.0 deg"', 1), "two places .* The nearest directions that close: in1: "),
        (CLOSE, "gears in1.wheel and in2.wheel overlap"),
        (TWO.replace('"2.0 mm"', '"2.5 mm"', 1), "in2.module: gear in1.pinion has another module in in1"),
        (split_text(of_shaft='clocking = "2 rad"'), "clocking.*is too large"),
        (row([24, 31, 40], [0, 60], 100).text + '[shafts.x]\ncarries = ["row.2"]\nclocking = "1 mrad"', "in a loop"),
        (TWO.replace('"20 mm"', '"25 mm"', 1), "in in1 and in in2, whose gears are not equally wide"),
        (TWO.replace('"steel"', '"POM"', 1), "in1.pinion: has another material in in2 than in in1"),
        (TWO.replace("direction", 'tip_relief = { depth = "9 um", start = "HPSTC" }\ndirection', 1), "by up to 9 um"),
    ],
)
def test_mistakes_are_told(text, said):
    """Each says where it is and what is allowed."""
    with pytest.raises(GearsError, match=f"(?s){said}"):
        train_model_of(train_from_text(text))


def loop_of_gears(one: float, other: float, back: float, further: float) -> str:
    """Two idlers of 31 teeth between gears of 20 and 60, by directions of the meshes, degrees."""
    first, idler, last = (gear_text(each, 2.0) for each in (20, 31, 60))
    meshes = mate("a", first, idler, one) + mate("b", '"a.wheel"', last, other)
    return meshes + mate("c", '"a.pinion"', idler, back) + mate("d", '"c.wheel"', '"b.wheel"', further) + LOAD


@pytest.mark.parametrize("angle", [42.0, 45.0, 50.0])
def test_a_loop_of_gears_assembles_where_its_teeth_add_up(angle):
    """With the outer gears held, an arm that swings by an angle rolls an idler by that of both gears together: the
    idlers at angles +-psi and, from the last gear, +-phi stand alike where ((z1 + z2) psi + (z2 + z3) phi)/pi is
    whole. Where it is not, the train is refused by that part of a pitch, with directions for which it is."""
    further = degrees(asin(51.0 * sin(radians(angle)) / 91.0))
    law = (51.0 * radians(angle) + 91.0 * radians(further)) / pi
    off = abs(law - round(law))
    with pytest.raises(GearsError, match="cannot be assembled") as refused:
        train_from_text(loop_of_gears(angle, -further, -angle, further))
    assert float(re.search("stand ([0-9.e-]+) pitches", str(refused.value))[1]) == pytest.approx(off, rel=1e-3)
    nearest = [float(each) for each in re.findall(r'"(-?[0-9.]+) deg"', str(refused.value))]
    assert nearest[0] == pytest.approx(angle, abs=1.0)
    law = (51.0 * radians(nearest[0]) - 91.0 * radians(nearest[1])) / pi
    assert law == pytest.approx(round(law), abs=1e-5)
    assert train_from_text(loop_of_gears(*nearest)).layout.not_closed()


def test_paths_beside_each_other_share_torques_before_a_run():
    """Without losses the torque of each shaft is that of all its meshes; paths have equal parts at first."""
    train = train_from_text(split_text(3, 600.0, teeth=(21, 45, 21, 45)))
    torques = [mesh.scene.load.wheel_torque for mesh in train.meshes]
    ratio = 21.0 / 45.0
    assert torques == pytest.approx([200e3 * ratio] * 3 + [200e3] * 3, rel=1e-12)
    assert train.input_torque == pytest.approx(600e3 * ratio**2, rel=1e-12)
    assert list(train.graph.senses) == [1, -1, -1, -1, 1]
