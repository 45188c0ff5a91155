"""The cheaper models of the mesh."""

from dataclasses import replace

import numpy as np
import pytest
from tests.coarse import coarse_scene, frictionless, quasi_static

from fenics_gears import SceneError, mesh_factor, model_of, scene_from_text, simulate
from fenics_gears.effects import OVER_CONTACT_NODES
from fenics_gears.geometry.iso_6336 import pair_stiffness
from fenics_gears.scene.data import ISO_6336, RIGID_TEETH, STIFFNESS_TABLE, Motion
from fenics_gears.simulation.bodies import gear_bodies
from fenics_gears.simulation.elastic_route import mesh_cycle

MODELS = (RIGID_TEETH, STIFFNESS_TABLE, ISO_6336)


def by(scene, name: str, **accuracy):
    return replace(scene, accuracy=replace(scene.accuracy, model=name, **accuracy))


@pytest.fixture(scope="module")
def static(paper_scene):
    return replace(frictionless(quasi_static(coarse_scene(paper_scene))), motion=Motion(200.0, 1, 1))


def distance(found, expected) -> float:
    """In parts of the transmission error's peak-to-peak value."""
    error = expected.transmission_error.values
    return float(np.abs(found.transmission_error.values - error).max() / np.ptp(error))


def test_table_is_the_full_model_at_its_own_load(static, paper_scene):
    """Exact: at the table's own loads the full contact, with removed material, and on the coast flanks."""
    text = paper_scene.text + '\n[tip_relief]\ndepth = "31 um"\nstart = "HPSTC"\n\n[coast_flanks]\n'
    scene = replace(
        scene_from_text(text), inertia=None, damping=None, friction=None, accuracy=static.accuracy, motion=static.motion
    )
    for torque in (437e3, -437e3):
        loaded = replace(scene, load=replace(scene.load, wheel_torque=torque))
        full, table = simulate(loaded), simulate(by(loaded, STIFFNESS_TABLE))
        assert distance(table, full) <= 1e-9
        assert table.normal_force.values == pytest.approx(full.normal_force.values, rel=1e-9)
        assert set(full.data_vars) - set(table.data_vars) == set(OVER_CONTACT_NODES) & set(full.data_vars)


def test_table_in_motion(paper_scene):
    """Limit: teeth without mass and friction are a spring; at 200 Hz but for interpolation."""
    scene = frictionless(coarse_scene(paper_scene, cycles=4))
    table = simulate(by(scene, STIFFNESS_TABLE))
    assert distance(table, simulate(scene)) <= 1e-3
    assert np.abs(table.energy_defect.values).max() <= 1e-10 * table.energy.values.max()


class WithoutBending:
    """A mesh cycle whose friction forces do not bend the teeth."""

    def __init__(self, cycle):
        self._cycle, self.traits = cycle, replace(cycle.traits, divisible=False)

    def __getattr__(self, name):
        return getattr(self._cycle, name)

    def position(self, step):
        position = self._cycle.position(step)
        operator = position.operator
        compliance, before = operator.compliance.copy(), operator.previous_compliance.copy()
        nodes = operator.nodes
        compliance[:nodes, nodes:] = compliance[nodes:, :nodes] = 0.0
        before[:, : before.shape[1] // 2] = 0.0
        return replace(position, operator=replace(operator, compliance=compliance, previous_compliance=before))


def unlike(found, expected) -> float:
    """Difference without means, in the L2 norm, in parts of the expected one's."""
    first, second = (
        each.transmission_error.values - each.transmission_error.values.mean() for each in (found, expected)
    )
    return float(np.sqrt(np.mean((first - second) ** 2) / np.mean(second**2)))


def test_friction_of_mesh_springs_does_not_bend_the_teeth(paper_scene):
    """Limit: the full contact whose friction does not bend the teeth; that bending is a sixth of the variation."""
    scene = quasi_static(coarse_scene(paper_scene))

    def without_bending(model, progress, cache):
        gears = gear_bodies(model, progress, cache)
        return gears, WithoutBending(mesh_cycle(model, gears))

    table, full, unbent = (
        simulate(by(scene, STIFFNESS_TABLE)),
        simulate(scene),
        simulate(scene, preparation=without_bending),
    )
    assert unlike(table, unbent) <= 0.04
    assert unlike(table, full) == pytest.approx(unlike(unbent, full), rel=0.1)
    assert unlike(simulate(by(frictionless(scene), STIFFNESS_TABLE)), full) > 2.0 * unlike(table, full)
    assert table.work_friction.values[-1] == pytest.approx(full.work_friction.values[-1], rel=0.03)
    assert np.abs(table.energy_defect.values).max() <= 1e-10 * table.energy.values.max()


def test_friction_force_is_that_of_its_pairs(paper_scene):
    """Exact: mu times the normal force but near the pitch point."""
    result = simulate(by(quasi_static(coarse_scene(paper_scene)), STIFFNESS_TABLE))
    normal, friction = result.pair_normal_force.values, result.pair_friction_force.values
    sliding = np.abs(np.abs(friction) - 0.1 * normal) <= 1e-9 * normal.max()
    assert np.all(np.abs(friction) <= 0.1 * normal + 1e-9 * normal.max())
    assert sliding.mean() > 0.95
    assert friction.min() < 0.0 < friction.max()


def test_iso_deflection(static):
    """Exact: F/(c' b) where one pair is in mesh; c_gamma = c' (0.75 eps + 0.25)."""
    scene = by(replace(static, shafts=None, bearings=None), ISO_6336, steps_per_mesh_cycle=1000)
    model, result = model_of(scene), simulate(scene)
    force = scene.load.wheel_torque / model.pair.wheel.base_radius
    stiffness = force / (result.transmission_error.values[:-1] * model.pair.wheel.base_radius)
    single = pair_stiffness(scene.gears, force / scene.gears.face_width)
    alone = (result.pair_normal_force.values[:-1] > 0.0).sum(axis=1) == 1
    assert stiffness[alone] == pytest.approx(np.full(alone.sum(), single), rel=1e-9)
    assert stiffness[~alone] == pytest.approx(np.full((~alone).sum(), 1.75 * single), rel=1e-9)
    assert stiffness.mean() == pytest.approx(single * mesh_factor(model.pair.contact_ratio), rel=2e-3)


def test_friction_of_rigid_teeth(paper_scene):
    """Exact statics: N rb2 + mu s N x2 = T, s the sense of sliding."""
    scene = by(quasi_static(coarse_scene(paper_scene)), RIGID_TEETH)
    model, result = model_of(scene), simulate(scene)
    normal, friction = result.pair_normal_force.values, result.pair_friction_force.values
    assert np.abs(friction) == pytest.approx(0.1 * normal, abs=1e-9 * normal.max())
    assert result.reaction_couple.sel(gear="wheel").values == pytest.approx(np.full(len(result.time), -437e3), rel=1e-9)
    pair = model.pair
    steps = np.arange(len(result.time)) % model.resolution.steps_per_mesh_cycle
    xi = pair.path_start + steps * pair.base_pitch / model.resolution.steps_per_mesh_cycle
    alone = ((normal > 0.0).sum(axis=1) == 1) & (xi > pair.path_end - pair.base_pitch * 0.99)
    assert alone.sum() > 5
    slides = np.sign(xi - pair.pitch_point)
    expected = 437e3 / (pair.wheel.base_radius + 0.1 * slides * (pair.line_of_action_length - xi))
    assert result.normal_force.values[alone] == pytest.approx(expected[alone], rel=1e-9)
    assert np.abs(result.energy_defect.values).max() <= 1e-10 * max(result.energy.values.max(), 1.0)


@pytest.mark.parametrize("name", MODELS)
def test_every_effect_goes_with_every_model(name, paper_scene):
    """Backlash, errors of single teeth, run-out, ripple, a ramp, lost contact."""
    text = (
        paper_scene.text.replace('"437 N m"', '"40 N m"')
        + """
[coast_flanks]
[flank_errors]
tolerance_class = 6
seed = 1
[eccentricity]
pinion = { distance = "10 um" }
[torque_ripple]
harmonics = [{ order = 8, amplitude = "400 N m" }]
[tip_relief]
depth = "31 um"
start = "HPSTC"
"""
    )
    scene = replace(scene_from_text(text), motion=Motion(200.0, 3, 2))
    scene = replace(scene, accuracy=coarse_scene(paper_scene).accuracy)
    result = simulate(by(scene, name))
    assert result.attrs["complete"] == 1
    assert result.attrs["model"] == name
    assert np.isfinite(result.transmission_error.values).all()
    if name != RIGID_TEETH:  # whose impacts backward Euler damps: there the defect is the method's
        assert np.abs(result.energy_defect.values).max() <= 1e-9 * result.energy.values.max()
    assert result.coast_normal_force.values.max() > 0.0


@pytest.mark.parametrize(
    "name, line, said",
    [
        (STIFFNESS_TABLE, 'condensation = "every step"', "cannot be combined with condensation"),
        (ISO_6336, "[output]\nroot_stress = true", "has no stresses"),
        (RIGID_TEETH, "[corner_contact]", "cannot be combined with [corner_contact]"),
        (ISO_6336, "[corner_contact]", "cannot be combined with [corner_contact]"),
    ],
)
def test_what_a_model_lacks_is_refused(name, line, said, paper_scene):
    """House rule: no option is ignored silently."""
    text = paper_scene.text.replace('condensation = "once"', f'model = "{name}"\n{line}')
    with pytest.raises(SceneError, match=said.replace("[", r"\[")):
        scene_from_text(text)
