"""Gaps of runs that are marched together on the operators of one row: those of a planetary set with pins beside their
places and gears that run out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from .mesh_cycle import Cycle, Gaps
from .operator import Position
from .row import JoinedPosition, RowCycle
from .run_out import RunOut


class GapsOfRows:
    """Runs on a `row` without offsets and run-out of its own. By mesh the `offsets` (runs, l), mm, as of MeshOfRow, and
    by run the `run_outs` of each mesh; gaps repeat after so many `steps`. It is `dynamics.batch.OpenedNodes`."""

    def __init__(
        self, row: RowCycle, offsets: Sequence[np.ndarray], run_outs: Sequence[Sequence[tuple[RunOut, ...]]], steps: int
    ):
        self._row = row
        self._offsets = offsets
        self._run_outs = run_outs
        # By mesh, with the number of the run.
        self._of_meshes = [
            [(run, each) for run, own in enumerate(of_mesh) for each in own] for of_mesh in zip(*run_outs)
        ]
        self.steps = steps

    def of_steps(self, positions: Sequence[Position]) -> np.ndarray:
        ends = np.cumsum([position.operator.nodes for position in positions])
        gaps = np.empty((len(self._run_outs), ends[-1]))
        for step, (position, end) in enumerate(zip(positions, ends)):
            self._put(step, position, gaps[:, end - position.operator.nodes : end])
        return gaps

    def at(self, asked: Sequence[tuple[int, Position]]) -> np.ndarray:
        """As of `OpenedNodes`, at places of the first mesh cycle."""
        found = []
        for run, position in asked:
            gaps = np.empty((len(self._run_outs), position.operator.nodes))
            self._put(position.index, position, gaps)
            found.append(gaps[run])
        return np.concatenate(found)

    def of(self, run: int) -> RowCycle:
        gaps_of = [partial(_with_run_outs, run_outs) for run_outs in self._run_outs[run]]
        return self._row.with_gaps_of([each[run] for each in self._offsets], gaps_of)

    def _put(self, step: float, position: Position, gaps: np.ndarray) -> None:
        """Put the gaps of all runs (runs, n) at a step into place."""
        assert isinstance(position, JoinedPosition)
        for number, (own, first) in enumerate(position.of_meshes):
            operator = own.operator
            there = gaps[:, first : first + operator.nodes]
            there[:] = operator.gap - self._offsets[number] @ operator.jacobian[: operator.nodes].T
            if self._of_meshes[number]:
                runs, run_outs = zip(*self._of_meshes[number])
                motions = np.array([each.motion(step) for each in run_outs])
                # Of one mesh all have the same rows.
                there[list(runs)] -= operator.face.cosine * (motions @ run_outs[0].rows(own).T)


def _with_run_outs(run_outs: tuple[RunOut, ...], cycle: Cycle) -> Gaps:
    """The gaps of a cycle whose gears run out so."""
    return replace(cycle.gaps, deviations=run_outs)
