"""Rows 3 to 21 without inertia, on flanks resolved over the face; bodies without finite elements."""

import numpy as np
import pytest
from tests.hard_cases.invariants import cycle_of, finished_helical_run
from tests.hard_cases.test_any_scene import obeys_the_laws
from tests.helical import BEARINGS, CROWNED, FRICTION, helical_scene, on_stand_in_bodies

from fenics_gears import model_of
from fenics_gears.dynamics.march import Marcher

FEW = "slices = 5\ncontact_nodes = 9\nsteps_per_mesh_cycle = 8"
BY_NIGHT = pytest.mark.nightly


def run(more="", **changes):
    return finished_helical_run(more, **{"accuracy": FEW, **changes})


def marched(more, **changes):
    """The model and the records of a march, without their result, which takes longer."""
    model = model_of(helical_scene(more, **{"accuracy": FEW, **changes}))
    marcher = Marcher(cycle_of(model, on_stand_in_bodies(model)), model.equations_of_motion)
    return model, marcher.run(model.steps, model.steps + 1).records


def states(model, records, name):
    """A coordinate (steps,) of a march, or its transmission error."""
    found = np.array([record.state.position for record in records])
    return model.transmission_error(found) if name == "transmission_error" else model.drivetrain.value(found, name)


def errors(found):
    return found.result["transmission_error"].values


def difference(one, other):
    return float(np.abs(one - other).max() / np.abs(other).max())


def misaligned(in_plane, out_of_plane=0.0):
    return f'[misalignment]\nin_plane = "{in_plane!r} mm"\nout_of_plane = "{out_of_plane!r} mm"\n'


def places(pinion, wheel):
    return (
        '[bearings]\nstiffness = "0.2e6 N/mm"\naxial_stiffness = "0.1e6 N/mm"\n'
        f'places = {{ pinion = ["{pinion[0]} mm", "{pinion[1]} mm"], wheel = ["{wheel[0]} mm", "{wheel[1]} mm"] }}\n'
    )


@pytest.mark.nightly
@pytest.mark.parametrize("friction", [pytest.param("", marks=BY_NIGHT), FRICTION])
def test_hands_in_the_mirror(friction, measured):
    """Row 9. Exact symmetry: z -> -z turns hands, misalignment, bearings' places, axial forces and tilts round."""
    right = run(friction + CROWNED + misaligned(0.02, 0.01) + places((-40, 60), (-45, 50)), hand="right", offset=2.0)
    left = run(friction + CROWNED + misaligned(-0.02, -0.01) + places((-60, 40), (-50, 45)), hand="left", offset=-2.0)
    apart = difference(errors(left), errors(right))
    axial, tilts = (
        difference(-left.result[name].values, right.result[name].values) for name in ("reaction_z", "tilt_y")
    )
    measured(
        f"hands mirrored{', friction' if friction else ''}: transmission error, axial force, tilt",
        f"{apart:.1g}, {axial:.1g}, {tilts:.1g}",
        "1e-10",
        row=9,
    )
    assert max(apart, axial, tilts) <= 1e-10


def test_springs_from_soft_to_rigid(measured):
    """Row 15. Known limit: tilts and axial motion fall as 1/k to the pair on rigid shafts."""
    rigid = states(*marched(misaligned(0.02) + FRICTION), "transmission_error")
    tilts, axial, apart = [], [], []
    for factor in (1e-3, 1.0, 1e3, 1e6, 1e12):
        text = (
            places((-40, 60), (-45, 50))
            .replace('"0.2e6', f'"{0.2e6 * factor!r}')
            .replace('"0.1e6', f'"{0.1e6 * factor!r}')
        )
        on_springs = marched(misaligned(0.02) + FRICTION + text)
        tilts.append(float(np.abs(states(*on_springs, "tilt_y1")).mean()))
        axial.append(float(np.abs(states(*on_springs, "axial_1")).mean()))
        apart.append(difference(states(*on_springs, "transmission_error"), rigid))
        measured(
            f"springs x {factor:g}: tilt, axial motion, difference of the transmission error from rigid",
            f"{tilts[-1]:.2g} rad, {axial[-1]:.2g} mm, {apart[-1]:.1g}",
            "falling",
            row=15,
        )
    assert np.all(np.diff(tilts) < 0.0) and np.all(np.diff(axial) < 0.0)
    assert (
        np.all(np.diff(apart[:4]) < 0.0) and apart[3] == pytest.approx(1e-3 * apart[2], rel=0.05) and apart[-1] < 1e-9
    )


def loads():
    """Torques from nothing to thirty times the usual, N mm, with friction and without; by day none and the largest."""
    for torque in (0.0, 1e-12, 1.0, 200e3, 6e6):
        for friction in ("", FRICTION):
            by_day = friction and torque in (0.0, 6e6)
            yield pytest.param(torque, friction, marks=() if by_day else BY_NIGHT)


@pytest.mark.parametrize(("torque", "friction"), loads())
def test_any_torque_is_carried(torque, friction, measured):
    """Row 16. Exact identity: the wheel's couple is the load, no step fails; the laws of contact hold."""
    found = run(friction + CROWNED + misaligned(0.01), torque=torque)
    obeys_the_laws(found)
    spurious = float(np.abs(found.result["reaction_couple"].sel(gear="wheel").values + torque).max())
    limit = "1e-9 of the torque, at least 1e-9 N mm"
    measured(f"torque {torque:g} N mm: largest spurious torque", spurious, limit, "N mm", row=16)
    assert spurious <= 1e-9 * max(torque, 1.0)


@pytest.mark.parametrize("helix", [40.0, pytest.param(45.0, marks=BY_NIGHT)])
def test_steep_helix(helix, measured):
    """Row 3. Exact identity: without friction the axial force is the transverse one times the tangent of the base
    helix angle (ISO 21771: sin(beta_b) = sin(beta) cos(alpha_n)), opposite on both gears."""
    found = run(CROWNED + misaligned(0.01), helix=helix, teeth=(30, 50))
    obeys_the_laws(found)
    sine = np.sin(np.radians(helix)) * np.cos(np.radians(20.0))
    wanted = 200e3 / found.model.pair.wheel.base_radius * sine / np.sqrt(1.0 - sine**2)
    axial = found.result["reaction_z"]
    apart = float(np.abs(np.abs(axial.values) / wanted - 1.0).max())
    left = float(np.abs(axial.sum("gear").values).max()) / wanted
    measured(f"helix {helix:g} deg: error of the axial force, sum of both", f"{apart:.1g}, {left:.1g}", "1e-11", row=3)
    assert apart <= 1e-11 and left <= 1e-11


@pytest.mark.parametrize(
    ("helix", "in_plane"),
    [(0.0, 0.3), (20.0, -0.3), pytest.param(0.0, -0.3, marks=BY_NIGHT), pytest.param(20.0, 0.3, marks=BY_NIGHT)],
)
def test_misaligned_so_far_that_one_end_touches(helix, in_plane, measured):
    """Row 18. Equilibrium on fixed shafts; the warning says which part of the face touches."""
    found = run(misaligned(in_plane), helix=helix, torque=20e3)
    result, pair = found.result, found.model.pair
    transverse = 20e3 / pair.wheel.base_radius
    apart = float(np.abs(result["normal_force"].values * pair.cosine / transverse - 1.0).max())
    loaded = result["line_load"].sum(["contact_time", "slot"]).values > 0.0
    end = "left" if in_plane > 0.0 else "right"
    measured(
        f"misaligned by {in_plane} mm, helix {helix:g} deg: slices that touch, error of the force",
        f"{loaded.sum()} of 5, {apart:.1g}",
        "1e-11",
        row=18,
    )
    assert apart <= 1e-11 and 0 < loaded.sum() < 4 and loaded[0 if end == "left" else -1]
    assert "of the face only" in result.attrs["warnings"] and f"at its {end} end" in result.attrs["warnings"]


@pytest.mark.parametrize("steps", [pytest.param(10, marks=BY_NIGHT), 100])
def test_a_slice_on_the_pitch_point(steps, measured):
    """Row 21. Exactly or 1e-12 mm beside: no step fails, nothing changes."""
    last, methods = [], set()
    for beside in (0.0, 1e-12, -1e-12):
        model = model_of(
            helical_scene(
                FRICTION + BEARINGS, accuracy=f"slices = 5\ncontact_nodes = 13\nsteps_per_mesh_cycle = {steps}"
            )
        )
        cycle, pair = cycle_of(model, on_stand_in_bodies(model)), model.pair
        first = (pair.pitch_point + beside - pair.path_start) / pair.base_pitch * steps - 5
        cycle.position = lambda step, cycle=cycle, first=first: cycle.between(first + step, first + step - 1)
        march = Marcher(cycle, model.equations_of_motion).run(10, 11)
        smallest = np.abs(march.records[5].position.operator.rigid_slip).min()
        methods |= {method for method, count in march.steps_by_method.items() if count}
        last.append(march.records[-1].solution.forces)
    apart = max(difference(each, last[0]) for each in last[1:])
    measured(
        f"{steps} steps: smallest rigid slip, change of forces 1e-12 mm beside, methods",
        f"{smallest:.1g} mm, {apart:.1g}, {'; '.join(sorted(methods))}",
        "1e-9",
        row=21,
    )
    assert apart <= 1e-9
