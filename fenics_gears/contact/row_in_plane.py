"""Compliance of gears in a row in the plane: summed over bodies, so that meshes in which the same gear stands feel each
other."""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from fenics_gears.elasticity.compliance import BothFlanksCompliance, FlankCompliance
from fenics_gears.geometry.gear_train import SharedGear
from fenics_gears.system.memory import Kept

from .idler import Part, units_of
from .mesh_cycle import Cycle
from .pairing import Blocks, FlankTable, Numbered, add_products


@dataclass(frozen=True)
class GearInPlane:
    """A gear of so many `teeth` in two meshes, which load its `body` over the same face width (mm) and feel each other
    through it.

    It is `BetweenFlanks`: its teeth are counted as the first mesh counts them, and are the same after a turn.
    """

    teeth: int
    gear: SharedGear
    body: FlankCompliance
    face_width: float

    @property
    def meshes(self) -> tuple[int, int]:
        return self.gear.meshes

    def ahead(self, drive: int, coast: int, first: int) -> int:
        """Pitches by which the tooth of one flank is ahead of that of another, of `first` and more: round the gear
        either way."""
        return first + (drive - coast - first) % self.teeth

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


class _Coupling(NamedTuple):
    """How two meshes feel each other through a gear: `now` (k, n, k, m), mm/N, displacement of the nodes of the second
    by forces on those of the first; with friction `before`, (2, m before, n) and (2, n before, m): of one by forces a
    step before on the other. `flanks`: whose addresses it is known by."""

    now: np.ndarray
    before: tuple[np.ndarray, ...]
    flanks: FlankTable

    @property
    def bytes(self) -> int:
        return sum(each.nbytes for each in (self.now, *self.before))


class RowInPlane:
    """See `idler.RowCompliance`. Meshes that are alike pass the very same places one after the other: what they feel
    through gears that are alike is computed once, as far as it is `kept`."""

    def __init__(self, gears: Sequence[GearInPlane]):
        # By body: those of gears that are alike, and of a gear in each two of its meshes, are the same.
        blocks: dict[int, Blocks] = {}
        self._gears = [(gear, blocks.setdefault(id(gear.body), Blocks())) for gear in gears]
        self._known: dict[Hashable, _Coupling] = {}
        self.kept = Kept()

    def give_up(self) -> None:
        """Give up the couplings that are kept."""
        self._known.clear()
        self.kept.taken = 0.0

    def of(
        self, cycles: Sequence[Cycle], parts: Sequence[Part], counts: tuple[int, int], steps: float
    ) -> tuple[np.ndarray, np.ndarray | None]:
        nodes, nodes_before = counts
        tangential = any(cycle.tangential for cycle in cycles)
        kinds = 2 if tangential else 1
        compliance = np.zeros((kinds * nodes, kinds * nodes))
        # By columns, as compiled code reads it.
        before = np.zeros((2 * nodes_before, nodes))
        # By slices: numpy takes longer for lists of rows.
        by_kind = compliance.reshape(kinds, nodes, kinds, nodes)
        stood = before.reshape(2, nodes_before, nodes)
        for cycle, part in zip(cycles, parts):
            own = part.own
            of_mesh = part.position.operator.compliance
            there = 2 if cycle.tangential else 1
            by_kind[:there, own, :there, own] = of_mesh.reshape(there, part.nodes, there, part.nodes)
            if cycle.tangential:
                earlier = part.position.operator.previous_compliance
                stood[:, part.own_before, own] = earlier.T.reshape(2, part.nodes_before, part.nodes)
        for gear, blocks in self._gears:
            meshes = [(cycles[mesh], parts[mesh]) for mesh in gear.meshes]
            coupling = self._through(gear, blocks, meshes, (steps, tangential))
            (_, one), (_, other) = meshes
            by_kind[:, other.own, :, one.own] += coupling.now
            by_kind[:, one.own, :, other.own] += coupling.now.transpose(2, 3, 0, 1)
            for (by, of), found in zip(((one, other), (other, one)), coupling.before):
                stood[:, by.own_before, of.own] += found
        units = units_of(parts)
        if units is not None:
            now, then = units
            compliance *= np.outer(now, now)
            before *= np.outer(then, now[nodes:])
            # Without friction each node by itself.
            bare = np.flatnonzero(now == 0.0)
            if len(bare):
                compliance[bare, bare] = compliance[0, 0]
        return compliance, before.T if tangential else None

    def _through(
        self, gear: GearInPlane, blocks: Blocks, meshes: list[tuple[Cycle, Part]], after: tuple[float, bool]
    ) -> _Coupling:
        """How two meshes of a gear feel each other through it `after` so many steps, with tangential rows or not."""
        flanks = FlankTable()
        products, back = _products(gear, blocks, meshes, flanks, after)
        sizes = [(part.nodes, part.nodes_before) for _, part in meshes]
        key = tuple(sizes), flanks.addresses, tuple(products), tuple(back), gear.face_width
        found = self._known.get(key)
        if found is None:
            found = _multiplied(sizes, flanks, (products, back), after[1], gear.face_width)
            if self.kept.takes(found.bytes):
                self._known[key] = found
        return found


def _products(
    gear: GearInPlane, blocks: Blocks, meshes: list[tuple[Cycle, Part]], flanks: FlankTable, after: tuple[float, bool]
) -> tuple[list[tuple[int, ...]], list[float]]:
    """What is to be multiplied, as `add_products` takes it, with the nodes of these two meshes alone."""
    steps, tangential = after
    now = []
    earlier = []
    first = 0
    first_before = 0
    for mesh, (side, (_, part)) in enumerate(zip(gear.gear.sides, meshes)):
        now.append(_shifted(gear, mesh, flanks.of(part.position.operator.pairs, side), first))
        own = flanks.of(part.before, side) if tangential else []
        earlier.append(_shifted(gear, mesh, own, first_before))
        first += part.nodes
        first_before += part.nodes_before
    products = []
    back = []
    for responding, other in ((0, 1), (1, 0)):
        new = blocks.products(gear, now[responding], now[other], earlier[other])
        cycle = meshes[responding][0]
        turn = cycle.pair.sides[gear.gear.sides[responding]].turn
        products += [(0, *each) for each in new]
        back += [turn * steps / cycle.steps] * len(new)
    return products, back


def _multiplied(
    sizes: list[tuple[int, int]],
    flanks: FlankTable,
    products: tuple[list[tuple[int, ...]], list[float]],
    tangential: bool,
    face_width: float,
) -> _Coupling:
    """The products of two meshes with so many nodes now and a step before."""
    kinds = 2 if tangential else 1
    (own, own_before), (others, others_before) = sizes
    nodes = own + others
    nodes_before = own_before + others_before
    compliance = np.zeros((kinds * nodes, kinds * nodes))
    before = np.zeros((2 * nodes_before, nodes))
    at = compliance.ctypes.data, before.ctypes.data, nodes, nodes_before
    add_products([at], flanks, products, tangential, face_width)
    by_kind = compliance.reshape(kinds, nodes, kinds, nodes)
    # Copies, which do not hold the whole.
    now = by_kind[:, own:, :, :own].copy()
    if not tangential:
        return _Coupling(now, (), flanks)
    stood = before.reshape(2, nodes_before, nodes)
    return _Coupling(now, (stood[:, :own_before, own:].copy(), stood[:, own_before:, :own].copy()), flanks)


def _shifted(gear: GearInPlane, mesh: int, numbered: list[Numbered], first: int) -> list[Numbered]:
    """Flanks as the gear's first mesh counts them, with nodes of the meshes before them."""
    return [(gear.gear.flank(mesh, flank), number, place + first) for flank, number, place in numbered]
