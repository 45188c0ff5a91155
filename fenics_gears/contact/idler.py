"""Meshes of a train at a position, and how those feel each other that have a gear in common."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

import numpy as np

from fenics_gears.system.memory import Kept

from .mesh_cycle import Cycle
from .operator import Position
from .tooth_pair import PairNodes, count_of

if TYPE_CHECKING:
    from .formed_rows import FormedRows


@dataclass(frozen=True)
class Part:
    """A mesh at a position: now, and how its pairs were a step before; its first node among all, then and now;
    `friction`: as of `row.MeshOfRow`."""

    position: Position
    before: tuple[PairNodes, ...]
    first: int
    first_before: int
    friction: float = 1.0

    @property
    def nodes(self) -> int:
        return self.position.operator.nodes

    @property
    def nodes_before(self) -> int:
        return count_of(self.before)

    @property
    def own(self) -> slice:
        """Where its nodes are among all."""
        return slice(self.first, self.first + self.nodes)

    @property
    def own_before(self) -> slice:
        """The same a step before."""
        return slice(self.first_before, self.first_before + self.nodes_before)


def units_of(parts: Sequence[Part]) -> tuple[np.ndarray, np.ndarray] | None:
    """By what displacements of all nodes are multiplied, and forces divided, now (2 n,) and a step before
    (2 n before,): normal ones by one, tangential ones by the `friction` of their mesh. None where all are one."""
    friction = [part.friction for part in parts]
    if friction == [1.0] * len(parts):
        return None
    both = ([part.nodes for part in parts], [part.nodes_before for part in parts])
    now, before = (np.concatenate([np.ones(sum(counts)), np.repeat(friction, counts)]) for counts in both)
    return now, before


class RowCompliance(Protocol):
    """How the contact nodes of meshes yield that stand beside each other; `kept`: memory for what it keeps."""

    kept: Kept

    def give_up(self) -> None:
        """Give up what is kept."""

    def of(
        self, cycles: Sequence[Cycle], parts: Sequence[Part], counts: tuple[int, int], steps: float
    ) -> tuple[np.ndarray | FormedRows, np.ndarray | FormedRows | None]:
        """C (m, m) of all meshes, and with friction E (n, m before), mm/N, after so many steps, in units as of
        `units_of`; `counts`: of nodes now and a step before."""
