"""Gears of a planetary set that run out: laws that hold whatever the contact."""

from cmath import rect
from dataclasses import replace
from math import pi

import numpy as np
import pytest
from tests.planets import COARSE, planetary, written_out

from fenics_gears import simulate_train
from fenics_gears.contact.eccentricity import Eccentricity, Offset
from fenics_gears.model.train import train_model_of

TEETH = (17, 19, 55)
STEPS = 12
FLOATING = 'floating = ["sun"]'
DISTANCE = 0.012
ANGLE = 0.7
CYCLES = "[motion]\nmesh_cycles = 2"


def of_member(name: str) -> str:
    return f'eccentricity.{name} = {{ distance = "{DISTANCE} mm", phase = "{ANGLE} rad" }}'


def run(*more: str, sections: str = CYCLES, **options):
    """Three planets whose meshes are not in phase."""
    lines = "\n".join(more)
    return simulate_train(planetary(teeth=TEETH, planets="planets = 3", more=lines, sections=sections, **options))


def centre(step: int, turning: int, teeth: int) -> complex:
    """Where (mm) the centre of a base circle stands, on a gear that turns counter-clockwise (1) or clockwise (-1)."""
    return rect(DISTANCE, ANGLE + turning * 2.0 * pi * step / (STEPS * teeth))


def pins_at(places: list[complex]) -> str:
    """Pins so far (mm) beside their places, in space."""
    own = [each * rect(1.0, -2.0 * pi * number / 3.0) for number, each in enumerate(places)]
    along, out = ([f"{each!r} mm" for each in part] for part in ([-each.imag for each in own], [e.real for e in own]))
    return f"carrier = {{ pin_errors = {along}, radial_pin_errors = {out} }}"


def same_at(step: int, found, other) -> None:
    """The same forces and lag at a step as at the same place of one mesh cycle."""
    for name in ("normal_force", "overall_transmission_error"):
        np.testing.assert_allclose(found[name][step], other[name][step % STEPS], rtol=1e-9)


def test_a_floating_sun_follows_its_run_out():
    """Its base circle stays where it is, so that forces and lag are those of a sun that runs true, at every instant;
    its axis goes round the other way."""
    true = run(FLOATING)
    found = run(FLOATING, of_member("sun"))
    np.testing.assert_allclose(found["normal_force"], true["normal_force"], rtol=1e-9)
    np.testing.assert_allclose(found["overall_transmission_error"], true["overall_transmission_error"], rtol=1e-9)
    assert found.attrs["load_sharing_factor"] == pytest.approx(1.0, abs=1e-9)
    moved = (found["member_x"] + 1j * found["member_y"] - true["member_x"] - 1j * true["member_y"]).values[:, 0]
    expected = [-centre(step, 1, TEETH[0]) for step in range(len(moved))]
    np.testing.assert_allclose(moved, expected, atol=1e-9 * DISTANCE)


@pytest.mark.parametrize("step", [5, 20])
def test_a_planet_that_runs_out_is_one_on_a_pin_beside_its_place(step):
    """A quasi-static set is at an instant as if its base circle stood there for good; the planet turns clockwise."""
    planets = f'distance = ["0 mm", "{DISTANCE} mm", "0 mm"], phase = ["0 deg", "{ANGLE} rad", "0 deg"]'
    found = run(f"eccentricity.planets = {{ {planets} }}")
    same_at(step, found, run(pins_at([0j, centre(step, -1, TEETH[1]), 0j]), sections=""))
    assert found.attrs["load_sharing_factor"] > 1.01


def test_a_ring_that_runs_out_is_one_beside_which_all_pins_stand():
    """A floating sun goes with the pins, so that the ring alone is displaced against all others."""
    step = 17
    beside = -centre(step, -1, TEETH[2])
    same_at(step, run(FLOATING, of_member("ring")), run(FLOATING, pins_at([beside] * 3), sections=""))


def test_a_planet_that_runs_out_shifts_load_once_a_turn_against_the_carrier():
    """All members held, springs alone (soft pins, k): planet 1 carries 2 k e/3 more than a third of all.

    e: how far its base circle stands against its force, a cosine over its z_p mesh cycles."""
    stiffness, teeth = 10.0, 18
    more = (
        f'carrier.pin_stiffness = "{stiffness} N/mm"\n'
        'eccentricity.planets.distance = ["0.1 mm", "0 mm", "0 mm"]\n'
        'eccentricity.planets.phase = ["-90 deg", "0 deg", "0 deg"]'
    )
    scene = planetary(
        teeth=(18, teeth, 54), planets="planets = 3", more=more, load='input_torque = "0.5 N m"',
        sections=f"[motion]\nmesh_cycles = {teeth}",
    )  # fmt: skip
    pin = simulate_train(scene)["pin_force"].values[:-1, :, 0]
    shifted = (pin[:, 0] / pin.sum(axis=1) - 1.0 / 3.0) * pin.sum(axis=1)
    turned = 2.0 * pi * np.arange(len(pin)) / len(pin)
    np.testing.assert_allclose(shifted, 2.0 * stiffness * 0.1 / 3.0 * np.cos(turned), atol=2e-3 * stiffness * 0.1)


def test_a_set_is_the_train_in_the_carriers_frame():
    """The pairs of the set written out, each with the run-outs of its gears: angles from its own line of action, in the
    sense in which the gear turns."""
    teeth = (17, 18, 53)
    planets = ((0.005, 0.3), (0.011, -2.0))
    more = "\n".join(
        [
            of_member("sun"),
            of_member("ring"),
            f"eccentricity.planets.distance = {[f'{each[0]} mm' for each in planets]}",
            f"eccentricity.planets.phase = {[f'{each[1]} rad' for each in planets]}",
        ]
    )
    same = f'{COARSE}\ncontact_length = "4 mm"\ncontact_nodes = 20'
    parts = "carrier", "sun", "ring"
    own = planetary(
        teeth=teeth, more=more, parts=parts, load='output_torque = "2 kN m"', sections=CYCLES, accuracy=same
    )
    found = simulate_train(own)
    train = written_out(teeth, [0.0, 180.0], same)
    meshes = []
    for number, mesh in enumerate(train.meshes):
        ahead = pi / 2.0 - mesh.pair.operating_pressure_angle
        along = mesh.direction + (ahead if number % 2 == 0 else -ahead)
        distance, angle = planets[number // 2]
        planet = Offset(distance=distance, phase=along - angle)
        if number % 2 == 0:
            own = Eccentricity(Offset(distance=DISTANCE, phase=ANGLE - along), planet)
        else:
            own = Eccentricity(planet, Offset(distance=DISTANCE, phase=along - ANGLE))
        motion = replace(mesh.scene.motion, mesh_cycles=2, recorded_cycles=2)
        meshes.append(replace(mesh, scene=replace(mesh.scene, eccentricity=own, motion=motion)))
    other = simulate_train(replace(train, meshes=tuple(meshes)))
    np.testing.assert_allclose(found["normal_force"], other["normal_force"], rtol=1e-9)


def test_a_run_out_of_nothing_is_none():
    """Nothing is constructed for it, so that results are the same to the last bit; the run has one mesh cycle."""
    none = 'eccentricity.sun = { distance = "0 um", phase = "9 deg" }'
    scene = planetary(more=none)
    assert scene.shafts.carrier.run_outs == ()
    assert all(mesh.scene.eccentricity is None for mesh in scene.meshes)
    assert simulate_train(scene)["normal_force"].equals(simulate_train(planetary())["normal_force"])


def test_what_is_not_seen_is_told():
    """A sun of 17 teeth takes 17 mesh cycles to turn against the carrier, beside planets of 18 teeth 17 x 18, each mesh
    by itself."""
    warnings = train_model_of(planetary(more=of_member("sun"))).warnings
    (said,) = (each for each in warnings if "common period" in each)
    assert "only 1 of the 17 mesh cycles" in said
    assert "pinion" not in said
    planets = 'eccentricity.planets.distance = ["0 um", "5 um"]'
    warnings = train_model_of(planetary(more=f"{of_member('sun')}\n{planets}")).warnings
    periods = [each for each in warnings if "common period" in each]
    assert [each.split(":")[1].strip() for each in periods] == ["sun, planet 1", "sun, planet 2", "planet 2, ring"]
    assert periods[1].endswith("motion.mesh_cycles = 306 goes through all")
