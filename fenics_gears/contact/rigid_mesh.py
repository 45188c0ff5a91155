"""The mesh of rigid flanks: the tooth pair with the smallest gap carries the whole force, and its gap is the
kinematic transmission error.

All contact nodes of the drive flanks move alike with the gears, by the base radii and along the line of action; so do
those of the coast flanks. On either side only the node with the smallest gap can touch. Where several pairs have the
same gap, as true involutes do wherever two pairs are in mesh, their shares of the force are not determined; the step's
solution puts the whole force on the first of them.
"""

from __future__ import annotations

import numpy as np

from fenics_gears.contact.errors import ContactNotConverged, NoStaticEquilibrium
from fenics_gears.contact.interpolation import hat_integrals
from fenics_gears.contact.laws import OPEN, SLIP_BACKWARD, SLIP_FORWARD, STICK
from fenics_gears.contact.mesh import Mesh, MeshTraits, nodes_at
from fenics_gears.contact.mesh_cycle import Position
from fenics_gears.contact.operator import ContactOperator, Passage, Response, count_of
from fenics_gears.contact.places import pair_places
from fenics_gears.contact.step_solver import NEWTON, StepProblem, StepSolution
from fenics_gears.contact.tooth_pair import DRIVE, PairNodes, Place, Removal, facing_points
from fenics_gears.contact.window import ContactGrid, flank_ends, node_offsets
from fenics_gears.geometry.pair import GearPair

# Gaps (mm) that differ by less are the same: the round-off of positions on the line of action.
SAME_GAP = 1e-10


def rigid_mesh(
    pair: GearPair,
    removal: tuple[Removal | None, Removal | None],
    grid: ContactGrid,
    coast_flanks: bool = False,
    frictional: bool = False,
) -> Mesh:
    """Rigid flanks; `removal`: material removed from either drive flank."""
    if frictional:
        from fenics_gears.contact.rigid_friction import RigidFriction as kind
    else:
        kind = RigidSolver
    return Mesh(
        pair,
        grid,
        lambda phase: nodes_at(
            pair_places(pair, grid, phase, coast_flanks), lambda place: _nodes(pair, removal, grid, place)
        ),
        _rigid,
        kind(pair),
        MeshTraits(has_pressure=False, prescribes_friction=frictional, own_solver=True),
        coast_flanks=coast_flanks,
    )


def _nodes(pair: GearPair, removal, grid: ContactGrid, place: Place) -> PairNodes | None:
    offsets = node_offsets(flank_ends(pair, place.contact_rolls), grid)
    if not len(offsets):
        return None
    if offsets[0] < 0.0 < offsets[-1]:
        # True involutes touch on the line of action itself.
        offsets = np.unique(np.append(offsets, 0.0))
    (pinion_roll, _), (x_1, x_2), gap = facing_points(
        pair, removal if place.flank == DRIVE else (None, None), place, offsets
    )
    return PairNodes(place, offsets, hat_integrals(offsets), gap, x_1, x_2, pinion_roll)


def _rigid(passage: Passage) -> Response:
    """No compliance: views of a single zero."""
    nodes = count_of(passage.pairs)
    if passage.previous is None:
        return Response(np.broadcast_to(0.0, (nodes, nodes)))
    before = np.broadcast_to(0.0, (nodes, 2 * count_of(passage.previous)))
    return Response(np.broadcast_to(0.0, (2 * nodes, 2 * nodes)), before)


class RigidSolver:
    """Solves a step between rigid flanks without friction."""

    def __init__(self, pair: GearPair):
        self.pair = pair

    def __call__(
        self, position: Position, problem: StepProblem, status: np.ndarray, last: StepSolution | None
    ) -> StepSolution:
        """The step with the first of `_candidates` that holds the load: no node touching, or the leading node of a
        side, or of both.

        Raises ContactNotConverged where none of them holds the load.
        """
        drive = position.operator.on_drive_flanks
        sides = (np.flatnonzero(drive), np.flatnonzero(~drive))
        leaders = [int(nodes[np.argmin(problem.gap[nodes])]) for nodes in sides if len(nodes)]
        for iterations, touching in enumerate(self._candidates(leaders), 1):
            unit = self._unit_forces(position.operator, problem, touching)
            forces, coordinates = _solved(problem, touching, unit)
            if forces is not None and _obeys(problem, leaders, touching, forces, coordinates):
                displacement = problem.jacobian @ coordinates
                return StepSolution(
                    forces, coordinates, displacement, _status(unit, len(problem.gap)), iterations, NEWTON
                )
        raise _no_equilibrium(problem, leaders)

    def _candidates(self, leaders: list[int]) -> list[list[int]]:
        """Sets of nodes that may touch. Both sides do where teeth are wider than the spaces between them and bearings
        let the centres move."""
        return [[], *([leader] for leader in leaders), *([leaders] if len(leaders) == 2 else [])]

    def _unit_forces(self, operator: ContactOperator, problem: StepProblem, touching: list[int]) -> np.ndarray:
        """Forces (m, t) per unit mesh force at each of the nodes `touching` (t)."""
        unit = np.zeros((len(problem.gap), len(touching)))
        unit[touching, np.arange(len(touching))] = 1.0
        return unit


def pairs_that_touch(operator: ContactOperator, node: int) -> np.ndarray:
    """Positions in `operator.pairs` of those that touch when `node` does; the shares of several are not determined."""
    side = operator.on_drive_flanks == operator.on_drive_flanks[node]
    return np.unique(operator.node_pair[side & (operator.gap <= operator.gap[node] + SAME_GAP)])


def _solved(problem: StepProblem, touching: list[int], unit: np.ndarray) -> tuple[np.ndarray | None, np.ndarray]:
    """Forces (m,) and coordinates (k,) with some nodes touching; forces None where the drivetrain cannot be solved so.

    `unit` (m, t): forces per unit mesh force at each of the nodes.
    """
    k, t = len(problem.load), len(touching)
    rows, gap = problem.jacobian[touching], problem.gap[touching]
    if not t:
        held = not len(problem.free_motion)
        return (np.zeros(len(unit)), np.linalg.solve(problem.stiffness, problem.load)) if held else (None, np.zeros(k))
    if t > 1 and not _independent(rows):
        return None, np.zeros(k)
    # Forces are carried as lengths, by the largest stiffness, so that all entries of the matrix are of one size.
    scale = np.abs(problem.stiffness).max(initial=0.0) or 1.0
    matrix = np.zeros((k + t, k + t))
    matrix[:k, :k], matrix[:k, k:], matrix[k:, :k] = (
        problem.stiffness,
        scale * (problem.jacobian.T @ unit),
        scale * rows,
    )
    right = np.append(problem.load, scale * gap)
    try:
        solution = np.linalg.solve(matrix, right)
        # Iterative refinement: where slow masses are hardly any stiffness, load over stiffness is a length beside which
        # the gap is round-off.
        solution += np.linalg.solve(matrix, right - matrix @ solution)
    except np.linalg.LinAlgError:
        return None, np.zeros(k)
    return unit @ (scale * solution[k:]), solution[:k]


def _status(unit: np.ndarray, nodes: int) -> np.ndarray:
    """Sets (n,) of nodes under forces `unit` (m, t), friction's sign being that of the slip."""
    pressed, sense = unit[:nodes].any(axis=1), unit[nodes:].sum(axis=1)
    slips = (
        np.where(sense > 0.0, SLIP_FORWARD, np.where(sense < 0.0, SLIP_BACKWARD, STICK)) if len(sense) else SLIP_FORWARD
    )
    return np.where(pressed, slips, OPEN).astype(np.int8)


def _independent(rows: np.ndarray) -> bool:
    """Whether drive and coast flanks hold the gears in different directions; with fixed centres they do not."""
    return np.linalg.matrix_rank(rows, tol=1e-9) == len(rows)


def _obeys(
    problem: StepProblem, leaders: list[int], touching: list[int], forces: np.ndarray, coordinates: np.ndarray
) -> bool:
    """Whether nothing pulls and nothing penetrates."""
    if np.min(forces[touching], initial=0.0) < -problem.tolerance.force:
        return False
    displaced = problem.jacobian[leaders] @ coordinates - problem.gap[leaders]
    others = [value for leader, value in zip(leaders, displaced) if leader not in touching]
    return max(others, default=-np.inf) <= problem.tolerance.length


def _no_equilibrium(problem: StepProblem, leaders: list[int]) -> ContactNotConverged:
    """The error of a load that no set of nodes holds."""
    words = problem.free_words or "the load moves the drivetrain freely"
    reason = f"no equilibrium: neither the drive flanks nor the coast flanks hold the load: {words}"
    play = float(problem.gap[leaders].sum())
    if len(leaders) == 2 and play < 0.0 and not _independent(problem.jacobian[leaders]):
        reason = (
            f"no equilibrium: rigid teeth are wedged between drive and coast flanks, by {-1e3 * play:.4g} um more than"
            " there is backlash: raise gears.centre_distance, lower the flank deviations, or make teeth or bearings"
            " elastic ([gears.material], [bearings])"
        )
    history, sets = np.zeros((1, 5)), np.full((1, len(problem.gap)), OPEN, dtype=np.int8)
    return NoStaticEquilibrium([("rigid flanks", "no solution", history, sets)], reason)
