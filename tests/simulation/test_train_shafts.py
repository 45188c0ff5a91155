"""Trains whose shafts bend, with several gears and bearings at places, in whole runs."""

from functools import cache

import numpy as np
import pytest
from tests.elastic_shaft_scenes import E_AXLE, ELASTIC, INPUT, OUTPUT, PINION, ROLLING, SKEWED, WHEEL
from tests.trains import (
    bearing_sections,
    bent_ends,
    bent_paths,
    bent_two_stages,
    gear_text,
    helical_paths,
    helical_row,
    helical_stage,
    mate,
    shaft_section,
)

from fenics_gears import scene_from_text, simulate, simulate_train, train_from_text
from fenics_gears.dynamics.march import Marcher
from fenics_gears.model.train import train_model_of
from fenics_gears.model.train_parts import parts_of
from fenics_gears.simulation.train import row_cycle
from fenics_gears.system.progress import SilentProgress

ACCURACY = """
    [accuracy]
    slices = 5
    layers = 2
    body_element_size = "5 mm"
    steps_per_mesh_cycle = 10
    flank_element_size = "0.25 mm"
    """
INERTIA = '[inertia]\ndensity = "7.85 g/cm^3"\n[inertia.load]\nmoment_of_inertia = "0.01 kg m^2"\n'


def all_bent(compliance: float, of_last: str = "", more: str = "") -> str:
    """Two paths all of whose shafts bend."""
    return bent_ends(bent_paths(compliance, of_last, more), compliance)


# What a pair's sections are called in a train of one mesh.
IN_A_TRAIN = {
    "[shafts.input]": '[shafts.a]\ncarries = ["one.pinion"]',
    "[shafts.output]": '[shafts.b]\ncarries = ["one.wheel"]',
    'material = "ductile cast iron"': 'material = { name = "ductile cast iron" }',
    "bearings.pinion": "shafts.a.bearings",
    "bearings.wheel": "shafts.b.bearings",
    'gear_at = "114 mm"': 'gears_at = ["114 mm"]',
    'gear_at = "60 mm"': 'gears_at = ["60 mm"]',
    'gear_at = "58 mm"': 'gears_at = ["58 mm"]',
    'seat = "integral"': 'seats = ["integral"]',
    'seat = "press fit"': 'seats = ["press fit"]',
}
ON_ROLLING = ROLLING + OUTPUT + WHEEL
BETWEEN = E_AXLE + OUTPUT + WHEEL
# As thick as the bore, on springs that are alike in all directions.
FITTED = (INPUT + PINION).replace("114 mm", "58 mm").replace('"85 mm"', '"110 mm"').replace("35 mm", "27 mm")
FITTED = FITTED.replace("torque_at", 'seat = "press fit"\ntorque_at') + OUTPUT + WHEEL


def pair_and_train(helix: float, shafts: str, vibrating: bool) -> tuple[str, str]:
    """A pair on shafts that bend, and the same as a train of one mesh, seen from another direction."""
    more = '[friction]\ncoefficient = 0.05\n[load]\n{} = "200 N m"\n'
    motion = ""
    if vibrating:
        more = f"[damping]\nratio = 0.05\n{INERTIA}{more}"
        motion = '[motion]\n{} = "3000 rpm"\nmesh_cycles = 2\n'
    gears = helical_stage("one", 3.0, (18, 35), helix).replace("stages.one", "gears")
    pair = gears + ACCURACY + more.format("wheel_torque") + motion.format("pinion_speed") + shafts
    train = helical_stage("one", 3.0, (18, 35), helix, 'direction = "25 deg"') + ACCURACY
    train += more.format("output_torque") + motion.format("input_speed")
    for of_pair, of_train in IN_A_TRAIN.items():
        shafts = shafts.replace(of_pair, of_train)
    return pair, train + shafts


@pytest.mark.parametrize(
    ("helix", "shafts", "vibrating"),
    [
        (15.0, ELASTIC, False),
        (15.0, BETWEEN, False),
        (15.0, ON_ROLLING, True),
        *(
            pytest.param(*each, marks=pytest.mark.nightly)
            for each in (
                (0.0, ELASTIC, False),
                (15.0, ON_ROLLING, False),
                (15.0, ELASTIC, True),
                (15.0, SKEWED, False),
                (15.0, BETWEEN, True),
                (15.0, FITTED, False),
                (0.0, ON_ROLLING, True),
            )
        ),
    ],
)
def test_a_train_of_one_mesh_on_shafts_that_bend_is_the_pair(helix, shafts, vibrating):
    """Two ways to the same equations, with friction: motions, forces over the face and in all bearings, misalignment
    by the load, at every step. The pair has its bearings' forces along and off the line of action."""
    pair, train = pair_and_train(helix, shafts, vibrating)
    expected = simulate(scene_from_text(pair))
    scene = train_from_text(train)
    whole = simulate_train(scene)
    found = whole.isel(mesh=0)
    names = ("transmission_error", "normal_force", "line_load", "tilt_x", "tilt_y", "axial_position", "centre_y")
    for name in (*names, "axis_inclination_in_plane", "axis_offset_out_of_plane", "rotation"):
        size = np.nanmax(np.abs(expected[name].values))
        assert found[name].values == pytest.approx(expected[name].values, rel=1e-8, abs=1e-8 * size), name
    along = np.deg2rad(25.0 + 90.0) - scene.meshes[0].pair.operating_pressure_angle
    x, y = (expected[f"bearing_force_{axis}"].values for axis in "xy")
    size = expected.attrs["largest_bearing_force"]
    in_space = x * np.cos(along) - y * np.sin(along), x * np.sin(along) + y * np.cos(along)
    for name, wanted in zip("xyz", (*in_space, expected["bearing_force_z"].values)):
        assert whole[f"bearing_force_{name}"].values == pytest.approx(wanted, abs=1e-8 * size)
    if not vibrating:
        assert whole.attrs["largest_bearing_force"] == pytest.approx(size, rel=1e-8)
        mean = expected.attrs["mean_axis_inclination_in_plane"]
        assert float(found["mean_axis_inclination_in_plane"]) == pytest.approx(mean, rel=1e-8)


def test_a_train_of_one_mesh_on_shafts_that_bend_is_the_pair_on_a_ramp():
    """Two ways to the same equations: inertia forces of gears, load and shafts, whose coupling leads; a pinion that
    runs out and wobbles."""
    pair, train = pair_and_train(15.0, ON_ROLLING, True)
    run_out = 'eccentricity.pinion]\ndistance = "20 um"\nphase = "1 rad"\nwobble = "9 um"\nwobble_phase = "2 rad"\n'
    expected = simulate(scene_from_text(f'{pair}[{run_out}[speed_ramp]\nend_frequency = "1500 Hz"\n'))
    whole = simulate_train(train_from_text(f'{train}[stages.one.{run_out}[speed_ramp]\nend_speed = "5000 rpm"\n'))
    assert whole["time"].values == pytest.approx(expected["time"].values, rel=1e-12)
    for name in ("transmission_error", "normal_force", "line_load", "rotation", "tilt_x"):
        size = np.nanmax(np.abs(expected[name].values))
        found = whole.isel(mesh=0)[name].values
        assert found == pytest.approx(expected[name].values, rel=1e-8, abs=1e-8 * size), name


def test_a_spin_up_loads_each_mesh_by_all_that_turns_behind_it():
    """Newton's law of a rotation: on a determinate train the forces of a mesh in balance are those of the torque and of
    the angular acceleration of all behind it, the shaft that bends among them."""
    ramp = f'[motion]\ninput_speed = "600 rpm"\nmesh_cycles = 2\n[speed_ramp]\nend_speed = "6000 rpm"\n{INERTIA}'
    train = train_from_text(bent_two_stages(more=ramp).text)
    (model,) = train_model_of(train).rows
    cycle = row_cycle(model, SilentProgress(), None)
    step = model.steps // 2
    rest = Marcher(cycle, model.equations_of_motion).stepper.in_balance(step, cycle.position(step))
    (shaft,) = model.drivetrain.elastic
    of_shaft = shaft.density * 150.0 * np.pi / 32.0 * 35.0**4
    gears = [each.moment_of_inertia for each in parts_of(model.meshes, model.shafts).masses]
    # Of the slowest mesh, the second, whose pinion has 24 teeth; its wheel has 30.
    accelerated = 2.0 * np.pi * model.ramp.acceleration / 24
    second = 300e3 + (gears[3] + 10.0) * accelerated * 24 / 30
    first = second * 24 / 30 + (gears[1] + gears[2] + of_shaft) * accelerated
    for (position, at), torque, mesh in zip(rest.position.of_meshes, (first, second), train.meshes):
        force = rest.solution.forces[at : at + position.operator.nodes].sum()
        assert force * mesh.pair.wheel.base_radius * mesh.pair.cosine == pytest.approx(torque, rel=1e-9)
    assert accelerated * of_shaft > 1e-3 * first


def textbook_force(mesh, sense: float) -> np.ndarray:
    """Force (3,) of a right-hand pinion on its wheel at the pitch circles, in space: tangential force T / r_w, F_t
    tan(alpha_wt), F_t tan(beta_w); the pinion turns counter-clockwise where the sense is 1. By the right hand's rule
    the thrust on the driver is along its axis of rotation."""
    pair = mesh.pair
    radius = pair.centre_distance * pair.wheel.teeth / (pair.pinion.teeth + pair.wheel.teeth)
    tangential = mesh.scene.load.wheel_torque / radius
    helix = abs(pair.slope) * radius / pair.wheel.base_radius
    outwards = np.array([np.cos(mesh.direction), np.sin(mesh.direction), 0.0])
    onwards = sense * np.array([-outwards[1], outwards[0], 0.0])
    pressed = np.tan(pair.operating_pressure_angle) * outwards
    return tangential * (onwards + pressed - np.array([0.0, 0.0, sense * helix]))


def cut_in(scene):
    """A train of two stages, the teeth of whose second pinion are cut into the shaft."""
    seats = 'seats = ["rigid over its width", "integral"]\n'
    return train_from_text(scene.text.replace("gears_at =", f"{seats}gears_at ="))


def two_mates():
    """A pinion that drives two wheels, each under a torque of its own."""
    stages = mate("a", gear_text(20, 2.0), gear_text(30, 2.0), 20.0) + mate(
        "b", '"a.pinion"', gear_text(24, 2.0), 150.0
    )
    stages = stages.replace('face_width = "20 mm"', 'helix_angle = "15 deg"\nface_width = "10 mm"')
    loads = '[load]\ntorques = [{ on = "a.wheel", torque = "120 N m" }, { on = "b.wheel", torque = "50 N m" }]\n'
    drive = shaft_section("drive", {"a.pinion": 40.0}, 90.0, 20.0, 'torque_at = "0 mm"')
    output = shaft_section("output", {"b.wheel": 40.0}, 90.0, 20.0, 'torque_at = "90 mm"')
    shafts = drive + output + "".join(bearing_sections(each, (10.0, 80.0), 3e5, 1e5) for each in ("drive", "output"))
    return train_from_text(f"{stages}{loads}{ACCURACY}{shafts}")


def idler():
    row = helical_row([24, 31, 40], [20, 80], 300).text
    shaft = shaft_section("idler", {"row.2": 40.0}, 100.0, 30.0) + bearing_sections("idler", (10.0, 90.0), 3e5, 1e5)
    return train_from_text(row + shaft)


# Of each mesh the sense in which its pinion turns, and its hand; for each shaft its meshes, and whether these press on
# its wheel (1) or on its pinion (-1).
STATICS = {
    "two stages": (bent_two_stages, [(1, 1), (-1, 1)], {"middle": [(0, 1), (1, -1)]}),
    "teeth cut in": (lambda: cut_in(bent_two_stages()), [(1, 1), (-1, 1)], {"middle": [(0, 1), (1, -1)]}),
    "two mates": (two_mates, [(1, 1), (1, 1)], {"drive": [(0, -1), (1, -1)], "output": [(1, 1)]}),
    "idler": (idler, [(1, 1), (-1, -1)], {"idler": [(0, 1), (1, -1)]}),
    "two paths": (
        lambda: train_from_text(all_bent(1.0)),
        [(1, 1), (1, 1), (-1, 1), (-1, 1)],
        {"first": [(0, -1), (1, -1)], "path1": [(0, 1), (2, -1)], "path2": [(1, 1), (3, -1)], "last": [(2, 1), (3, 1)]},
    ),
}


@cache
def run_of(name):
    """The scene of an arrangement, and its run."""
    scene = STATICS[name][0]()
    return scene, simulate_train(scene)


@pytest.mark.parametrize("name", STATICS)
def test_bearings_of_a_shaft_carry_what_its_gears_put_on_it(name):
    """Statics in space, without friction: the bearings of each shaft have the sum of the textbook's forces of its
    meshes, each under the torque that it hands on, wherever the load stands on the face."""
    _, meshes, shafts = STATICS[name]
    scene, found = run_of(name)
    forces = np.stack([found[f"bearing_force_{axis}"].values for axis in "xyz"], axis=-1)
    names = np.array([str(each).partition(" ")[0] for each in found["bearing"].values])
    on_wheels = []
    for number, (sense, hand) in enumerate(meshes):
        mesh = scene.meshes[number]
        nominal = mesh.scene.load.wheel_torque / mesh.pair.wheel.base_radius / mesh.pair.cosine
        share = found["normal_force"].isel(mesh=number).values[: len(forces)] / nominal
        on_wheels.append(np.outer(share, textbook_force(mesh, sense) * [1.0, 1.0, hand]))
    size = np.abs(on_wheels).max()
    assert {*names} == {*shafts}
    for shaft, pressed in shafts.items():
        wanted = sum(sign * on_wheels[number] for number, sign in pressed)
        assert forces[:, names == shaft].sum(axis=1) == pytest.approx(wanted, abs=1e-8 * size), shaft
    # Paths share as their shafts bend.
    if "path_share" not in found:
        for mesh, of_mesh in zip(scene.meshes, on_wheels):
            assert np.linalg.norm(of_mesh, axis=1) == pytest.approx(np.linalg.norm(textbook_force(mesh, 1)), rel=1e-9)


@pytest.mark.parametrize("name", ["two stages", "teeth cut in"])
def test_bearings_of_a_shaft_balance_moments_of_both_of_its_gears(name):
    """Statics: about the left bearing the right one has the moments of the textbook's forces, each in the middle of its
    gear, with those that the gears have there by the distribution of the load over the face."""
    scene, found = run_of(name)
    on_wheel = textbook_force(scene.meshes[0], 1.0)
    on_pinion = -textbook_force(scene.meshes[1], -1.0)
    forces = np.stack([found[f"bearing_force_{axis}"].values for axis in "xyz"], axis=-1)
    size = np.abs(on_pinion).max()
    # The second mesh is seen from the other end, where its pinion turns counter-clockwise.
    moments = np.zeros((len(forces), 2))
    for mesh, gear, sense in ((0, "wheel", 1.0), (1, "pinion", -1.0)):
        own = found.isel(mesh=mesh).sel(gear=gear)
        pair = scene.meshes[mesh].pair
        along = scene.meshes[mesh].direction + sense * (0.5 * np.pi - pair.operating_pressure_angle)
        x, y = (own[f"reaction_moment_{axis}"].values[: len(forces)] for axis in "xy")
        off = sense * np.array([-np.sin(along), np.cos(along)])
        moments += np.outer(x, [np.cos(along), np.sin(along)]) + np.outer(y, off)
    arm = np.array([0.0, 0.0, 1.0])
    for force, place in ((on_wheel, 35.0), (on_pinion, 100.0)):
        moments += np.cross((place - 15.0) * arm, force)[:2]
    carried = np.cross((135.0 - 15.0) * arm, forces[:, 1])[:, :2]
    assert carried == pytest.approx(moments, abs=1e-9 * size * 100.0)


def test_a_shaft_lies_in_its_bearings_as_their_forces_press_it():
    """Hooke's law in space: the mean deflection of the shaft at its bearings, points of its line, is their mean force
    over their stiffness, of the mesh cycle in which each step counts once."""
    _, found = run_of("two stages")
    for axis in "xy":
        line = found[f"shaft_deflection_{axis}"].values[0]
        points = np.rint(found["bearing_place"].values / found["shaft_place"].values[0, 1]).astype(int)
        mean = found[f"bearing_force_{axis}"].values[1:].mean(axis=0)
        assert line[points] == pytest.approx(mean / 1e6, rel=1e-9)


def test_stages_on_a_stiff_shaft_are_pairs_and_depart_as_it_gives_way():
    """A shaft on two bearings is determinate: each mesh has the force of its pair, however much the shaft yields. Of a
    millionth of the compliance transmission errors and line loads are those of the pairs; the difference grows in
    proportion to the compliance, for so little of it."""
    pairs = simulate_train(bent_two_stages(None))
    parts = {part: simulate_train(bent_two_stages(part)) for part in (1e-6, 1e-4, 2e-4)}
    for found in parts.values():
        assert found["normal_force"].values == pytest.approx(pairs["normal_force"].values, rel=1e-12)
    near = {"transmission_error": 1e-6, "line_load": 1e-6}
    for name, limit in near.items():
        wanted = pairs[name].values
        size = np.nanmax(np.abs(wanted))
        assert parts[1e-6][name].values == pytest.approx(wanted, abs=limit * size, nan_ok=True)
        once, twice = (np.nan_to_num(parts[each][name].values - wanted) for each in (1e-4, 2e-4))
        assert np.abs(once).max() > 5e-6 * size
        assert twice == pytest.approx(2.0 * once, abs=3e-4 * np.abs(twice).max())


def coupled_within(compliance: float, of_last: str = "") -> str:
    """The same, drive and load coupled within the faces of second gears."""
    text = all_bent(compliance, of_last)
    return text.replace('torque_at = "0.0 mm"', 'torque_at = "60 mm"').replace(
        'torque_at = "90.0 mm"', 'torque_at = "60 mm"'
    )


@pytest.mark.parametrize(
    "bent", [bent_paths, *(pytest.param(each, marks=pytest.mark.nightly) for each in (all_bent, coupled_within))]
)
def test_clocked_paths_on_stiff_shafts_are_those_on_rigid_shafts(bent):
    """Limit: of a millionth of the compliance paths share as on rigid shafts, here unevenly."""
    clocking = 'clocking = "1e-4 rad"\n'
    rigid = simulate_train(train_from_text(helical_paths(clocking)))
    stiff = simulate_train(train_from_text(bent(1e-6, clocking)))
    assert (rigid["path_share"].isel(mesh=[1, 3]) < 0.49).all()
    for name in ("path_share", "overall_transmission_error", "line_load", "transmission_error"):
        size = np.nanmax(np.abs(rigid[name].values))
        assert stiff[name].values == pytest.approx(rigid[name].values, abs=1e-5 * size, nan_ok=True), name


def test_shafts_whose_seats_give_way_are_in_balance_on_three_bearings():
    """Newton's third law and statics in space, at every step: forces and moments of all bearings of a shaft, of which
    one too many holds it, and of its gear's teeth cancel about its left end; friction among them. One gear is pressed
    on beside its bearings, the other is cut in between."""
    text = helical_stage("one", 3.0, (18, 35), 15.0) + "[friction]\ncoefficient = 0.1\n"
    text += ACCURACY.replace("steps_per_mesh_cycle = 10", "steps_per_mesh_cycle = 4")
    text += '[load]\noutput_torque = "200 N m"\n'
    ends = {"pinion": ("press fit", 120.0, 27.0, 0.0), "wheel": ("integral", 60.0, 45.0, 140.0)}
    for gear, (seat, at, thick, coupled) in ends.items():
        more = f'seats = ["{seat}"]\ntorque_at = "{coupled} mm"\n'
        text += shaft_section(gear, {f"one.{gear}": at}, 140.0, thick, more)
        places = (10.0, 50.0, 85.0) if gear == "pinion" else (10.0, 100.0, 130.0)
        text += bearing_sections(gear, places, 3e5, 1e5) + 'tilting_stiffness = "1e8 N mm/rad"\n'
    scene = train_from_text(text)
    found = simulate_train(scene)
    pair = scene.meshes[0].pair
    along = scene.meshes[0].direction + 0.5 * np.pi - pair.operating_pressure_angle
    turn = np.array([[np.cos(along), np.sin(along), 0.0], [-np.sin(along), np.cos(along), 0.0], [0.0, 0.0, 1.0]])
    for gear, (_, at, *_) in ends.items():
        own = found.isel(mesh=0).sel(gear=gear)
        force = np.stack([own[f"reaction_{axis}"].values for axis in "xyz"], axis=-1) @ turn
        moment = np.stack([own[f"reaction_moment_{axis}"].values for axis in "xy"], axis=-1) @ turn[:2, :2]
        on = [number for number, name in enumerate(found["bearing"].values) if str(name).startswith(gear)]
        carried = np.stack([found[f"bearing_force_{axis}"].values[:, on] for axis in "xyz"], axis=-1)
        moments = np.stack([found[f"bearing_moment_{axis}"].values[:, on] for axis in "xy"], axis=-1).sum(axis=1)
        arm = np.array([0.0, 0.0, 1.0])
        places = found["bearing_place"].values[on]
        moments += np.cross(places[:, None] * arm, carried)[..., :2].sum(axis=1)
        size = np.abs(force).max()
        assert np.abs(carried).min(axis=0).max() > 1e-3 * size
        assert carried.sum(axis=1) == pytest.approx(force, abs=1e-9 * size)
        assert moments == pytest.approx(moment + np.cross(at * arm, force)[:, :2], abs=1e-9 * size * 140.0)
