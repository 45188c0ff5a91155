"""Equations of motion of trains."""

import numpy as np
import pytest
from scipy.linalg import eigh
from tests.trains import bent_two_stages, row, split_text, stage, two_stages

from fenics_gears import train_from_text
from fenics_gears.dynamics.frequencies import natural_frequencies
from fenics_gears.model.train import train_model_of
from fenics_gears.model.train_motion_rows import frequencies_of_train, motion_rows
from fenics_gears.model.train_parts import whole_steps

MORE = """
    [inertia]
    density = "7.85 g/cm^3"
    [inertia.load]
    moment_of_inertia = "0.05 kg m^2"
    [motion]
    input_speed = "1500 rpm"
    mesh_cycles = 2
    """


def test_natural_frequencies_of_two_outputs():
    """Rotors in their rotations in space, joined by torsional springs and by mesh springs between base circles: the
    matrices of textbooks (Rao, Mechanical Vibrations, branched systems), put together here in other coordinates. The
    end of one of two branches is behind a shaft that twists, with a load of its own."""
    side = '{ on = "side.wheel", torque = "90 N m", moment_of_inertia = "0.02 kg m^2" }'
    more = MORE + '[shafts.end]\ncarries = ["side.wheel"]\ntorsional_stiffness = "3e8 N mm/rad"\n'
    more += '[shafts.middle]\ncarries = ["first.wheel", "second.pinion", "side.pinion"]\n'
    stages = stage("side", 2.0, (18, 25), 'direction = "120 deg"') + two_stages(more=more.split("[shafts", 1)[0]).text
    text = stages.replace('"400 N m"', f'"400 N m"\ntorques = [{side}]', 1) + "[shafts" + more.split("[shafts", 1)[1]
    (model,) = train_model_of(train_from_text(text)).rows
    pairs = {mesh.name: mesh.pair for mesh in model.meshes}
    of_mesh = {"side": 2e5, "first": 3e5, "second": 5e5}
    found = natural_frequencies(model.drivetrain, np.array([of_mesh[mesh.name] for mesh in model.meshes]))
    said = {name: value for name, value, _ in motion_rows(model)}
    gears = ("first.wheel", "second.pinion", "side.pinion", "second.wheel", "side.wheel")
    one, two, three, last, end = (1e-3 * said[f"{name}: moment of inertia"] for name in gears)
    (of_side,) = (value for name, value in said.items() if name.startswith("load on shaft"))
    # The middle shaft, the second wheel with its load, the wheel at the side, its load.
    masses = [one + two + three, last + 1e-3 * said["load: moment of inertia"], end, 1e-3 * of_side]
    rows = [
        (of_mesh["first"], [pairs["first"].wheel.base_radius, 0, 0, 0]),
        (of_mesh["second"], [pairs["second"].pinion.base_radius, pairs["second"].wheel.base_radius, 0, 0]),
        (of_mesh["side"], [pairs["side"].pinion.base_radius, 0, pairs["side"].wheel.base_radius, 0]),
        (3e8, [0, 0, 1, -1]),
    ]
    stiffness = sum(spring * np.outer(along, along) for spring, along in rows)
    squares = eigh(stiffness, np.diag(masses), eigvals_only=True)
    assert found == pytest.approx(np.sqrt(squares) / (2.0 * np.pi), rel=1e-10)


def test_natural_frequencies_of_two_paths():
    """The same of a loop: two shafts that twist between the first gear, which turns as prescribed, and the last."""
    more = '[inertia]\ndensity = "7.85 g/cm^3"\n[motion]\ninput_speed = "1500 rpm"\nmesh_cycles = 2\n'
    text = split_text(of_shaft='torsional_stiffness = "2e8 N mm/rad"', more=more)
    text = text.replace('"out1.pinion"]', '"out1.pinion"]\ntorsional_stiffness = "1e8 N mm/rad"', 1)
    (model,) = train_model_of(train_from_text(text)).rows
    pairs = [mesh.pair for mesh in model.meshes]
    of_mesh = [3e5, 4e5, 5e5, 6e5]
    found = natural_frequencies(model.drivetrain, np.array(of_mesh))
    names = ("in1.wheel", "out1.pinion", "in2.wheel", "out2.pinion", "out1.wheel")
    masses = [1e-3 * each for each in moments(model, names)]
    rows = [
        (of_mesh[0], [pairs[0].wheel.base_radius, 0, 0, 0, 0]),
        (of_mesh[1], [0, 0, pairs[1].wheel.base_radius, 0, 0]),
        (1e8, [1, -1, 0, 0, 0]),
        (2e8, [0, 0, 1, -1, 0]),
        (of_mesh[2], [0, pairs[2].pinion.base_radius, 0, 0, pairs[2].wheel.base_radius]),
        (of_mesh[3], [0, 0, 0, pairs[3].pinion.base_radius, pairs[3].wheel.base_radius]),
    ]
    stiffness = sum(spring * np.outer(along, along) for spring, along in rows)
    squares = eigh(stiffness, np.diag(masses), eigvals_only=True)
    assert found == pytest.approx(np.sqrt(squares) / (2.0 * np.pi), rel=1e-10)


def moments(model, names) -> list[float]:
    """Moments of inertia (g mm^2) as `gears check` says them, in kg mm^2 times 1000."""
    said = {name: value for name, value, _ in motion_rows(model)}
    return [said[f"{name}: moment of inertia"] for name in names]


def test_all_meshes_have_steps_of_one_length():
    """Steps of a cycle times the mesh frequency are the same number a second for all; an idler's meshes have one
    frequency."""
    meshes = two_stages().meshes
    steps = whole_steps(meshes, [100, 200])
    frequencies = [mesh.scene.motion.mesh_frequency for mesh in meshes]
    assert np.ptp(np.multiply(steps, frequencies)) < 1e-9 * steps[0] * frequencies[0]
    assert steps[0] >= 100
    assert steps[1] >= 200
    assert len(set(whole_steps(row([24, 31, 40], [0, 60], 300).meshes, [100, 120]))) == 1


def test_what_bends_is_told():
    """A user's expectation of `gears check`: the shaft, its gears and bearings with their places, how stiff it is, its
    mass, and which modes are its bending."""
    more = """
        [inertia]
        density = "7.85 g/cm^3"
        [motion]
        input_speed = "1500 rpm"
        mesh_cycles = 2
        """
    (row,) = train_model_of(bent_two_stages(1.0, more)).rows
    said = {name: (value, words) for name, value, words in motion_rows(row)}
    assert said["shaft middle"][0] == 150.0
    assert "first.wheel at 35, second.pinion at 100; bearings at 15, 135 mm" in said["shaft middle"][1]
    assert {"its stiffness at first.wheel", "its stiffness at second.pinion"} < set(said)
    steel = 7.85e-6 * np.pi / 4.0 * 35.0**2 * 150.0
    assert said["mass of shaft middle"][0] == pytest.approx(steel, rel=1e-6)
    assert any("bending of shaft middle" in words for _, _, words in frequencies_of_train(row))
    (at_rest,) = train_model_of(bent_two_stages()).rows
    assert not frequencies_of_train(at_rest)
