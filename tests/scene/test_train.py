"""Mistakes in scenes of trains, told before anything is computed."""

import pytest
from tests.trains import row, stage

from fenics_gears import GearsError, SceneError, train_from_text

TWO = stage("first", 2.0, (20, 30)) + stage("second", 3.0, (20, 40))
ROW = row([24, 31, 40], [0, 60], 100).text
LOAD = '[load]\noutput_torque = "400 N m"'
DENSITY = '[inertia]\ndensity = "7.8 g/cm^3"\n'
MOVING = '[motion]\ninput_speed = "900 rpm"\nmesh_cycles = 3'
RAMP = f'{TWO}{LOAD}\n{DENSITY}{MOVING}\n[speed_ramp]\nend_speed = "1200 rpm"\n'
SHAFT = '[shafts.one]\ncarries = ["{}"]\ntorsional_stiffness = "1e8 N mm/rad"'


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (TWO, r"\[load\]|load\n    is missing"),
        (f'{TWO}[load]\npower = "3 kW"', "needs a speed"),
        (f'{TWO}[load]\nwheel_torque = "3 N m"', "is not known here.*output_torque"),
        (f'{TWO}[load]\noutput_torque = "3 N m"\ninput_torque = "1 N m"', "output_torque"),
        (f"{TWO}{LOAD}\n[eccentricity]\n", "is not of a train"),
        (f"{TWO}{LOAD}\n[speed_ramp]\n", r"speed_ramp.end_speed\n    is missing"),
        (f'{TWO}{LOAD}\n[speed_ramp]\nend_speed = "9 rpm"', r"needs the section \[inertia\]"),
        (f'{RAMP}end_frequency = "9 Hz"', "is not known here.*end_speed"),
        (RAMP.replace("1200", "900"), "is the speed at the start"),
        (f"{RAMP}hold_cycles = 3", "leaves no cycle of motion.mesh_cycles = 3"),
        (RAMP.replace("output_torque", "power").replace("N m", "kW"), "has no constant torque with"),
        (f"{TWO}{LOAD}\n{DENSITY}[motion]\nmesh_cycles = 3", r"motion.input_speed\n    is missing, which \[inertia\]"),
        (f'{TWO}{LOAD}\n{DENSITY}[motion]\ninput_speed = "9 rpm"', r"motion.mesh_cycles\n    is missing"),
        (f"{TWO}{LOAD}\n[damping]\nratio = 0.1", r"needs the section \[inertia\]"),
        (f"{TWO}{LOAD}\n[damping]\nratio = 0.1\n[damping.pinion]", "is of a pair. Allowed: one damping"),
        (f"{TWO}{LOAD}\n[shafts]\nstiff = 3", r"sections \[shafts.NAME\]"),
        (
            f"{TWO}{LOAD}\n{SHAFT.format('first.weel')}",
            '"first.weel"\n    is no gear of this train. Did you mean "first.wheel"',
        ),
        (f"{TWO}{LOAD}\n{SHAFT.format('first.wheel')}", 'carry: "first.pinion"; "first.wheel", "second.pinion"; "sec'),
        (
            f"{TWO}{LOAD}\n{DENSITY}{SHAFT.format('second.wheel')}\n{MOVING}",
            r"inertia.load\n    is missing. The far end of the last shaft",
        ),
        (stage("one", 2.0, (20, 30), '[stages.one.inertia]\ndensity = "7.8 g/cm^3"') + LOAD, "is of one stage"),
        (f"{TWO}{LOAD}\n[tip_relief]\n", r"\[stages.NAME.tip_relief\]"),
        (f'[stages.one]\nkind = "planets"\n{LOAD}', 'is no kind of stage. Allowed: "pair", "row" or "planetary"'),
        (f'[stages.one]\nkind = "row"\ngears = [{{ teeth = 20 }}]\n{LOAD}', "has not the gears of a row"),
        (f"[stages]\n{LOAD}", "has no stages"),
        (f"load = 5\n{TWO}", "load = 5.* is not a section. Write a line .load.,"),
        (f"title = 3\n{TWO}{LOAD}", "title = 3\n    is not a text"),
        (stage('".."', 2.0, (20, 30)) + LOAD, "is no name of a stage"),
        (stage("one", 2.0, (20, 30), 'direction = "3 mm"') + LOAD, "is no angle"),
        (
            stage("one", 2.0, (20, 30), "[stages.one.bearings]\nx = 3") + LOAD,
            r"stages.one.bearings.x = 3.*not a known field of \[bearings\]",
        ),
        (stage("one", 2.0, (20, 30), "[stages.one.torque_ripple]\nx = 3") + LOAD, "is not yet computed of a stage"),
        (ROW.replace("[load]", "[stages.row.eccentricity]\n[load]"), "says of no gear what it has"),
        (ROW.replace("[load]", "[stages.row.body_meshes]\n[load]"), "where a gear has several mates"),
        (stage("one", 2.0, (20, 30)).replace("teeth = 30", "tooth = 30") + LOAD, "train:7: stages.one.wheel.tooth"),
        (stage("one", 2.0, (20, 30)) + LOAD + "\n[accuracy]\nelements = 3", "accuracy.elements = 3"),
    ],
)
def test_mistakes_are_told(text, said):
    """Each says where it is and what is allowed."""
    with pytest.raises(GearsError, match=f"(?s){said}"):
        train_from_text(text)


def test_mistakes_of_all_meshes_are_told_at_once():
    """The list; a gear of two meshes is told once, by its own name."""
    text = row([24, 31, 40], [0, 60], 100).text
    wrong = text.replace("teeth = 24", "teeth = 3").replace("teeth = 31", "teeth = 31, face = 2")
    with pytest.raises(SceneError) as caught:
        train_from_text(wrong.replace("teeth = 40", "teeth = 4"))
    assert [".".join(each.path) for each in caught.value.problems] == [
        "stages.row.gears.1.teeth",
        "stages.row.gears.2.face",
        "stages.row.gears.3.teeth",
    ]
    assert "is not a known field of [stages.row.gears.2]" in str(caught.value)


def test_an_idler_that_both_mates_would_thin_differently_is_refused():
    """Backlash is shared by both gears of a mesh; an idler has one tooth thickness in two meshes."""
    with pytest.raises(SceneError, match="would thin the teeth of a gear differently"):
        train_from_text(row([24, 31, 40], [0, 60], 100).text.replace("[load]", 'backlash = "0.1 mm"\n[load]', 1))


def test_an_idler_has_one_tip_circle():
    """Profile shifts shorten the tips of a mesh; of an idler the shorter tip holds in both of its meshes."""
    text = row([24, 31, 40], [0, 60], 100).text.replace("profile_shift = 0", "profile_shift = 0.6", 2)
    first, second = train_from_text(text).meshes
    assert first.pair.wheel == second.pair.pinion


def test_torques_and_speeds_follow_from_the_ratios():
    """Without losses the torque grows by the ratio; mesh frequencies are those of each shaft's teeth."""
    train = train_from_text(f'{TWO}[load]\npower = "2 kW"\n[motion]\ninput_speed = "1200 rpm"')
    assert train.input_torque == pytest.approx(2e6 / (2.0 * 3.141592653589793 * 20.0), rel=1e-12)
    assert train.output_torque == pytest.approx(3.0 * train.input_torque, rel=1e-12)
    frequencies = [mesh.scene.motion.mesh_frequency for mesh in train.meshes]
    assert frequencies == pytest.approx([400.0, 20.0 * 20.0 / 1.5], rel=1e-12)


def test_an_idler_does_not_twist():
    """Between the meshes of one gear there is no shaft."""
    text = row([24, 31, 40], [0, 60], 100).text
    with pytest.raises(SceneError, match="is of an idler"):
        train_from_text(f"{text}\n{SHAFT.format('row.2')}")


def test_meshes_of_a_row_have_one_frequency():
    """To the last digit, whatever the numbers of teeth: a cycle of one is a cycle of all, and no step more."""
    meshes = row([24, 31, 40, 25], [0, 60, 20], 100).meshes
    assert {mesh.scene.motion.mesh_frequency for mesh in meshes} == {1.0}
