"""Compliance of meshes that move together: rows of all one after the other. Those that have no gear in common do not
feel each other; a gear in several meshes gives how they do."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

import numpy as np

from fenics_gears.system.memory import Kept

from .addresses import form_rows
from .formed_rows import FormedRows
from .idler import Part, units_of
from .joined_rows import AllRows, Coupling, Joined, joined_rows
from .mesh_cycle import Cycle


class CouplingGear(Protocol):
    """A gear in several meshes of a train."""

    def couplings(
        self, cycles: Sequence[Cycle], parts: Sequence[Part], steps: float
    ) -> tuple[list[Coupling], list[Coupling]]:
        """How its meshes feel each other after so many steps: forces now, and with friction those a step before."""


class JoinedMeshes:
    """See `idler.RowCompliance`; `gears`: those in several meshes."""

    def __init__(self, gears: Sequence[CouplingGear] = ()):
        self._gears = gears
        self.kept = Kept()

    def give_up(self) -> None:
        """Nothing is kept."""

    def of(
        self, cycles: Sequence[Cycle], parts: Sequence[Part], counts: tuple[int, int], steps: float
    ) -> tuple[FormedRows, FormedRows | None]:
        nodes, nodes_before = counts
        tangential = any(cycle.tangential for cycle in cycles)
        kinds = 2 if tangential else 1
        couplings = [gear.couplings(cycles, parts, steps) for gear in self._gears]
        now, earlier = ([each for found in couplings for each in found[time]] for time in (0, 1))
        frictional = [cycle.tangential for cycle in cycles]
        own = [
            Joined(_rows(part, "compliance"), (part.first, part.nodes), (part.first, part.nodes), 1 + rubs)
            for part, rubs in zip(parts, frictional)
        ]
        units = units_of(parts)
        of_rows, of_columns = (None, None) if units is None else ((units[0],) * 2, (units[1], units[0][nodes:]))
        compliance = joined_rows(own, now, (nodes, nodes), (kinds, kinds), of_rows)
        # Its first number is the size that others are measured by.
        form_rows(compliance.address, np.zeros(1, dtype=np.int64))
        if not tangential:
            return compliance, None
        own = [
            Joined(
                _rows(part, "previous_compliance") if rubs else AllRows(np.empty((0, part.nodes))),
                (part.first_before, part.nodes_before), (part.first, part.nodes), 2 * rubs,
            )
            for part, rubs in zip(parts, frictional)
        ]  # fmt: skip
        return compliance, joined_rows(own, earlier, (nodes_before, nodes), (2, 1), of_columns, by_columns=True)


def _rows(part: Part, name: str) -> FormedRows | AllRows:
    """A compliance of a mesh by itself, whose rows are not formed by this; of the previous one its columns."""
    stored = part.position.operator.__dict__[name]
    if isinstance(stored, FormedRows):
        return stored
    return AllRows(np.ascontiguousarray(stored if name == "compliance" else stored.T))
