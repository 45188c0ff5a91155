"""Places of flanks that can touch at a phase of the mesh, in the plane and in the slices of a face; and which tooth
pairs can touch over a mesh cycle.

A pair touches without a break from the first to the last of its positions, and every pair does so at the same positions
of its own way through the mesh. Positions are counted in steps along this way: pair `index` stands at `step + index *
steps` at a step of the cycle.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from functools import lru_cache
from math import ceil, floor
from typing import TYPE_CHECKING

import numpy as np

from fenics_gears.elasticity.compliance import Reach
from fenics_gears.geometry.pair import GearPair

from .face import one_slice
from .tooth_pair import COAST, DRIVE, PairNodes, Place, coast_place, drive_place
from .window import ContactGrid, coast_roll_angles, contact_roll_angles, ends_of, exists, windows

if TYPE_CHECKING:
    from .corner import CornerContact
    from .face import Face


# Cost, the search for touching pairs and the cycle itself ask for the same places.
@lru_cache(maxsize=4096)
def pair_places(
    pair: GearPair, grid: ContactGrid, phase: float, coast_flanks: bool = False, corner: CornerContact | None = None
) -> tuple[Place, ...]:
    """Every pair of flanks whose window is not empty at `phase` (0 <= phase < 1): drive flanks, then coast flanks if
    asked for.

    Index 0 is the pair that reached the start of contact last, 1 the one before it, -1 the one to come. `corner`: tips
    touch by their edges too; places are theoretical ones all the same.
    """
    return tuple(face_places(pair, grid, one_slice(pair.face_width), phase, coast_flanks, corner))


def counted_from(cycles: int, pairs: tuple[PairNodes, ...]) -> tuple[PairNodes, ...]:
    """Pairs counted from so many mesh cycles later: each index rises as a pair passes the end of a cycle."""
    if not cycles:
        return pairs
    return tuple(replace(each, place=replace(each.place, index=each.place.index + cycles)) for each in pairs)


def face_places(
    pair: GearPair,
    grid: ContactGrid,
    face: Face,
    phase: float,
    coast_flanks: bool = False,
    corner: CornerContact | None = None,
) -> list[Place]:
    """Every pair of flanks in every slice whose window is not empty at `phase` (0 <= phase < 1), as `pair_places` has
    it; by pair, then slice."""
    # Off the line of action a tip can touch up to the window's length before and after the path of contact.
    reach = 2 + ceil(grid.length / pair.base_pitch)
    candidates = np.arange(-reach, ceil(pair.contact_ratio) + reach)
    phases = phase + face.shifts / pair.base_pitch
    passed = np.floor(phases)
    xi = pair.path_start + ((phases - passed)[:, None] + candidates) * pair.base_pitch
    # A slice that is a whole mesh cycle ahead has the next pair where the middle has this one.
    indices = (candidates - passed[:, None]).astype(int)
    heights = face.positions.tolist()
    places = []
    kinds = (DRIVE, drive_place, contact_roll_angles), (COAST, coast_place, coast_roll_angles)
    for flank, place_of, rolls_of in kinds[: 1 + coast_flanks]:
        rolls = np.array(rolls_of(pair, xi))
        same = place_of(pair, 0, pair.path_start)
        if corner is None:
            touches = exists(*windows(ends_of(pair, rolls.reshape(2, -1)), grid), grid).reshape(xi.shape)
        else:
            touches = _with_edges(pair, grid, corner, place_of, xi)
        slices, _ = np.nonzero(touches)
        # By pair, then slice.
        order = np.lexsort((slices, indices[touches]))
        each = zip(indices[touches][order].tolist(), slices[order].tolist(), rolls[:, touches].T[order].tolist())
        places += [
            Place(index, flank, tuple(both), same.axes, same.turn, slice=number, height=heights[number])
            for index, number, both in each
        ]
    return places


def _with_edges(pair: GearPair, grid: ContactGrid, corner: CornerContact, place_of, xi: np.ndarray) -> np.ndarray:
    """Whether flanks with their tip edges may touch at places on the path (mm)."""
    return np.reshape([corner.reaches(pair, grid, place_of(pair, 0, at)) for at in xi.ravel().tolist()], xi.shape)


# Positions of a mesh cycle at which touching pairs are looked for; between them the ends are found by halving.
LOOKED_AT = 16


@dataclass(frozen=True)
class Touching:
    """First and last position at which drive flanks touch, and coast flanks (None where they cannot), at `steps` a mesh
    cycle."""

    steps: int
    drive: tuple[int, int]
    coast: tuple[int, int] | None = None

    @property
    def reach(self) -> Reach:
        """How many teeth apart flanks are that interact at a step, with those of the step before, or between both."""
        same = max((last - first + 1) // self.steps for first, last in (self.drive, self.coast or self.drive))
        if self.coast is None:
            return Reach(same, None)
        least = -((self.coast[1] - self.drive[0] + 1) // self.steps)
        most = (self.drive[1] - self.coast[0] + 1) // self.steps
        # Between a drive and a coast flank: on the pinion, and on the wheel, whose tooth of a coast pair stands one
        # beside.
        return Reach(same, (min(least, -most - 1), max(most, -least - 1)))

    @property
    def latest(self) -> int:
        """Largest index of a pair at any step."""
        return max(last // self.steps for _, last in (self.drive, self.coast or self.drive))

    @property
    def slots(self) -> int:
        """Largest number of consecutive tooth pairs that can touch at a step; drive and coast flank of a pair count
        once."""
        ways = [self.drive, self.coast or self.drive]
        # Pairs come and go only at these steps.
        changes = {(end + later) % self.steps for way in ways for end in way for later in (0, 1)}
        return max(
            max((last - step) // self.steps for _, last in ways)
            - min(-((step - first) // self.steps) for first, _ in ways)
            + 1
            for step in changes
        )


@lru_cache(maxsize=64)
def touching(
    pair: GearPair,
    grid: ContactGrid,
    steps: int,
    coast_flanks: bool = False,
    corner: CornerContact | None = None,
    shifts: tuple[float, ...] = (0.0,),
) -> Touching:
    """Where the pairs of a mesh cycle touch in any slice; `shifts`: of the outermost slices (`Face.outermost_shifts`),
    between which the others touch."""

    def places_at(step: int) -> Iterator[Place]:
        for shift in shifts:
            ahead = shift / pair.base_pitch
            passed = floor(step / steps + ahead)
            for place in pair_places(pair, grid, step / steps + ahead - passed, coast_flanks, corner):
                # A slice that is a whole mesh cycle ahead has the next pair where the middle has this one.
                yield replace(place, index=place.index - passed) if passed else place

    return touching_at(places_at, steps, coast_flanks)


def touching_at(places_at: Callable[[int], Iterable[Place]], steps: int, coast_flanks: bool) -> Touching:
    """Where pairs touch, of which `places_at` gives those at a step (0 to steps - 1)."""

    def touches(position: int, flank: int) -> bool:
        index, step = divmod(position, steps)
        return any(place.index == index and place.flank == flank for place in places_at(step))

    def ends(flank: int) -> tuple[int, int] | None:
        looked_at = range(0, steps, max(1, steps // LOOKED_AT))
        positions = [
            step + place.index * steps for step in looked_at for place in places_at(step) if place.flank == flank
        ]
        if not positions:
            return None
        return _end(lambda position: touches(position, flank), min(positions), -1, steps), _end(
            lambda position: touches(position, flank), max(positions), 1, steps
        )

    return Touching(steps, ends(DRIVE), ends(COAST) if coast_flanks else None)


def _end(touches, inside: int, direction: int, far: int) -> int:
    """The last position in a direction that touches, from one that does; `far` positions on none does."""
    outside = inside + direction * far
    while abs(outside - inside) > 1:
        middle = (inside + outside) // 2
        inside, outside = (middle, outside) if touches(middle) else (inside, middle)
    return inside
