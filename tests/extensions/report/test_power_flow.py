"""The power flow of trains."""

import pytest
from tests.trains import COARSE, gear_text, mate, two_stages

from fenics_gears import simulate_train, train_from_text
from fenics_gears.extensions.report.power_flow import power_flow

FRICTION = "[friction]\ncoefficient = 0.08\n"


def test_power_is_lost_mesh_by_mesh():
    """Balance of power: the load has its torque, and what goes in is more by the loss of the whole."""
    train = two_stages(more=FRICTION)
    found = simulate_train(train)
    flow = power_flow(found, train)
    assert flow.shafts[-1].torque == train.output_torque
    assert flow.shafts[-1].power / flow.shafts[0].power == pytest.approx(1.0 - found.attrs["friction_loss"], rel=1e-12)
    assert flow.efficiency == pytest.approx(1.0 - found.attrs["friction_loss"], rel=1e-12)
    assert flow.shafts[0].speed == pytest.approx(3.0 * flow.shafts[-1].speed)


def test_a_torque_between_stages_loads_those_before_it():
    """Statics: 400 N m through 2, with 50 N m on the shaft between the stages, through 1.5."""
    load = 'torques = [{ on = "first.wheel", torque = "50 N m" }]'
    train = train_from_text(two_stages().text.replace('"400 N m"', f'"400 N m"\n{load}'))
    flow = power_flow(simulate_train(train), train)
    assert [each.torque for each in flow.shafts] == pytest.approx([250e3 / 1.5, 250e3, 400e3], rel=1e-12)


def test_two_outputs_and_the_loss_take_the_power():
    """Balance of power: that of the input is that of both outputs and of the loss."""
    text = mate("a", gear_text(20, 2.0), gear_text(30, 2.0), 0.0) + mate("b", '"a.pinion"', gear_text(40, 2.0), 150.0)
    torques = ", ".join(
        f'{{ on = "{name}.wheel", torque = "{torque} N m" }}' for name, torque in (("a", 60), ("b", 120))
    )
    load = f"[load]\ntorques = [{torques}]\n[accuracy]\n{COARSE}\n"
    train = train_from_text(text + load + FRICTION + '[motion]\ninput_speed = "1500 rpm"')
    found = simulate_train(train)
    flow = power_flow(found, train)
    loss = float(found["friction_loss"].values[-1])
    assert 0.001 < loss < 0.05
    assert flow.shafts[0].power * (1.0 - loss) == pytest.approx(sum(each.power for each in flow.shafts[1:]), rel=1e-12)
