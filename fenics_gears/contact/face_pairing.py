"""Compliance between contact nodes over a face: a body in three dimensions, and near each contact the plane route's own
flanks (docs/third_dimension.md).

The body's mesh is too coarse for the contact. Under a load that does not vary along the face its error is that of the
same section in plane strain. Therefore the difference between a fine section and the body's own section is added in
each slice. A force dF on a slice of width dz is the line load cos(beta_b) dF/dz on the line of contact, across which
the section is in plane strain.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy import sparse

from fenics_gears.elasticity.compliance import FlankCompliance
from fenics_gears.elasticity.face_compliance_data import FaceCompliance
from fenics_gears.elasticity.slice_averages import oblique_averages, oblique_sections, slice_averages
from fenics_gears.elasticity.slice_compliance import Addition, SliceCompliance, along_normals
from fenics_gears.errors import ComputationError
from fenics_gears.geometry.side import Side

from .addresses import form_rows
from .between_flank_nodes import Between, between_flank_nodes
from .closed_compliance import functions
from .compliance_product import directions
from .face import Face
from .face_ends import ends_of
from .face_seat import seat_motions
from .fine_sections import SECTION, SLICE, TOOTH, Fine, SectionNodes, by_nodes, groups_of, stacked, together
from .formed_rows import FormedRows, fine_section, uncertain_slices
from .interpolation import FlankInterpolation
from .operator import Passage, Response
from .pairing import LAYER, SMALLEST_PIVOT, dependent_rows
from .tooth_pair import Flanks, Place, ToothPair


@dataclass(frozen=True)
class FacePair(ToothPair):
    """Contact nodes of a tooth pair in one slice, with the interpolation of fine flanks and `coarse` ones of bodies."""

    coarse: tuple[FlankInterpolation, FlankInterpolation]


class FacePairing:
    """Compliance between the contact nodes of tooth pairs in the slices of a face."""

    def __init__(self, flanks: Flanks, bodies: tuple[FaceCompliance, FaceCompliance], face: Face):
        self.face = face
        self._nodes = tuple(len(body.roll_angle) for body in bodies)
        self._flanks = bodies[0].flanks
        self.sections = Flanks(flanks.pair, tuple(body.plane for body in bodies), flanks.removal)
        self._sides = flanks.pair.sides
        first, second = flanks.compliance
        self._fine = stacked(first), stacked(second)
        self._shares = face.cosine / face.widths
        self._softest = np.array([_softest(section) for section in flanks.compliance])
        self._largest = sum(section.between(0, 0).diagonal().max() for section in flanks.compliance)
        # The averages of a section are alike in slices of one width.
        self._widths, self._kinds = np.unique(face.widths, return_inverse=True)
        self._ends = ends_of(self.face, bodies)
        self._bodies = tuple((self._on_slices(*each), self._plane(*each)) for each in zip(self._sides, bodies))

    def _plane(self, side: Side, body: FaceCompliance) -> np.ndarray:
        """Averages over slices of the body's section in plane strain (k, n, n, 4), for one width after the other."""
        offsets = range(-body.plane.offsets, body.plane.offsets + 1)
        blocks = np.stack([body.plane.block(offset) for offset in offsets])
        size = blocks.shape[1]
        rises = rises_of(self.face, side)[: body.flanks]
        found = np.zeros((len(blocks), *2 * (size * len(self._widths),)))
        for kind, width in enumerate(self._widths):
            own = slice(size * kind, size * (kind + 1))
            found[:, own, own] = oblique_sections(blocks, body.roll_angle, rises, width)
        return by_nodes(found, 2)

    def _on_slices(self, side: Side, body: FaceCompliance) -> SliceCompliance:
        face = self.face
        rises = rises_of(self.face, side)[: body.flanks]
        positions = face.positions - face.middles[side.number]
        additions: list[Addition] = []

        def along(heights: np.ndarray) -> list[sparse.csr_matrix]:
            return [oblique_averages(heights, positions, face.widths, body.roll_angle, rise) for rise in rises]

        if body.near is not None:
            parts = zip(along(body.near.heights), body.near.compliance, body.near.normals)
            additions += [along_normals(*part, flank * face.slices) for flank, part in enumerate(parts)]
        if body.seat is not None:
            weights = slice_averages(body.heights, body.element_order, positions, face.widths)
            additions.append(seat_motions(weights, body, side.gear, rises[0]))
        return SliceCompliance(body.blocks, along(body.heights), face.slices, additions)

    def responses(self, passages: Sequence[Passage]) -> list[Response]:
        """How the contact nodes of passages yield; dependent rows have a thin layer each (`contact.pairing`)."""
        now = [self._nodes_of(passage.pairs, passage.previous is not None) for passage in passages]
        before = [None if each.previous is None else self._nodes_of(each.previous, True) for each in passages]
        together = [(one, own) for earlier, own in zip(before, now) for one in (own, earlier) if one is not None]
        for gear, (body, sections) in enumerate(self._bodies):
            self._find(body, len(sections) // 2, [(one.on_gears[gear], two.on_gears[gear]) for one, two in together])
        between: list[Between | None] = [None] * len(passages)
        if passages and passages[0].previous is None:
            parts = enumerate(self._bodies)
            matrices = zip(*(between_flank_nodes(*body, self._shares, now, gear) for gear, body in parts))
            between = [Between(own, functions()) for own in matrices]
        return [self._response(*each) for each in zip(passages, now, before, between)]

    def _find(self, body: SliceCompliance, sections: int, sides: list[tuple[np.ndarray, np.ndarray]]) -> None:
        """Have the body's compliance between the groups of sides, each two of which are there together."""
        offsets = len(body.values) // 2
        teeth = []
        for own, other in sides:
            _check_known(min(offsets, sections), own[TOOTH], other[TOOTH])
            apart = own[TOOTH][:, None] - other[TOOTH]
            pair = np.broadcast_arrays(apart, own[SECTION][:, None], other[SECTION])
            teeth.append(np.unique(np.ravel_multi_index((pair[0] + offsets, *pair[1:]), body.values.shape[:3])))
        asked = np.unique(np.concatenate(teeth)) if teeth else np.empty(0, dtype=np.int64)
        apart, own, other = np.unravel_index(asked, body.values.shape[:3])
        body.find(apart - offsets, own, other)

    def _response(
        self, passage: Passage, now: SectionNodes, before: SectionNodes | None, between: Between | None
    ) -> Response:
        pairs: Sequence[FacePair] = passage.pairs
        layers = np.zeros(self.face.slices)
        compliance = self._rows(now, now, layers, self._ends, between=between)
        earlier = None
        if before is not None:
            # The tangents as they were before. Reciprocal, so that rows are those of nodes before, as the march reads
            # them.
            turned = [contact_axes(self.face, side, pairs, True, side.turn * passage.advance) for side in self._sides]
            tangents = now._replace(axes=np.stack(turned))
            earlier = self._rows(before, tangents, np.zeros_like(layers), self._ends[:, :, :0], by_columns=True)
        if not len(pairs):
            return Response(compliance, earlier)
        dependent = self._dependent(compliance, layers)
        # Its first number is the size that others are measured by.
        form_rows(compliance.address, np.zeros(1, dtype=np.int64))
        return Response(compliance, earlier, dependent)

    def _rows(
        self,
        rows: SectionNodes,
        columns: SectionNodes,
        layers: np.ndarray,
        ends: np.ndarray,
        by_columns: bool = False,
        between: Between | None = None,
    ) -> FormedRows:
        same = rows.groups[SLICE][:, None] == columns.groups[SLICE]
        for fine, own, other in zip(self._fine, rows.on_gears, columns.on_gears):
            _check_sections(fine, own[TOOTH][:, None] - other[TOOTH], (rows.flanks[:, None], columns.flanks), same)
        bodies = [(body.values, sections) for body, sections in self._bodies]
        return FormedRows.of(bodies, rows, columns, Fine(*self._fine, self._shares, layers, ends), by_columns, between)

    def _nodes_of(self, pairs: Sequence[FacePair], tangential: bool) -> SectionNodes:
        """The pairs' nodes, along normal and tangent."""
        counts = np.array([len(pair.offsets) for pair in pairs], dtype=np.int64)
        places = [pair.place for pair in pairs]
        slices, flanks = (np.array([getattr(each, name) for each in places], np.int64) for name in ("slice", "flank"))
        begins = np.cumsum(counts) - counts
        on_gears = np.empty((2, 6, len(pairs)), dtype=np.int64)
        first, near, _ = together([pair.coarse for pair in pairs])
        for gear, count in enumerate(self._nodes):
            widths = np.array([pair.coarse[gear].near.shape[1] for pair in pairs], dtype=np.int64)
            # Groups always have nodes.
            lowest = np.minimum.reduceat(first[gear], begins) if len(pairs) else counts
            under = np.maximum.reduceat(first[gear], begins) + widths - lowest if len(pairs) else counts
            section = flanks * self.face.slices + slices
            # One section's after the other's, as they are read (`contact.between_flank_nodes`).
            order = np.argsort(section, kind="stable")
            place = np.empty_like(under)
            place[order] = np.cumsum(under[order]) - under[order]
            first[gear] += np.repeat(place - lowest, counts)
            teeth = [each.teeth[gear] for each in places]
            plane_node = count * (flanks + self._flanks * self._kinds[slices]) + lowest
            on_gears[gear] = teeth, under, place, section, lowest, plane_node
        axes = np.stack([contact_axes(self.face, side, pairs, tangential) for side in self._sides])
        fine = together([pair.interpolation for pair in pairs], padded=False)
        offsets = np.concatenate([np.empty(0), *(pair.offsets for pair in pairs)])
        return SectionNodes(
            np.repeat(np.arange(len(pairs)), counts), offsets, first, groups_of(begins, counts, slices), on_gears, near,
            axes, flanks, *fine[:2], *fine[2],
        )  # fmt: skip

    def _dependent(self, compliance: FormedRows, layers: np.ndarray) -> int:
        """Dependent rows of all slices; sections that have some get a thin layer."""
        # Of weights that are never more than twice one together.
        least = MARGIN * SMALLEST_PIVOT * 4.0 * self._largest
        dependent = 0
        known = {}
        for number in np.flatnonzero(uncertain_slices(compliance.address, self._softest, least)).tolist():
            # Slices of a spur pair are all alike.
            shift = self.face.shifts[number]
            if shift not in known:
                section = fine_section(compliance.address, number)
                section = section.reshape(2 * [section.shape[0] * section.shape[1]]) / self._shares[number]
                found = dependent_rows(section)
                known[shift] = found, LAYER * section.diagonal().max() if found else 0.0
            found, layers[number] = known[shift]
            dependent += found
        return dependent


# A section is taken to have no smaller eigenvalue than this part of its largest entry, if its flanks by themselves have
# not.
SOFTEST = 1e-3
# Where that is so, a margin for how flanks that touch together differ from one alone.
MARGIN = 1e3


def _softest(section: FlankCompliance) -> float:
    """A compliance, mm per N/mm, below which the eigenvalues of a section surely are not; 0 where there is none."""
    flanks = [section.between(0, 0, (side, side)) for side in range(section.flanks)]
    least = SOFTEST * max(flank.diagonal().max() for flank in flanks)
    try:
        for flank in flanks:
            np.linalg.cholesky(flank - least * np.eye(len(flank)))
    except np.linalg.LinAlgError:
        return 0.0
    return least


def _check_sections(fine: np.ndarray, apart: np.ndarray, flanks: tuple[np.ndarray, np.ndarray], same: np.ndarray):
    """Raise ComputationError where the sections' compliance is not known between teeth so far `apart` (P, Q) that touch
    in the same slice."""
    reach = len(fine) // 2
    flank, other = np.broadcast_arrays(*flanks)
    known = ~np.isnan(fine[:, :, :, 0, 0, 0])
    near = np.clip(apart[same], -reach, reach)
    if np.any(near != apart[same]) or not known[reach + near, flank[same], other[same]].all():
        raise ComputationError(
            "compliance over the face: flanks touch that are further apart than the sections' compliance is known;"
            " ask flank_compliance for a larger reach"
        )


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


def rises_of(face: Face, side: Side) -> list[float]:
    """By how much (rad/mm) the lines of contact of drive and coast flanks of a gear rise along the face; a coast
    flank's goes the other way along the profile."""
    rise = side.sense * face.slope / side.gear.base_radius
    return [rise, -rise]


def contact_axes(
    face: Face, side: Side, pairs: Sequence[ToothPair], tangential: bool, turned: float | None = None
) -> np.ndarray:
    """Directions (P, d, 5) of contact in the tooth's frame, in the body and in its section: of normal and tangent, or
    with `turned` (rad) of the tangent as it was before."""
    places = [pair.place for pair in pairs]
    plane = _plane_directions(side.number, places, tangential, turned)
    axes = np.concatenate([plane, np.zeros((*plane.shape[:2], 1)), plane], axis=2)
    if turned is None:
        axes[:, 0, :2] *= face.cosine
        axes[:, 0, 2] = [face.axial_share(side, place.turn) for place in places]
    return axes


def _plane_directions(gear: int, places: Sequence[Place], tangential: bool, turned: float | None) -> np.ndarray:
    """Unit vectors (P, d, 2) in the transverse section, in the tooth's frame; with `turned` (rad) the tangent as it
    was before."""
    rolls = np.array([place.contact_rolls[gear] for place in places])
    if turned is not None:
        rolls = rolls - np.array([place.turn for place in places]) * turned
    axes = directions(rolls, tangential)
    return axes if turned is None else axes[:, 1:]
