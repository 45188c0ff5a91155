"""Gaps of runs that are marched together on the operators of one row: those of a planetary set with pins beside their
places, gears that run out, and errors of their pitches."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from .mesh_cycle import Cycle, Deviation, Gaps
from .operator import Position
from .row import JoinedPosition, RowCycle


class GapsOfRows:
    """Runs on a `row` without offsets and deviations of its own. By mesh the `offsets` (runs, l), mm, as of MeshOfRow,
    and by run the `deviations` of each mesh, of kinds that have `of_runs`; gaps repeat after so many `steps`. It is
    `dynamics.batch.OpenedNodes`."""

    def __init__(
        self,
        row: RowCycle,
        offsets: Sequence[np.ndarray],
        deviations: Sequence[Sequence[tuple[Deviation, ...]]],
        steps: int,
    ):
        self._row = row
        self._offsets = offsets
        self._deviations = deviations
        self._of_meshes = [_by_kind(of_mesh) for of_mesh in zip(*deviations)]
        self.steps = steps

    def of_steps(self, positions: Sequence[Position]) -> np.ndarray:
        steps = np.arange(len(positions))
        nodes = np.array([position.operator.nodes for position in positions])
        firsts = np.cumsum(nodes) - nodes
        gaps = np.empty((len(self._deviations), nodes.sum()))
        added = self._added(steps)
        # At the same place of each mesh cycle all but the deviations is the same.
        for place, position in enumerate(positions[: self._row.steps]):
            there = slice(place, None, self._row.steps)
            columns = firsts[there, None] + np.arange(nodes[place])
            gaps[:, columns] = self._opened(position, added, there, len(columns))
        return gaps

    def at(self, asked: Sequence[tuple[int, Position]]) -> np.ndarray:
        """As of `OpenedNodes`, at places of the first mesh cycle."""
        found = []
        for run, position in asked:
            added = self._added(np.array([position.index]))
            found.append(self._opened(position, added, slice(None), 1)[run, 0])
        return np.concatenate(found)

    def of(self, run: int) -> RowCycle:
        gaps_of = [partial(_with_deviations, own) for own in self._deviations[run]]
        return self._row.with_gaps_of([each[run] for each in self._offsets], gaps_of)

    def _added(self, steps: np.ndarray) -> list[list[tuple[list[int], Any]]]:
        """By mesh the runs that deviate in a way, and what it adds to their gaps at these steps."""
        return [[(runs, kind.of_runs(own, steps)) for kind, runs, own in of_mesh] for of_mesh in self._of_meshes]

    def _opened(
        self, position: Position, added: list[list[tuple[list[int], Any]]], there: slice, count: int
    ) -> np.ndarray:
        """The gaps of all runs (runs, count, n) at a position and those of the steps that are `there`."""
        assert isinstance(position, JoinedPosition)
        gaps = np.empty((len(self._deviations), count, position.operator.nodes))
        for number, (own, first) in enumerate(position.of_meshes):
            operator = own.operator
            of_mesh = gaps[:, :, first : first + operator.nodes]
            of_mesh[:] = (operator.gap - self._offsets[number] @ operator.jacobian[: operator.nodes].T)[:, None]
            for runs, opening in added[number]:
                # Openings are measured along the line of action, gaps along the normal.
                of_mesh[runs] += operator.face.cosine * opening(own, there)
        return gaps


def _by_kind(of_runs: Sequence[tuple[Deviation, ...]]) -> list[tuple[Any, list[int], list[Deviation]]]:
    """The deviations of all runs in a mesh: each kind, the numbers of the runs that have it, and theirs."""
    found: dict[type, tuple[Any, list[int], list[Deviation]]] = {}
    for run, own in enumerate(of_runs):
        for each in own:
            _, runs, deviations = found.setdefault(type(each), (type(each), [], []))
            runs.append(run)
            deviations.append(each)
    return list(found.values())


def _with_deviations(deviations: tuple[Deviation, ...], cycle: Cycle) -> Gaps:
    """The gaps of a cycle whose gears deviate so."""
    return replace(cycle.gaps, deviations=deviations)
