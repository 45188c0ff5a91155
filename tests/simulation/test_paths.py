"""Trains of several paths, whose meshes share the torque."""

from math import asin, degrees, radians, sin

import numpy as np
import pytest
from tests.contact.test_row import overall_errors
from tests.scene.test_paths import loop_of_gears
from tests.trains import COARSE, gear_text, mate, split_text

from fenics_gears import simulate_train, train_from_text
from fenics_gears.elasticity.cache import Cache
from fenics_gears.model.train import train_model_of
from fenics_gears.simulation.train import row_cycle
from fenics_gears.system.progress import SilentProgress

# Teeth that leave each other alone, and contact nodes that do not depend on the load.
APART = 'elastic_teeth = 1\ncontact_length = "2 mm"'


def run(text: str):
    return simulate_train(train_from_text(text))


def one_path(torque: float) -> str:
    """The first path of two by itself."""
    text = split_text(torque=torque, accuracy=APART)
    stages = text[: text.index("[stages.in2]")], text[text.index("[stages.out1]") : text.index("[stages.out2]")]
    return "".join(
        [*stages, text[text.index("[shafts.path1]") : text.index("[shafts.path2]")], text[text.index("[load]") :]]
    )


@pytest.mark.parametrize(("paths", "teeth"), [(2, (20, 40, 20, 40)), (3, (21, 45, 21, 45))])
def test_equal_paths_share_evenly(paths, teeth):
    """Turned by a whole number of teeth of its middle gears, the train is itself: each path carries the same at every
    step, also through bodies that all meshes of a gear load."""
    found = run(split_text(paths, teeth=teeth))
    assert found["path_share"].values == pytest.approx(np.full((len(found["step"]), 2 * paths), 1.0 / paths), abs=1e-9)
    for name in ("mean", "largest", "least"):
        assert found[f"{name}_path_share"].values == pytest.approx(np.full(2 * paths, 1.0 / paths), abs=1e-9)


def test_equal_paths_have_the_transmission_error_of_one_under_its_part():
    """Bodies between which nothing couples: two paths under a torque lag as one of them under half of it."""
    found = run(split_text(accuracy=APART))
    alone = run(one_path(200.0))
    lag = alone["overall_transmission_error"].values
    assert found["overall_transmission_error"].values == pytest.approx(lag, rel=1e-9)
    assert found.attrs["mean_overall_transmission_error"] == pytest.approx(lag[:-1].mean(), rel=1e-9)


def test_clocking_moves_load_from_path_to_path():
    """Turned ahead by beta, a shaft takes k_t beta/(2 T) more of the torque T of both shafts; k_t: the torsional
    stiffness of each path there (two springs side by side); the last shaft moves on by half of beta times its ratio.
    The law holds for the slope of the curve, at every step."""
    change = 1e-2
    lag = [run(one_path(200.0 + sign * change))["overall_transmission_error"].values for sign in (1.0, -1.0)]
    # Of the last shaft (rad per N mm); the ratio to it is 1/2.
    stiffness = 0.25 * 2e3 * change / (lag[0] - lag[1])
    clocking = 2e-8
    ahead, back = (
        run(split_text(accuracy=APART, of_shaft=f'clocking = "{sign * clocking} rad"')) for sign in (1.0, -1.0)
    )
    moved = (ahead["path_share"] - back["path_share"]).values / (2.0 * clocking)
    for mesh in (1, 3):
        assert moved[:, mesh] == pytest.approx(stiffness / (2.0 * 200e3), rel=1e-5)
        assert moved[:, mesh - 1] == pytest.approx(-moved[:, mesh], rel=1e-5)
    lag = (ahead["overall_transmission_error"] - back["overall_transmission_error"]).values / (2.0 * clocking)
    assert lag == pytest.approx(np.full(len(lag), -0.25), rel=1e-5)
    # Each mesh has its own error, to which clocking adds but what its load changes.
    assert float(np.abs(ahead["transmission_error"] - back["transmission_error"]).max()) < 2.0 * clocking


def test_a_path_that_is_turned_back_too_far_carries_nothing():
    """Its teeth do not touch with force, and the other path has what it would have alone."""
    found = run(split_text(accuracy=APART, of_shaft='clocking = "-0.01 rad"'))
    assert found["path_share"].isel(mesh=[0, 2]).values == pytest.approx(1.0, abs=1e-12)
    alone = run(one_path(400.0))
    lag = alone["overall_transmission_error"].values
    assert found["overall_transmission_error"].values == pytest.approx(lag, rel=1e-9)


def test_torques_balance_on_every_shaft():
    """Without friction the forces of each shaft's meshes, times base radii, add up to nothing, at every step, whatever
    the shares of paths of different teeth are."""
    paths = loop_of_shafts()
    train = train_from_text(paths)
    found = simulate_train(train)
    forces = found["normal_force"].values
    pairs = [mesh.pair for mesh in train.meshes]
    graph = train.graph
    assert float(np.ptp(found["path_share"].values[:, 0])) > 1e-3
    for shaft in range(1, graph.last):
        driven = sum(forces[:, mesh] * pairs[mesh].base_radii[1] for mesh in graph.into(shaft))
        driving = sum(forces[:, mesh] * pairs[mesh].base_radii[0] for mesh in graph.out_of(shaft))
        assert driving == pytest.approx(driven, rel=1e-9)
    load = sum(forces[:, mesh] * pairs[mesh].base_radii[1] for mesh in graph.into(graph.last))
    assert load == pytest.approx(np.full(len(forces), 400e3), rel=1e-9)


def loop_of_shafts() -> str:
    """Two paths at angles of 70 degrees, whose meshes have other phases."""
    further = degrees(asin(60.0 * sin(radians(70.0)) / 80.0))
    text = split_text(teeth=(20, 40, 20, 60))
    for before, after in (
        ('"180.0 deg"', '"-70.0 deg"'),
        ('"180.0 deg"', f'"{-further!r} deg"'),
        ('"0.0 deg"', '"70.0 deg"'),
    ):
        text = text.replace(before, after, 1)
    return text.replace('"0.0 deg"', f'"{further!r} deg"')


def test_a_loop_of_gears_driven_from_its_other_end_has_the_same_transmission_error(tmp_path):
    """As of a row: phases, teeth and the coupling of a gear that drives two others, on the same flanks, have to be
    right for this, and of one that two others drive. No shaft of the loop could be turned."""
    angles = (45.893835, 23.729829)
    one, other = angles
    driven = train_from_text(f"{loop_of_gears(one, -other, -one, other)}\n[accuracy]\n{COARSE}")
    text = reversed_loop(one, other)
    mirrored = train_from_text(text)
    cache = Cache(tmp_path)

    def errors(model, steps):
        return overall_errors(model, row_cycle(model, SilentProgress(), cache), steps)

    steps = np.array([3.0, 5.75, 10.0, 14.5, 17.25])
    (model,) = train_model_of(driven).rows
    # The mesh that is the last in the first train is the first in the other.
    phase = mirrored.layout.phases[1]
    ahead = model.models[0].pair.contact_ratio - steps / 20.0 - phase
    found = errors(model, steps) * 60.0 / 20.0
    (model,) = train_model_of(mirrored).rows
    assert errors(model, (ahead % 1.0) * 20.0) == pytest.approx(found, rel=1e-8)


def reversed_loop(one: float, other: float) -> str:
    """The mirror image of the loop of gears of 20, 31 and 60 teeth, driven from its last gear."""
    first, idler, last = (gear_text(each, 2.0) for each in (20, 31, 60))
    text = mate("b", last, idler, 180.0 + other) + mate("a", '"b.wheel"', first, 180.0 - one)
    text += mate("d", '"b.pinion"', idler, 180.0 - other) + mate("c", '"d.wheel"', '"a.wheel"', 180.0 + one)
    return f'{text}\n[load]\noutput_torque = "{400.0 / 3.0!r} N m"\n[accuracy]\n{COARSE}'
