"""Places of flanks that can touch at a phase of the mesh, in the plane and in the slices of a face."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache
from math import ceil
from typing import TYPE_CHECKING

import numpy as np

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
    found = []
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
        found += [
            Place(index, flank, tuple(both), same.axes, same.turn, slice=number, height=heights[number])
            for index, number, both in each
        ]
    return found


def _with_edges(pair: GearPair, grid: ContactGrid, corner: CornerContact, place_of, xi: np.ndarray) -> np.ndarray:
    """Whether flanks with their tip edges may touch at places on the path (mm)."""
    from .corner import pair_reaches

    return np.reshape([pair_reaches(pair, grid, corner, place_of(pair, 0, at)) for at in xi.ravel().tolist()], xi.shape)
