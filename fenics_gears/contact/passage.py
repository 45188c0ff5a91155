"""From contact nodes and how they yield to the contact equations at many positions, all in one go."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fenics_gears.geometry.pair import GearPair

from .face import Face
from .kinematics import (
    COORDINATES,
    IN_THE_PLANE,
    displacement_jacobian,
    earlier_tangential_jacobian,
    lines_of,
    slip_of_rigid_flanks,
    turned,
)
from .operator import ContactOperator
from .tooth_pair import DRIVE, PairNodes, count_of, over_nodes, per_node

if TYPE_CHECKING:
    from .formed_rows import FormedRows

NO_NODES_BEFORE = np.empty(0, dtype=np.int64)


class Passage(NamedTuple):
    """Contact nodes on their way from one position to the next: the `pairs` now and the `previous` ones, None without
    friction; the node before of each node now (`node_before`, as of a Position); the place of both in the mesh cycle,
    in steps; and by how much (rad) the pinion turns (`advance`)."""

    pairs: tuple[PairNodes, ...]
    previous: tuple[PairNodes, ...] | None = None
    node_before: np.ndarray = NO_NODES_BEFORE
    index: float = 0
    index_before: float = -1
    advance: float = 0.0


class Response(NamedTuple):
    """How contact nodes yield: `compliance`, `previous_compliance` (None without friction), `dependent_rows` and
    `sliding` of a ContactOperator; `normal_lever_arms` and `previous_jacobian`, over all coordinates, where they are
    not those of flanks that slide along the line of action."""

    compliance: np.ndarray | FormedRows
    previous_compliance: np.ndarray | FormedRows | None = None
    dependent_rows: int = 0
    normal_lever_arms: tuple[np.ndarray, np.ndarray] | None = None
    previous_jacobian: np.ndarray | None = None
    sliding: np.ndarray | None = None


def contact_operators(
    gears: GearPair,
    passages: Sequence[Passage],
    coordinates: list[int],
    responses: Sequence[Response],
    face: Face = IN_THE_PLANE,
) -> list[ContactOperator]:
    """The contact equations at the end of each of some passages, of nodes whose normal forces act along their pair's
    line; those of friction too where the passages have previous nodes. All in one go: of a position by itself Python
    takes several times what its numbers do.

    `coordinates`: which of COORDINATES are unknowns; those beyond, at the end, are of shafts, and move no contact.
    """
    radii, frictional = (gears.pinion.base_radius, gears.wheel.base_radius), passages[0].previous is not None
    counts = [count_of(passage.pairs) for passage in passages]
    lines = lines_of([pair for passage in passages for pair in passage.pairs], radii)
    arms, slip, before = lines.lever_arms, None, None
    if responses[0].normal_lever_arms is not None:
        arms = tuple(np.concatenate(each) for each in zip(*(response.normal_lever_arms for response in responses)))
    rows = _of_unknowns(displacement_jacobian(lines.pairs, radii, arms, frictional, lines, face), coordinates)
    if frictional:
        angles = np.repeat([turned(gears, passage.advance) for passage in passages], counts, axis=0).T
        slip = slip_of_rigid_flanks(lines, angles)
        if responses[0].previous_jacobian is None:
            before = earlier_tangential_jacobian(lines, radii, angles, face)
        else:
            before = np.concatenate([response.previous_jacobian for response in responses])
        before = _of_unknowns(before, coordinates)
    gap, starts, found = over_nodes(lines.pairs, "gap") * face.cosine, np.cumsum(counts) - counts, []
    if frictional:
        rows = _step_by_step(rows, starts, counts)
    drive, pair_of_node = _pairs_of_nodes(passages)
    for passage, response, start, count in zip(passages, responses, starts.tolist(), counts):
        own, kinds = slice(start, start + count), len(rows) // len(gap) if len(gap) else 1
        earlier = response.previous_compliance
        found.append(ContactOperator(
            pairs=passage.pairs,
            base_radii=radii,
            normal_lever_arms=(arms[0][own], arms[1][own]),
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
        found[-1].__dict__.update(on_drive_flanks=drive[own], node_pair=pair_of_node[own])
    return found


def _pairs_of_nodes(passages: Sequence[Passage]) -> tuple[np.ndarray, np.ndarray]:
    """Of the nodes (n,) of all passages whether each is on the drive flanks, and the position of its pair among those
    of its passage, as of a ContactOperator."""
    pairs = [pair for passage in passages for pair in passage.pairs]
    drive = np.array([pair.place.flank == DRIVE for pair in pairs], dtype=bool)
    position = np.array([position for passage in passages for position in range(len(passage.pairs))], dtype=int)
    return per_node(pairs, drive), per_node(pairs, position)


def _step_by_step(rows: np.ndarray, starts: np.ndarray, counts: Sequence[int]) -> np.ndarray:
    """Rows (2 n, k) of the normals of all steps, then of all tangents, put in the order of steps: each one's normals,
    then its tangents; the first nodes and how many each has."""
    n = len(rows) // 2
    normals = np.arange(n) + np.repeat(starts, counts)
    found = np.empty_like(rows)
    found[normals], found[normals + np.repeat(counts, counts)] = rows[:n], rows[n:]
    return found


def _of_unknowns(rows: np.ndarray, coordinates: list[int]) -> np.ndarray:
    """The columns of those coordinates that contact moves."""
    return rows.take([each for each in coordinates if each < len(COORDINATES)], axis=1)
