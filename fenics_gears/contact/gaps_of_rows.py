"""Gaps of runs that are marched together on the operators of one row: those of a planetary set with pins beside their
places and gears that run out."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from .mesh_cycle import Deviation
from .operator import Position
from .row import JoinedPosition, RowCycle


class GapsOfRows:
    """Runs on a `row` without offsets and deviations of its own. By mesh the `offsets` (runs, l), mm, and by run the
    `deviations` of each mesh, as of MeshOfRow; `steps` (0 to `steps` - 1) of the run, after which they repeat. It is
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
        self.steps = steps

    def of_steps(self, positions: Sequence[Position]) -> np.ndarray:
        ends = np.cumsum([position.operator.nodes for position in positions])
        gaps = np.empty((len(self._deviations), ends[-1]))
        for step, (position, end) in enumerate(zip(positions, ends)):
            self._put(step, position, gaps[:, end - position.operator.nodes : end])
        return gaps

    def at(self, asked: Sequence[tuple[int, Position]]) -> np.ndarray:
        """As of `OpenedNodes`, at places of the first mesh cycle."""
        found = []
        for run, position in asked:
            gaps = np.empty((len(self._deviations), position.operator.nodes))
            self._put(position.index, position, gaps)
            found.append(gaps[run])
        return np.concatenate(found)

    def of(self, run: int) -> RowCycle:
        return self._row.with_gaps_of([each[run] for each in self._offsets], self._deviations[run])

    def _put(self, step: float, position: Position, gaps: np.ndarray) -> None:
        """Put the gaps of all runs (runs, n) at a step into place."""
        assert isinstance(position, JoinedPosition)
        for number, (own, first) in enumerate(position.of_meshes):
            operator = own.operator
            there = gaps[:, first : first + operator.nodes]
            there[:] = operator.gap - self._offsets[number] @ operator.jacobian[: operator.nodes].T
            for run, deviations in enumerate(self._deviations):
                for deviation in deviations[number]:
                    there[run] += operator.face.cosine * deviation(step, own)
