"""The mean position of gears whose teeth pass faster than the drivetrain can follow: forces balance on the average of a
mesh cycle.

Held at centre coordinates q, the contact at each position of the cycle gives forces p_i(q). The mean position solves

    K q + mean(G_i^T p_i(q)) = F

by Newton's method, with G^T C^-1 G over the closed nodes as the contact's stiffness. The unbalanced force at each
position accelerates the gears; its integral over the cycle, less the mean, is the velocity of the steady motion at that
position.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from fenics_gears.contact.addresses import form_rows
from fenics_gears.contact.laws import OPEN, Tolerance
from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.contact.mixed_form import StepEquations
from fenics_gears.contact.operator import Position
from fenics_gears.contact.step_solver import StepSolution, cold_start

from .drivetrain import Drivetrain
from .steps import Record
from .time_integration import State

if TYPE_CHECKING:
    from .stepping import Stepper

ITERATIONS = 20
# Of the largest load. An unbalanced rest only adds a vibration of its size to the start of a run.
BALANCE = 1e-9

Held = Callable[[Position, np.ndarray], StepSolution]


@dataclass(frozen=True)
class MeanEquilibrium:
    """Mean centre coordinates (k,), mm, the velocity (k,), mm/s, of the steady motion at step 0, and the contact
    there."""

    position: np.ndarray
    velocity: np.ndarray
    solution: StepSolution


def mean_equilibrium(
    cycle: Cycle, drivetrain: Drivetrain, time_step: float, friction: float, tolerance: Tolerance, first: np.ndarray,
    slid: float,
    load: Callable[[float], np.ndarray],
) -> MeanEquilibrium:  # fmt: skip
    """Mean equilibrium of a drivetrain with inertia, sought from coordinates `first` (k,); `slid`: steps of sliding
    before each position;
    `load`: forces (k,), N, at a step.

    Raises ContactNotConverged.
    """
    cycle.build(range(cycle.steps))
    positions = [cycle.position(step) for step in range(cycle.steps)]
    held = _holder(cycle, friction, tolerance, slid)
    coordinates = first
    loads = [load(step) for step in range(cycle.steps)]
    largest = np.abs(loads).max(initial=0.0)
    for _ in range(ITERATIONS):
        solutions = [held(position, coordinates) for position in positions]
        left = np.array([_balance(drivetrain, *each, coordinates) for each in zip(loads, positions, solutions)])
        missing = left.mean(axis=0)
        if np.abs(missing).max() <= BALANCE * largest:
            break
        stiffness = np.mean([_contact_stiffness(*each) for each in zip(positions, solutions)], axis=0)
        coordinates = coordinates + np.linalg.lstsq(drivetrain.stiffness_at_work + stiffness, missing, rcond=None)[0]
    return MeanEquilibrium(coordinates, _velocity(drivetrain, left, time_step), held(positions[0], coordinates))


def mean_start(stepper: Stepper, static: Record, slid: float) -> Record:
    """The start at the mean equilibrium of the motion of a `stepper`, sought from the `static` one; `slid`: as of
    `mean_equilibrium`."""
    drivetrain, jacobian = stepper.drivetrain, static.position.operator.jacobian
    mean = mean_equilibrium(
        stepper.cycle, drivetrain, stepper.clock.duration(0, 1), stepper.friction, stepper.tolerance,
        static.state.position, slid, stepper.load,
    )  # fmt: skip
    left = stepper.load(0) - drivetrain.elastic_forces(mean.position) - jacobian.T @ mean.solution.forces
    if drivetrain.damping is not None:
        left = left - drivetrain.damping @ mean.velocity
    state = State(mean.position, mean.velocity, np.linalg.solve(drivetrain.mass, left))
    return Record(0, state, static.position, mean.solution)


def _holder(cycle: Cycle, friction: float, tolerance: Tolerance, slid: float) -> Held:
    """The contact of a position with the gears held at coordinates (k,)."""
    unit, nothing = np.eye(1), np.empty(0)

    def held(position: Position, coordinates: np.ndarray) -> StepSolution:
        operator = position.operator
        moved, nodes = operator.jacobian @ coordinates, operator.nodes
        slip_before = nothing if operator.rigid_slip is None else slid * operator.rigid_slip + moved[nodes:]
        gap = operator.gap - moved[:nodes]
        problem = StepEquations(
            unit,
            np.zeros(1),
            operator.stored.rows,
            np.zeros((len(operator.jacobian), 1)),
            gap,
            slip_before,
            friction,
            nothing,
            tolerance,
            rows=operator.stored.address,
        )
        solution = cycle.solve(position, problem, cold_start(gap, operator.node_pair), None)
        return replace(solution, coordinates=coordinates, displacement=solution.displacement + moved)

    return held


def _balance(
    drivetrain: Drivetrain, load: np.ndarray, position: Position, solution: StepSolution, coordinates: np.ndarray
) -> np.ndarray:
    """Unbalanced force (k,), N, of load, springs and contact."""
    return load - drivetrain.elastic_forces(coordinates) - position.operator.jacobian.T @ solution.forces


def _contact_stiffness(position: Position, solution: StepSolution) -> np.ndarray:
    """Stiffness (k, k), N/mm, of the contact along its normals."""
    closed = np.flatnonzero(solution.status != OPEN)
    jacobian = position.operator.jacobian[closed]
    stored = position.operator.stored
    # Meshes that are solved by themselves have no rows of all.
    form_rows(stored.address, closed)
    return jacobian.T @ np.linalg.solve(stored.rows[np.ix_(closed, closed)], jacobian)


def _velocity(drivetrain: Drivetrain, left: np.ndarray, time_step: float) -> np.ndarray:
    """Velocity (k,), mm/s, at the first of the positions whose unbalanced forces (n, k), N, are `left`; its mean over
    the cycle is zero."""
    acceleration = np.linalg.solve(drivetrain.mass, (left - left.mean(axis=0)).T).T
    gained = np.cumsum(0.5 * time_step * (acceleration + np.roll(acceleration, -1, axis=0)), axis=0)
    return -gained.mean(axis=0)
