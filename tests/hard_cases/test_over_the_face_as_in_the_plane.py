"""Rows 10 to 12, 19, 20 and 23 to 25 over the face, by the code that judges them in the plane."""

import numpy as np
import pytest
from tests.frozen_gears import frozen_at
from tests.hard_cases.invariants import cycle_of, run_of
from tests.hard_cases.test_over_the_face_in_time import DAMPED
from tests.hard_cases.test_over_the_face_static import FEW, marched, misaligned, run, states
from tests.hard_cases.test_row_10_friction_to_zero import is_of_its_order
from tests.hard_cases.test_row_11_scale_of_r import SCALES, do_not_depend_on_r
from tests.hard_cases.test_row_12_order import is_the_same
from tests.hard_cases.test_row_20_strong_friction import converges_or_says_why, locks_from
from tests.hard_cases.test_row_23_mesh_frequency import apart, does_not_ring
from tests.hard_cases.test_row_25_order_in_time import orders_of
from tests.helical import BEARINGS, CROWNED, FRICTION, INERTIA, SHAFTS, helical_scene, on_stand_in_bodies
from tests.permuted_cycle import in_other_order, solved_by

from fenics_gears import model_of
from fenics_gears.contact.step_solver import cold_start
from fenics_gears.dynamics.march import Marcher

BY_NIGHT = pytest.mark.nightly
LEANING = CROWNED + misaligned(0.01)


def ready(more):
    model = model_of(helical_scene(more, accuracy=FEW))
    return model, cycle_of(model, on_stand_in_bodies(model))


def records(model, cycle):
    return Marcher(cycle, model.equations_of_motion).run(model.steps, model.steps + 1).records


def test_effect_of_friction_is_of_its_order(measured):
    """Row 10. Known order, as in the plane."""

    def error_with(coefficient):
        friction = f"[friction]\ncoefficient = {coefficient!r}\n" if coefficient else ""
        return states(*marched(LEANING + friction), "transmission_error")

    is_of_its_order("quasi-static", error_with, measured)


@pytest.mark.parametrize("scale", [SCALES[0], *(pytest.param(each, marks=BY_NIGHT) for each in SCALES[1:])])
@pytest.mark.parametrize("friction", [pytest.param("", marks=BY_NIGHT), FRICTION])
def test_steps_do_not_depend_on_r(friction, scale, measured):
    """Row 11. Exact: a solution is a fixed point of the projections for every r."""
    (model, cycle), problems = ready(LEANING + friction), []
    plain = cycle.solve

    def solve(position, problem, status, last):
        problems.append((problem, cold_start(problem.gap, position.operator.node_pair)))
        return plain(position, problem, status, last)

    records(model, solved_by(cycle, solve))
    do_not_depend_on_r(problems, scale, "steps of a helical pair", measured)


@pytest.mark.parametrize("more", [pytest.param("", marks=BY_NIGHT), FRICTION + BEARINGS], ids=["alone", "friction"])
def test_order_of_contact_nodes_and_gears(more, measured):
    """Row 12. Exact identity: shuffled nodes and coordinates have the same solution."""
    found = []
    for seed in (1, None):
        model, cycle = ready(LEANING + more)
        steps = records(model, cycle if seed is None else in_other_order(cycle, seed))
        error = states(model, steps, "transmission_error")
        found.append((error, np.concatenate([each.solution.forces for each in steps])))
    is_the_same(*found, "friction, gears that tilt" if more else "frictionless", "forces", measured)


@pytest.mark.parametrize("nodes", [2, 101])
def test_contact_nodes_too_few_or_too_close(nodes, measured):
    """Row 19. Equilibrium; nodes that elements cannot tell apart are named by a warning."""
    found = run(LEANING, accuracy=f"slices = 3\ncontact_nodes = {nodes}\nsteps_per_mesh_cycle = 4")
    pair = found.model.pair
    held = 200e3 / pair.wheel.base_radius
    error = float(np.abs(found.result["normal_force"].values * pair.cosine / held - 1.0).max())
    measured(f"{nodes} contact nodes in a slice: error of the force", error, 1e-11, row=19)
    assert ("contact compliance is singular" in found.result.attrs["warnings"]) == (nodes == 101)


@pytest.mark.parametrize(
    "more",
    [LEANING, pytest.param(LEANING + BEARINGS, marks=BY_NIGHT), pytest.param(DAMPED + BEARINGS, marks=BY_NIGHT)],
    ids=["rigid shafts", "gears that tilt", "inertia"],
)
@pytest.mark.parametrize("friction", [0.3, pytest.param(0.6, marks=BY_NIGHT), pytest.param(1.0, marks=BY_NIGHT), 2.0])
def test_strong_friction_converges_or_says_why(friction, more, request, measured):
    """Row 20. Coulomb's law from the equations and the wheel's balance of moments; the normal force is by
    1/cos(beta_b) larger than what drives."""
    model = model_of(helical_scene(more + f"[friction]\ncoefficient = {friction!r}\n", accuracy=FEW))
    locks = locks_from(model.pair) * model.pair.cosine
    words = request.node.callspec.id.rpartition("-")[2]
    converges_or_says_why(run_of(model, on_stand_in_bodies(model)), words, locks, measured)


@pytest.mark.parametrize("friction", [pytest.param("", marks=BY_NIGHT), FRICTION], ids=["frictionless", "friction"])
def test_low_end_is_quasi_static_and_does_not_ring(friction, measured):
    """Row 23. Limit: inertia and damping vanish."""
    more, slow = LEANING + BEARINGS + SHAFTS + friction, {"frequency": 0.01, "cycles": 3}
    dynamic, static = (states(*marched(each + more, **slow), "transmission_error") for each in (DAMPED, ""))
    does_not_ring(apart(dynamic, static), f"0.01 Hz, {'friction' if friction else 'frictionless'}", measured)


def test_high_end_is_the_rigid_mean_motion(measured):
    """Row 23. Newton's law: the ripple meets mass alone and falls as 1/f^2."""
    ripples = [
        np.ptp(states(*marched(INERTIA + LEANING, frequency=each, cycles=each // 2000), "transmission_error")[-9:])
        for each in (40_000, 80_000)
    ]
    order = float(np.log2(ripples[0] / ripples[1]))
    measured("order of the peak-to-peak value in 1 / mesh frequency, 40 to 80 kHz", order, "2 +- 0.1", row=23)
    assert order == pytest.approx(2.0, abs=0.1)


@pytest.mark.parametrize("frequency", [17.0, pytest.param(200.0, marks=BY_NIGHT)])
def test_large_steps_are_finite_and_bounded(frequency, measured):
    """Row 24. Twice the quasi-static energy bounds both methods of stepping."""
    two = {"accuracy": FEW.replace("= 8", "= 2"), "frequency": frequency, "cycles": 20}
    found, static = (run(more + LEANING + BEARINGS + SHAFTS, **two).result for more in (DAMPED, ""))
    ratio = float(found["energy"].max() / static["energy"].max())
    measured(f"largest energy / static energy, 2 steps per mesh cycle at {frequency:g} Hz", ratio, 2.0, row=24)
    assert np.all(np.isfinite(found["transmission_error"]))


def test_order_two_while_the_status_stands(measured):
    """Row 25. Exact solution: while the closed nodes stay closed, the matrix exponential."""
    model, cycle = ready(DAMPED + BEARINGS + SHAFTS + LEANING)
    shafts = model.drivetrain
    orders = orders_of(lambda step: (frozen_at(cycle, model.scene, shafts, step, 3), shafts), 5e-4, (400, 800, 1600))
    measured("order while the contact status is unchanged", orders[-1], "2 +- 0.1", row=25)
    assert orders == pytest.approx([2.0, 2.0], abs=0.1)
