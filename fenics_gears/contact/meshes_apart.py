"""Compliance of meshes that move together: rows of all side by side. Those that have no gear in common do not feel each
other; what others do is given as couplings."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from .addresses import form_rows
from .formed_rows import FormedRows
from .idler import Part
from .joined_rows import AllRows, Coupling, Joined, joined_rows
from .mesh_cycle import Cycle

Rows = tuple[FormedRows, FormedRows | None]


class MeshesApart:
    """See `idler.RowCompliance`."""

    def of(self, cycles: Sequence[Cycle], parts: Sequence[Part], counts: tuple[int, int], steps: float) -> Rows:
        return side_by_side(parts, counts, cycles[0].tangential)


def side_by_side(
    parts: Sequence[Part],
    counts: tuple[int, int],
    tangential: bool,
    now: Sequence[Coupling] = (),
    earlier: Sequence[Coupling] = (),
) -> Rows:
    """C of all meshes, and with friction E, as of `idler.RowCompliance`, with how meshes couple `now` and to forces a
    step before."""
    nodes, nodes_before = counts
    kinds = 2 if tangential else 1
    own = [Joined(_rows(part, "compliance"), part.first, part.first) for part in parts]
    compliance = joined_rows(own, now, (nodes, nodes), (kinds, kinds))
    # Its first number is the size that others are measured by.
    form_rows(compliance.address, np.zeros(1, dtype=np.int64))
    if not tangential:
        return compliance, None
    own = [Joined(_rows(part, "previous_compliance"), part.first_before, part.first) for part in parts]
    return compliance, joined_rows(own, earlier, (nodes_before, nodes), (2, 1), by_columns=True)


def _rows(part: Part, name: str) -> FormedRows | AllRows:
    """A compliance of a mesh by itself, whose rows are not formed by this; of the previous one its columns."""
    stored = part.position.operator.__dict__[name]
    if isinstance(stored, FormedRows):
        return stored
    return AllRows(np.ascontiguousarray(stored if name == "compliance" else stored.T))
