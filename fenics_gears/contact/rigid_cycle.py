"""The mesh cycle of rigid flanks: the tooth pair with the smallest gap carries the whole force, and its gap is the kinematic transmission error.

All contact nodes of the drive flanks move alike with the gears, by the base radii and along the line of action; so do those of the coast
flanks. On either side only the node with the smallest gap can touch. Where several pairs have the same gap, as true involutes do wherever two
pairs are in mesh, their shares of the force are not determined; the step's solution puts the whole force on the first of them.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fenics_gears.contact.errors import ContactNotConverged, NoStaticEquilibrium
from fenics_gears.contact.interpolation import hat_integrals
from fenics_gears.contact.laws import OPEN, SLIP_FORWARD
from fenics_gears.contact.mesh_cycle import Cycle, CycleTraits, Position
from fenics_gears.contact.operator import ContactOperator, operator_on_lines, over_nodes
from fenics_gears.contact.step_solver import NEWTON, StepProblem, StepSolution
from fenics_gears.contact.tooth_pair import DRIVE, PairNodes, Place, Removal, facing_points
from fenics_gears.contact.window import ContactGrid, node_offsets
from fenics_gears.geometry.pair import GearPair

# Gaps (mm) that differ by less are the same: the round-off of positions on the line of action.
SAME_GAP = 1e-10


@dataclass(frozen=True)
class RigidPosition(Position):
    """A position with its nodes on the drive flanks and on the coast flanks, of which one of each can touch."""

    sides: tuple[np.ndarray, np.ndarray]


class RigidCycle(Cycle):
    """Contact nodes on rigid flanks; without friction.

    `coordinates`: which centre coordinates are unknowns; `removal`: material removed from either drive flank.
    """

    traits = CycleTraits(has_pressure=False)
    frictional = False

    def __init__(
        self,
        pair: GearPair,
        removal: tuple[Removal | None, Removal | None],
        grid: ContactGrid,
        steps: int,
        coordinates: list[int],
        coast_flanks: bool,
    ):
        super().__init__(pair, grid, steps, coast_flanks)
        self._removal, self._coordinates = removal, coordinates

    def solve(self, position: RigidPosition, problem: StepProblem, status: np.ndarray, last: StepSolution | None) -> StepSolution:
        """The step with nothing touching, else with the leading drive flanks, else with the leading coast flanks, else with both.

        Both touch where teeth are wider than the spaces between them and elastic bearings let the centres move apart. Raises
        ContactNotConverged where none of them holds the load.
        """
        leaders = [int(nodes[np.argmin(problem.gap[nodes])]) for nodes in position.sides if len(nodes)]
        sets = [[], *([leader] for leader in leaders), *([leaders] if len(leaders) == 2 else [])]
        for iterations, touching in enumerate(sets, 1):
            forces, coordinates = _solved(problem, touching)
            if forces is not None and obeys(problem, leaders, touching, forces, coordinates):
                status = np.zeros(len(problem.gap), dtype=np.int8)
                status[touching] = SLIP_FORWARD
                displacement = problem.jacobian @ coordinates
                return StepSolution(forces, coordinates, displacement, status, iterations, NEWTON)
        raise no_equilibrium(why_none_holds(problem, leaders), len(problem.gap))

    def _pair(self, place: Place) -> PairNodes | None:
        offsets = node_offsets(self.pair, place.contact_rolls, self.grid)
        if not len(offsets):
            return None
        if offsets[0] < 0.0 < offsets[-1]:
            # True involutes touch on the line of action itself.
            offsets = np.unique(np.append(offsets, 0.0))
        removal = self._removal if place.flank == DRIVE else (None, None)
        (pinion_roll, _), (x_1, x_2), gap = facing_points(self.pair, removal, place, offsets)
        return PairNodes(place, offsets, hat_integrals(offsets), gap, x_1, x_2, pinion_roll)

    def _position(self, index: float, pairs, previous, advance: float, carried: np.ndarray) -> RigidPosition:
        nodes, before = len(over_nodes(pairs, "gap")), len(over_nodes(previous, "gap"))
        # Rigid: views of a single zero.
        rows = 2 * nodes if self.frictional else nodes
        previous_compliance = np.broadcast_to(0.0, (nodes, 2 * before)) if self.frictional else None
        compliance = np.broadcast_to(0.0, (rows, rows))
        operator = operator_on_lines(self.pair, pairs, self._coordinates, compliance, previous_compliance, advance)
        return RigidPosition(operator, carried, (np.flatnonzero(operator.on_drive_flanks), np.flatnonzero(~operator.on_drive_flanks)))


def pairs_that_touch(operator: ContactOperator, node: int) -> np.ndarray:
    """Positions in `operator.pairs` of those that touch when `node` does; the shares of several are not determined."""
    side = operator.on_drive_flanks == operator.on_drive_flanks[node]
    return np.unique(operator.node_pair[side & (operator.gap <= operator.gap[node] + SAME_GAP)])


def _solved(problem: StepProblem, touching: list[int]) -> tuple[np.ndarray | None, np.ndarray]:
    """Forces (n,) and coordinates (k,) with some nodes touching; forces None where the drivetrain cannot be solved so."""
    k, forces = len(problem.load), np.zeros(len(problem.gap))
    if not touching:
        if len(problem.free_motion):
            return None, np.zeros(k)
        return forces, np.linalg.solve(problem.stiffness, problem.load)
    rows = problem.jacobian[touching]
    if len(touching) > 1 and not _independent(rows):
        return None, np.zeros(k)
    pressing, coordinates = tied(problem, rows, rows.T, problem.gap[touching])
    if pressing is None:
        return None, coordinates
    forces[touching] = pressing
    return forces, coordinates


def tied(problem: StepProblem, rows: np.ndarray, pushes: np.ndarray, gap: np.ndarray) -> tuple[np.ndarray | None, np.ndarray]:
    """Forces (t,) and coordinates (k,) with `rows` (t, k) of the flanks closed to their `gap` (t,), where a unit force pushes the drivetrain
    by `pushes` (k, t); forces None where that cannot be solved."""
    k, t = len(problem.load), len(gap)
    # Forces are carried as lengths, by the largest stiffness, so that all entries of the matrix are of one size.
    unit = np.abs(problem.stiffness).max(initial=0.0) or 1.0
    matrix = np.zeros((k + t, k + t))
    matrix[:k, :k], matrix[:k, k:], matrix[k:, :k] = problem.stiffness, unit * pushes, unit * rows
    right = np.append(problem.load, unit * gap)
    try:
        solution = np.linalg.solve(matrix, right)
        # Iterative refinement: where slow masses are hardly any stiffness, load over stiffness is a length beside which the gap is round-off.
        solution += np.linalg.solve(matrix, right - matrix @ solution)
    except np.linalg.LinAlgError:
        return None, np.zeros(k)
    return unit * solution[k:], solution[:k]


def _independent(rows: np.ndarray) -> bool:
    """Whether drive and coast flanks hold the gears in different directions; with fixed centres they do not."""
    return np.linalg.matrix_rank(rows, tol=1e-9) == len(rows)


def obeys(problem: StepProblem, leaders: list[int], touching: list[int], forces: np.ndarray, coordinates: np.ndarray) -> bool:
    """Whether nothing pulls and nothing penetrates."""
    if np.min(forces[touching], initial=0.0) < -problem.tolerance.force:
        return False
    displaced = problem.jacobian[leaders] @ coordinates - problem.gap[leaders]
    others = [value for leader, value in zip(leaders, displaced) if leader not in touching]
    return max(others, default=-np.inf) <= problem.tolerance.length


def why_none_holds(problem: StepProblem, leaders: list[int]) -> str:
    """Why no set of nodes holds the load."""
    play = float(problem.gap[leaders].sum())
    if len(leaders) == 2 and play < 0.0 and not _independent(problem.jacobian[leaders]):
        return (
            f"no equilibrium: rigid teeth are wedged between drive and coast flanks, by {-1e3 * play:.4g} um more than there is backlash: "
            "raise gears.centre_distance, lower the flank deviations, or make teeth or bearings elastic ([gears.material], [bearings])"
        )
    words = problem.free_words or "the load moves the drivetrain freely"
    return f"no equilibrium: neither the drive flanks nor the coast flanks hold the load: {words}"


def no_equilibrium(words: str, nodes: int) -> ContactNotConverged:
    history, sets = np.zeros((1, 5)), np.full((1, nodes), OPEN, dtype=np.int8)
    return NoStaticEquilibrium([("rigid flanks", "no solution", history, sets)], words)
