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
from fenics_gears.contact.fine_sections import OnSections, fine_sections, stacked
from fenics_gears.contact.formed_rows import (
    BEGIN,
    DOF,
    IN_SLICE,
    OF_SLICE,
    PLACE,
    PLANE_DOF,
    SECTION,
    SLICE,
    TOOTH,
    WIDTH,
    Fine,
    FormedRows,
    Side,
    form_rows,
)
from fenics_gears.contact.interpolation import FlankInterpolation
from fenics_gears.contact.operator import Passage, Response, count_of, node_slices, per_node, turned
from fenics_gears.contact.pairing import of_full_rank
from fenics_gears.contact.tooth_pair import Flanks, Place, ToothPair
from fenics_gears.elasticity.face_compliance_data import FaceCompliance
from fenics_gears.elasticity.slice_averages import on_slices, slice_averages
from fenics_gears.errors import ComputationError

GEARS = (0, 1)


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
        self._fine, self._shares = tuple(map(stacked, flanks.compliance)), face.cosine / face.widths
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
        before = None if previous is None else self._side(previous, True)
        fine, fine_before, dependent = self._fine_sections(now, pairs, before, previous, angles)
        compliance, earlier = self._rows(now, now, fine), None
        if before is not None:
            # The tangents as they stood before. Reciprocal, so that rows are those of nodes before, as the march reads
            # them.
            tangents = now._replace(axes=np.stack([self._axes(gear, pairs, True, angles[gear]) for gear in GEARS]))
            earlier = self._rows(before, tangents, fine_before, by_columns=True)
        if len(pairs):
            # Its first number is the size that others are measured by.
            form_rows(compliance.address, np.zeros(1, dtype=np.int64))
        return Response(compliance, earlier, dependent)

    def _rows(self, rows: Side, columns: Side, fine: Fine, by_columns: bool = False) -> FormedRows:
        for (blocks, sections), own, other in zip(self._bodies, rows.on_gears, columns.on_gears):
            _check_known(min(len(blocks), len(sections)) // 2, own[TOOTH], other[TOOTH])
        return FormedRows.of(self._bodies, rows, columns, fine, by_columns)

    def _side(self, pairs: Sequence[FacePair], tangential: bool) -> Side:
        """The pairs' nodes, along normal and tangent."""
        nodes, places = node_slices(pairs), [pair.place for pair in pairs]
        views = np.array([pair.coarse for pair in pairs], dtype=object).reshape(-1, 2).T
        first, near = np.empty((2, count_of(pairs)), dtype=np.int64), _widest(views, count_of(pairs))
        on_gears = np.empty((2, 6, len(pairs)), dtype=np.int64)
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
            on_gears[gear, SECTION], on_gears[gear, DOF] = flanks * self.face.slices + slices, 3 * lowest
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

    def _fine_sections(self, now: Side, pairs, before: Side | None, previous, turned) -> tuple[Fine, Fine, int]:
        """Compliance of the fine sections in each slice, between the nodes now and by those before; the dependent
        rows."""
        axes, kinds = now.axes[..., 3:], now.axes.shape[2]
        if before is not None:
            earlier = [_plane_directions(gear, [pair.place for pair in pairs], True, turned[gear]) for gear in GEARS]
            axes = np.concatenate([axes, earlier], axis=2)
        nodes = _on_sections(now, pairs, axes)
        nodes_before = (
            _on_sections(now, (), axes[:, :0])
            if before is None
            else _on_sections(before, previous, before.axes[..., 3:])
        )
        counts, counts_before = (_in_slices(each.groups, self.face.slices) for each in (nodes, nodes_before))
        begins, size = self._places((kinds * counts) ** 2)
        begins_before, size_before = self._places(2 * counts * counts_before)
        fine, by_earlier = (
            Fine(np.zeros(each), np.maximum(at, 0), self._shares)
            for each, at in ((size, begins), (size_before, begins_before))
        )
        fine_sections(self._fine, nodes, nodes_before, begins, begins_before, fine.numbers, by_earlier.numbers)
        return fine, by_earlier, self._dependent(fine, begins, kinds * counts)

    def _places(self, sizes: np.ndarray) -> tuple[np.ndarray, int]:
        """Where sections (S,) begin that take so many numbers, and the end of the last. Slices of a spur pair are all
        alike: -1 but for the first."""
        if self.face.slope == 0.0:
            return np.where(np.arange(len(sizes)) == 0, 0, -1), int(sizes[0])
        return np.cumsum(sizes) - sizes, int(sizes.sum())

    def _dependent(self, fine: Fine, begins: np.ndarray, rows: np.ndarray) -> int:
        """Dependent rows of all slices; sections that have some get a thin layer."""
        if np.isnan(fine.numbers.sum()):
            raise ComputationError(
                "compliance over the face: flanks touch that are further apart than the sections' compliance is known;"
                " ask flank_compliance for a larger reach"
            )
        found = dependent = 0
        for begin, count in zip(begins, rows):
            if begin >= 0:
                section = fine.numbers[begin : begin + count**2].reshape(count, count)
                section[:], dependent = of_full_rank(section)
            found += dependent
        return found


def _on_sections(side: Side, pairs: Sequence[FacePair], axes: np.ndarray) -> OnSections:
    places = [pair.place for pair in pairs]
    flanks = np.array([place.flank for place in places], dtype=np.int64)
    groups, teeth = side.groups[:, : len(pairs)], side.on_gears[:, TOOTH, : len(pairs)]
    return OnSections.of(
        groups, flanks, np.ascontiguousarray(teeth), np.ascontiguousarray(axes), [pair.interpolation for pair in pairs]
    )


def _in_slices(groups: np.ndarray, slices: int) -> np.ndarray:
    """Number of contact nodes in each slice (S,)."""
    found = np.zeros(slices, dtype=np.int64)
    found[groups[SLICE]] = groups[OF_SLICE]
    return found


def _widest(views: np.ndarray, nodes: int) -> np.ndarray:
    """Room for the weights (2, nodes, w) of all `views` (2, P)."""
    return np.zeros((2, nodes, max((view.near.shape[1] for view in views.flat), default=1)))


def _groups(nodes: Sequence[slice], slices: np.ndarray) -> np.ndarray:
    """Of groups whose `nodes` stand there among all: numbers (4, P) as of `formed_rows.Side`."""
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
