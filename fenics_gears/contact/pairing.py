"""Compliance between contact nodes in the plane, from the flank compliances of both gears; its rank, and a thin
layer for contact nodes that elasticity cannot tell apart."""

from __future__ import annotations

from collections.abc import Hashable, Sequence

import numpy as np
from scipy.linalg.lapack import dpstrf

from fenics_gears.elasticity.compliance import BetweenFlanks

from .compliance_product import NO_FLANK, OWN, compliance_products, directions
from .interpolation import FlankInterpolation
from .operator import Passage, Response
from .tooth_pair import Flanks, ToothPair, count_of

# Nodes that coincide, or more nodes on an element than it has degrees of freedom, yield together: elasticity does not
# determine how they share a force. Each node then gets a thin elastic layer of its own, and nodes that coincide share
# it evenly. In parts of the largest self-compliance of a node. Newton does not converge with a layer below 1e-5; this
# one changes the transmission error of the paper's pair by 1e-5 of itself, a hundredth of the error of such a grid.
SMALLEST_PIVOT = 1e-10
LAYER = 1e-4


def dependent_rows(compliance: np.ndarray) -> int:
    """Rows of a positive semi-definite matrix (m, m) that follow from the others; by Cholesky with pivots."""
    if not len(compliance):
        return 0
    tolerance = SMALLEST_PIVOT * compliance.diagonal().max()
    # Turned over, in the order of Fortran: it is symmetric.
    return len(compliance) - int(dpstrf(compliance.T, tol=tolerance, lower=1)[2])


def of_full_rank(compliance: np.ndarray) -> tuple[np.ndarray, int]:
    """The compliance (m, m), mm/N, itself where it has full rank, else with a thin layer at every node; and its
    dependent rows."""
    dependent = dependent_rows(compliance)
    if not dependent:
        return compliance, 0
    return compliance + LAYER * compliance.diagonal().max() * np.eye(len(compliance)), dependent


# A flank of a gear, by its tooth's place and its side.
Flank = tuple[int, int]


# A flank, its number in a FlankTable, and the place of its first contact node among all at a position.
Numbered = tuple[Flank, int, int]


class Blocks:
    """Compliance of a body between its flanks as compiled code finds it."""

    def __init__(self) -> None:
        self._known: dict[Hashable, tuple[tuple[int, int, int], np.ndarray]] = {}

    def products(
        self, body: BetweenFlanks, responding: list[Numbered], now: list[Numbered], before: list[Numbered]
    ) -> list[tuple[int, ...]]:
        """What is to be multiplied at a position, as `compliance_products` takes it: flanks of a body that are
        responding by those that are loaded `now` or were a step `before`."""
        loads = matched(now, before)
        products = []
        for flank, own, place in responding:
            for other, loaded, at, loaded_before, at_before in loads:
                if at > place:
                    # By symmetry.
                    loaded = NO_FLANK
                if loaded != NO_FLANK or loaded_before != NO_FLANK:
                    block = self._between(body, flank, other)
                    products.append((*block, own, loaded, loaded_before, place, at, at_before))
        return products

    def _between(self, body: BetweenFlanks, responding: Flank, loaded: Flank) -> tuple[int, int, int]:
        """Address, size and columns of the compliance of one flank under forces on another."""
        teeth, sides = zip(responding, loaded)
        key = body.key(*teeth), sides
        if key not in self._known:
            found = np.ascontiguousarray(body.between(*teeth, sides))
            # With the block itself, which holds the memory.
            self._known[key] = (found.ctypes.data, found.size, found.shape[1]), found
        return self._known[key][0]


class CompliancePairing:
    """Compliance between the contact nodes of tooth pairs, from the flank compliances of both gears."""

    def __init__(self, flanks: Flanks, blocks: tuple[Blocks, Blocks] | None = None):
        """`blocks`: of either gear, by pairs of teeth, which pairings of the same bodies may share."""
        self.flanks = flanks
        self._blocks = blocks or (Blocks(), Blocks())

    def responses(self, passages: Sequence[Passage]) -> list[Response]:
        """How the contact nodes of some passages yield, all with previous pairs or all without."""
        of_passages = []
        for compliance, before in self.compliances(passages):
            compliance, dependent = of_full_rank(compliance)
            of_passages.append(Response(compliance, before, dependent))
        return of_passages

    def compliances(self, passages: Sequence[Passage]) -> list[tuple[np.ndarray, np.ndarray | None]]:
        """Sum over both gears of `N A N^T`, mm/N, at the end of each passage: C (m, m) between the nodes of its pairs,
        and E (n, m before) by forces on those of the previous ones.

        With previous pairs there are tangential rows, and E is the displacement along the tangent that the material
        points had a step before. E is None without.
        """
        tangential = passages[0].previous is not None
        kinds = 2 if tangential else 1
        flanks = FlankTable()
        matrices = []
        positions = []
        products = []
        back = []
        for number, passage in enumerate(passages):
            nodes = count_of(passage.pairs)
            nodes_before = count_of(passage.previous or ())
            compliance = np.zeros((kinds * nodes, kinds * nodes))
            before = np.zeros((2 * nodes_before, nodes))
            positions.append((compliance.ctypes.data, before.ctypes.data, nodes, nodes_before))
            matrices.append((compliance, before.T if tangential else None))
            for side, body, blocks in zip(self.flanks.pair.sides, self.flanks.compliance, self._blocks):
                now, earlier = (flanks.of(each or (), side.number) for each in passage[:2])
                new = blocks.products(body, now, now, earlier)
                products += [(number, *each) for each in new]
                back += [side.turn * passage.advance] * len(new)
        add_products(positions, flanks, (products, back), tangential, self.flanks.pair.face_width)
        return matrices


def add_products(
    positions: list[tuple[int, ...]],
    flanks: FlankTable,
    products: tuple[list[tuple[int, ...]], list[float]],
    tangential: bool,
    face_width: float,
) -> None:
    """Add products of flanks of bodies to compliances at positions, as `compliance_products` takes both; with the
    products the angles (rad) by which the gears of the responding flanks stood back a step before."""
    rows, back = products
    if not rows:
        return
    table = np.array(rows)
    responding = flanks.responding(table[:, OWN], np.array(back), tangential)
    compliance_products(
        (np.array(positions), flanks.table, table), np.concatenate(flanks.near), np.concatenate(flanks.first),
        flanks.axes(tangential), responding / face_width,
    )  # fmt: skip


def matched(now: list[Numbered], before: list[Numbered]) -> list[tuple[Flank, int, int, int, int]]:
    """Flanks that are loaded now, each with its number and place a step before, or NO_FLANK; and those loaded then
    alone."""
    left = list(before)
    flanks = []
    for flank, *numbers in now:
        same = next((place for place, (other, *_) in enumerate(left) if other == flank), None)
        flanks.append((flank, *numbers, *((NO_FLANK, 0) if same is None else left.pop(same)[1:])))
    return flanks + [(flank, NO_FLANK, 0, *numbers) for flank, *numbers in left]


class FlankTable:
    """Flanks with contact nodes as `compliance_products` takes them, each once, at however many positions it is asked
    for."""

    def __init__(self):
        self.near: list[np.ndarray] = []
        self.first: list[np.ndarray] = []
        self._views: list[FlankInterpolation] = []
        self._numbers: dict[int, int] = {}
        self._known: dict[tuple[int, int], list[Numbered]] = {}
        self._sizes: list[tuple[int, int, float, float]] = []

    def of(self, pairs: Sequence[ToothPair], gear: int) -> list[Numbered]:
        """Flanks of a gear at a position, whose pairs are held as long as this table is."""
        flanks = self._known.setdefault((id(pairs), gear), [])
        if flanks:
            return flanks
        start = 0
        for pair in pairs:
            view = pair.interpolation[gear]
            place = pair.place
            number = self._numbers.get(id(view))
            if number is None:
                number = self._numbers[id(view)] = len(self.near)
                self.near.append(view.near.ravel())
                self.first.append(view.first)
                self._views.append(view)
                self._sizes.append((*view.near.shape, place.contact_rolls[gear], place.turn))
            flanks.append(((place.teeth[gear], place.flank), number, start))
            start += len(view.near)
        return flanks

    @property
    def addresses(self) -> tuple[int, ...]:
        """Of the interpolation of each flank, which this table holds."""
        return tuple(self._numbers)

    @property
    def table(self) -> np.ndarray:
        """Of each flank (flanks, 4) where its weights begin, how many a node has, where its first flank nodes begin and
        how many contact nodes there are."""
        counts, widths = np.array([size[:2] for size in self._sizes], dtype=np.int64).T
        return np.stack([np.cumsum(counts * widths) - counts * widths, widths, np.cumsum(counts) - counts, counts], 1)

    def axes(self, tangential: bool) -> np.ndarray:
        """Directions (flanks, 1 or 2, 2) of forces on each flank, in the tooth's frame."""
        return directions(np.array([size[2] for size in self._sizes]), tangential)

    def responding(self, numbers: np.ndarray, back: np.ndarray, tangential: bool) -> np.ndarray:
        """Directions of the displacement of flanks of these numbers (p,); the tangent also as it stood (p, 1 or 3, 2),
        when their gears stood `back` (p,), rad."""
        rolls, turns = (np.array([size[at] for size in self._sizes])[numbers] for at in (2, 3))
        now = directions(rolls, tangential)
        if not tangential:
            return now
        return np.concatenate([now, directions(rolls - turns * back, True)[:, 1:]], axis=1)
