"""The contact operators of a mesh cycle of pairs whose flanks are resolved over the face: a slice is a spur mesh at
another phase."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from math import floor

import numpy as np

from fenics_gears.contact.face import Face
from fenics_gears.contact.face_pairing import FacePair, FacePairing
from fenics_gears.contact.mesh_cycle import MeshCycle, Position, pair_places
from fenics_gears.contact.operator import operator_on_lines, turned
from fenics_gears.contact.tooth_pair import COAST, DRIVE, Flanks, Place, flank_points, interpolations
from fenics_gears.contact.touching import Touching, touching_at
from fenics_gears.contact.window import ContactGrid
from fenics_gears.elasticity.face_compliance_data import FaceCompliance

Opening = Callable[[np.ndarray, np.ndarray], np.ndarray]


def face_places(
    pair, grid: ContactGrid, face: Face, phase: float, coast_flanks: bool = False, corner=None
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


class FaceCycle(MeshCycle):
    """Contact nodes in the slices of a `face`: compliance of the gears' three-dimensional `bodies`, and of fine plane
    sections near the contact.

    `opening(z, positions)`: gap (k,), mm along the line of action, that lead modifications and misalignment leave
    between the flanks, at heights z (k,), mm, and positions (k,), mm from T1, of the contact; `coast_opening` the same
    of the coast flanks, None for no gap. Other arguments as of MeshCycle.
    """

    def __init__(
        self,
        flanks: Flanks,
        bodies: tuple[FaceCompliance, FaceCompliance],
        face: Face,
        opening: Opening,
        grid: ContactGrid,
        steps: int,
        coordinates: list[int],
        tangential: bool,
        corner=None,
        coast_opening: Opening | None = None,
    ):
        pairing = FacePairing(flanks, bodies, face)
        super().__init__(flanks, grid, steps, coordinates, tangential, corner, pairing)
        self.face, self._sections, self._openings_of = face, pairing.sections, (opening, coast_opening)

    def _pairs_of(self, index: float) -> tuple[FacePair, ...]:
        found, alike = [], {}
        places = face_places(self.pair, self.grid, self.face, index / self.steps, self.coast_flanks, self.corner)
        for place, opening in zip(places, self._openings(places)):
            # Slices of a spur pair are all alike.
            key = place.flank, place.index, self.face.shifts[place.slice]
            if key not in alike:
                alike[key] = self._pair(place)
            if alike[key] is not None:
                found.append(self._in_slice(alike[key], place, opening))
        return tuple(found)

    def _openings(self, places: list[Place]) -> list[float]:
        """What opens the flanks at each place, mm along the line of action."""
        flanks, heights = (
            np.array([place.flank for place in places], dtype=int),
            np.array([place.height for place in places]),
        )
        positions, found = (
            self.pair.pinion.base_radius * np.array([place.contact_rolls[0] for place in places]),
            np.zeros(len(places)),
        )
        for flank, opening in zip((DRIVE, COAST), self._openings_of):
            if opening is not None:
                found[flanks == flank] = opening(heights[flanks == flank], positions[flanks == flank])
        return found.tolist()

    def _pair(self, place: Place) -> FacePair | None:
        """The contact nodes of a tooth pair in a slice, with the gap of flanks that are not modified along the face,
        along the line of action."""
        pair = super()._pair(place)
        if pair is None:
            return None
        rolls = flank_points(self.pair, pair.place, pair.offsets)[0]
        return FacePair(**vars(pair), coarse=interpolations(self._sections, self.grid, pair.place, pair.offsets, rolls))

    def _in_slice(self, pair: FacePair, place: Place, opening: float) -> FacePair:
        gap = self.face.cosine * (pair.gap + opening)
        return replace(pair, place=replace(pair.place, slice=place.slice, height=place.height), gap=gap)

    def _position(self, index: float, pairs, previous, advance: float, carried: np.ndarray) -> Position:
        before = previous if self._tangential else None
        compliance, earlier, dependent = self._pairing.compliance(pairs, before, turned(self.pair, advance))
        operator = operator_on_lines(
            self.pair, pairs, self._coordinates, compliance, earlier, advance, dependent, self.face
        )
        return Position(operator, carried)


def touching_on_face(
    pair, grid: ContactGrid, face: Face, steps: int, coast_flanks: bool = False, corner=None
) -> Touching:
    """Where the pairs of a mesh cycle touch in any slice."""
    ends = sorted({int(face.shifts.argmin()), int(face.shifts.argmax())})
    # Slices between the outermost two touch between them.
    outer = Face(face.positions[ends], face.widths[ends], face.slope, face.middles)
    return touching_at(
        lambda step: face_places(pair, grid, outer, step / steps, coast_flanks, corner), steps, coast_flanks
    )
