"""Compile the hot kernels, or load them from disk, before the clock of the march starts.

`python -m fenics_gears.simulation.warm_up` compiles all of them that are not compiled yet into numba's files on disk
(`compiled_ahead`). The launcher calls it after the set-up and after each change of the sources. With the name of a part
it compiles that part in this process, until its standard input ends.
"""

import gc
import sys
import time
from functools import cache

import numpy as np

from fenics_gears.contact.compliance_product import NO_FLANK, compliance_products
from fenics_gears.contact.flank_at_height import points_of_pairs, roll_angle_at_height
from fenics_gears.contact.interpolation import (
    AVERAGED,
    INTERPOLATIONS,
    GearContacts,
    flank_interpolations,
    node_average,
    quadrature_offsets,
)
from fenics_gears.contact.kinematics import nodes_before
from fenics_gears.contact.laws import SLIP_FORWARD, Tolerance
from fenics_gears.contact.mixed_form import StepEquations
from fenics_gears.contact.operator import ContactOperator, Position
from fenics_gears.contact.rigid_step import solve_rigid
from fenics_gears.contact.step_solver import NEWTON, solve_step
from fenics_gears.contact.tooth_pair import DRIVE, PairNodes, Place, nodal_gap
from fenics_gears.contact.window import ContactGrid, node_offsets
from fenics_gears.dynamics.compiled_march import Course, Motion, solve_steps
from fenics_gears.dynamics.drivetrain import Drivetrain
from fenics_gears.dynamics.energy_account import contact_work
from fenics_gears.dynamics.steps import Steps, drive_flanks_touch, smallest_openings
from fenics_gears.dynamics.time_integration import Scheme
from fenics_gears.results.contact_variables import energy_of_teeth
from fenics_gears.results.crests import Searches
from fenics_gears.results.mesh_curves import stiffness_curves
from fenics_gears.results.numbers import largest_of_cubics
from fenics_gears.system.progress import LineProgress, Progress, SilentProgress

from .compiled_ahead import MARCH, compile_loops, end_at_once_by_ctrl_c, end_with_its_parent


def compile_kernels(tangential: bool, rigid: bool = False, progress: Progress | None = None) -> float:
    """Run every compiled kernel on a problem of one contact node, with `rigid` those of rigid flanks too; returns the
    seconds it took."""
    begun = time.perf_counter()
    compile_loops(progress or SilentProgress())
    _run_once(tangential, rigid)
    return time.perf_counter() - begun


@cache
def _run_once(tangential: bool, rigid: bool, evaluated: bool = True) -> None:
    _place_nodes(tangential)
    steps, problem = _steps(tangential)
    status = np.array([SLIP_FORWARD], dtype=np.int8)
    solve_step(problem, status)
    drivetrain = Drivetrain(("rotation_2",), np.ones(1), np.eye(1), np.ones(1), np.eye(1), None)
    motion = Motion.of(Scheme(drivetrain, 1.0), 0.1, problem.tolerance)
    solve_steps(steps, 1, 2, motion, Course(np.ones(2), np.ones((2, 1))))
    if rigid:
        solve_rigid(steps.positions[0], problem, status, None)
    if evaluated:
        _evaluate(steps, tangential)


def _place_nodes(tangential: bool) -> None:
    """Contact nodes on flanks and how these yield."""
    offsets = np.array([-0.1, 0.1])
    rolls = roll_angle_at_height(40.0, 0.5, 40.0 + offsets)
    ends = np.array([0, 2])
    contact = np.array([0.5])
    nodes = GearContacts(offsets, ends, rolls, contact, [np.linspace(0.4, 0.6, 5)], 40.0, -1, 1)
    (interpolation,) = flank_interpolations(nodes)
    node_average(offsets, roll_angle_at_height(40.0, 0.5, 40.0 + quadrature_offsets(offsets)))
    view = INTERPOLATIONS[AVERAGED]
    nodal_gap(view, offsets, ends, view.places(offsets, ends))
    points_of_pairs(40.0, -1, contact, np.array([40.0]), offsets, ends)
    node_offsets(((-0.1, -0.2), (0.1, 0.2)), ContactGrid(1.0, 5))
    kinds = 2 if tangential else 1
    near = np.ravel(interpolation.near)
    # With friction also along the tangent as it stood before.
    block = np.eye(10)
    results = np.zeros((2, 2 * kinds, 2 * kinds))
    positions = np.array([[results[0].ctypes.data, results[1].ctypes.data, 2, 2]])
    flanks = np.array([[0, interpolation.near.shape[1], 0, 2]])
    products = np.array([[0, block.ctypes.data, block.size, 10, 0, 0, 0 if tangential else NO_FLANK, 0, 0, 0]])
    axes = np.ones((1, kinds, 2))
    responding = np.ones((1, 2 * kinds - 1, 2))
    compliance_products((positions, flanks, products), near, interpolation.first, axes, responding)


def _steps(tangential: bool) -> tuple[Steps, StepEquations]:
    """Room for two steps of one contact node, and the problem of such a step."""
    kinds = 2 if tangential else 1
    node = np.zeros(1)
    row = np.eye(kinds, 1)
    tolerance = Tolerance.of_load(1.0)
    slip = np.ones(1) if tangential else np.empty(0)
    problem = StepEquations(np.eye(1), np.ones(1), np.eye(kinds), row, node, slip, 0.1, np.empty(0), tolerance)
    place = Place(0, DRIVE, (0.5, 0.5))
    both = np.zeros((2, 1))
    pair = PairNodes(place, node, node, node, both, both)
    earlier = (node, np.zeros((1, kinds)), np.zeros((1, 1))) if tangential else (None, None, None)
    operator = ContactOperator((pair,), (), both, np.eye(kinds), row, node, *earlier)
    position = Position(operator, nodes_before([((pair,), (pair,))], 0.1)[0])
    return Steps.to_solve(range(2), [position] * 2, 1, NEWTON), problem


def _evaluate(steps: Steps, tangential: bool) -> None:
    """What results are made of."""
    for evaluated in (contact_work, stiffness_curves, energy_of_teeth, smallest_openings, drive_flanks_touch):
        evaluated(steps)
    if tangential:
        # Imported here: runs without friction have none of it.
        from fenics_gears.contact.uniqueness import between_closed

        between_closed(np.zeros((1, 1)), np.eye(2), np.array([0]), np.ones(1))


def _look_for_extremes() -> None:
    """Not with every run: each is loaded where a run looks for its extremes."""
    largest_of_cubics(np.arange(4.0), np.zeros(4))
    Searches(np.arange(4.0), np.zeros((1, 4)), np.ones(1), 0.125)


def _compile_part(name: str) -> None:
    # Few of the many objects that numba makes are garbage before it ends.
    gc.set_threshold(100_000)
    if name == MARCH:
        for with_friction in (True, False):
            _run_once(with_friction, rigid=True, evaluated=False)
        _look_for_extremes()
        return
    for with_friction in (True, False):
        _evaluate(_steps(with_friction)[0], with_friction)
    # What is compiled already, a run in the plane does not load.
    from fenics_gears.contact import (
        between_flank_nodes,
        closed_compliance,
        factored_compliance,
        formed_rows,
        joined_rows,
        joined_solver,
        joined_table,
    )

    formed_rows.row_former()
    closed_compliance.functions()
    between_flank_nodes.put_between.compile(
        "(int64[::1], int64[:, ::1], int64[::1], float64[:, ::1], float64[:, :, :, :, :, ::1], float64[:, :, :, ::1],"
        " float64[::1])"
    )
    joined_rows.joined_row_former()
    factored_compliance.factored_solver()
    joined_solver.joined_solver()
    joined_table.joined_displacer()
    formed_rows.uncertain_slices.compile("(int64, float64[::1], float64)")
    formed_rows.fine_section.compile("(int64, int64)")


if __name__ == "__main__":
    end_at_once_by_ctrl_c()
    if sys.argv[1:]:
        end_with_its_parent()
        _compile_part(*sys.argv[1:])
    else:
        lines = LineProgress()
        compile_loops(lines)
        lines.close()
