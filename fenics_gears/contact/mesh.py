"""What the contact equations of a mesh are put together from: contact nodes, and how they yield."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from itertools import chain
from typing import TYPE_CHECKING, Any

from fenics_gears.geometry.pair import GearPair

from .pairing import CompliancePairing
from .passage import Passage, Response
from .places import pair_places
from .step_solver import StepProblem, StepSolution, solve_step
from .tooth_pair import Flanks, Nodes, PairNodes, Place, ToothPair, tooth_pairs
from .window import ContactGrid

if TYPE_CHECKING:
    import numpy as np

    from .corner import CornerContact
    from .face import Face
    from .operator import Position


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


def by_newton(position: Position, problem: StepProblem, status: np.ndarray, last: StepSolution | None) -> StepSolution:
    """Solve a step at a position from the sets `status` (n,) by Newton's method and its fallbacks; `last`: the step
    before, None at the start. Raises ContactNotConverged."""
    return solve_step(problem, status)


@dataclass(frozen=True, eq=False)
class Mesh:
    """A gear pair in mesh, as the contact equations are built of it.

    `nodes`: of the tooth pairs that can touch; `responses`: how these yield; `solve`: a step at a position.
    `bodies`: flank compliance of pinion and wheel; empty where they have none. `corner`: tip edges that touch off the
    line of action; `face`: its slices along the axes; one unless given. `of_cycle(number)`: the mesh in a mesh cycle;
    where None this one, as teeth are all alike.
    """

    pair: GearPair
    grid: ContactGrid
    nodes: Nodes
    responses: Callable[[Sequence[Passage]], list[Response]]
    solve: Callable[[Position, StepProblem, np.ndarray, StepSolution | None], StepSolution] = by_newton
    traits: MeshTraits = MeshTraits()
    bodies: tuple[Any, ...] = ()
    coast_flanks: bool = False
    corner: CornerContact | None = None
    face: Face | None = None
    of_cycle: Callable[[int], Mesh] | None = None


def nodes_at(places: Iterable[Place], nodes_of: Callable[[Place], PairNodes | None]) -> tuple[PairNodes, ...]:
    """The contact nodes of the places that have some."""
    return tuple(pair for pair in map(nodes_of, places) if pair is not None)


def flank_nodes(
    flanks: Flanks, grid: ContactGrid, corner: CornerContact | None, places: Sequence[Place]
) -> list[ToothPair]:
    """The contact nodes of elastic flanks at those places whose window is not empty; `corner`: with tip edges."""
    if corner is None:
        return tooth_pairs(flanks, grid, places)
    from .corner import corner_pairs

    return corner_pairs(flanks, grid, corner, places)


def elastic_mesh(
    flanks: Flanks, grid: ContactGrid, corner: CornerContact | None = None, pairing: CompliancePairing | None = None
) -> Mesh:
    """Elastic flanks in the plane, whose teeth are all alike; `pairing`: of these flanks, one of its own unless
    given."""
    coast = flanks.compliance[0].flanks == 2

    def nodes(phases: Sequence[float]) -> list[tuple[PairNodes, ...]]:
        places = [pair_places(flanks.pair, grid, phase, coast, corner) for phase in phases]
        if corner is not None:
            return [tuple(flank_nodes(flanks, grid, corner, each)) for each in places]
        # All in one go: of a pair by itself Python takes several times what its nodes do.
        found = {pair.place: pair for pair in flank_nodes(flanks, grid, None, list(chain(*places)))}
        return [nodes_at(each, found.get) for each in places]

    return Mesh(
        flanks.pair, grid, nodes, (pairing or CompliancePairing(flanks)).responses,
        traits=ELASTIC_FLANKS, bodies=flanks.compliance, coast_flanks=coast, corner=corner,
    )  # fmt: skip
