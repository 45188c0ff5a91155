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
from fenics_gears.contact.face_product import Seen, Views, add_between_seen, at_contact_nodes, seen_by
from fenics_gears.contact.interpolation import FlankInterpolation
from fenics_gears.contact.operator import CompliancePairing, node_slices
from fenics_gears.contact.rank import of_full_rank
from fenics_gears.contact.tooth_pair import Flanks, Place, ToothPair
from fenics_gears.elasticity.face_compliance_data import FaceCompliance
from fenics_gears.elasticity.slice_averages import on_slices, slice_averages
from fenics_gears.errors import ComputationError

# Over the slice's own width, by which all is divided in the end.
UNIT_WIDTH = 1.0


@dataclass(frozen=True)
class FacePair(ToothPair):
    """Contact nodes of a tooth pair in one slice, that see the fine flanks by `interpolation` and the body's by
    `coarse`."""

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

    def compliance(
        self, pairs: Sequence[FacePair], previous: Sequence[FacePair] | None, turned: tuple[float, float]
    ) -> tuple[np.ndarray, np.ndarray | None, int]:
        """C (m, m) and E (n, m before), mm/N, as of `CompliancePairing.compliance`; and the dependent rows, which have
        a thin layer each (`contact.rank`)."""
        kinds, seen = 1 if previous is None else 2, seen_by([pair.coarse for pair in pairs])
        now = [self._views(gear, pairs, seen, kinds == 2) for gear in range(2)]
        compliance, earlier = self._seen_compliance(now, seen, now, seen, symmetric=True), None
        if previous is not None:
            seen_before = seen_by([pair.coarse for pair in previous])
            before = [self._views(gear, previous, seen_before, True) for gear in range(2)]
            earlier_tangents = [self._views(gear, pairs, seen, True, turned[gear]) for gear in range(2)]
            # Reciprocal, so that it lies in memory by columns, as the march reads it.
            earlier = self._seen_compliance(before, seen_before, earlier_tangents, seen)
        dependent = self._add_fine(compliance, earlier, pairs, previous, turned)
        rows = kinds * _count(pairs)
        return (
            compliance.reshape(rows, rows),
            None if previous is None else earlier.reshape(2 * _count(previous), _count(pairs)).T,
            dependent,
        )

    def _seen_compliance(
        self, rows: list[Views], seen: Seen, columns: list[Views], seen_by_columns: Seen, symmetric: bool = False
    ) -> np.ndarray:
        """Between contact nodes (d, n, e, m), mm/N: of the bodies, less what their plane sections give in each
        slice."""
        kinds, others = rows[0].axes.shape[1], columns[0].axes.shape[1]
        sizes = (groups.seen[-1].stop if groups.seen else 0 for groups in (seen, seen_by_columns))
        between = np.zeros((kinds, next(sizes), others, next(sizes)))
        for (blocks, sections), own, other in zip(self._bodies, rows, columns):
            _check_known(min(len(blocks), len(sections)) // 2, own.teeth, other.teeth)
            add_between_seen(blocks, sections, self._shares, own, other, symmetric, between)
        return at_contact_nodes(between, seen, seen_by_columns, symmetric)

    def _views(
        self, gear: int, pairs: Sequence[FacePair], seen: Seen, tangential: bool, turned: float | None = None
    ) -> Views:
        """How the pairs' nodes see one gear's body: along normal and tangent, or with `turned` (rad) along the tangent
        as it stood before."""
        places = [pair.place for pair in pairs]
        teeth, flanks, slices = (
            np.array([(place.ahead(gear), place.flank, place.slice) for place in places], dtype=np.int64)
            .reshape(-1, 3)
            .T.copy()
        )
        first, nodes = seen.firsts[gear], self._nodes[gear]
        plane = _plane_directions(gear, places, tangential, turned)
        axes = np.concatenate([plane, np.zeros((*plane.shape[:2], 1))], axis=2)
        if turned is None:
            axes[:, 0] *= self.face.cosine
            axes[:, 0, 2] = [self.face.axial_share(gear, place.turn) for place in places]
        dofs = 3 * (nodes * (flanks * self.face.slices + slices) + first)
        return Views(
            teeth, slices, seen.widths[gear], seen.places[gear], dofs, 2 * (nodes * flanks + first), axes, plane
        )

    def _add_fine(self, compliance, earlier, pairs, previous, turned) -> int:
        """Add the compliance of the fine sections in each slice; returns the dependent rows."""
        now, before = _of_slices(pairs, self.face.slices), _of_slices(previous or (), self.face.slices)
        known, dependent = None, 0
        for (nodes, own), (nodes_before, own_before), share in zip(now, before, self._shares):
            if known is None or self.face.slope != 0.0:
                known = self._fine_section(own, own_before if previous is not None else None, turned)
            more, more_before, rows = known
            compliance[:, nodes[:, None], :, nodes] += share * more.transpose(1, 3, 0, 2)
            if previous is not None:
                earlier[:, nodes_before[:, None], :, nodes] += share * more_before.transpose(3, 1, 2, 0)
            dependent += rows
        return dependent

    def _fine_section(self, pairs, previous, turned) -> tuple[np.ndarray, np.ndarray | None, int]:
        """Of one slice, mm per N/mm: between its nodes (d, n, d, n), by those before (1, n, 2, before), and its
        dependent rows."""
        count, kinds = _count(pairs), 1 if previous is None else 2
        fine, before = self._fine.compliance(pairs, previous, turned)
        fine, dependent = of_full_rank(fine)
        return (
            fine.reshape(kinds, count, kinds, count),
            None if before is None else before.reshape(1, count, 2, -1),
            dependent,
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


def _count(pairs: Sequence[ToothPair]) -> int:
    return sum(len(pair.offsets) for pair in pairs)
