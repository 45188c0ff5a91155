"""Compliance of gears in a row in the plane: summed over bodies, so that meshes in which the same gear stands feel each
other."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fenics_gears.elasticity.compliance import BothFlanksCompliance, FlankCompliance

from .idler import BetweenMeshes, Part
from .mesh_cycle import Cycle
from .pairing import Blocks, FlankTable, Numbered, add_products


@dataclass(frozen=True)
class GearInPlane(BetweenMeshes):
    """A gear whose `body` both meshes load over the same face width (mm).

    It is `BetweenFlanks`: its teeth are counted as the first mesh counts them, and are the same after a turn.
    """

    body: FlankCompliance
    face_width: float

    def between(self, responding: int, loaded: int, sides: tuple[int, int] = (0, 0)) -> np.ndarray:
        side, other = sides
        if side == other:
            return self.body.between(self.ahead(responding, loaded, -(self.teeth // 2)), 0, sides)
        assert isinstance(self.body, BothFlanksCompliance)
        sense = 1 if side == 0 else -1
        ahead = self.ahead(sense * responding, sense * loaded, self.body.first_across)
        return self.body.between(sense * ahead, 0, sides)

    def key(self, responding: int, loaded: int) -> int:
        return responding - loaded


class RowInPlane:
    """See `idler.RowCompliance`."""

    def __init__(self, gears: Sequence[GearInPlane]):
        self._gears = [(gear, Blocks()) for gear in gears]

    def of(
        self, cycles: Sequence[Cycle], parts: Sequence[Part], counts: tuple[int, int], steps: float
    ) -> tuple[np.ndarray, np.ndarray | None]:
        nodes, nodes_before = counts
        tangential = cycles[0].tangential
        kinds = 2 if tangential else 1
        compliance = np.zeros((kinds * nodes, kinds * nodes))
        # By columns, as compiled code reads it.
        before = np.zeros((2 * nodes_before, nodes))
        for part in parts:
            rows = part.rows(kinds, nodes)
            compliance[np.ix_(rows, rows)] = part.position.operator.compliance
            if tangential:
                earlier = part.position.operator.previous_compliance
                before[np.ix_(part.rows_before(nodes_before), part.rows(1, nodes))] = earlier.T
        at = compliance.ctypes.data, before.ctypes.data, nodes, nodes_before
        for gear, blocks in self._gears:
            own = [(cycles[mesh], parts[mesh]) for mesh in gear.meshes]
            _add_through(gear, blocks, own, at, steps)
        return compliance, before.T if tangential else None


def _add_through(
    gear: GearInPlane, blocks: Blocks, meshes: list[tuple[Cycle, Part]], at: tuple[int, ...], steps: float
) -> None:
    """Add how two meshes of a gear feel each other through it."""
    flanks = FlankTable()
    tangential = meshes[0][0].tangential
    now = []
    earlier = []
    for mesh, (side, (_, part)) in enumerate(zip(gear.gear.sides, meshes)):
        own = flanks.of(part.position.operator.pairs, side)
        now.append(_shifted(gear, mesh, own, part.first))
        own = flanks.of(part.before, side) if tangential else []
        earlier.append(_shifted(gear, mesh, own, part.first_before))
    products = []
    back = []
    for responding, other in ((0, 1), (1, 0)):
        new = blocks.products(gear, now[responding], now[other], earlier[other])
        cycle = meshes[responding][0]
        turn = cycle.pair.sides[gear.gear.sides[responding]].turn
        products += [(0, *each) for each in new]
        back += [turn * steps / cycle.steps] * len(new)
    add_products([at], flanks, (products, back), tangential, gear.face_width)


def _shifted(gear: GearInPlane, mesh: int, numbered: list[Numbered], first: int) -> list[Numbered]:
    """Flanks as the gear's first mesh counts them, with nodes of all meshes before them."""
    return [(gear.gear.flank(mesh, flank), number, place + first) for flank, number, place in numbered]
