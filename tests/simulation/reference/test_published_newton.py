"""The Newton method of Appendix B."""

from dataclasses import replace

import numpy as np
import pytest
from tests.simulation.reference.published_newton import Equations, iterates, merit
from tests.simulation.reference.published_solver import PublishedSolver

from fenics_gears import model_of
from fenics_gears.contact.laws import Tolerance
from fenics_gears.contact.mixed_form import StepEquations
from fenics_gears.contact.remeshed_mesh import RemeshedGears, paired_nodes
from fenics_gears.contact.step_solver import cold_start, solve_step
from fenics_gears.dynamics.march import Marcher
from fenics_gears.model.resolution import EVERY_STEP
from fenics_gears.scene.data import Accuracy
from fenics_gears.simulation.reference_route import reference_route
from fenics_gears.system.progress import SilentProgress

NODES, CENTRE = 7, 3
SEEDS = [pytest.param(seed, marks=pytest.mark.nightly if seed > 3 else ()) for seed in range(25)]


def random_problem(seed, tangential=True, friction=0.2):
    """A step in the mixed form with a regular drivetrain, and in [24], [25], [C.1] by K = (C + G K_eff^-1 G^T)^-1."""
    generator = np.random.default_rng(seed)
    m = 2 * NODES if tangential else NODES
    factor = generator.normal(size=(m, m))
    compliance = 1e-6 * (factor @ factor.T / m + np.eye(m))
    rigid = generator.uniform(-1.0, 1.0, (m, CENTRE))
    rigid[:NODES, 0] = 1.0
    root = generator.normal(size=(CENTRE, CENTRE))
    stiffness = 1e5 * (root @ root.T + np.eye(CENTRE))
    load = np.array([3e3, *generator.normal(size=CENTRE - 1) * 100.0])
    problem = StepEquations(
        stiffness=stiffness,
        load=load,
        compliance=compliance,
        jacobian=rigid,
        gap=generator.uniform(0.0, 0.02, NODES),
        slip_before=generator.normal(size=NODES) * 0.02 if tangential else np.empty(0),
        friction=friction if tangential else 0.0,
        free_motion=np.empty(0),
        tolerance=Tolerance.of_load(3e3),
    )
    moved = np.linalg.solve(stiffness, np.column_stack([load, rigid.T]))
    relative = np.linalg.inv(compliance + rigid @ moved[:, 1:])
    equations = Equations(
        stiffness=relative,
        load=-relative @ (rigid @ moved[:, 0]),
        gap=problem.gap,
        slip_before=problem.slip_before,
        friction=problem.friction,
        r=1.0 / np.diag(compliance),
    )
    return problem, equations


def solved(equations, most=200):
    """Iterates up to a merit that is round-off."""
    found = []
    for iterate in iterates(equations, np.zeros(len(equations.r)), np.zeros(len(equations.r))):
        found.append(iterate)
        if (len(found) > 1 and iterate.merit < 1e-14) or len(found) > most:
            return found


@pytest.mark.parametrize("tangential", [True, False])
@pytest.mark.parametrize("seed", SEEDS)
def test_same_solution_as_active_sets(seed, tangential):
    """Other solver: the active-set Newton on the mixed form."""
    problem, equations = random_problem(seed, tangential)
    expected = solve_step(problem, cold_start(problem.gap, np.zeros(NODES, dtype=int)))
    found = solved(equations)[-1]
    assert found.merit < 1e-14
    assert found.forces == pytest.approx(expected.forces, abs=1e-7 * 3e3)
    assert found.displacement == pytest.approx(expected.displacement, abs=1e-9)
    assert np.array_equal(equations.status(found.displacement, found.forces) > 0, expected.status > 0)


@pytest.mark.parametrize("seed", SEEDS)
def test_direction_is_newtons(seed):
    """Finite differences: along z the directional derivative of H is -H [B.2]."""
    _, equations = random_problem(seed)
    generator = np.random.default_rng(seed + 100)
    displacement, forces = generator.normal(size=2 * NODES) * 0.01, generator.normal(size=2 * NODES) * 2e3
    step_u, step_p = equations.direction(displacement, forces)
    small = 1e-9
    value = np.concatenate(equations.residual(displacement, forces))
    moved = np.concatenate(equations.residual(displacement + small * step_u, forces + small * step_p))
    assert (moved - value) / small == pytest.approx(-value, abs=2e-6 * np.abs(value).max())
    assert merit(equations, displacement, forces) == pytest.approx(0.5 * value @ value, rel=1e-12)


@pytest.mark.parametrize("case", ["static frictionless", "static"])
def test_a_run_has_the_steps_of_the_program(case, paper_cases, reference_cache):
    """Other solver: a mesh cycle with every step by the paper's Newton, and by the program's."""
    accuracy = Accuracy(
        element="P2",
        flank_element_size=0.3,
        contact_length=1.5,
        contact_nodes=8,
        steps_per_mesh_cycle=2,
        condensation=EVERY_STEP,
    )
    model = model_of(replace(paper_cases[case], accuracy=accuracy))
    gears, cycle = reference_route(model, SilentProgress(), reference_cache)
    grid = model.resolution.contact_grid
    nodes = paired_nodes(model.pair, model.removal, grid, 2, 2)
    stiffness = RemeshedGears(model.pair, nodes, list(zip(*(gear.positions for gear in gears)))).stiffness
    solver = PublishedSolver(model.drivetrain.indices, stiffness)
    published = reference_route(model, SilentProgress(), reference_cache)[1]
    published.mesh = replace(published.mesh, solve=solver, traits=replace(published.mesh.traits, own_solver=True))
    published.traits = published.mesh.traits
    found, expected = (Marcher(each, model.equations_of_motion).run(2, 3).records for each in (published, cycle))
    for one, other in zip(found, expected):
        assert one.solution.forces == pytest.approx(other.solution.forces, abs=1e-6 * other.solution.forces.max())
        assert one.state.position == pytest.approx(other.state.position, abs=1e-9)
