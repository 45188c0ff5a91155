"""Gaps of modified flanks on the contact operators of involutes: material removed from flanks opens gaps and changes
nothing else."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from fenics_gears.geometry.relief import side_by_side

from .interpolation import INTERPOLATIONS, Averages, Points
from .mesh_cycle import Cycle, Gaps, Opening, PerPosition
from .operator import Position
from .tooth_pair import DRIVE, Removal, apart, facing_points, nodal_gap, node_ends, over_nodes


@dataclass(frozen=True)
class Facing:
    """Facing points of both flanks at the places of the interpolation of a position's contact nodes, pair after pair:
    roll angles `rolls` (2, p), rad, and the `gap` (p,), mm, of true involutes. `drive` (p,): where these are modified.

    `ends` (pairs + 1,): where the points of each pair begin and end. `offsets` (n,), mm, and `node_ends` (pairs + 1,):
    those of its nodes, whose flanks are so far `apart` (n,), mm, beyond the gap.
    """

    rolls: np.ndarray
    gap: np.ndarray
    drive: np.ndarray
    ends: np.ndarray
    offsets: np.ndarray
    node_ends: np.ndarray
    apart: np.ndarray


@dataclass
class FacingPoints:
    """The facing points of the positions of a cycle, which all reliefs on its operators have in common: by place, and
    `together` those of all steps once these are known."""

    known: dict[float, Facing] = field(default_factory=dict)
    together: Facing | None = None

    def of_steps(self, steps: int) -> Facing | None:
        """The points of all steps of the cycle, one after the other; None as long as some are not known."""
        if self.together is None and all(step in self.known for step in range(steps)):
            self.together = _joined([self.known[step] for step in range(steps)])
        return self.together


def profile_of(
    cycle: Cycle, removal: tuple[Removal | None, Removal | None]
) -> tuple[PerPosition[np.ndarray], np.ndarray | None]:
    """The gaps (n,), mm, at a position of a `cycle`, of flanks from which `removal` is taken, on the line of action;
    and the gaps of all steps, one after the other, where they are known.

    Material that the cycle's own flanks lack is not counted.
    """
    points = cycle.shared(FacingPoints)
    facing = _facing_points(cycle)
    known: dict[float, np.ndarray] = {}
    of_steps = None if (together := points.of_steps(cycle.steps)) is None else _gaps(cycle, together, removal)
    if of_steps is not None:
        first = 0
        for step in range(cycle.steps):
            end = first + len(points.known[step].offsets)
            known[step] = of_steps[first:end]
            first = end
    return PerPosition(lambda position: _gaps(cycle, facing(position), removal), known), of_steps


class Profiles:
    """The gaps of several runs on the contact operators of one `cycle`, from whose flanks each has material of its own
    removed: `removals` of pinion and wheel, by run; and `openings` of its own, over a face."""

    def __init__(
        self,
        cycle: Cycle,
        removals: Sequence[tuple[Removal | None, Removal | None]],
        openings: Sequence[tuple[Opening, ...]],
    ):
        self._cycle = cycle
        self._removals = removals
        self._openings = openings
        self._facing = _facing_points(cycle)
        self.steps = cycle.steps

    def of_steps(self, positions: Sequence[Position]) -> np.ndarray:
        """Gaps (runs, n), mm along the normal, at all steps of the mesh cycle, one after the other."""
        for position in positions:
            self._facing(position)
        together = self._cycle.shared(FacingPoints).of_steps(self._cycle.steps)
        assert together is not None
        # Samples of a design have its reliefs in common.
        profiles: dict[Any, np.ndarray] = {}
        for removal in self._removals:
            if removal not in profiles:
                profiles[removal] = _gaps(self._cycle, together, removal)
        gaps = np.array([profiles[removal] for removal in self._removals])
        for gap, openings in zip(gaps, self._openings):
            for opening in openings:
                gap += np.concatenate([opening(position) for position in positions])
        return self._cycle.face.cosine * gaps

    def at(self, asked: Sequence[tuple[int, Position]]) -> np.ndarray:
        """Gaps (n,), mm along the normal, of runs at a position each, one after the other."""
        facing = [self._facing(position) for _, position in asked]
        counts = [len(each.gap) for each in facing]
        of_gears = zip(*(self._removals[run] for run, _ in asked))
        gaps = _gaps(self._cycle, _joined(facing), tuple(side_by_side(own, counts) for own in of_gears))
        first = 0
        for run, position in asked:
            end = first + position.operator.nodes
            for opening in self._openings[run]:
                gaps[first:end] += opening(position)
            first = end
        return self._cycle.face.cosine * gaps

    def of(self, run: int) -> Cycle:
        """The cycle with the gaps of a run."""
        removal = self._removals[run]
        openings = self._openings[run]
        if removal == (None, None) and not openings:
            return self._cycle
        profile, of_steps = profile_of(self._cycle, removal) if removal != (None, None) else (None, None)
        return self._cycle.with_gaps(Gaps(profile, openings, of_steps=of_steps))


def _facing_points(cycle: Cycle) -> PerPosition[Facing]:
    return PerPosition(lambda position: _facing(cycle, position), cycle.shared(FacingPoints).known)


def _gaps(cycle: Cycle, at: Facing, removal: tuple[Removal | None, Removal | None]) -> np.ndarray:
    gap = at.gap
    everywhere = at.drive.all()
    for removed, rolls in zip(removal, at.rolls):
        if removed is not None:
            gap = gap + (removed(rolls) if everywhere else np.where(at.drive, removed(rolls), 0.0))
    return nodal_gap(INTERPOLATIONS[cycle.grid.interpolation], at.offsets, at.node_ends, gap) + at.apart


def _joined(parts: list[Facing]) -> Facing:
    """Facing points of several positions as if their pairs were those of one."""

    def whole(arrays: Iterable[np.ndarray]) -> np.ndarray:
        return np.concatenate(list(arrays), axis=-1)

    def ends(of: Iterable[np.ndarray]) -> np.ndarray:
        return np.concatenate([[0], np.cumsum(whole(map(np.diff, of)))])

    return Facing(
        whole(part.rolls for part in parts),
        whole(part.gap for part in parts),
        whole(part.drive for part in parts),
        ends(part.ends for part in parts),
        whole(part.offsets for part in parts),
        ends(part.node_ends for part in parts),
        whole(part.apart for part in parts),
    )


def _facing(cycle: Cycle, position: Position) -> Facing:
    view: Averages | Points = INTERPOLATIONS[cycle.grid.interpolation]
    pairs = position.operator.pairs
    offsets = over_nodes(pairs, "offsets")
    ends = node_ends(pairs)
    points = view.points(ends)
    places = [pair.place for pair in pairs]
    rolls, _, gap = facing_points(cycle.pair, places, view.places(offsets, ends), points)
    drive = np.repeat(np.array([pair.place.flank == DRIVE for pair in pairs], dtype=bool), np.diff(points))
    return Facing(rolls, gap, drive, points, offsets, ends, np.repeat(apart(cycle.pair, places), np.diff(ends)))
