"""What the contact equations of a mesh are put together from, contact nodes and how they yield; and the equations at
many positions, all in one go."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from itertools import chain
from typing import TYPE_CHECKING, Any

import numpy as np

from fenics_gears.geometry.pair import GearPair

from .face import Face
from .kinematics import (
    COORDINATES,
    IN_THE_PLANE,
    approach,
    displacement_jacobian,
    lines_of,
    points_before,
    slip_of_rigid_flanks,
)
from .mixed_form import StepEquations
from .operator import ContactOperator, Passage, Position, Response
from .pairing import CompliancePairing
from .places import pair_places
from .step_solver import StepSolution, solve_step
from .tooth_pair import DRIVE, Flanks, Nodes, PairNodes, Place, ToothPair, count_of, over_nodes, per_node, tooth_pairs
from .window import ContactGrid

if TYPE_CHECKING:
    from .corner import CornerContact


@dataclass(frozen=True)
class MeshTraits:
    """What the contact nodes of a mesh are.

    `divisible`: there are positions between its steps. `nodes_on_flanks`: nodes are points of the flanks, springs are
    not. `has_pressure`: forces of nodes are a pressure on the flank, those of springs and rigid flanks are not.
    `repeats`: a step is nearer to the one a mesh cycle before than to the last one, as flanks have many slices.
    `rigid`: steps are solved by `rigid_step`, and friction is that of the nominal motion. `own_solver`: steps are not
    solved by Newton's method first.
    """

    divisible: bool = False
    nodes_on_flanks: bool = True
    has_pressure: bool = True
    rigid: bool = False
    own_solver: bool = False
    repeats: bool = False


ELASTIC_FLANKS = MeshTraits(divisible=True)


def by_newton(
    position: Position, problem: StepEquations, status: np.ndarray, last: StepSolution | None
) -> StepSolution:
    """Solve a step at a position from the sets `status` (n,) by Newton's method and its fallbacks; `last`: the step
    before, None at the start. Raises ContactNotConverged."""
    return solve_step(problem, status)


@dataclass(frozen=True, eq=False)
class Mesh:
    """A gear pair in mesh, as the contact equations are built of it.

    `nodes`: of the tooth pairs that can touch; `responses`: how these yield; `solve`: a step at a position.
    `bodies`: flank compliance of pinion and wheel; empty where they have none. `corner`: tip edges that touch off the
    line of action; `face`: its slices along the axes; one unless given. `of_cycle(number)`: the mesh in a mesh cycle;
    where None this one, as teeth are all alike. `ahead`: mesh cycles by which its pairs are past a start of contact at
    phase 0.
    """

    pair: GearPair
    grid: ContactGrid
    nodes: Nodes
    responses: Callable[[Sequence[Passage]], list[Response]]
    solve: Callable[[Position, StepEquations, np.ndarray, StepSolution | None], StepSolution] = by_newton
    traits: MeshTraits = MeshTraits()
    bodies: tuple[Any, ...] = ()
    coast_flanks: bool = False
    corner: CornerContact | None = None
    face: Face | None = None
    of_cycle: Callable[[int], Mesh] | None = None
    ahead: float = 0.0


def nodes_at(places: Iterable[Place], nodes_of: Callable[[Place], PairNodes | None]) -> tuple[PairNodes, ...]:
    """The contact nodes of the places that have some."""
    return tuple(pair for pair in map(nodes_of, places) if pair is not None)


def flank_nodes(
    flanks: Flanks, grid: ContactGrid, corner: CornerContact | None, places: Sequence[Place]
) -> list[ToothPair]:
    """The contact nodes of elastic flanks at those places whose window is not empty; `corner`: with tip edges."""
    if corner is None:
        return tooth_pairs(flanks, grid, places)
    return corner.pairs(flanks, grid, places)


def elastic_mesh(
    flanks: Flanks,
    grid: ContactGrid,
    corner: CornerContact | None = None,
    pairing: CompliancePairing | None = None,
    coast: bool | None = None,
) -> Mesh:
    """Elastic flanks in the plane, whose teeth are all alike; `pairing`: of these flanks, one of its own unless given.
    `coast`: whether coast flanks touch too, unless given where both bodies have them."""
    if coast is None:
        coast = flanks.compliance[0].flanks == 2

    def nodes(phases: Sequence[float]) -> list[tuple[PairNodes, ...]]:
        places = [pair_places(flanks.pair, grid, phase, coast, corner) for phase in phases]
        if corner is not None:
            return [tuple(flank_nodes(flanks, grid, corner, each)) for each in places]
        # All in one go: for each pair by itself Python would take several times as long.
        by_place = {pair.place: pair for pair in flank_nodes(flanks, grid, None, list(chain(*places)))}
        return [nodes_at(each, by_place.get) for each in places]

    return Mesh(
        flanks.pair, grid, nodes, (pairing or CompliancePairing(flanks)).responses,
        traits=ELASTIC_FLANKS, bodies=flanks.compliance, coast_flanks=coast, corner=corner,
    )  # fmt: skip


def contact_operators(
    gears: GearPair,
    passages: Sequence[Passage],
    coordinates: list[int],
    responses: Sequence[Response],
    face: Face = IN_THE_PLANE,
) -> list[ContactOperator]:
    """The contact equations at the end of each of some passages, with rows of friction where these have previous nodes.

    Normal forces act along the line of a pair. All in one go: for each position by itself Python would take several
    times as long.

    `coordinates`: which of COORDINATES are unknowns; those beyond, at the end, are of shafts, and move no contact.
    """
    frictional = passages[0].previous is not None
    counts = [count_of(passage.pairs) for passage in passages]
    starts = np.cumsum(counts) - counts
    lines = lines_of([pair for passage in passages for pair in passage.pairs], gears.sides, face)
    arms = lines.lever_arms
    if responses[0].normal_lever_arms is not None:
        arms = np.concatenate([response.normal_lever_arms for response in responses], axis=1)
    rows = _of_unknowns(displacement_jacobian(replace(lines, lever_arms=arms), frictional), coordinates)
    slip = before = None
    if frictional:
        stood = points_before(lines, np.repeat([passage.advance for passage in passages], counts))
        slip = slip_of_rigid_flanks(lines, stood)
        if responses[0].previous_jacobian is None:
            before = approach(lines.sides, stood, lines.directions[1])
        else:
            before = np.concatenate([response.previous_jacobian for response in responses])
        before = _of_unknowns(before, coordinates)
        rows = step_by_step(rows, starts, counts)
    gap = over_nodes(lines.pairs, "gap") * face.cosine
    drive, pair_of_node = _pairs_of_nodes(passages)
    operators = []
    for passage, response, start, count in zip(passages, responses, starts.tolist(), counts):
        own = slice(start, start + count)
        kinds = len(rows) // len(gap) if len(gap) else 1
        earlier = response.previous_compliance
        operators.append(ContactOperator(
            pairs=passage.pairs,
            sides=gears.sides,
            normal_lever_arms=arms[:, own],
            compliance=response.compliance,  # type: ignore[arg-type]
            jacobian=rows[kinds * start : kinds * (start + count)],
            gap=gap[own],
            rigid_slip=None if slip is None else slip[own],
            previous_compliance=np.asfortranarray(earlier) if isinstance(earlier, np.ndarray) else earlier,
            previous_jacobian=None if before is None else before[own],
            dependent_rows=response.dependent_rows,
            face=face,
            sliding=response.sliding,
            coordinates=len(coordinates),
        ))  # fmt: skip
        # Known here; each would find its own when asked.
        operators[-1].__dict__.update(on_drive_flanks=drive[own], node_pair=pair_of_node[own])
    return operators


def _pairs_of_nodes(passages: Sequence[Passage]) -> tuple[np.ndarray, np.ndarray]:
    """Of the nodes (n,) of all passages whether each is on the drive flanks, and the position of its pair among those
    of its passage, as of a ContactOperator."""
    pairs = [pair for passage in passages for pair in passage.pairs]
    drive = np.array([pair.place.flank == DRIVE for pair in pairs], dtype=bool)
    position = np.array([position for passage in passages for position in range(len(passage.pairs))], dtype=int)
    return per_node(pairs, drive), per_node(pairs, position)


def step_by_step(rows: np.ndarray, starts: np.ndarray, counts: Sequence[int]) -> np.ndarray:
    """Rows (2 n, ...) of the normals of all steps, then of all tangents, put in the order of steps: each one's normals,
    then its tangents; the first nodes and how many each has."""
    n = len(rows) // 2
    normals = np.arange(n) + np.repeat(starts, counts)
    by_step = np.empty_like(rows)
    by_step[normals] = rows[:n]
    by_step[normals + np.repeat(counts, counts)] = rows[n:]
    return by_step


def _of_unknowns(rows: np.ndarray, coordinates: list[int]) -> np.ndarray:
    """The columns of those coordinates that contact moves."""
    return rows.take([each for each in coordinates if each < len(COORDINATES)], axis=1)
