"""Contact steps without gears."""

import numpy as np

from fenics_gears.contact.laws import OPEN, Tolerance
from fenics_gears.contact.mixed_form import StepEquations
from fenics_gears.contact.operator import ContactOperator
from fenics_gears.contact.step_solver import StepSolution, cold_start, solve_step


def random_problem(seed, nodes=8, friction=0.0, coordinates=3, load_scale=1e4, free=False) -> StepEquations:
    """Random positive definite compliance and stiffness; gaps and loads of any sign. `free`: only contact holds the
    load along the first coordinate."""
    rng = np.random.default_rng(seed)
    size = 2 * nodes if friction else nodes
    root = rng.normal(size=(size, size)) / np.sqrt(size)
    compliance = 1e-6 * (root @ root.T + 0.2 * np.eye(size))
    bend = rng.normal(size=(coordinates, coordinates))
    rigid = rng.normal(size=(size, coordinates))
    stiffness = 1e5 * (bend @ bend.T + np.eye(coordinates))
    load = load_scale * rng.normal(size=coordinates)
    if free:
        stiffness[0], stiffness[:, 0], rigid[:nodes, 0], load[0] = 0.0, 0.0, 1.0, abs(load[0])
    return StepEquations(
        stiffness=stiffness,
        load=load,
        compliance=compliance,
        jacobian=rigid,
        gap=0.02 * rng.normal(size=nodes),
        slip_before=0.02 * rng.normal(size=nodes) if friction else np.empty(0),
        friction=friction,
        free_motion=np.eye(coordinates)[0] if free else np.empty(0),
        tolerance=Tolerance.of_load(load_scale),
    )


def all_open(problem: StepEquations) -> np.ndarray:
    return np.full(len(problem.gap), OPEN, dtype=np.int8)


def only_one_moves(compliance, jacobian, gap, force: float) -> StepEquations:
    """Without friction or springs, a force (N) on the one coordinate."""
    return StepEquations(
        np.zeros((1, 1)),
        np.array([force]),
        compliance,
        jacobian,
        gap,
        np.empty(0),
        0.0,
        np.array([np.sign(force)]),
        Tolerance.of_load(abs(force)),
    )


def pressed(operator: ContactOperator, force: float, jacobian=None) -> StepSolution:
    jacobian = operator.jacobian if jacobian is None else jacobian
    problem = only_one_moves(operator.compliance, jacobian, operator.gap, force)
    return solve_step(problem, cold_start(operator.gap, operator.node_pair))
