"""The mesh of rigid flanks: the tooth pair with the smallest gap carries the whole force, and its gap is the
kinematic transmission error."""

from __future__ import annotations

import numpy as np

from fenics_gears.geometry.pair import GearPair
from fenics_gears.geometry.sliding import sliding_per_rotation

from .errors import NoStaticEquilibrium
from .interpolation import hat_integrals
from .kinematics import lines_of
from .laws import OPEN
from .mesh import Mesh, MeshTraits, nodes_at
from .mixed_form import Iterate
from .newton import ALL_AT_ONCE, CONVERGED, Method
from .operator import ContactOperator, Passage, Position, Response
from .places import pair_places
from .rigid_step import Sides, rigid_step
from .step_solver import NEWTON, StepProblem, StepSolution
from .tooth_pair import DRIVE, PairNodes, Place, Removal, count_of, facing_points_at
from .window import ContactGrid, flank_ends, node_offsets


def rigid_mesh(
    pair: GearPair, removal: tuple[Removal | None, Removal | None], grid: ContactGrid, coast_flanks: bool = False
) -> Mesh:
    """Rigid flanks; `removal`: material removed from either drive flank."""
    return Mesh(
        pair,
        grid,
        lambda phases: [
            nodes_at(pair_places(pair, grid, phase, coast_flanks), lambda place: _nodes(pair, removal, grid, place))
            for phase in phases
        ],
        lambda passages: [_response(pair, passage) for passage in passages],
        solve_rigid,
        MeshTraits(has_pressure=False, rigid=True),
        coast_flanks=coast_flanks,
    )


def _nodes(pair: GearPair, removal, grid: ContactGrid, place: Place) -> PairNodes | None:
    offsets = node_offsets(flank_ends(pair, place.contact_rolls), grid)
    if not len(offsets):
        return None
    if offsets[0] < 0.0 < offsets[-1]:
        # True involutes touch on the line of action itself.
        offsets = np.unique(np.append(offsets, 0.0))
    removal = removal if place.flank == DRIVE else (None, None)
    rolls, arms, gap = facing_points_at(pair, removal, place, offsets)
    return PairNodes(place, offsets, hat_integrals(offsets), gap, arms, rolls)


def _response(pair: GearPair, passage: Passage) -> Response:
    """No compliance, and the sense in which the nodes slide in the nominal motion."""
    nodes = count_of(passage.pairs)
    if passage.previous is None:
        return Response(np.zeros((nodes, nodes)))
    lines = lines_of(passage.pairs, pair.sides)
    sliding = np.sign(lines.turn * sliding_per_rotation(pair, lines.friction_arms[0]))
    # By columns, as it is stored.
    before = np.zeros((2 * count_of(passage.previous), nodes)).T
    return Response(np.zeros((2 * nodes, 2 * nodes)), before, sliding=sliding)


def solve_rigid(
    position: Position, problem: StepProblem, status: np.ndarray, last: StepSolution | None
) -> StepSolution:
    """A step between rigid flanks, as `mesh.Mesh` solves one. Raises NoStaticEquilibrium where nothing holds the
    load."""
    operator = position.operator
    tolerance = problem.tolerance
    sliding = np.empty(0) if operator.sliding is None else operator.sliding
    sides = Sides(operator.on_drive_flanks, operator.node_pair, sliding)
    method = Method(1.0, ALL_AT_ONCE, tolerance.length, tolerance.force)
    m = len(problem.compliance)
    iterate = Iterate(status, np.zeros(m), np.zeros(len(problem.load)), np.zeros(m))
    outcome, iterations = rigid_step(problem.equations, sides, iterate, method)
    if outcome != CONVERGED:
        raise _no_equilibrium(operator, problem)
    return StepSolution(iterate.forces, iterate.coordinates, iterate.displacement, status, iterations, NEWTON)


def _no_equilibrium(operator: ContactOperator, problem: StepProblem) -> NoStaticEquilibrium:
    """The error of a load that no set of nodes holds."""
    drive = operator.on_drive_flanks
    words = problem.free_words or "the load moves the drivetrain freely"
    reason = f"no equilibrium: neither the drive flanks nor the coast flanks hold the load: {words}"
    leaders = [nodes[np.argmin(problem.gap[nodes])] for nodes in map(np.flatnonzero, (drive, ~drive)) if len(nodes)]
    play = float(problem.gap[leaders].sum())
    if len(leaders) == 2 and play < 0.0 and np.linalg.matrix_rank(problem.jacobian[leaders], tol=1e-9) < 2:
        reason = (
            f"no equilibrium: rigid teeth are wedged between drive and coast flanks, by {-1e3 * play:.4g} um more than"
            " there is backlash: raise gears.centre_distance, lower the flank deviations, or make teeth or bearings"
            " elastic ([gears.material], [bearings])"
        )
    sets = np.full((1, len(problem.gap)), OPEN, dtype=np.int8)
    return NoStaticEquilibrium([("rigid flanks", "no solution", np.zeros((1, 5)), sets)], reason)
