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
from scipy import sparse

from fenics_gears.elasticity.compliance import FlankCompliance
from fenics_gears.elasticity.face_compliance_data import FaceCompliance
from fenics_gears.elasticity.slice_averages import oblique_averages, oblique_sections, slice_averages
from fenics_gears.elasticity.slice_compliance import Addition, SliceCompliance, along_normals
from fenics_gears.errors import ComputationError

from .addresses import form_rows
from .compliance_product import directions
from .face import Face
from .fine_sections import BEGIN, IN_SLICE, OF_SLICE, SECTION, SLICE, TOOTH, Fine, Side, by_nodes, stacked
from .formed_rows import FormedRows, fine_section, uncertain_slices
from .interpolation import FlankInterpolation
from .kinematics import turned
from .operator import Passage, Response
from .pairing import LAYER, SMALLEST_PIVOT, dependent_rows
from .tooth_pair import Flanks, Place, ToothPair

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
        self._flanks = bodies[0].flanks
        self.sections = Flanks(flanks.pair, (bodies[0].plane, bodies[1].plane), flanks.removal)
        first, second = flanks.compliance
        self._fine, self._shares = (stacked(first), stacked(second)), face.cosine / face.widths
        self._softest = np.array([_softest(section) for section in flanks.compliance])
        self._largest = sum(section.between(0, 0).diagonal().max() for section in flanks.compliance)
        # Slices of one width see a section alike.
        self._widths, self._kinds = np.unique(face.widths, return_inverse=True)
        self._bodies = tuple((self._on_slices(gear, body), self._plane(gear, body)) for gear, body in enumerate(bodies))

    def _rises(self, gear: int, body: FaceCompliance) -> list[float]:
        """By how much (rad/mm) the lines of contact of the body's flanks rise along the face; a coast flank's goes the
        other way along the profile."""
        own = (self.sections.pair.pinion, self.sections.pair.wheel)[gear]
        rise = (1.0, -1.0)[gear] * self.face.slope / own.base_radius
        return [rise, -rise][: body.flanks]

    def _plane(self, gear: int, body: FaceCompliance) -> np.ndarray:
        """What slices see of the body's section in plane strain (k, n, n, 4), those of one width after the other."""
        offsets = range(-body.plane.offsets, body.plane.offsets + 1)
        blocks = np.stack([body.plane.block(offset) for offset in offsets])
        size = blocks.shape[1]
        found = np.zeros((len(blocks), *2 * (size * len(self._widths),)))
        for kind, width in enumerate(self._widths):
            own = slice(size * kind, size * (kind + 1))
            found[:, own, own] = oblique_sections(blocks, body.roll_angle, self._rises(gear, body), width)
        return by_nodes(found, 2)

    def _on_slices(self, gear: int, body: FaceCompliance) -> SliceCompliance:
        face, rises = self.face, self._rises(gear, body)
        positions, additions = face.positions - face.middles[gear], list[Addition]()

        def along(heights: np.ndarray) -> list[sparse.csr_matrix]:
            return [oblique_averages(heights, positions, face.widths, body.roll_angle, rise) for rise in rises]

        if body.near is not None:
            parts = zip(along(body.near.heights), body.near.compliance, body.near.normals)
            additions += [along_normals(*part, flank * face.slices) for flank, part in enumerate(parts)]
        if body.seat is not None:
            # Imported here: few gears are cut into a shaft.
            from .face_seat import seat_motions

            weights = slice_averages(body.heights, body.element_order, positions, face.widths)
            own = (self.sections.pair.pinion, self.sections.pair.wheel)[gear]
            additions.append(seat_motions(weights, body, own, rises[0]))
        return SliceCompliance(body.blocks, along(body.heights), face.slices, additions)

    def responses(self, passages: Sequence[Passage]) -> list[Response]:
        """How the contact nodes of passages yield; dependent rows have a thin layer each (`contact.pairing`)."""
        sides = [self._side(passage.pairs, passage.previous is not None) for passage in passages]
        before = [None if each.previous is None else self._side(each.previous, True) for each in passages]
        together = [(one, now) for earlier, now in zip(before, sides) for one in (now, earlier) if one is not None]
        for gear, (body, sections) in enumerate(self._bodies):
            self._find(body, len(sections) // 2, [(one.on_gears[gear], two.on_gears[gear]) for one, two in together])
        return [self._response(*each) for each in zip(passages, sides, before)]

    def _find(self, body: SliceCompliance, sections: int, sides: list[tuple[np.ndarray, np.ndarray]]) -> None:
        """Have the body's compliance between the groups of sides, each two of which are there together."""
        offsets, teeth = len(body.values) // 2, []
        for own, other in sides:
            _check_known(min(offsets, sections), own[TOOTH], other[TOOTH])
            ahead = own[TOOTH][:, None] - other[TOOTH]
            pair = np.broadcast_arrays(ahead, own[SECTION][:, None], other[SECTION])
            teeth.append(np.unique(np.ravel_multi_index((pair[0] + offsets, *pair[1:]), body.values.shape[:3])))
        asked = np.unique(np.concatenate(teeth)) if teeth else np.empty(0, dtype=np.int64)
        ahead, own, other = np.unravel_index(asked, body.values.shape[:3])
        body.find(ahead - offsets, own, other)

    def _response(self, passage: Passage, now: Side, before: Side | None) -> Response:
        pairs: Sequence[FacePair] = passage.pairs
        angles, layers = turned(self.sections.pair, passage.advance), np.zeros(self.face.slices)
        compliance, earlier = self._rows(now, now, layers), None
        if before is not None:
            # The tangents as they stood before. Reciprocal, so that rows are those of nodes before, as the march reads
            # them.
            tangents = now._replace(axes=np.stack([self._axes(gear, pairs, True, angles[gear]) for gear in GEARS]))
            earlier = self._rows(before, tangents, np.zeros_like(layers), by_columns=True)
        if not len(pairs):
            return Response(compliance, earlier)
        dependent = self._dependent(compliance, layers)
        # Its first number is the size that others are measured by.
        form_rows(compliance.address, np.zeros(1, dtype=np.int64))
        return Response(compliance, earlier, dependent)

    def _rows(self, rows: Side, columns: Side, layers: np.ndarray, by_columns: bool = False) -> FormedRows:
        same = rows.groups[SLICE][:, None] == columns.groups[SLICE]
        for fine, own, other in zip(self._fine, rows.on_gears, columns.on_gears):
            _check_sections(fine, own[TOOTH][:, None] - other[TOOTH], (rows.flanks[:, None], columns.flanks), same)
        fine = Fine(*self._fine, self._shares, layers)
        bodies = [(body.values, sections) for body, sections in self._bodies]
        return FormedRows.of(bodies, rows, columns, fine, by_columns)

    def _side(self, pairs: Sequence[FacePair], tangential: bool) -> Side:
        """The pairs' nodes, along normal and tangent."""
        counts, places = np.array([len(pair.offsets) for pair in pairs], dtype=np.int64), [pair.place for pair in pairs]
        slices, flanks = (np.array([getattr(place, name) for place in places], np.int64) for name in ("slice", "flank"))
        begins, on_gears = np.cumsum(counts) - counts, np.empty((2, 6, len(pairs)), dtype=np.int64)
        first, near, _ = _together([pair.coarse for pair in pairs])
        for gear, count in enumerate(self._nodes):
            widths = np.array([pair.coarse[gear].near.shape[1] for pair in pairs], dtype=np.int64)
            # Groups always have nodes.
            lowest = np.minimum.reduceat(first[gear], begins) if len(pairs) else counts
            under = np.maximum.reduceat(first[gear], begins) + widths - lowest if len(pairs) else counts
            beside = np.cumsum(under) - under
            first[gear] += np.repeat(beside - lowest, counts)
            teeth = np.array([place.ahead(gear) for place in places], dtype=np.int64)
            section = flanks * self.face.slices + slices
            kinds = self._flanks * self._kinds[slices]
            on_gears[gear] = teeth, under, beside, section, lowest, count * (flanks + kinds) + lowest
        axes, group = np.stack([self._axes(gear, pairs, tangential) for gear in GEARS]), np.arange(len(pairs))
        fine = _together([pair.interpolation for pair in pairs], padded=False)
        return Side(
            np.repeat(group, counts), first, _groups(begins, counts, slices), on_gears, near, axes, flanks, fine[0],
            fine[1], *fine[2],
        )  # fmt: skip

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

    def _dependent(self, compliance: FormedRows, layers: np.ndarray) -> int:
        """Dependent rows of all slices; sections that have some get a thin layer."""
        # Of weights that are never more than twice one together.
        least = MARGIN * SMALLEST_PIVOT * 4.0 * self._largest
        dependent, known = 0, {}
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
# not; where that is so, nodes are looked at by a margin for how flanks that touch together differ from one alone.
SOFTEST, MARGIN = 1e-3, 1e3


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


def _together(views: Sequence[tuple[FlankInterpolation, FlankInterpolation]], padded: bool = True):
    """How all nodes see both gears: the first flank node (2, n); weights (2, n, w) with zeros behind the narrower ones,
    or those of one group after the other; and where these begin and how many there are for a node (2, P)."""
    widths = np.array([[view[gear].near.shape[1] for view in views] for gear in GEARS], dtype=np.int64)
    sizes = np.array([[view[gear].near.size for view in views] for gear in GEARS], dtype=np.int64)
    first = np.array([_joined([view[gear].first for view in views], np.int64) for gear in GEARS])
    begins, flat = (
        (np.cumsum(sizes) - sizes.ravel()).reshape(2, -1),
        [_joined([view[gear].near.ravel() for view in views], float) for gear in GEARS],
    )
    if not padded:
        return first, np.concatenate(flat), (begins, widths)
    near = np.zeros((2, first.shape[1], widths.max(initial=1)))
    for gear in GEARS:
        there = np.arange(near.shape[2]) < np.repeat(widths[gear], sizes[gear] // widths[gear])[:, None]
        near[gear][there] = flat[gear]
    return first, near, (begins, widths)


def _joined(arrays: Sequence[np.ndarray], kind) -> np.ndarray:
    return np.concatenate([np.empty(0, kind), *arrays]).astype(kind, copy=False)


def _groups(begins: np.ndarray, counts: np.ndarray, slices: np.ndarray) -> np.ndarray:
    """Of groups of so many nodes that begin there among all: numbers (4, P) as of `fine_sections.Side`."""
    found = np.zeros((4, len(begins)), dtype=np.int64)
    found[BEGIN], found[SLICE] = begins, slices
    in_slice = np.zeros(slices.max(initial=-1) + 1, dtype=np.int64)
    for group, (number, count) in enumerate(zip(slices.tolist(), counts.tolist())):
        found[IN_SLICE, group] = in_slice[number]
        in_slice[number] += count
    found[OF_SLICE] = in_slice[slices]
    return found


def _check_sections(fine: np.ndarray, ahead: np.ndarray, flanks: tuple[np.ndarray, np.ndarray], same: np.ndarray):
    """Raise ComputationError where the sections' compliance is not known between teeth (P, Q) `ahead` that touch in the
    same slice."""
    reach, (flank, other) = len(fine) // 2, np.broadcast_arrays(*flanks)
    known = ~np.isnan(fine[:, :, :, 0, 0, 0])
    near = np.clip(ahead[same], -reach, reach)
    if np.any(near != ahead[same]) or not known[reach + near, flank[same], other[same]].all():
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


def directions_on_face(place: Place, face: Face, gear: int, tangential: bool) -> np.ndarray:
    """Unit vectors (1 or 2, 3) of the contact normal and of the tangent, in the tooth's frame at the slice's height."""
    axes = np.pad(directions(place.contact_rolls[gear], tangential), ((0, 0), (0, 1)))
    axes[0] *= face.cosine
    axes[0, 2] = face.axial_share(gear, place.turn)
    return axes


def _plane_directions(gear: int, places: Sequence[Place], tangential: bool, turned: float | None) -> np.ndarray:
    """Unit vectors (P, d, 2) in the transverse section, in the tooth's frame; with `turned` (rad) the tangent as it
    stood before."""
    rolls = np.array([place.contact_rolls[gear] for place in places])
    if turned is not None:
        rolls = rolls - np.array([place.turn for place in places]) * turned
    cosine, sine = np.cos(rolls), np.sin(rolls)
    normal, tangent = np.stack([cosine, -sine], axis=1), np.stack([sine, cosine], axis=1)
    kinds = [tangent] if turned is not None else [normal, tangent] if tangential else [normal]
    return np.stack(kinds, axis=1)
