"""Compliance between contact nodes over a face: a body in three dimensions, and near each contact the plane route's own flanks (docs/third_dimension.md).

The body's mesh is too coarse for the contact. Under a load that does not vary along the face it errs as the same section does in plane strain;
what a fine section gives more than the body's own section is therefore added in each slice. A force dF on a slice of width dz is the line load
cos(beta_b) dF/dz on the line of contact, across which the section is in plane strain.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from fenics_gears.contact.compliance_product import directions
from fenics_gears.contact.face import Face
from fenics_gears.contact.face_product import Views, face_product, views
from fenics_gears.contact.interpolation import FlankInterpolation
from fenics_gears.contact.operator import CompliancePairing, node_slices
from fenics_gears.contact.rank import LAYER, dependent_rows
from fenics_gears.contact.tooth_pair import Flanks, Place, ToothPair
from fenics_gears.elasticity.face_compliance_data import FaceCompliance
from fenics_gears.elasticity.slice_averages import on_slices, slice_averages

# Over the slice's own width, by which all is divided in the end.
UNIT_WIDTH = (1.0, 1.0)


@dataclass(frozen=True)
class FacePair(ToothPair):
    """Contact nodes of a tooth pair in one slice, that see the fine flanks by `interpolation` and the body's by `coarse`."""

    coarse: tuple[FlankInterpolation, FlankInterpolation]


class FacePairing:
    """Compliance between the contact nodes of tooth pairs in the slices of a face."""

    def __init__(self, flanks: Flanks, bodies: tuple[FaceCompliance, FaceCompliance], face: Face):
        self.face, self._nodes = face, tuple(len(body.roll_angle) for body in bodies)
        sections = Flanks(flanks.pair, (bodies[0].plane, bodies[1].plane), flanks.removal)
        self.sections = sections
        self._fine, self._coarse = (CompliancePairing(each, widths=UNIT_WIDTH) for each in (flanks, sections))
        self._bodies = tuple(
            on_slices(body.blocks, slice_averages(body.heights, body.element_order, face.positions - middle, face.widths), body.flanks)
            for body, middle in zip(bodies, face.middles)
        )

    def compliance(
        self, pairs: Sequence[FacePair], previous: Sequence[FacePair] | None, turned: tuple[float, float]
    ) -> tuple[np.ndarray, np.ndarray | None, int]:
        """C (m, m) and E (n, m before), mm/N, as of `CompliancePairing.compliance`; and the dependent rows, which have a thin layer each (`contact.rank`)."""
        tangential = previous is not None
        kinds, nodes, before = 2 if tangential else 1, _count(pairs), _count(previous or ())
        compliance, earlier = np.zeros((kinds, nodes, kinds, nodes)), np.zeros((1, nodes, 2, before))
        for gear, blocks in enumerate(self._bodies):
            rows = self._views(gear, pairs, tangential)
            face_product(blocks, rows, rows, compliance, True)
            if tangential:
                tangents = self._views(gear, pairs, tangential, turned[gear])
                face_product(blocks, tangents, self._views(gear, previous, True), earlier, False)
        dependent = self._add_local(compliance, earlier, pairs, previous, turned)
        return compliance.reshape(kinds * nodes, kinds * nodes), earlier.reshape(nodes, 2 * before) if tangential else None, dependent

    def _views(self, gear: int, pairs: Sequence[FacePair], tangential: bool, turned: float | None = None) -> Views:
        """How the pairs' nodes see one gear's body: along normal and tangent, or with `turned` (rad) along the tangent as it stood before."""
        size, places = 3 * self._nodes[gear], [pair.place for pair in pairs]
        return views(
            [pair.coarse[gear] for pair in pairs],
            [place.ahead(gear) for place in places],
            [size * (place.flank * self.face.slices + place.slice) for place in places],
            [self._directions(place, gear, tangential, turned) for place in places],
        )

    def _directions(self, place: Place, gear: int, tangential: bool, turned: float | None) -> np.ndarray:
        """Unit vectors (d, 3) in the tooth's frame."""
        if turned is not None:
            return np.pad(directions(place.contact_rolls[gear] - place.turn * turned, True)[1:], ((0, 0), (0, 1)))
        axes = np.pad(directions(place.contact_rolls[gear], tangential), ((0, 0), (0, 1)))
        axes[0] *= self.face.cosine
        axes[0, 2] = self.face.axial_share(gear, place.turn)
        return axes

    def _add_local(self, compliance, earlier, pairs, previous, turned) -> int:
        """Add what the fine sections give more than the body's, in each slice; returns the dependent rows."""
        now, before = _of_slices(pairs, self.face.slices), _of_slices(previous or (), self.face.slices)
        known, dependent = None, 0
        for number in range(self.face.slices):
            nodes, own = now[number]
            nodes_before, own_before = before[number]
            if known is None or self.face.slope != 0.0:
                known = self._local(own, own_before if previous is not None else None, turned)
            share = self.face.cosine / self.face.widths[number]
            more, more_before, rows = known
            compliance[:, nodes[:, None], :, nodes] += share * more.transpose(1, 3, 0, 2)
            if previous is not None:
                earlier[:, nodes[:, None], :, nodes_before] += share * more_before.transpose(1, 3, 0, 2)
            dependent += rows
        return dependent

    def _local(self, pairs, previous, turned) -> tuple[np.ndarray, np.ndarray | None, int]:
        """Of one slice, mm per N/mm: between its nodes (d, n, d, n), by those before (1, n, 2, before), and its dependent rows."""
        count, kinds = _count(pairs), 1 if previous is None else 2
        fine, fine_before = self._fine.compliance(pairs, previous, turned)
        coarse, coarse_before = self._coarse.compliance(_seen_coarsely(pairs), None if previous is None else _seen_coarsely(previous), turned)
        dependent = dependent_rows(fine)
        if dependent:
            fine = fine + LAYER * fine.diagonal().max() * np.eye(len(fine))
        more = (fine - coarse).reshape(kinds, count, kinds, count)
        return more, None if previous is None else (fine_before - coarse_before).reshape(1, count, 2, -1), dependent


def _seen_coarsely(pairs: Sequence[FacePair]) -> list[FacePair]:
    return [replace(pair, interpolation=pair.coarse) for pair in pairs]


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
