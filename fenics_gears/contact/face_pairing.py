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
from fenics_gears.contact.face_product import (
    BEGIN,
    DOF,
    IN_SLICE,
    OF_SLICE,
    PLACE,
    PLANE_DOF,
    SLICE,
    TOOTH,
    WIDTH,
    FaceRows,
    Fine,
    Side,
    form_rows,
)
from fenics_gears.contact.interpolation import FlankInterpolation
from fenics_gears.contact.operator import Passage, Response, count_of, node_slices, per_node, turned
from fenics_gears.contact.pairing import CompliancePairing
from fenics_gears.contact.rank import of_full_rank
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
        """How the contact nodes of a passage yield; dependent rows have a thin layer each (`contact.rank`)."""
        pairs: Sequence[FacePair] = passage.pairs
        previous: Sequence[FacePair] | None = passage.previous
        angles = turned(self.sections.pair, passage.advance)
        now = self._side(pairs, previous is not None)
        fine, fine_before, dependent = self._fine_sections(pairs, previous, angles)
        compliance, earlier = self._rows(now, now, fine), None
        if previous is not None:
            # The tangents as they stood before. Reciprocal, so that rows are those of nodes before, as the march reads
            # them.
            tangents = now._replace(axes=np.stack([self._axes(gear, pairs, True, angles[gear]) for gear in GEARS]))
            earlier = self._rows(self._side(previous, True), tangents, fine_before, by_columns=True)
        if len(pairs):
            # Its first number is the size that others are measured by.
            form_rows(compliance.address, np.zeros(1, dtype=np.int64))
        return Response(compliance, earlier, dependent)

    def _rows(self, rows: Side, columns: Side, fine: Fine, by_columns: bool = False) -> FaceRows:
        for (blocks, sections), own, other in zip(self._bodies, rows.on_gears, columns.on_gears):
            _check_known(min(len(blocks), len(sections)) // 2, own[TOOTH], other[TOOTH])
        return FaceRows.of(self._bodies, rows, columns, fine, by_columns)

    def _side(self, pairs: Sequence[FacePair], tangential: bool) -> Side:
        """The pairs' nodes, along normal and tangent."""
        nodes, places = node_slices(pairs), [pair.place for pair in pairs]
        views = np.array([pair.coarse for pair in pairs], dtype=object).reshape(-1, 2).T
        first, near = np.empty((2, count_of(pairs)), dtype=np.int64), _widest(views, count_of(pairs))
        on_gears = np.empty((2, 5, len(pairs)), dtype=np.int64)
        slices = np.array([place.slice for place in places], dtype=np.int64)
        flanks = np.array([place.flank for place in places], dtype=np.int64)
        for gear, count in enumerate(self._nodes):
            lowest, under = np.empty(len(pairs), dtype=np.int64), 0
            for group, (view, own) in enumerate(zip(views[gear], nodes)):
                width, lowest[group] = view.near.shape[1], view.first.min()
                first[gear, own], near[gear, own, :width] = under + view.first - lowest[group], view.near
                on_gears[gear, PLACE, group], last = under, view.first.max() + width
                on_gears[gear, WIDTH, group] = last - lowest[group]
                under += last - lowest[group]
            on_gears[gear, TOOTH] = [place.ahead(gear) for place in places]
            on_gears[gear, DOF] = 3 * (count * (flanks * self.face.slices + slices) + lowest)
            on_gears[gear, PLANE_DOF] = 2 * (count * flanks + lowest)
        axes = np.stack([self._axes(gear, pairs, tangential) for gear in GEARS])
        return Side(per_node(pairs, np.arange(len(pairs))), first, _groups(nodes, slices), on_gears, near, axes)

    def _axes(self, gear: int, pairs: Sequence[FacePair], tangential: bool, turned: float | None = None) -> np.ndarray:
        """Directions (P, d, 5) of contact in the tooth's frame, in the body and in its section: of normal and tangent,
        or with `turned` (rad) of the tangent as it stood before."""
        places = [pair.place for pair in pairs]
        plane = _plane_directions(gear, places, tangential, turned)
        axes = np.concatenate([plane, np.zeros((*plane.shape[:2], 1)), plane], axis=2)
        if turned is None:
            axes[:, 0, :2] *= self.face.cosine
            axes[:, 0, 2] = [self.face.axial_share(gear, place.turn) for place in places]
        return axes

    def _fine_sections(self, pairs, previous, turned) -> tuple[Fine, Fine, int]:
        """Compliance of the fine sections in each slice, between the nodes now and by those before; the dependent
        rows."""
        now, before = _of_slices(pairs, self.face.slices), _of_slices(previous or (), self.face.slices)
        between: list[np.ndarray] = []
        by_earlier: list[np.ndarray] = []
        dependent = 0
        for own, own_before in zip(now, before):
            if not between or self.face.slope != 0.0:
                section, earlier = self._fine.compliance(own, own_before if previous is not None else None, turned)
                full, rows = of_full_rank(section)
                between.append(full)
                by_earlier.append(np.empty(0) if earlier is None else earlier.T)
            dependent += rows
        return self._in_slices(between), self._in_slices(by_earlier), dependent

    def _in_slices(self, sections: list[np.ndarray]) -> Fine:
        begins = np.cumsum([0, *(section.size for section in sections)], dtype=np.int64)[:-1]
        # Slices of a spur pair are all alike.
        begins = np.resize(begins, self.face.slices)
        return Fine(np.concatenate([section.ravel() for section in sections]), begins, self._shares)


def _widest(views: np.ndarray, nodes: int) -> np.ndarray:
    """Room for the weights (2, nodes, w) of all `views` (2, P)."""
    return np.zeros((2, nodes, max((view.near.shape[1] for view in views.flat), default=1)))


def _groups(nodes: Sequence[slice], slices: np.ndarray) -> np.ndarray:
    """Of groups whose `nodes` stand there among all: numbers (4, P) as of `face_product.Side`."""
    found = np.zeros((4, len(nodes)), dtype=np.int64)
    found[BEGIN], found[SLICE] = [own.start for own in nodes], slices
    in_slice = np.zeros(slices.max(initial=-1) + 1, dtype=np.int64)
    for group, own in enumerate(nodes):
        found[IN_SLICE, group] = in_slice[slices[group]]
        in_slice[slices[group]] += own.stop - own.start
    found[OF_SLICE] = in_slice[slices]
    return found


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


def _of_slices(pairs: Sequence[FacePair], slices: int) -> list[list[FacePair]]:
    """The pairs of each slice."""
    found: list[list[FacePair]] = [[] for _ in range(slices)]
    for pair in pairs:
        found[pair.place.slice].append(pair)
    return found
