"""The numbers of a run, and their signs."""

from dataclasses import replace

import numpy as np
import pytest
from tests.coarse import COARSE, coarse_scene, frictionless, quasi_static, teeth_alone

from fenics_gears import mesh_factor, model_of, simulate, single_stiffness
from fenics_gears.dynamics.torque_ripple import Harmonic, TorqueRipple
from fenics_gears.geometry.profile_modification import ProfileModification, ProfileModifications
from fenics_gears.model.resolution import plane_contact_modulus
from fenics_gears.results.key_numbers import _stiffness as stiffness_numbers
from fenics_gears.results.numbers import harmonics, shares_at
from fenics_gears.results.summary import summary_rows
from fenics_gears.scene.data import Motion


@pytest.fixture(scope="module")
def static(paper_scene):
    scene = frictionless(quasi_static(paper_scene))
    return simulate(replace(scene, motion=Motion(200.0, 1, 1)))


def test_mesh_stiffness_beside_iso_6336(static, paper_scene):
    """ISO 6336-1, method B: c_gamma within 3 %, c' of one pair between c' and c'th."""
    theoretical, single = single_stiffness(paper_scene.gears)
    assert static.attrs["mean_mesh_stiffness"] == pytest.approx(
        single * mesh_factor(model_of(paper_scene).pair.contact_ratio), rel=0.03
    )
    assert single < static.attrs["single_pair_stiffness"] < theoretical


def test_the_printed_stiffness_is_the_tangent(paper_scene):
    """Definition: a gap alike at all steps is deflection to the secant alone."""
    scene = replace(
        frictionless(teeth_alone(coarse_scene(paper_scene, cycles=1))),
        accuracy=replace(COARSE, steps_per_mesh_cycle=20),
    )
    modifications = ProfileModifications(ProfileModification(slope=0.02))
    plain, run = (simulate(each) for each in (scene, replace(scene, profile_modifications=modifications)))
    plain, sloped = plain.attrs, run.attrs
    assert sloped["mean_mesh_stiffness"] < 0.9 * plain["mean_mesh_stiffness"]
    assert sloped["mean_mesh_stiffness_tangent"] == pytest.approx(plain["mean_mesh_stiffness_tangent"], rel=0.01)
    row = next(value for label, value, _ in summary_rows(run) if label == "mesh stiffness, mean tangent")
    assert row.startswith(f"{sloped['mean_mesh_stiffness_tangent']:.4g} N/(mm um)")


def test_flanks_that_do_not_approach_have_no_secant(static, paper_scene):
    """Definition: force over a deflection that is not there is no number; other steps keep theirs, and where there are
    none the summary says so instead of the KeyError that it was."""
    pair, tangent = model_of(paper_scene).pair, np.full(3, 3e5)
    curves = {"mesh_stiffness_tangent": tangent, "loaded_pairs": np.array([1.0, 1.0, 2.0])}
    found = stiffness_numbers(curves | {"mesh_stiffness": np.array([np.nan, 2e5, 4e5])}, pair)
    per_width = 1e3 * pair.face_width
    assert found["mean_mesh_stiffness"] == pytest.approx(3e5 / per_width)
    assert found["single_pair_stiffness"] == pytest.approx(2e5 / per_width)
    found = stiffness_numbers(curves | {"mesh_stiffness": np.full(3, np.nan)}, pair)
    assert list(found) == ["mean_mesh_stiffness_tangent"]
    lost = {"mean_mesh_stiffness", "single_pair_stiffness"}
    run = static.assign_attrs()
    run.attrs = {name: value for name, value in static.attrs.items() if name not in lost}
    rows = {label: value for label, value, _ in summary_rows(run)}
    assert rows["mesh stiffness, mean secant"].startswith("none: ")


def test_peak_pressure_is_that_of_hertz(static, paper_scene):
    """Hertz: p = sqrt(F' E*/(pi rho)) at the place that the result names, within 2 %."""
    attributes, pair = static.attrs, model_of(paper_scene).pair
    at = static.sel(time=attributes["peak_contact_pressure_time"])
    force = at.pair_normal_force.values[at.pair_number.values == attributes["peak_contact_pressure_pair"]].item()
    first = np.sqrt((0.5 * attributes["peak_contact_pressure_diameter"]) ** 2 - pair.pinion.base_radius**2)
    radius = first * (pair.line_of_action_length - first) / pair.line_of_action_length
    hertz = np.sqrt(force / pair.face_width * plane_contact_modulus(paper_scene) / (np.pi * radius))
    assert attributes["peak_contact_pressure"] == pytest.approx(hertz, rel=0.02)
    assert attributes["peak_contact_pressure_flank"] == "drive"


def test_efficiency_by_the_energy_account(paper_scene):
    """Energy account: with friction and without damping."""
    result = simulate(replace(quasi_static(paper_scene), accuracy=COARSE, motion=Motion(200.0, 2, 1)))
    names = ("work_input", "work_output", "work_friction", "work_contact_changes", "energy_defect", "energy")
    work, attributes = {name: float(result[name][-1] - result[name][0]) for name in names}, result.attrs
    came_out = work["work_output"] - work["work_contact_changes"] - work["energy_defect"] + work["energy"]
    seconds = float(result.time[-1] - result.time[0])
    assert attributes["mesh_efficiency"] == pytest.approx(came_out / work["work_input"], rel=1e-9)
    assert attributes["friction_power"] == pytest.approx(1e-3 * work["work_friction"] / seconds, rel=1e-9)
    assert attributes["friction_power"] == pytest.approx(
        (1.0 - attributes["mesh_efficiency"]) * attributes["input_power"], rel=1e-9
    )


def test_dynamic_factor_without_root_stress(paper_scene):
    """Definition: of a run of the same scene without inertia, which has none."""
    scene = coarse_scene(paper_scene, cycles=4)
    moving, still = simulate(scene), simulate(quasi_static(scene))
    assert moving.attrs["quasi_static_pair_normal_force"] == pytest.approx(still.attrs["largest_pair_force"], rel=1e-6)
    ratio = moving.attrs["largest_pair_force"] / still.attrs["largest_pair_force"]
    assert moving.attrs["dynamic_factor_by_force"] == pytest.approx(ratio, rel=1e-6) and ratio > 1.01
    assert not [name for name in still.attrs if "dynamic" in name or "quasi_static" in name]


def test_cycles_that_differ_are_not_run_twice_unasked(paper_scene):
    """Definition: with torque ripple the quasi-static march is left out, and the result says why."""
    scene = replace(coarse_scene(paper_scene), torque_ripple=TorqueRipple((Harmonic(1, 1e4, 0.0),)))
    attributes = simulate(scene).attrs
    assert "mesh cycles differ" in attributes["dynamic_factor_unknown"] and "dynamic_factor_by_force" not in attributes


def test_load_shares_at_the_contact_points(static):
    """Definition: A and D, B and E are a base pitch apart; at C one pair carries."""
    share = {str(point): float(value) for point, value in zip(static.path_point.values, static.load_share.values)}
    assert share["A"] + share["D"] == pytest.approx(1.0, abs=0.02) and share["B"] + share["E"] == pytest.approx(
        1.0, abs=0.02
    )
    assert share["C"] == pytest.approx(1.0) and 0.2 < share["A"] < 0.6


def test_signs_of_forces_torques_and_rotations(paper_scene):
    """Statics: F = T/rb2; action and reaction on both shafts."""
    scene = frictionless(teeth_alone(coarse_scene(paper_scene, cycles=1)))
    result, pair = simulate(scene), model_of(scene).pair
    force = scene.load.wheel_torque / pair.wheel.base_radius
    last = result.isel(time=-1)
    assert float(last.normal_force) == pytest.approx(force, rel=1e-9)
    assert last.reaction_x.values == pytest.approx([-force, force], rel=1e-9)
    assert last.reaction_couple.values == pytest.approx(
        [-force * pair.pinion.base_radius, -scene.load.wheel_torque], rel=1e-9
    )
    assert float(last.rotation.sel(gear="wheel")) > 0.0 and float(last.transmission_error) > 0.0
    assert np.all(np.diff(result.work_input.values) > 0.0) and np.all(np.diff(result.work_output.values) > 0.0)


@pytest.mark.parametrize("cycles", [1, 3])
def test_harmonics_of_a_curve_that_is_made_of_them(cycles):
    """Exact; a tone between two harmonics leaves them."""
    phase = np.arange(40 * cycles) / 40
    amplitudes = np.array([3.0, 0.0, 1.5, 0.25, 0.125])
    curve = 7.0 + sum(a * np.cos(2.0 * np.pi * n * phase + n) for n, a in enumerate(amplitudes, 1))
    if cycles == 3:
        curve = curve + 0.5 * np.cos(2.0 * np.pi * phase / 3.0)
    assert harmonics(curve, cycles) == pytest.approx(amplitudes, abs=1e-12)


def test_shares_of_pairs_that_hand_over_in_a_straight_line():
    """Exact: a contact ratio of 1.5, from 1/3 to 2/3, 1 alone, and the other way."""
    phase = np.linspace(2.0, 4.0, 81)
    numbers = np.tile(np.arange(0, 5), (len(phase), 1))
    passed = phase[:, None] - numbers
    entering, leaving = (passed >= 0.0) & (passed <= 0.5), (passed >= 1.0) & (passed <= 1.5)
    share = np.where(entering, 1 / 3 + 2 / 3 * passed, np.where(leaving, 2 / 3 - 2 / 3 * (passed - 1.0), 0.0))
    share = np.where((passed > 0.5) & (passed < 1.0), 1.0, share)
    forces = 5000.0 * share * np.linspace(1.0, 2.0, len(phase))[:, None]
    found = shares_at([0.0, 0.25, 0.75, 1.25, 1.5, 9.0], phase, numbers, forces)
    assert found[:5] == pytest.approx([1 / 3, 0.5, 1.0, 0.5, 1 / 3], abs=1e-12) and np.isnan(found[5])
