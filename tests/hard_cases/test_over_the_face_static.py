"""Rows 9 to 21 without inertia, on flanks resolved over the face; bodies without finite elements."""

from dataclasses import replace

import numpy as np
import pytest
from tests.hard_cases.invariants import cycle_of, run_of
from tests.hard_cases.test_row_11_scale_of_r import scaled_step
from tests.helical import BEARINGS, CROWNED, FRICTION, SHAFTS, helical_scene, on_stand_in_bodies

from fenics_gears.contact.errors import ContactNotConverged, MoreThanOneSolution, SelfLocking
from fenics_gears.dynamics.march import Marcher
from fenics_gears.model.model import model_of

EVERYTHING = BEARINGS + FRICTION + SHAFTS + CROWNED


FEW = "slices = 5\ncontact_nodes = 9\nsteps_per_mesh_cycle = 8"
BY_NIGHT = pytest.mark.nightly


def run(more="", **changes):
    """A run of a scene; it must not fail."""
    model = model_of(helical_scene(more, **{"accuracy": FEW, **changes}))
    found = run_of(model, on_stand_in_bodies(model))
    assert found.failure is None, str(found.failure)
    return found


def marched(more):
    """The model and the records of a march, without their result, which takes longer."""
    model = model_of(helical_scene(more, accuracy=FEW))
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


@pytest.mark.parametrize("friction", [pytest.param("", marks=BY_NIGHT), FRICTION])
def test_hands_in_the_mirror(friction, measured):
    """Row 9. Exact symmetry: z -> -z turns hands, misalignment, places of bearings, axial forces and tilts round, and
    nothing else."""
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


def test_friction_to_zero(measured):
    """Row 10. Known order: the difference from the frictionless run is in proportion to the coefficient; that has no
    tangential unknowns."""
    (model, records), apart = marched(CROWNED + BEARINGS), {}
    assert all(len(record.solution.forces) == record.position.operator.nodes for record in records)
    plain = states(model, records, "transmission_error")
    for friction in (1e-2, 1e-4, 1e-6, 1e-12):
        rubbing = states(
            *marched(CROWNED + BEARINGS + f"[friction]\ncoefficient = {friction!r}\n"), "transmission_error"
        )
        apart[friction] = difference(rubbing, plain) / friction
        measured(
            f"mu = {friction:g}: relative difference of the transmission error / mu",
            apart[friction],
            "alike; from 1e-12 round-off",
            row=10,
        )
    assert apart[1e-4] == pytest.approx(apart[1e-2], rel=0.1) and apart[1e-6] == pytest.approx(apart[1e-4], rel=0.1)
    assert apart[1e-12] * 1e-12 < 1e-10


@pytest.mark.parametrize("scale", [pytest.param(1e-6, marks=BY_NIGHT), 1e6])
def test_scale_of_r(scale, measured):
    """Row 11. Exact: r steers which sets are tried, never what a solution is."""
    model = model_of(helical_scene(EVERYTHING, accuracy=FEW))
    compliances, marches = on_stand_in_bodies(model), []
    for scaled in (False, True):
        cycle = cycle_of(model, compliances)
        if scaled:
            cycle.solve = lambda position, problem, status, last: scaled_step(problem, status, scale)
        marches.append(Marcher(cycle, model.equations_of_motion).run(8, 9).records)
    worst = max(difference(one.solution.forces, other.solution.forces) for one, other in zip(*marches))
    measured(f"r x {scale:g}: difference of forces", worst, "1e-9", row=11)
    assert worst <= 1e-9


def test_order_of_nodes_and_coordinates(measured):
    """Row 12. Exact: a step's equations with nodes of all slices and coordinates shuffled have the same solution."""
    model, random = model_of(helical_scene(EVERYTHING, accuracy=FEW)), np.random.default_rng(3)
    (_, plain), cycle = marched(EVERYTHING), cycle_of(model, on_stand_in_bodies(model))
    own = cycle.solve

    def solve(position, problem, status, last):
        nodes, coordinates = random.permutation(len(problem.gap)), random.permutation(len(problem.load))
        rows = np.concatenate([nodes, len(nodes) + nodes])
        shuffled = replace(
            problem, stiffness=problem.stiffness[np.ix_(coordinates, coordinates)].copy(),
            load=problem.load[coordinates],
            compliance=problem.compliance[np.ix_(rows, rows)].copy(),
            jacobian=problem.jacobian[np.ix_(rows, coordinates)].copy(),
            gap=problem.gap[nodes],
            slip_before=problem.slip_before[nodes] if len(problem.slip_before) else problem.slip_before,
            free_motion=problem.free_motion[coordinates] if len(problem.free_motion) else problem.free_motion,
        )  # fmt: skip
        found = own(position, shuffled, status[nodes], None)
        orders = {"forces": rows, "displacement": rows, "coordinates": coordinates, "status": nodes}
        return replace(
            found,
            **{
                name: getattr(found, name)[np.argsort(order[: len(getattr(found, name))])]
                for name, order in orders.items()
            },
        )

    cycle.solve = solve
    records = Marcher(cycle, model.equations_of_motion).run(model.steps, model.steps + 1).records
    worst = max(difference(one.solution.forces, other.solution.forces) for one, other in zip(records, plain))
    measured("contact nodes of all slices and coordinates shuffled: change of forces", worst, "1e-11", row=12)
    assert worst <= 1e-11


def test_units(measured):
    """Row 13. Exact: all stiffnesses and loads times a million (stresses in another unit) change no displacement and no
    iteration."""
    million, found = 1e6, []
    for factor in (1.0, million):
        more = (
            CROWNED
            + FRICTION
            + f'[shafts]\ntorsional_stiffness = "{1e8 * factor!r} N mm/rad"\n'
            + places((-40, 60), (-45, 50))
            .replace('"0.2e6', f'"{0.2e6 * factor!r}')
            .replace('"0.1e6', f'"{0.1e6 * factor!r}')
        )
        model = model_of(
            helical_scene(more, accuracy=FEW, torque=200e3 * factor, elasticities=(206e3 * factor, 206e3 * factor))
        )
        sections, bodies = on_stand_in_bodies(model)
        sections = tuple(replace(each, blocks=each.blocks / factor) for each in sections)
        bodies = tuple(
            replace(each, blocks=each.blocks / factor, plane=replace(each.plane, blocks=each.plane.blocks / factor))
            for each in bodies
        )
        found.append(run_of(model, (sections, bodies)))
    apart = difference(errors(found[1]), errors(found[0]))
    same = np.array_equal(*(each.result["newton_iterations"].values for each in found))
    measured(
        "stresses in a unit a million times smaller: difference of the transmission error, same iterations",
        f"{apart:.1g}, {same}",
        "1e-9, True",
        row=13,
    )
    assert apart <= 1e-9 and same


def test_springs_from_soft_to_rigid(measured):
    """Row 15. Known limit: tilts and axial motion fall as the bearings stiffen, in proportion to 1/k in the end, to the
    pair on rigid shafts."""
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


TILTING = CROWNED + FRICTION + BEARINGS


@pytest.mark.parametrize(
    ("torque", "more"),
    [(0.0, TILTING), (1e-12, CROWNED), (1.0, CROWNED), (2e6, TILTING)]
    + [
        pytest.param(torque, more, marks=BY_NIGHT)
        for torque, more in ((0.0, CROWNED), (1e-12, TILTING), (1.0, TILTING), (2e6, CROWNED))
    ],
)
def test_any_torque(torque, more, measured):
    """Row 16. Exact (equilibrium): the wheel's torque is the load; nothing is added, no step fails."""
    result = run(more, torque=torque).result
    spurious = float(np.abs(result["reaction_couple"].sel(gear="wheel").values + torque).max())
    measured(
        f"torque {torque:g} N mm: largest spurious torque",
        spurious,
        "1e-9 of the torque, at least 1e-9 N mm",
        "N mm",
        row=16,
    )
    assert spurious <= 1e-9 * max(torque, 1.0)
    # Without load the touching node's force is the round-off of zero.
    assert result["line_load"].values.min() >= -1e-9


@pytest.mark.parametrize(
    ("helix", "in_plane"),
    [(0.0, 0.3), (20.0, -0.3), pytest.param(0.0, -0.3, marks=BY_NIGHT), pytest.param(20.0, 0.3, marks=BY_NIGHT)],
)
def test_misaligned_so_far_that_one_end_touches(helix, in_plane, measured):
    """Row 18. Equilibrium: with fixed shafts any torque closes some contact in the end; the warning says which part of
    the face it is."""
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


def test_touching_over_the_whole_face_is_no_warning():
    """Row 18. The other side: a pair that carries over its face says nothing of it; a strongly crowned one touches in
    the middle."""
    assert "of the face only" not in run().result.attrs["warnings"]
    crowned = run('[lead_modifications.pinion]\ncrowning = "0.2 mm"\n', torque=2e3).result.attrs["warnings"]
    assert "of the face only, from" in crowned and "crowning" in crowned


@pytest.mark.parametrize("friction", [0.3, pytest.param(0.6, marks=BY_NIGHT), 1.0])
def test_strong_friction(friction, measured):
    """Row 20. The run converges or names self-locking or more than one solution; what it has done until then obeys the
    laws (row 2)."""
    model = model_of(helical_scene(BEARINGS + f"[friction]\ncoefficient = {friction}\n", accuracy=FEW))
    found = run_of(model, on_stand_in_bodies(model))
    warnings = found.result.attrs["warnings"]
    outcome = "converges" if found.failure is None else type(found.failure).__name__
    outcome += ", self-locking named" if "self-locking" in warnings else ""
    outcome += ", not certified as the only solution" if "more than one solution" in warnings else ""
    measured(f"mu = {friction}: outcome", outcome, "converges, or the cause is named", row=20)
    assert found.failure is None or isinstance(found.failure, (SelfLocking, MoreThanOneSolution))
    assert not isinstance(found.failure, ContactNotConverged) or found.failure.reason


@pytest.mark.parametrize("steps", [pytest.param(10, marks=BY_NIGHT), 100])
def test_a_slice_on_the_pitch_point(steps, measured):
    """Row 21. The middle slice stands on the pitch point, exactly or 1e-12 mm beside it, at a step: no step fails,
    nothing changes."""
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
