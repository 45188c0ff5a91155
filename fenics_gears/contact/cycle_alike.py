"""The cycle of a mesh that passes the very same places as another one, whole steps later or earlier, as the meshes of
planets with the sun do: it has the operators of that one, with its own numbers of tooth pairs."""

from __future__ import annotations

from .mesh import Mesh
from .mesh_cycle import Cycle
from .operator import Position
from .places import counted_from
from .tooth_pair import PairNodes


class CycleAlike(Cycle):
    """The cycle of a `mesh` that is `ahead` of that of `like` by so many steps; gaps may be others."""

    def __init__(self, mesh: Mesh, like: Cycle, ahead: int):
        super().__init__(mesh, like.steps, like.coordinates, like.tangential)
        self._like = like
        self._ahead = ahead

    def true_place(self, step: float) -> tuple[Cycle, float]:
        return self._like.true_place(step + self._ahead)

    def pairs_at(self, index: int) -> tuple[PairNodes, ...]:
        key = (self.mesh.nodes, index)
        if key not in self._pairs:
            cycles, there = divmod(index + self._ahead, self.steps)
            self._pairs[key] = counted_from(-int(cycles), self._like.pairs_at(there))
        return self._pairs[key]

    def _built_of(self, mesh: Mesh, steps: list[tuple[float, float]]) -> list[Position]:
        ahead = [(step + self._ahead, before + self._ahead) for step, before in steps]
        true = self._like.true_positions(ahead)
        return [self._counted(step % self.steps, position) for (step, _), position in zip(steps, true)]

    def _counted(self, index: float, true: Position) -> Position:
        """A position of the other mesh as this one has it."""
        cycles = int((index + self._ahead) // self.steps)
        operator = true.operator.changed(pairs=counted_from(-cycles, true.operator.pairs))
        return Position(operator, true.node_before, index, self.mesh.nodes)
