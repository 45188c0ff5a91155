"""The mesh of a pair whose teeth are not all alike: contact operators depend on the teeth in mesh.

Cycles whose teeth in mesh respond alike share their operators; the others have their own: with one cracked tooth, the
few cycles in which it can be in mesh.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from fenics_gears.elasticity.compliance import FlankBody
from fenics_gears.geometry.side import Side

from .mesh import Mesh, elastic_mesh
from .pairing import Blocks, CompliancePairing
from .places import pair_places
from .tooth_pair import Flanks
from .window import ContactGrid

if TYPE_CHECKING:
    from .corner import CornerContact

# Teeth respond alike where their compliances agree to this part of the largest, a fifth of the error of a default mesh.
# The effect of a crack on the next teeth falls by about half from tooth to tooth.
ALIKE = 1e-4
SAME_ROLL = 1e-9


def whole_body_mesh(flanks: Flanks, grid: ContactGrid, steps: int, corner: CornerContact | None = None) -> Mesh:
    """The mesh of gears of which one at least has a `WholeBodyCompliance`, over mesh cycles of so many steps.

    Tooth 0 of either body is that of pair 0 at the start of the run.
    """
    meshes = MeshesAlike(flanks, grid, steps, corner)
    return replace(meshes.of_cycle(0), bodies=flanks.compliance, of_cycle=meshes.of_cycle)


class MeshesAlike:
    """Meshes of their own for mesh cycles whose teeth respond differently, shared by those whose teeth respond alike;
    arguments as of `whole_body_mesh`."""

    def __init__(self, flanks: Flanks, grid: ContactGrid, steps: int, corner: CornerContact | None = None):
        self._flanks = flanks
        self._grid = grid
        self._steps = steps
        self._corner = corner
        self._blocks = Blocks(), Blocks()
        self._first_alike: tuple[dict[int, int], ...] = ({}, {})
        self.meshes: dict[tuple[int, int], tuple[tuple, Mesh]] = {}

    def of_cycle(self, number: int) -> Mesh:
        """The mesh in the mesh cycle of that number, counted from the start of the run."""
        key = tuple(self._like(side, number) for side in self._flanks.pair.sides)
        if key not in self.meshes:
            self.meshes[key] = self._made(key)
        return self.meshes[key][1]

    def _like(self, side: Side, number: int) -> int:
        """The first tooth of a gear's earlier cycle whose teeth in mesh respond as those of cycle `number` do."""
        body = self._flanks.compliance[side.number]
        if body.alike:
            return 0
        first = first_tooth(side, number) % body.teeth
        known = self._first_alike[side.number]
        if first not in known:
            distinct = sorted(set(known.values()))
            known[first] = next((each for each in distinct if self._respond_alike(side.number, first, each)), first)
        return known[first]

    def _respond_alike(self, gear: int, one: int, other: int) -> bool:
        body = self._flanks.compliance[gear]
        teeth = self._teeth[gear]
        if not all(same_rolls(body.rolls_of(one + tooth), body.rolls_of(other + tooth)) for tooth in teeth):
            return False
        largest = np.abs(body.between(one, one).diagonal()).max()
        return all(
            np.abs(body.between(one + a, one + b) - body.between(other + a, other + b)).max() <= ALIKE * largest
            for a in teeth for b in teeth if 0 <= a - b <= body.offsets
        )  # fmt: skip

    @cached_property
    def _teeth(self) -> tuple[range, range]:
        """Teeth of either gear that can be in mesh during a cycle or a step before it, counter-clockwise of that in
        pair 0."""
        places = [
            place
            for step in range(self._steps)
            for place in pair_places(self._flanks.pair, self._grid, step / self._steps, corner=self._corner)
        ]
        ranges = []
        for side in self._flanks.pair.sides:
            teeth = [place.teeth[side.number] for place in places]
            # At the start of a cycle the pairs of the step before it have indices higher by one.
            teeth += [tooth + side.sense for tooth in teeth]
            ranges.append(range(min(teeth), max(teeth) + 1))
        return tuple(ranges)

    def _made(self, first: tuple[int, int]) -> tuple[tuple, Mesh]:
        """Both gears as that mesh cycle meets them, and its mesh."""
        bodies = tuple(
            body if body.alike else body.counted_from(tooth) for body, tooth in zip(self._flanks.compliance, first)
        )
        flanks = Flanks(self._flanks.pair, bodies, self._flanks.removal)
        made = elastic_mesh(flanks, self._grid, self._corner, CompliancePairing(flanks, self._blocks))
        for others, mesh in self.meshes.values():
            if self._same_nodes(others, bodies):
                return bodies, replace(made, nodes=mesh.nodes)
        return bodies, made

    def _same_nodes(self, one: tuple[FlankBody, ...], other: tuple[FlankBody, ...]) -> bool:
        """Whether flank nodes of all teeth in mesh are at the same roll angles, so that interpolations are alike."""
        bodies = zip(one, other, self._teeth)
        return all(same_rolls(a.rolls_of(tooth), b.rolls_of(tooth)) for a, b, teeth in bodies for tooth in teeth)


def same_rolls(one: np.ndarray, other: np.ndarray) -> bool:
    """Whether two flanks have nodes at the same roll angles (rad), but for the last digits of points in a file."""
    return one.shape == other.shape and bool(np.abs(one - other).max() <= SAME_ROLL)


def first_tooth(side: Side, cycle: int) -> int:
    """Tooth of a gear, counted counter-clockwise, that reaches the start of contact with a mesh cycle.

    Teeth come into mesh against the sense of rotation, one after the other.
    """
    return -side.sense * cycle
