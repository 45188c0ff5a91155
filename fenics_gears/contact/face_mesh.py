"""Contact nodes in the slices of a face: a slice is a spur mesh at another phase."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from fenics_gears.elasticity.face_compliance_data import FaceCompliance

from .face import Face
from .face_pairing import FacePair, FacePairing
from .mesh import Mesh, MeshTraits, flank_nodes
from .mesh_cycle import Cycle, Opening, PerPosition
from .operator import Position
from .places import face_places
from .tooth_pair import COAST, DRIVE, Flanks, PairNodes, Place, interpolations, node_ends, over_nodes, rolls_of
from .window import ContactGrid, coast_roll_angles, contact_roll_angles

# Gap (k,), mm along the line of action, between flanks at heights z (k,), mm, and positions (k,), mm from T1.
OverFace = Callable[[np.ndarray, np.ndarray], np.ndarray]
# Of each pair's line of contact in its slice (p,): the flank, the height (mm), where it is on the path (mm from T1) and
# how many contact nodes it has.
OnLines = tuple[np.ndarray, np.ndarray, np.ndarray, list[int]]


class LinesOfContact(dict[float, OnLines]):
    """Lines of contact at the positions of a cycle, whatever their gaps."""


def face_mesh(
    flanks: Flanks, bodies: tuple[FaceCompliance, FaceCompliance], face: Face, grid: ContactGrid, corner=None
) -> Mesh:
    """Elastic flanks in slices: compliance of the gears' three-dimensional `bodies`, and of fine plane sections near
    the contact; gaps are those of flanks that are not modified along the face."""
    pair = flanks.pair
    coast = flanks.compliance[0].flanks == 2
    pairing = FacePairing(flanks, bodies, face)

    def alike(place: Place) -> tuple[int, int, float]:
        return place.flank, place.index, face.shifts[place.slice]

    def nodes(phase: float) -> tuple[PairNodes, ...]:
        places = face_places(pair, grid, face, phase, coast, corner)
        first: dict[tuple[int, int, float], Place] = {}
        for place in places:
            # Slices of a spur pair are all alike.
            first.setdefault(alike(place), place)
        nodes_on_flanks = flank_nodes(flanks, grid, corner, list(first.values()))
        if not nodes_on_flanks:
            return ()
        there = [each.place for each in nodes_on_flanks]
        at = over_nodes(nodes_on_flanks, "offsets"), node_ends(nodes_on_flanks)
        on_bodies = interpolations(pairing.sections, grid, there, at, rolls_of(pair, there, at))
        made = {
            alike(each.place): FacePair(**vars(each), coarse=coarse) for each, coarse in zip(nodes_on_flanks, on_bodies)
        }
        return tuple(_in_slice(made[alike(place)], place) for place in places if alike(place) in made)

    return Mesh(
        pair,
        grid,
        lambda phases: [nodes(phase) for phase in phases],
        pairing.responses,
        traits=MeshTraits(divisible=True, repeats=True),
        bodies=flanks.compliance, coast_flanks=coast, corner=corner, face=face,
    )  # fmt: skip


def _in_slice(pair: FacePair, place: Place) -> FacePair:
    """The nodes of a pair in the slice of a place that is like its own."""
    if pair.place.slice == place.slice:
        return pair
    return replace(pair, place=replace(pair.place, slice=place.slice, height=place.height))


def opening_over_face(cycle: Cycle, drive: OverFace, coast: OverFace | None = None) -> Opening:
    """What lead modifications and misalignment leave between the flanks of a cycle over a face; `coast`: None for no
    gap between the coast flanks."""
    pair = cycle.pair
    face = cycle.face

    def roll(place: Place, phase: float) -> float:
        """Roll angle (rad) of the theoretical contact on the pinion, also where a tip's edge touches."""
        if place.line is None:
            return place.contact_rolls[0]
        xi = pair.path_start + (phase + place.index) * pair.base_pitch + face.shifts[place.slice]
        return (contact_roll_angles if place.flank == DRIVE else coast_roll_angles)(pair, xi)[0]

    def lines(position: Position) -> OnLines:
        pairs = position.operator.pairs
        phase = position.index / cycle.steps + cycle.mesh.ahead
        places = [each.place for each in pairs]
        flanks, heights = (np.array([getattr(place, name) for place in places]) for name in ("flank", "height"))
        along = pair.base_radii[0] * np.array([roll(place, phase) for place in places])
        return flanks, heights, along, [len(each.offsets) for each in pairs]

    lines_of = PerPosition(lines, cycle.shared(LinesOfContact))

    def opening(position: Position) -> np.ndarray:
        flanks, heights, along, counts = lines_of(position)
        gaps = np.zeros(len(flanks))
        for flank, over_face in ((DRIVE, drive), (COAST, coast)):
            if over_face is not None:
                own = flanks == flank
                gaps[own] = over_face(heights[own], along[own])
        return np.repeat(gaps, counts)

    return PerPosition(opening)
