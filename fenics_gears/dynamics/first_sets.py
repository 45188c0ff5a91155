"""The sets of contact nodes that a step begins with, where more is known than those of the step before."""

from __future__ import annotations

from collections.abc import Sequence
from math import ceil

import numpy as np

from fenics_gears.contact.mesh_cycle import Cycle, in_common
from fenics_gears.contact.operator import Position
from fenics_gears.contact.step_solver import cold_start

from .compiled_march import NO_SETS, begin


class KnownSets(dict[float, np.ndarray]):
    """By place in the mesh cycle, in steps, the sets (n,) that a run without friction had there last."""


class FirstSets:
    """Sets of a run's steps on a `cycle`, for its own next mesh cycle and for other runs.

    Over a face they are nearly those of the same position a mesh cycle before. In a plane, with a tenth of the nodes, a
    step before is as near. Without friction there is one solution, whatever the sets to begin with: those of runs
    before do as well. `remembers`: whether any are kept.
    """

    def __init__(self, cycle: Cycle, friction: float):
        self._steps = cycle.steps
        self._repeats = cycle.traits.repeats
        self._friction = friction
        # By step, those of the last mesh cycle and a little more.
        self._own: dict[float, np.ndarray] = {}
        self._shared = cycle.shared(KnownSets) if not friction and cycle.alike else KnownSets()
        self._others = dict(self._shared)
        self.remembers = self._repeats or not friction

    def remember(self, step: float, status: np.ndarray) -> None:
        """Keep the sets (n,) of a step."""
        if in_common(step) and not self._friction:
            self._shared[step % self._steps] = status
        if self._repeats:
            self._own[step] = status
            self._own.pop(step - self._steps - 2, None)

    def before(self, step: float) -> np.ndarray:
        """The sets (n,) of a mesh cycle before `step`, or of another run there; empty where none are known."""
        own = self._own.get(step - self._steps)
        return self._others.get(step % self._steps, NO_SETS) if own is None else own

    def before_all(self, steps: Sequence[float], nodes: np.ndarray) -> np.ndarray:
        """The sets (N,) before some steps with so many `nodes`, -1 where they are not known; none where none are
        kept."""
        known = np.full(nodes.sum() if self.remembers else 0, -1, dtype=np.int8)
        for step, end in zip(steps, np.cumsum(nodes).tolist()) if self.remembers else ():
            sets = self.before(step)
            known[end - len(sets) : end] = sets
        return known

    def near(self, step: float, position: Position) -> np.ndarray:
        """The sets (n,) to begin with at a position where the step before is not solved: those that another run had
        there, or at the whole step before it."""
        then = self._others.get(step % self._steps)
        if then is not None:
            return then.copy()
        before = self._others.get((ceil(step) - 1) % self._steps)
        if before is None:
            return cold_start(position.operator.gap, position.operator.node_pair)
        status = np.empty(position.operator.nodes, dtype=np.int8)
        begin(status, before, position.node_before, NO_SETS, NO_SETS)
        return status
