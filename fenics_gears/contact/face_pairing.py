"""Compliance between contact nodes over a face: a body in three dimensions, and near each contact the plane route's own
flanks (docs/third_dimension.md).

The body's mesh is too coarse for the contact. Under a load that does not vary along the face its error is that of the
same section in plane strain; the difference between a fine section and the body's own section is therefore added in
each slice. A force dF on a slice of width dz is the line load cos(beta_b) dF/dz on the line of contact, across which
the section is in plane strain.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fenics_gears.contact.compliance_product import directions
from fenics_gears.contact.face import Face
from fenics_gears.contact.face_product import Groups, OnGear, Side, face_product
from fenics_gears.contact.interpolation import FlankInterpolation
from fenics_gears.contact.operator import Passage, Response, count_of, node_slices, turned
from fenics_gears.contact.pairing import CompliancePairing, of_full_rank
from fenics_gears.contact.tooth_pair import Flanks, Place, ToothPair
from fenics_gears.elasticity.face_compliance_data import FaceCompliance
from fenics_gears.elasticity.slice_averages import on_slices, slice_averages
from fenics_gears.errors import ComputationError

GEARS = (0, 1)
# Over the slice's own width, by which all is divided in the end.
UNIT_WIDTH = 1.0


@dataclass(frozen=True)
class FacePair(ToothPair):
    """Contact nodes of a tooth pair in one slice, whose interpolation is that of the fine flanks, `coarse` that of the
    body's."""

    coarse: tuple[FlankInterpolation, FlankInterpolation]


class FacePairing:
    """Compliance between the contact nodes of tooth pairs in the slices of a face."""

    def __init__(self, flanks: Flanks, bodies: tuple[FaceCompliance, FaceCompliance], face: Face):
        self.face, self._nodes = face, tuple(len(body.roll_angle) for body in bodies)
        self.sections = Flanks(flanks.pair, (bodies[0].plane, bodies[1].plane), flanks.removal)
        self._fine, self._shares = CompliancePairing(flanks, width=UNIT_WIDTH), face.cosine / face.widths
        self._bodies = tuple(
            (
                on_slices(
                    body.blocks,
                    slice_averages(body.heights, body.element_order, face.positions - middle, face.widths),
                    body.flanks,
                ),
                np.stack([body.plane.block(offset) for offset in range(-body.plane.offsets, body.plane.offsets + 1)]),
            )
            for body, middle in zip(bodies, face.middles)
        )

    def response(self, passage: Passage) -> Response:
        """How the contact nodes of a passage yield; dependent rows have a thin layer each (`contact.pairing`)."""
        pairs: Sequence[FacePair] = passage.pairs
        previous: Sequence[FacePair] | None = passage.previous
        angles = turned(self.sections.pair, passage.advance)
        now = self._side(pairs, previous is not None)
        compliance, earlier = self._of_bodies(now, now), None
        if previous is not None:
            # The tangents as they stood before.
            tangents = Side(
                now.groups, tuple(self._on_gear(gear, pairs, now.groups, True, angles[gear]) for gear in GEARS)
            )
            # Reciprocal, so that it lies in memory by columns, as the march reads it.
            earlier = self._of_bodies(self._side(previous, True), tangents)
        dependent = self._add_fine(compliance, earlier, pairs, previous, angles)
        kinds, nodes, _ = now.shape
        return Response(
            compliance.reshape(kinds * nodes, kinds * nodes),
            None if previous is None else earlier.reshape(2 * count_of(previous), nodes).T,
            dependent,
        )

    def _of_bodies(self, rows: Side, columns: Side) -> np.ndarray:
        for (blocks, sections), own, other in zip(self._bodies, rows.gears, columns.gears):
            _check_known(min(len(blocks), len(sections)) // 2, own.teeth, other.teeth)
        return face_product(self._bodies, self._shares, rows, columns)

    def _side(self, pairs: Sequence[FacePair], tangential: bool) -> Side:
        groups = Groups.of([pair.coarse for pair in pairs])
        return Side(groups, tuple(self._on_gear(gear, pairs, groups, tangential) for gear in GEARS))

    def _on_gear(
        self, gear: int, pairs: Sequence[FacePair], groups: Groups, tangential: bool, turned: float | None = None
    ) -> OnGear:
        """The pairs' nodes on one gear: along normal and tangent, or with `turned` (rad) along the tangent as it stood
        before."""
        places = [pair.place for pair in pairs]
        teeth, flanks, slices = (
            np.array([(place.ahead(gear), place.flank, place.slice) for place in places], dtype=np.int64)
            .reshape(-1, 3)
            .T.copy()
        )
        first, nodes = groups.first[gear], self._nodes[gear]
        plane = _plane_directions(gear, places, tangential, turned)
        axes = np.concatenate([plane, np.zeros((*plane.shape[:2], 1))], axis=2)
        if turned is None:
            axes[:, 0] *= self.face.cosine
            axes[:, 0, 2] = [self.face.axial_share(gear, place.turn) for place in places]
        dofs = 3 * (nodes * (flanks * self.face.slices + slices) + first)
        plane_dofs = 2 * (nodes * flanks + first)
        return OnGear(teeth, slices, groups.widths[gear], groups.places[gear], dofs, plane_dofs, axes, plane)

    def _add_fine(self, compliance, earlier, pairs, previous, turned) -> int:
        """Add the compliance of the fine sections in each slice; returns the dependent rows."""
        now, before = _of_slices(pairs, self.face.slices), _of_slices(previous or (), self.face.slices)
        fine, dependent = None, 0
        for (nodes, own), (nodes_before, own_before), share in zip(now, before, self._shares):
            if fine is None or self.face.slope != 0.0:
                # mm per N/mm: between the slice's nodes, and by those before.
                section, by_earlier = self._fine.compliance(own, own_before if previous is not None else None, turned)
                fine, rows = of_full_rank(section)
                kinds, count = len(compliance), len(nodes)
            dependent += rows
            compliance[:, nodes[:, None], :, nodes] += share * fine.reshape(kinds, count, kinds, count).transpose(
                1, 3, 0, 2
            )
            if previous is not None:
                more = by_earlier.reshape(1, count, 2, -1).transpose(3, 1, 2, 0)
                earlier[:, nodes_before[:, None], :, nodes] += share * more
        return dependent


def _check_known(offsets: int, responding: np.ndarray, loaded: np.ndarray) -> None:
    """Raise ComputationError for teeth (P,) that are further apart than the bodies' compliance is known: compiled code
    would not notice."""
    if not len(responding) or not len(loaded):
        return
    apart = max(responding.max() - loaded.min(), loaded.max() - responding.min())
    if apart > offsets:
        raise ComputationError(
            f"compliance over the face: teeth {apart} pitches apart touch, it is known for {offsets}; ask"
            " face_compliance for a larger reach"
        )


def directions_on_face(place: Place, face: Face, gear: int, tangential: bool) -> np.ndarray:
    """Unit vectors (1 or 2, 3) of the contact normal and of the tangent, in the tooth's frame at the slice's height."""
    axes = np.pad(directions(place.contact_rolls[gear], tangential), ((0, 0), (0, 1)))
    axes[0] *= face.cosine
    axes[0, 2] = face.axial_share(gear, place.turn)
    return axes


def _plane_directions(gear: int, places: Sequence[Place], tangential: bool, turned: float | None) -> np.ndarray:
    """Unit vectors (P, d, 2) in the transverse section, in the tooth's frame; with `turned` (rad) the tangent as it
    stood before."""
    if turned is None:
        found = [directions(place.contact_rolls[gear], tangential) for place in places]
    else:
        found = [directions(place.contact_rolls[gear] - place.turn * turned, True)[1:] for place in places]
    return np.array(found).reshape(len(places), 2 if tangential and turned is None else 1, 2)


def _of_slices(pairs: Sequence[FacePair], slices: int) -> list[tuple[np.ndarray, list[FacePair]]]:
    """The contact nodes of each slice among all, and its pairs."""
    found: list[tuple[list[np.ndarray], list[FacePair]]] = [([], []) for _ in range(slices)]
    for pair, nodes in zip(pairs, node_slices(pairs)):
        numbers, own = found[pair.place.slice]
        numbers.append(np.arange(nodes.start, nodes.stop))
        own.append(pair)
    return [(np.concatenate(numbers) if numbers else np.empty(0, dtype=int), own) for numbers, own in found]
