"""Trains with loads on several shafts."""

import numpy as np
import pytest
from tests.trains import COARSE, stage, two_stages

from fenics_gears import simulate_train, train_from_text

SHORT = f"[accuracy]\n{COARSE}\n"


def branches(load: str, more: str = "") -> str:
    """Two stages whose pinions stand on the driven shaft, each with an output of its own."""
    one = stage("main", 2.0, (20, 40))
    other = stage("pump", 2.0, (20, 30), 'direction = "180 deg"')
    return f'{one}{other}[shafts.drive]\ncarries = ["main.pinion", "pump.pinion"]\n[load]\n{load}\n{SHORT}{more}'


def torques(*named: tuple[str, float]) -> str:
    listed = (f'{{ on = "{name}", torque = "{torque!r} N m" }}' for name, torque in named)
    return f"torques = [{', '.join(listed)}]"


def test_branches_on_a_rigid_shaft_are_pairs():
    """Law: the driven shaft turns as prescribed, so that neither branch feels the other; each lags as its pair does
    by itself under its torque, and with power going to both outputs the input has the sum, each through its ratio."""
    text = branches(f"output_torque = '300 N m'\n{torques(('pump.wheel', 90.0))}")
    train = train_from_text(text)
    assert train.input_torque == pytest.approx(1e3 * (300.0 / 2.0 + 90.0 / 1.5), rel=1e-12)
    found = simulate_train(train)
    lags = found["output_transmission_error"]
    for name, teeth, torque in (("main", (20, 40), 300), ("pump", (20, 30), 90)):
        alone = f'{stage(name, 2.0, teeth)}[load]\noutput_torque = "{torque} N m"\n{SHORT}'
        pair = simulate_train(train_from_text(alone))
        own = pair["transmission_error"].values[:-1, 0]
        both = lags.sel(output=f"{name}.wheel").values
        assert np.ptp(both) == pytest.approx(np.ptp(own), rel=1e-6)
        assert both[:-1].mean() == pytest.approx(own.mean(), rel=1e-9)
    assert float(found.attrs["peak_to_peak_overall_transmission_error"]) == np.ptp(lags.sel(output="main.wheel").values)


@pytest.mark.parametrize(
    ("load", "motion"),
    [
        (torques(("main.wheel", 300.0), ("pump.wheel", 90.0)), ""),
        ('input_torque = "210 N m"\n' + torques(("pump.wheel", 90.0)), ""),
        (
            'power = "21 kW"\n' + torques(("pump.wheel", 90.0)),
            '[motion]\nspeed = "50 rad/s"\nspeed_of = "main.wheel"',
        ),
    ],
)  # fmt: skip
def test_what_is_left_out_follows(load, motion):
    """Balance of power without losses: 210 N m on the input are 300 N m and 90 N m on outputs at 1/2 and 2/3 turn;
    an output at 50 rad/s has the input turn at 100 rad/s."""
    train = train_from_text(branches(load, motion))
    of_gears = {carried[0]: torque for carried, torque in zip(train.shafts.carried, train.loads)}
    assert of_gears == pytest.approx({"main.pinion": 0.0, "main.wheel": 3e5, "pump.wheel": 9e4})
    assert train.input_torque == pytest.approx(2.1e5, rel=1e-12)
    if motion:
        assert train.input_speed == pytest.approx(100.0 / (2.0 * np.pi), rel=1e-12)


def test_a_torque_between_stages_loads_those_before_it():
    """Statics: the first mesh carries what the second hands on and the torque on the shaft between them, the second
    mesh that of the last shaft alone; without friction each has torque over base radius."""
    load = torques(("first.wheel", 50.0))
    train = train_from_text(two_stages().text.replace('"400 N m"', f'"400 N m"\n{load}'))
    found = simulate_train(train)
    for mesh, torque in zip(train.meshes, (400.0 / 2.0 + 50.0, 400.0)):
        force = found["normal_force"].sel(mesh=mesh.name).dropna("step").values
        assert force == pytest.approx(1e3 * torque / mesh.pair.wheel.base_radius, rel=1e-9)
