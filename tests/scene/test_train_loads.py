"""Mistakes in loads and speeds by shafts, told before anything is computed."""

import pytest
from tests.scene.test_train import DENSITY, MOVING, SHAFT, TWO
from tests.simulation.test_train_loads import branches, torques

from fenics_gears import SceneError, train_from_text

BOTH = torques(("main.wheel", 300.0), ("pump.wheel", 90.0))
ON_THE_SHAFT = f'[load]\noutput_torque = "400 N m"\n{torques(("first.wheel", 50.0))}\n'


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (branches('output_torque = "300 N m"'), '"main.wheel" and "pump.wheel" drive no gear.* on = "main.wheel"'),
        (branches(torques(("pump.wheel", 90.0))), 'that of the shaft of "main.wheel". Allowed: one of output_torque'),
        (branches(f'{BOTH}\ninput_torque = "9 N m"'), 'input_torque = "9 N m"\n.*of all shafts that drive no gear'),
        (branches(torques(("pump.weel", 90.0))), 'on = "pump.weel"\n.*Did you mean "pump.wheel".*"drive"'),
        (branches(torques(("drive", 90.0))), "on the driven shaft.*whose torque follows"),
        (branches(torques(("pump.wheel", 9.0), ("pump.wheel", 8.0))), "has a torque already"),
        (branches("torques = []"), "load.torques = .*is empty"),
        (branches('torques = [{ on = "pump.wheel" }]'), "has no torque at place 1"),
        (branches('input_torque = "60 N m"\n' + torques(("pump.wheel", 90.0))), "take 60 N m: nothing is left"),
        (branches(BOTH.replace(" }", ', moment_of_inertia = "1 kg m^2" }', 1)), r"needs \[inertia\]"),
        (branches(BOTH, '[motion]\nspeed = "9 rpm"'), "motion.speed_of\n.*is missing"),
        (branches(BOTH, '[motion]\nspeed_of = "main.wheel"'), "names a shaft without a speed"),
        (branches(BOTH, '[motion]\nspeed = "9 rpm"\nspeed_of = "main"'), "is no gear and no shaft"),
        (branches(BOTH, '[motion]\nspeed = "9 rpm"\ninput_speed = "9 rpm"\nspeed_of = "drive"'), "given together with"),
        (branches(BOTH, f"{DENSITY}{MOVING}\n{SHAFT.format('main.wheel')}"), "whose far end needs one"),
        (TWO + ON_THE_SHAFT + SHAFT.replace('"{}"', '"first.wheel", "second.pinion"'), "twists or bends"),
    ],
)
def test_mistakes_are_told(text, said):
    """Each says where it is and what is allowed."""
    with pytest.raises(SceneError, match=f"(?s){said}"):
        train_from_text(text)


def test_all_mistakes_of_loads_are_told_at_once():
    """The list of them."""
    wrong = torques(("pump.weel", 9.0), ("drive", 8.0))
    with pytest.raises(SceneError) as caught:
        train_from_text(branches(wrong, '[motion]\nspeed = "9 rpm"\nspeed_of = "main"'))
    assert [".".join(each.path) for each in caught.value.problems] == [
        "load.torques.1.on",
        "load.torques.2.on",
        "motion.speed_of",
    ]
