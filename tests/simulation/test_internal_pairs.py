"""Runs of a pinion in its ring, in the plane: laws of statics and energy, limits, the mirror."""

import numpy as np
import pytest
from tests.coarse import cycle_of
from tests.hertz_contact import HertzContact
from tests.internal import COARSE, internal_scene, moving

from fenics_gears import gear_pair, model_of, simulate
from fenics_gears.dynamics.batch import Batch
from fenics_gears.dynamics.marched import BetweenSteps
from fenics_gears.scene.read import scene_from_text


def run(**changes):
    return simulate(scene_from_text(internal_scene(**changes)))


def test_without_friction_the_torques_are_in_the_ratio_of_the_base_radii():
    """Statics: at every step T2/T1 = rb2/rb1 = 61/22, both in the pinion's sense of rotation, and action is reaction;
    the wheel lags behind."""
    result = run()
    couple = result.reaction_couple.values
    assert -couple[:, 1] / couple[:, 0] == pytest.approx(np.full(len(couple), 61.0 / 22.0), rel=1e-9)
    assert couple[:, 1] == pytest.approx(np.full(len(couple), 500e3 * 61.0 / 22.0), rel=1e-9)
    for name in ("reaction_x", "reaction_y"):
        force = result[name].values
        assert force.sum(axis=1) == pytest.approx(np.zeros(len(force)), abs=1e-6)
    assert result.transmission_error.values.min() > 0.0 and result.rotation.values[:, 1].max() < 0.0


@pytest.mark.parametrize("support", ["", ', support = { kind = "foundation", radial_stiffness = "500 N/mm^3", '
                                         'tangential_stiffness = "300 N/mm^3" }'])  # fmt: skip
def test_energy_and_momentum_balance_with_friction_and_inertia(support):
    """Energy: work in, out, damped and rubbed, and what is stored, add up to round-off; friction takes some, on a mesh
    whose efficiency an internal pair's small sliding makes high."""
    result = run(wheel=support, more=COARSE + moving(3))
    carried = float(np.abs(result.work_input.values).max())
    assert float(np.abs(result.energy_defect.values).max()) < 1e-9 * carried
    assert result.work_input.values[-1] > result.work_output.values[-1] > 0.0
    assert result.work_friction.values[-1] > 0.0
    assert 0.99 < result.attrs["mesh_efficiency"] < 0.9995


def test_a_wheel_that_drives_is_the_pair_in_the_mirror():
    """Symmetry: mirrored at the line of centres the coast flanks are drive flanks, so that the same torque the other
    way turns the wheel as far, backwards, at mirrored phases."""
    phases = np.array([0.13, 0.4, 0.77])
    pair = gear_pair(scene_from_text(internal_scene()).gears)
    whole = 2.0 * pair.pinion.base_radius * (pair.operating_pressure_angle + pair.pinion.tooth_half_angle_at_base)
    mirrored = ((whole - 2.0 * pair.path_start) / pair.base_pitch - phases) % 1.0
    drive, coast = (turned(torque, at) for torque, at in (("500", phases), ("-500", mirrored)))
    assert drive == pytest.approx(coast, rel=1e-6) and drive.min() > 1e-3


def turned(torque: str, phases: np.ndarray) -> np.ndarray:
    """How far (mm at its base circle) the wheel stands behind at phases of the mesh cycle, either way round."""
    more = COARSE + "[coast_flanks]\n"
    model = model_of(scene_from_text(internal_scene(more=more, load=f'pinion_torque = "{torque} N m"')))
    places = (20.0 * (1.0 + phases)).tolist()
    found = BetweenSteps(Batch(cycle_of(model), [model.equations_of_motion])).at([(0, place) for place in places])
    return np.array([np.abs(found[0, place].solution.coordinates).max() for place in places])


def rack_like(teeth: int) -> float:
    """Mean transmission error, um along the line of action, of a pinion against a wheel of so many teeth, negative for
    a ring, whose rims are alike."""
    sign = -1 if teeth < 0 else 1
    rim, tip = (4 * abs(teeth) + size for size in (-30 * sign, 6 * sign))
    body = f'bore_diameter = "{rim} mm"' if teeth > 0 else f'outer_diameter = "{rim} mm", support = "held"'
    wheel = f'teeth = {teeth}, profile_shift = 0, {body}, rack_tip_radius = 0.2, tip_diameter = "{tip} mm"'
    scene = f"""
[gears]
module = "4 mm"
pressure_angle = "20 deg"
face_width = "10 mm"
material = "steel"
pinion = {{ teeth = 22, profile_shift = 0.3, bore_diameter = "40 mm" }}
wheel = {{ {wheel} }}
[load]
pinion_torque = "100 N m"
{COARSE}"""
    result = simulate(scene_from_text(scene))
    return float(result.attrs["mean_transmission_error"] * result.attrs["base_radius_wheel"]) * 1e3


@pytest.mark.nightly
def test_ring_and_wheel_meet_at_the_rack():
    """Limit: with growing numbers of teeth ring and external wheel both become a rack; their transmission errors
    approach each other as 1/z2."""
    apart = [rack_like(teeth) - rack_like(-teeth) for teeth in (125, 250)]
    assert apart[0] / apart[1] == pytest.approx(2.0, rel=0.15)


def test_contact_is_hertzian_with_the_difference_of_the_curvatures():
    """Johnson, Contact Mechanics, 4.2, with 1/R = 1/rho1 - 1/rho2: peak pressure and half-width at the pitch point."""
    contact = HertzContact(scene_from_text(internal_scene(more="", wheel=', tip_diameter = "241 mm"')))
    half_width = contact.half_width(contact.line_load)
    xi = contact.pair.pitch_point
    assert contact.radius == pytest.approx(1.0 / (1.0 / xi - 1.0 / (xi + 26.67757118)), rel=1e-8)
    size = half_width / 4.0
    pressed = contact.pressed(contact.compliances(size), 0.5 * size, contact.line_load)
    assert pressed.half_width == pytest.approx(half_width, rel=0.02)
    assert pressed.peak == pytest.approx(2.0 * contact.line_load / (np.pi * half_width), rel=0.02)


@pytest.mark.parametrize("model, within", [("stiffness table", 0.02), ("ISO 6336-1", 0.4)])
def test_springs_are_as_stiff_as_the_full_contact(model, within):
    """Two routes: a table of the same contact; and ISO 6336-1, for which an internal gear is a rack."""
    full = run()
    springs = run(more=f'[accuracy]\nmodel = "{model}"\nsteps_per_mesh_cycle = 20\n')
    assert springs.attrs["mean_transmission_error"] == pytest.approx(full.attrs["mean_transmission_error"], rel=within)


def rigid(more: str):
    text = internal_scene(more=more).replace('material = "steel"\n', "")
    return simulate(scene_from_text(text))


def test_rigid_flanks_follow_the_run_out_of_the_ring():
    """Geometry: a ring whose base circle runs out by c has a transmission error of 2 c peak to peak along the line of
    action, over a turn of the ring."""
    result = rigid('[motion]\nmesh_cycles = 61\nrecorded_cycles = 61\n[eccentricity.wheel]\ndistance = "10 um"\n')
    error = result.transmission_error.values * result.attrs["base_radius_wheel"]
    assert np.ptp(error) == pytest.approx(0.02, rel=1e-3)


def test_rigid_flanks_with_a_pitch_deviation_and_reliefs():
    """Geometry: one ring tooth that comes 5 um late pushes the ring by 5 um rb2/r2 where it carries; tip reliefs of
    8 mm at both ends of the path leave a part between them, and are as deep as where two pairs share the load."""
    pitch = ", ".join(['"5 um"', '"-5 um"', *['"0 um"'] * 59])
    more = f"[motion]\nmesh_cycles = 61\nrecorded_cycles = 61\n[flank_errors.wheel]\npitch = [{pitch}]\n"
    error = rigid(more).transmission_error.values * 114.6425
    assert np.ptp(error) == pytest.approx(5e-3 * np.cos(np.radians(20.0)), rel=1e-3)
    relieved = rigid('[tip_relief]\ndepth = "2 um"\nlength_on_path = "8 mm"\n').transmission_error.values * 114.6425
    pair = gear_pair(scene_from_text(internal_scene()).gears)
    most = 0.002 * (8.0 + 0.5 * (pair.path_start - pair.path_end + pair.base_pitch)) / 8.0
    assert relieved.min() == pytest.approx(0.0, abs=1e-9)
    assert relieved.max() == pytest.approx(most, abs=2e-5)


def test_root_stress_is_in_proportion_to_the_torque_and_on_both_gears():
    """Linearity at a fixed position of one pair: twice the torque, nearly twice the stress; fillets in tension on the
    loaded side."""
    more = COARSE + "[output]\nroot_stress = true\n"
    once, twice = (run(more=more, load=f'pinion_torque = "{torque} N m"') for torque in (100, 200))
    for gear in ("pinion", "wheel"):
        first, second = (float(each.root_stress.sel(gear=gear).max()) for each in (once, twice))
        assert first > 5.0 and second / first == pytest.approx(2.0, rel=0.1)
