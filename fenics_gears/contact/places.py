"""Where flanks stand that can touch at a phase of the mesh, in the plane and in the slices of a face."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache
from math import ceil, floor
from typing import TYPE_CHECKING

from fenics_gears.contact.tooth_pair import Place, coast_place, drive_place
from fenics_gears.contact.window import ContactGrid, flank_ends, window
from fenics_gears.geometry.pair import GearPair

if TYPE_CHECKING:
    from fenics_gears.contact.corner import CornerContact
    from fenics_gears.contact.face import Face


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

    def can_touch(place: Place) -> bool:
        if corner is not None:
            from fenics_gears.contact.corner import pair_reaches

            return pair_reaches(pair, grid, corner, place)
        return window(flank_ends(pair, place.contact_rolls), grid) is not None

    # Off the line of action a tip can touch up to the window's length before and after the path of contact.
    reach = 2 + ceil(grid.length / pair.base_pitch)
    candidates = range(-reach, ceil(pair.contact_ratio) + reach)
    sides = (drive_place, coast_place) if coast_flanks else (drive_place,)
    places = (side(pair, k, pair.path_start + (phase + k) * pair.base_pitch) for side in sides for k in candidates)
    return tuple(place for place in places if can_touch(place))


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
    found = []
    for number, (height, shift) in enumerate(zip(face.positions.tolist(), (face.shifts / pair.base_pitch).tolist())):
        passed = floor(phase + shift)
        places = pair_places(pair, grid, phase + shift - passed, coast_flanks, corner)
        # A slice that is a whole mesh cycle ahead has the next pair where the middle has this one.
        found += [replace(place, index=place.index - passed, slice=number, height=height) for place in places]
    return sorted(found, key=lambda place: (place.flank, place.index, place.slice))
