"""Trains whose stages move together: masses, bearings, and shafts that twist."""

import numpy as np
import pytest
from tests.trains import COARSE, row, row_section, stage, two_stages

from fenics_gears import ComputationError, scene_from_text, simulate, simulate_train, train_from_text

INERTIA = '\n[inertia]\ndensity = "7.85 g/cm^3"\n[inertia.load]\nmoment_of_inertia = "0.05 kg m^2"\n'
BEARINGS = '\n[bearings]\nstiffness = "2e5 N/mm"\n'
FRICTION = "\n[friction]\ncoefficient = 0.08\n"


def shaft(name: str, gears: str, stiffness: float) -> str:
    return f'\n[shafts.{name}]\ncarries = [{gears}]\ntorsional_stiffness = "{stiffness} N mm/rad"\n'


def motion(speed: float, cycles: int) -> str:
    return f'\n[motion]\ninput_speed = "{speed} rpm"\nmesh_cycles = {cycles}\n'


@pytest.mark.parametrize("damping", ["ratio = 0.05", 'stiffness_proportional = "1e-5 s"\nmass_proportional = "3 1/s"'])
def test_a_train_of_one_mesh_vibrates_as_the_pair(damping):
    """With masses, shafts that twist at both ends, bearings, damping and friction it has the pair's motion, force for
    force: two ways to the same equations. Gears are not equally wide, and coast flanks may touch."""
    more = 'backlash = "0.05 mm"\n[stages.one.coast_flanks]' if "ratio" in damping else ""
    gears = stage("one", 3.0, (20, 40), more).replace("teeth = 40", 'teeth = 40, face_width = "25 mm"')
    both = f'{INERTIA}[damping]\n{damping}{FRICTION}[bearings]\nstiffness_x = "2e5 N/mm"\nstiffness_y = "1e5 N/mm"\n'
    both += f"[accuracy]\n{COARSE}\n"
    ends = shaft("a", '"one.pinion"', 1e8) + shaft("b", '"one.wheel"', 2e8)
    train = train_from_text(f'{gears}[load]\noutput_torque = "400 N m"{motion(1500, 3)}{both}{ends}')
    of_pair = '[load]\nwheel_torque = "400 N m"\n[motion]\npinion_speed = "1500 rpm"\nmesh_cycles = 3\n'
    ends = '[shafts.input]\ntorsional_stiffness = "1e8 N mm/rad"\n[shafts.output]\ntorsional_stiffness = "2e8 N mm/rad"'
    gears = gears.replace("stages.one.coast", "coast").replace("stages.one", "gears")
    expected = simulate(scene_from_text(f"{gears}{of_pair}{both}{ends}"))
    found = simulate_train(train).isel(mesh=0)
    for name in ("transmission_error", "normal_force", "centre_x", "centre_y", "rotation"):
        assert found[name].values == pytest.approx(expected[name].values, rel=1e-9, abs=1e-15), name
    assert float(found["friction_loss"]) == pytest.approx(expected.attrs["friction_loss"], rel=1e-9)


def test_a_shaft_that_twists_at_rest_adds_its_twist():
    """Without masses the torque of a shaft is constant: its stages have what they have on rigid shafts, and the last
    gear lags by the shaft's twist through the ratio behind it besides."""
    rigid = simulate_train(two_stages())
    stiffness = 1e8
    twisting = simulate_train(two_stages(more=shaft("middle", '"first.wheel", "second.pinion"', stiffness)))
    # Of the first stage; steps of the second are made as long in time.
    own = float(rigid["mean_transmission_error"][0])
    assert float(twisting["mean_transmission_error"][0]) == pytest.approx(own, rel=1e-9)
    twist = 0.5 * 400e3 / stiffness
    lag = twisting["overall_transmission_error"].values
    errors = twisting["transmission_error"].values
    assert lag == pytest.approx(errors[:, 1] + 0.5 * (errors[:, 0] + twist), rel=1e-9)


@pytest.mark.parametrize("direction", [0.0, 60.0, -80.0])
def test_the_bearing_of_an_idler_carries_both_of_its_forces(direction):
    """Without friction each mesh presses along its line of action with torque over base radius. Seen from the front,
    with gear 1 turning counter-clockwise, the first line leans by the pressure angle from the way that the first pitch
    point moves, towards gear 2, and the second likewise towards gear 3."""
    scene = row([24, 31, 40], [20, 20 + direction], 300, more=BEARINGS)
    found = simulate_train(scene).isel(mesh=0)
    force = 300e3 / scene.meshes[1].pair.wheel.base_radius
    first, second = (mesh.pair.operating_pressure_angle for mesh in scene.meshes)
    along = np.deg2rad(20.0) + 0.5 * np.pi - first
    # The idler turns clockwise; gear 3 pushes back on it.
    of_second = np.deg2rad(20.0 + direction) - 0.5 * np.pi + second + np.pi
    both = force * np.array([np.cos(along) + np.cos(of_second), np.sin(along) + np.sin(of_second)])
    axes = np.array([[np.cos(along), np.sin(along)], [-np.sin(along), np.cos(along)]])
    moved = np.array([float(found[f"centre_{axis}"].isel(gear=1)[3]) for axis in "xy"])
    assert 2e5 * moved == pytest.approx(axes @ both, rel=1e-9, abs=1e-6 * force)


def test_a_row_behind_a_stage_is_its_mirror_image():
    """Its first gear turns clockwise: the idler stands in its second mesh as in the mirrored row, driven the other way
    round."""
    idlers = row_section((24, 31, 40), (10, 75))
    load = '[load]\noutput_torque = "400 N m"\n'
    behind = train_from_text(stage("first", 2.0, (20, 30)) + idlers + load).layout
    alone = row([24, 31, 40], [-10, -75], 400).layout
    assert behind.phases[2] == pytest.approx(alone.phases[1], abs=1e-12)
    assert (behind.shared(3, 1, 2).tooth - alone.shared(1, 0, 1).tooth) % 31 == 0


def test_a_train_of_one_mesh_on_a_ramp_is_the_pair():
    """Identity: the same times of steps and inertia forces of the accelerating motion, on shafts that twist."""
    gears = stage("one", 3.0, (20, 40))
    both = f"{INERTIA}[damping]\nratio = 0.05\n{FRICTION}[accuracy]\n{COARSE}\n"
    of_train = of_pair = ""
    for name, gear, stiffness in zip(("input", "output"), ("pinion", "wheel"), (1e8, 2e8)):
        of_train += shaft(name, f'"one.{gear}"', stiffness)
        of_pair += f'[shafts.{name}]\ntorsional_stiffness = "{stiffness} N mm/rad"\n'
    ramp = '[speed_ramp]\nend_speed = "2400 rpm"\nhold_cycles = 1\n'
    train = train_from_text(f'{gears}[load]\noutput_torque = "400 N m"{motion(1500, 4)}{both}{ramp}{of_train}')
    load = '[load]\nwheel_torque = "400 N m"\n[motion]\nmesh_frequency = "500 Hz"\nmesh_cycles = 4\n'
    ramp = '[speed_ramp]\nend_frequency = "800 Hz"\nhold_cycles = 1\n'
    expected = simulate(scene_from_text(f"{gears.replace('stages.one', 'gears')}{load}{both}{ramp}{of_pair}"))
    found = simulate_train(train)
    assert found["time"].values == pytest.approx(expected["time"].values, rel=1e-12)
    for name in ("transmission_error", "normal_force", "rotation", "mesh_frequency"):
        assert found.isel(mesh=0)[name].values == pytest.approx(expected[name].values, rel=1e-9, abs=1e-15), name


@pytest.mark.parametrize("strong", ["first", "second"])
def test_friction_locks_the_mesh_that_has_it(strong):
    """By lever arms: where the coefficient times the roll angle of the wheel's tip is below 1 friction cannot lock, so
    that only the mesh with the strong friction does, wherever it stands; there is no efficiency then."""
    friction = "".join(
        f"[stages.{name}.friction]\ncoefficient = {2.0 if name == strong else 0.1}\n" for name in ("first", "second")
    )
    found = simulate_train(two_stages(more=friction + BEARINGS))
    said = [each for each in found.attrs["warnings"].splitlines() if "self-locking" in each]
    assert [each.partition(":")[0] for each in said] == [strong]
    assert "friction_loss" not in found.attrs


def test_meshes_of_a_train_say_what_their_pair_says():
    """Each assumption that a result breaks: rotations that are not small, teeth that went through each other, contact
    at the end of its window. A train of one mesh is its pair; before, it said nothing."""
    accuracy = f'{COARSE}\ncontact_length = "0.3 mm"\nelastic_teeth = 2\n'
    gears = stage("one", 3.0, (20, 40))
    soft = f'[bearings]\nstiffness = "50 N/mm"\n[accuracy]\n{accuracy}'
    expected = simulate(
        scene_from_text(f'{gears.replace("stages.one", "gears")}[load]\nwheel_torque = "400 N m"\n{soft}')
    )
    found = simulate_train(train_from_text(f'{gears}[load]\noutput_torque = "400 N m"\n{soft}'))
    said = found.attrs["warnings"].splitlines()
    words = ("no meaning", "end of the contact window", "the wheel turns by")
    for each in words:
        (of_pair,) = [line for line in expected.attrs["warnings"].splitlines() if each in line]
        assert f"one: {of_pair}" in said
    assert "no meaning" in said[0]


def test_a_ramp_that_pulls_the_teeth_apart_is_named():
    """The masses of 0.05 kg m^2 are slowed by more than 400 N m slow them: a pair names its ramp too."""
    ramp = '[speed_ramp]\nend_speed = "1 rpm"\n'
    with pytest.raises(ComputationError, match=r"first: .*\[speed_ramp\] accelerates .* a longer ramp"):
        simulate_train(two_stages(more=f"{INERTIA}{motion(9000, 2)}{ramp}"))
