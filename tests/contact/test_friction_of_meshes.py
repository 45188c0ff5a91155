"""Meshes that move together, each with a coefficient of friction of its own."""

from dataclasses import replace
from functools import reduce

import numpy as np
import pytest
from tests.planets import planetary
from tests.simulation.test_train_motion import INERTIA, motion
from tests.trains import COARSE, gear_text, helical_row, mate, row, stage

from fenics_gears import scene_from_text, simulate, simulate_train, train_from_text
from fenics_gears.contact.row import RowCycle
from fenics_gears.dynamics.march import Marcher
from fenics_gears.dynamics.steps import Steps
from fenics_gears.geometry.friction_formulas import schlenk
from fenics_gears.model.train import train_model_of
from fenics_gears.model.train_cost import WITH_FACTORS, row_cost
from fenics_gears.simulation.train import of_mesh, row_cycle
from fenics_gears.system.progress import SilentProgress

SCHLENK = '\n[friction]\nformula = "Schlenk"\nviscosity = "13 mPa s"\nroughness = "0.8 um"\n'
CASES = {
    "an idler": lambda: row([24, 31, 60], [0, 60], 300, more=SCHLENK + motion(1500, 1)),
    "a helical idler": lambda: train_from_text(
        helical_row([24, 31, 60], [0, 60], 300).text + SCHLENK + motion(1500, 1)
    ),
    "a set": lambda: planetary(teeth=(17, 19, 55), planets="planets = 3", sections=SCHLENK + motion(3000, 1)),
}


@pytest.mark.parametrize("train", CASES.values(), ids=CASES)
def test_each_mesh_obeys_coulombs_law_with_its_own_coefficient(train):
    """The laws themselves, by the compliance and slip of all nodes in N and mm: a node that slips has its friction
    against its slip and as large as its mesh's coefficient times its normal force, one that sticks at most that.
    Coefficients are the formula's at the force and speed of each mesh."""
    (model,) = train_model_of(train()).rows
    coefficients = []
    for each in model.models:
        force = each.pair.force_of(each.scene.load.wheel_torque)
        speed = 60.0 * each.scene.motion.mesh_frequency / each.pair.pinion.teeth
        coefficients.append(schlenk(each.pair, force, speed, 13.0, 0.8))
    assert len({f"{each:.6f}" for each in coefficients}) == 2
    cycle = row_cycle(model, SilentProgress(), None)
    plain = RowCycle([replace(mesh, friction=1.0) for mesh in cycle.meshes], cycle._compliance)
    blocks: list[Steps] = []
    Marcher(cycle, model.equations_of_motion).run(4, 1, observe=lambda solved, so_far: blocks.append(solved))
    steps = reduce(Steps.followed_by, blocks)
    of_meshes = [of_mesh(steps, cycle, number) for number in range(len(cycle.meshes))]
    forces = [_all_of([each.records[s].solution.forces for each in of_meshes]) for s in range(len(steps))]
    states = steps.states[:, 0]
    slipped = 0
    for s in range(1, len(steps)):
        operator = plain.position(int(steps.numbers[s])).operator
        n = operator.nodes
        normal, tangential = forces[s][:n], forces[s][n:]
        moved = operator.jacobian @ states[s] - operator.compliance @ forces[s]
        displaced = [each.records[s].solution.displacement for each in of_meshes]
        assert moved == pytest.approx(_all_of(displaced), rel=1e-9, abs=1e-9)
        stood = operator.previous_jacobian @ states[s - 1] - operator.previous_compliance @ forces[s - 1]
        slip = moved[n:] + operator.rigid_slip - stood
        nodes = [mesh.cycle.position(int(steps.numbers[s])).operator.nodes for mesh in cycle.meshes]
        most = np.repeat(coefficients, nodes) * normal
        assert (np.abs(tangential) <= most + 1e-3).all()
        slides = np.abs(slip) > 1e-6
        loaded = normal > 1.0
        assert tangential[slides & loaded] == pytest.approx((np.sign(slip) * most)[slides & loaded], rel=1e-9)
        slipped += np.count_nonzero(slides & loaded)
    assert slipped > 0


def _all_of(of_meshes: list[np.ndarray]) -> np.ndarray:
    """Normal and tangential values of each mesh (2 n,) as those of all: normals first."""
    halves = [np.split(each, 2) for each in of_meshes]
    return np.concatenate([each[kind] for kind in range(2) for each in halves])


def test_branches_in_time_are_pairs_with_their_own_friction():
    """Law: the driven shaft turns as prescribed, so that neither branch feels the other, masses and all."""
    coefficients = {"one": 0.03, "other": 0.12}
    torques = {"one": 200, "other": 300}
    gears = {"one": stage("one", 3.0, (20, 40)), "other": stage("other", 3.0, (20, 30))}
    own = {name: f"[stages.{name}.friction]\ncoefficient = {each}\n" for name, each in coefficients.items()}
    rest = INERTIA.split("[inertia.load]")[0]
    rest += '[damping]\nmass_proportional = "300 1/s"\nstiffness_proportional = "1e-6 s"\n[accuracy]\n'
    rest += 'steps_per_mesh_cycle = 40\nflank_element_size = "0.1 mm"\n'
    outputs = ", ".join(f'{{ on = "{name}.wheel", torque = "{each} N m" }}' for name, each in torques.items())
    text = "".join(gears[name] + own[name] for name in gears)
    text += f'[shafts.driven]\ncarries = ["one.pinion", "other.pinion"]\n[load]\ntorques = [{outputs}]\n'
    found = simulate_train(train_from_text(text + motion(1500, 2) + rest))
    for number, name in enumerate(gears):
        section = (gears[name] + own[name]).replace(f"stages.{name}.", "").replace(f"stages.{name}", "gears")
        load = f'[load]\nwheel_torque = "{torques[name]} N m"\n[motion]\npinion_speed = "1500 rpm"\nmesh_cycles = 2\n'
        alone = simulate(scene_from_text(section + load + rest))
        for curve in ("transmission_error", "normal_force", "friction_force"):
            expected = alone[curve].values
            scale = np.abs(expected).max()
            assert np.abs(found[curve].values[: len(expected), number] - expected).max() < 1e-8 * scale, curve
        assert float(found["friction_coefficient"][number]) == coefficients[name]


def two_stages_in_time(second: str) -> str:
    """Two stages with masses, the first one with friction."""
    rest = INERTIA.replace("[inertia.load]", f"{DAMPING}[inertia.load]") + motion(1500, 2)
    stages = stage("first", 2.0, (20, 30), RUBBING.format("first", "0.08"))
    return (
        f'{stages}{stage("last", 3.0, (20, 40), second)}[load]\noutput_torque = "400 N m"\n[accuracy]\n{COARSE}\n{rest}'
    )


def idler_of_stages(second: str, more: str = "", accuracy: str = COARSE) -> str:
    """An idler whose first mesh has friction."""
    one, idler, other = (gear_text(each, 2.0) for each in (24, 31, 40))
    stages = mate("first", one, idler, 0.0, more=more + RUBBING.format("first", "0.08"))
    stages += mate("last", '"first.wheel"', other, 60.0, more=more + second)
    return f'{stages}[load]\noutput_torque = "100 N m"\n[accuracy]\n{accuracy}\n'


def first_mesh_behind(first: str) -> str:
    """The same train, in which the second mesh has the friction and the first one none."""
    text = idler_of_stages(RUBBING.format("last", "0.08"))
    return text.replace(RUBBING.format("first", "0.08"), first)


RUBBING = "[stages.{}.friction]\ncoefficient = {}\n"
DAMPING = '[damping]\nmass_proportional = "300 1/s"\nstiffness_proportional = "1e-6 s"\n'
FEW = 'slices = 3\nlayers = 2\nbody_element_size = "4 mm"\nsteps_per_mesh_cycle = 8\nflank_element_size = "0.25 mm"'
PARTLY = {
    "two stages in time": (two_stages_in_time, "last"),
    "an idler": (idler_of_stages, "last"),
    "an idler, friction behind it": (first_mesh_behind, "first"),
    "a helical idler": (lambda own: idler_of_stages(own, 'helix_angle = "15 deg"\n', FEW), "last"),
}


@pytest.mark.parametrize(("text_of", "bare"), PARTLY.values(), ids=PARTLY)
def test_a_mesh_without_friction_is_one_of_hardly_any(text_of, bare):
    """Limit: beside meshes with friction one without has what one has with a coefficient of 1e-9, to 1e-8, and neither
    curves of friction nor a coefficient; the loss is that of the others, to the coefficient."""
    without, hardly = (simulate_train(train_from_text(text_of(own))) for own in ("", RUBBING.format(bare, "1e-9")))
    number = list(without["mesh"].values).index(bare)
    for curve in ("transmission_error", "normal_force", "friction_force", "overall_transmission_error"):
        values, expected = (found[curve].values for found in (without, hardly))
        there = ~np.isnan(values)
        assert there.any() and np.abs(values - expected)[there].max() < 1e-8 * np.nanmax(np.abs(expected)), curve
    assert np.isnan(without["friction_force"].isel(mesh=number)).all()
    assert np.isnan(without["friction_coefficient"].values[number])
    loss = without.attrs["friction_loss"]
    assert loss == pytest.approx(hardly.attrs["friction_loss"], rel=0.0, abs=1e-9) and loss > 1e-3


@pytest.mark.parametrize("text_of", [two_stages_in_time, idler_of_stages])
def test_no_friction_acts_where_there_is_none(text_of):
    """Exactly: no node of a mesh without friction has a tangential force, also of what the steps hold of it; it slips
    nowhere, so that all work of friction is the other mesh's."""
    (model,) = train_model_of(train_from_text(text_of(""))).rows
    cycle = row_cycle(model, SilentProgress(), None)
    blocks: list[Steps] = []
    Marcher(cycle, model.equations_of_motion).run(12, 1, observe=lambda solved, so_far: blocks.append(solved))
    steps = reduce(Steps.followed_by, blocks)
    rubbed = 0.0
    for (operator, _, forces), position in zip(steps.solved, steps.positions):
        (_, _), (bare, first) = position.of_meshes
        tangential = forces[operator.nodes :]
        assert not tangential[first : first + bare.operator.nodes].any()
        rubbed += np.abs(tangential).sum()
    assert rubbed > 0.0 and of_mesh(steps, cycle, 1).kinds == 1


def test_expected_memory_where_some_meshes_have_friction():
    """Counted arrays: a mesh without friction has rows of both kinds among all meshes, and its own alone."""
    text = idler_of_stages("", 'helix_angle = "15 deg"\n', FEW)
    (model,) = train_model_of(train_from_text(f"{text}\n[motion]\nmesh_cycles = 2")).rows
    cycle = row_cycle(model, SilentProgress(), None)
    steps = range(cycle.steps)
    together = sum(cycle.position(step).bytes for step in steps)
    alone = sum(mesh.cycle.position(step).bytes for mesh in cycle.meshes for step in steps)
    assert row_cost(model).operators == pytest.approx(WITH_FACTORS * together + alone, rel=0.3)
