"""What must hold at every step of every run (rows 1 to 3), from the equations."""

from dataclasses import dataclass

import numpy as np
import xarray as xr
from tests.contact.laws_of_contact import law_residual
from tests.helical import helical_scene, on_stand_in_bodies

from fenics_gears.contact.errors import ContactNotConverged
from fenics_gears.contact.kinematics import displacement_jacobian
from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.dynamics.march import Marcher
from fenics_gears.elasticity.compliance import Bodies
from fenics_gears.model.model import Model, model_of
from fenics_gears.results.dataset import RunResult
from fenics_gears.results.recorder import Recorder
from fenics_gears.simulation.elastic_route import mesh_cycle
from fenics_gears.simulation.rigid_route import rigid_cycle


@dataclass(frozen=True)
class Run:
    """A march with all of its steps; `failure` where a step did not converge."""

    model: Model
    marcher: Marcher
    records: list
    result: xr.Dataset
    failure: ContactNotConverged | None = None

    @property
    def friction(self) -> float:
        return self.model.scene.friction.coefficient if self.model.scene.friction else 0.0


# Not numbers by design: contact nodes that do not stand, the place of the largest pressure where none is off the edges,
# the share at a point of the path that no loaded pair passes, and those of rigid pairs that touch together.
NODES_OF_THEIR_OWN, SHARES = (
    ("contact_offset", "contact_roll_angle", "_opening", "load_share", "pressure_roll_angle"),
    ("pair_normal_force", "pair_coast_normal_force"),
)
# Of wedged teeth that friction holds the flanks do not approach (docs/result.md).
OF_WEDGED_TEETH = ("mesh_stiffness",)


def cycle_of(model: Model, bodies: Bodies | None) -> Cycle:
    """Contact on given gears, None for rigid ones."""
    return rigid_cycle(model) if bodies is None else mesh_cycle(model, bodies)


def run_of(model: Model, bodies: Bodies | None) -> Run:
    """March a scene on given gears (as of `cycle_of`) and keep every step; its result is made too, of finite
    numbers."""
    cycle = cycle_of(model, bodies)
    without_number = NODES_OF_THEIR_OWN + (SHARES if bodies is None else ())
    if model.scene.friction and model.scene.coast_flanks:
        without_number += OF_WEDGED_TEETH
    marcher = Marcher(cycle, model.equations_of_motion)
    recorder = Recorder(model, cycle)
    try:
        march, failure = marcher.run(model.steps, model.steps + 1, observe=recorder.take), None
    except ContactNotConverged as failed:
        march, failure = failed.partial, failed
    result = RunResult(recorder, march).dataset
    for name, variable in result.data_vars.items():
        assert np.all(np.isfinite(variable)) or name.endswith(without_number), name
    return Run(model, marcher, list(march.records), result, failure)


def finished_helical_run(more: str = "", **changes) -> Run:
    """Of a helical scene on bodies without finite elements; every step converges."""
    model = model_of(helical_scene(more, **changes))
    found = run_of(model, on_stand_in_bodies(model))
    assert found.failure is None, str(found.failure)
    return found


def worst_of(run: Run) -> dict[str, float]:
    worst: dict[str, float] = {}
    # A step that was divided is judged part by part.
    passed = [part for record in run.records for part in record.parts or (record,)]
    for before, record in zip([None, *passed], passed):
        for name, value in step_residuals(run, before, record).items():
            worst[name] = max(worst.get(name, 0.0), value)
    return worst


def step_residuals(run: Run, before, record) -> dict[str, float]:
    """How far one step misses rows 1 to 3; `before`: the step before it, None at the start. Penetration in um;
    forces in parts of the largest force, works of that times the largest length, sums in parts of the sum of all
    nodal forces (times the centre distance)."""
    operator, forces = record.position.operator, record.solution.forces
    n = operator.nodes
    displacement = operator.jacobian @ record.state.position - operator.compliance @ forces
    slip_before = None if before is None else _slip_before(operator, before)
    laws = law_residual(forces, displacement, operator.gap, slip_before, run.friction)
    load = float(np.abs(run.model.drivetrain.load).max())
    force = max(float(np.abs(forces).max(initial=0.0)), load, 5e-3)
    terms = (operator.gap, record.state.position, operator.compliance @ forces)
    length = max(float(np.abs(each).max(initial=0.0)) for each in terms)
    found = {
        "penetration": 1e3 * laws["penetration"],
        "tension": laws["tension"] / force,
        "complementarity": float(np.max(np.abs(forces[:n] * (operator.gap - displacement[:n])), initial=0.0))
        / (force * length),
    }
    if len(forces) > n and slip_before is not None:
        slip = displacement[n:] + slip_before
        path = max(length, float(np.abs(slip).max(initial=0.0)))
        found["cone"] = laws["cone_excess"] / force
        found["wrong_way"] = laws["wrong_way"] / (force * path)
        found["dissipation"] = max(-float(forces[n:] @ slip), 0.0) / (force * path)
    return found | _action_and_reaction(run, operator, forces) | _equilibrium(run, record, force)


def _slip_before(operator, before) -> np.ndarray | None:
    if operator.rigid_slip is None:
        return None
    return operator.rigid_slip - (
        operator.previous_jacobian @ before.state.position - operator.previous_compliance @ before.solution.forces
    )


def _action_and_reaction(run: Run, operator, forces: np.ndarray) -> dict[str, float]:
    """Forces of the contact on the two gears and their moments about the pinion's centre, summed: zero."""
    pair = run.model.pair
    (radius_1, radius_2), frictional = pair.base_radii, len(forces) > operator.nodes
    rows = displacement_jacobian(operator.lines, frictional)
    on_pinion, on_wheel = -(rows.T @ forces)[:3], -(rows.T @ forces)[3:6]
    total = float(np.abs(forces).sum()) or 1.0
    # In the frame of the drive flanks' line of action, the wheel's centre seen from the pinion's.
    across, along = -(radius_1 + radius_2), pair.line_of_action_length
    couple = radius_1 * on_pinion[2] + radius_2 * on_wheel[2] + (along * on_wheel[1] - across * on_wheel[0])
    found = {
        "sum_of_forces": float(np.abs(on_pinion[:2] + on_wheel[:2]).max()) / total,
        "sum_of_moments": abs(couple) / (total * pair.centre_distance),
    }
    if operator.face.slices > 1:
        axial, moments = _along_the_axes(operator, -(rows.T @ forces)[7:], on_wheel, (along, across))
        found |= {
            "sum_of_axial_forces": axial / total,
            "sum_of_tilting_moments": moments / (total * pair.centre_distance),
        }
    # A tip's edge touches along a line of its own, with another lever arm.
    if not frictional and all(each.place.line is None for each in operator.pairs):
        found["couples_by_base_radii"] = abs(on_pinion[2] - on_wheel[2]) / total
    return found


def _along_the_axes(
    operator, on_gears: np.ndarray, on_wheel: np.ndarray, centre: tuple[float, float]
) -> tuple[float, float]:
    """Sum of the axial forces, N, and of the moments about x and y through the pinion's mid-width, N mm."""
    (radius_1, radius_2), (along, across) = [side.gear.base_radius for side in operator.sides], centre
    (axial_1, x_1, y_1), (axial_2, x_2, y_2) = on_gears.reshape(2, 3)
    beside = operator.face.middles[1] - operator.face.middles[0]
    about_x = radius_1 * x_1 + radius_2 * x_2 + across * axial_2 - beside * on_wheel[1]
    about_y = radius_1 * y_1 + radius_2 * y_2 + beside * on_wheel[0] - along * axial_2
    return abs(axial_1 + axial_2), max(abs(about_x), abs(about_y))


def _equilibrium(run: Run, record, force: float) -> dict[str, float]:
    """Without masses springs, load and contact balance at every step."""
    train = run.model.drivetrain
    if train.mass is not None:
        return {}
    operator = record.position.operator
    springs = train.stiffness @ record.state.position
    left = springs + operator.jacobian.T @ record.solution.forces - run.marcher.stepper.load(record.step)
    # Round-off of stiff springs' forces is part of what they carry.
    scale = max(force, float(np.abs(train.stiffness).max() * np.abs(record.state.position).max()))
    return {"equilibrium": float(np.abs(left).max()) / scale}
