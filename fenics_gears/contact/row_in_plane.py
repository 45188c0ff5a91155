"""Compliance of gears in a row in the plane: summed over bodies, so that meshes in which the same gear stands feel each
other."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fenics_gears.elasticity.compliance import BothFlanksCompliance, FlankCompliance

from .idler import BetweenMeshes, Part
from .mesh_cycle import Cycle
from .pairing import Blocks, Flank, FlankTable, Numbered, add_products, matched


@dataclass(frozen=True)
class GearInPlane(BetweenMeshes):
    """A gear whose `body` both meshes load over the same face width (mm)."""

    body: FlankCompliance
    face_width: float

    def block(self, responding: Flank, loaded: Flank) -> np.ndarray:
        """Compliance of one flank under forces on one of the other mesh, mm per N/mm: of the same side of another
        tooth, or of the other side."""
        (tooth, side), (other, other_side) = responding, loaded
        if side == other_side:
            return self.body.between(self.ahead(tooth, other, -(self.teeth // 2)), 0, (side, side))
        assert isinstance(self.body, BothFlanksCompliance)
        sense = 1 if side == 0 else -1
        ahead = self.ahead(sense * tooth, sense * other, self.body.first_across)
        return self.body.between(sense * ahead, 0, (side, other_side))


class RowInPlane:
    """See `idler.RowCompliance`."""

    def __init__(self, gears: Sequence[GearInPlane]):
        self._gears = gears
        self._blocks = Blocks()

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
        for gear in self._gears:
            own = [(cycles[mesh], parts[mesh]) for mesh in gear.meshes]
            self._add_through(gear, own, at, steps)
        return compliance, before.T if tangential else None

    def _add_through(
        self, gear: GearInPlane, meshes: list[tuple[Cycle, Part]], at: tuple[int, ...], steps: float
    ) -> None:
        """Add how two meshes of a gear feel each other through it."""
        flanks = FlankTable()
        tangential = meshes[0][0].tangential
        now = []
        earlier = []
        for mesh, (side, (_, part)) in enumerate(zip(gear.gear.sides, meshes)):
            own = flanks.of(part.position.operator.pairs, side)
            now.append([_shifted(gear.gear.flank(mesh, each[0]), each, part.first) for each in own])
            own = flanks.of(part.before, side) if tangential else []
            earlier.append([_shifted(gear.gear.flank(mesh, each[0]), each, part.first_before) for each in own])
        products = []
        back = []
        for responding, other in ((0, 1), (1, 0)):
            # Nodes of the first mesh stand before those of the second: the other half follows by symmetry.
            loads = matched(now[other] if responding == 1 else [], earlier[other])
            cycle = meshes[responding][0]
            turn = cycle.pair.sides[gear.gear.sides[responding]].turn
            for flank, number, place in now[responding]:
                for loaded, *numbers in loads:
                    block = self._block(gear, flank, loaded)
                    products.append((0, *block, number, numbers[0], numbers[2], place, numbers[1], numbers[3]))
                    back.append(turn * steps / cycle.steps)
        add_products([at], flanks, (products, back), tangential, gear.face_width)

    def _block(self, gear: GearInPlane, responding: Flank, loaded: Flank) -> tuple[int, int, int]:
        """Address, size and columns of the compliance between two flanks of a gear."""
        return self._blocks.of((gear.meshes, responding, loaded), lambda: gear.block(responding, loaded))


def _shifted(flank: Flank, numbered: Numbered, first: int) -> Numbered:
    return flank, numbered[1], numbered[2] + first
