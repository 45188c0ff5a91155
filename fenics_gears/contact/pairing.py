"""Compliance between contact nodes in the plane, from the flank compliances of both gears; its rank, and a thin
layer for contact nodes that elasticity cannot tell apart."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.linalg.lapack import dpstrf

from .compliance_product import compliance_product, directions
from .kinematics import turned
from .operator import Passage, Response
from .tooth_pair import Flanks, Place, ToothPair, count_of

# Nodes that coincide, or more nodes on an element than it has degrees of freedom, yield together: elasticity does not
# determine how they share a force. Each node then gets a thin elastic layer of its own, and nodes that coincide share
# it evenly. In parts of the largest self-compliance of a node. Newton does not converge with a layer below 1e-5; this
# one changes the transmission error of the paper's pair by 1e-5 of itself, a hundredth of the error of such a grid.
SMALLEST_PIVOT = 1e-10
LAYER = 1e-4


def dependent_rows(compliance: np.ndarray) -> int:
    """Rows of a positive semi-definite matrix (m, m) that follow from the others; by Cholesky with pivots."""
    if not len(compliance):
        return 0
    tolerance = SMALLEST_PIVOT * compliance.diagonal().max()
    # Turned over, in the order of Fortran: it is symmetric.
    return len(compliance) - int(dpstrf(compliance.T, tol=tolerance, lower=1)[2])


def of_full_rank(compliance: np.ndarray) -> tuple[np.ndarray, int]:
    """The compliance (m, m), mm/N, itself where it has full rank, else with a thin layer at every node; and its
    dependent rows."""
    dependent = dependent_rows(compliance)
    if not dependent:
        return compliance, 0
    return compliance + LAYER * compliance.diagonal().max() * np.eye(len(compliance)), dependent


# A flank of a gear, by its tooth's place and its side; contact nodes as `compliance_product` takes them, and none of
# them.
_Flank = tuple[int, int]
_Nodes = tuple[int, np.ndarray, np.ndarray, np.ndarray]
NO_NODES: _Nodes = (0, np.empty((0, 1)), np.empty(0, dtype=np.int64), np.eye(2))


class CompliancePairing:
    """Compliance between the contact nodes of tooth pairs, from the flank compliances of both gears."""

    def __init__(self, flanks: Flanks, blocks: tuple[dict, dict] | None = None):
        """`blocks`: of either gear, by pairs of teeth, which pairings of the same bodies may share."""
        self.flanks, self._gears, self._blocks = flanks, flanks.compliance, blocks or ({}, {})

    def response(self, passage: Passage) -> Response:
        """How the contact nodes of a passage yield."""
        angles = turned(self.flanks.pair, passage.advance)
        compliance, before = self.compliance(passage.pairs, passage.previous, angles)
        compliance, dependent = of_full_rank(compliance)
        return Response(compliance, before, dependent)

    def _block(self, gear: int, responding: _Flank, loaded: _Flank) -> np.ndarray:
        body, blocks, teeth, sides = (
            self._gears[gear],
            self._blocks[gear],
            (responding[0], loaded[0]),
            (responding[1], loaded[1]),
        )
        key = body.key(*teeth), sides
        if key not in blocks:
            blocks[key] = np.ascontiguousarray(body.between(*teeth, sides))
        return blocks[key]

    def compliance(
        self,
        pairs: Sequence[ToothPair],
        previous: Sequence[ToothPair] | None = None,
        turned: tuple[float, float] = (0.0, 0.0),
    ) -> tuple[np.ndarray, np.ndarray | None]:
        """Sum over both gears of `N A N^T`, mm/N: C (m, m) between the nodes of `pairs`, and E (n, m before) by forces
        on those of `previous`.

        With `previous`, the pairs a step before, there are tangential rows, and E is the displacement along the tangent
        that the material points had while the gears stood `turned` (rad, of either one) before. E is None without.
        """
        tangential = previous is not None
        kinds, nodes, nodes_before = 2 if tangential else 1, count_of(pairs), count_of(previous or ())
        compliance, earlier = np.zeros((kinds, nodes, kinds, nodes)), np.zeros((1, nodes, 2, nodes_before))
        for gear in range(2):
            now, before = (_nodes_of(each, gear, tangential) for each in (pairs, previous or ()))
            loads = _matched(now, before)
            for pair, (flank, own) in zip(pairs, now):
                row, near, first, axes = own
                if tangential:
                    axes = np.concatenate([axes, _earlier_tangent(pair.place, gear, turned)])
                own = row, near, first, axes / self.flanks.pair.face_width
                for other, loaded, loaded_before in loads:
                    # The other half follows by symmetry.
                    loaded = loaded if loaded[0] <= row else NO_NODES
                    if len(loaded[2]) or len(loaded_before[2]):
                        compliance_product(
                            self._block(gear, flank, other), own, loaded, compliance, loaded_before, earlier
                        )
        rows = kinds * nodes
        return compliance.reshape(rows, rows), earlier.reshape(nodes, 2 * nodes_before) if tangential else None


def _nodes_of(pairs: Sequence[ToothPair], gear: int, tangential: bool) -> list[tuple[_Flank, _Nodes]]:
    """The flank of each pair, its contact nodes, and the directions of forces on them: e_x, and e_y where friction asks
    for it."""
    found, start = [], 0
    for pair in pairs:
        view, place = pair.interpolation[gear], pair.place
        axes = directions(place.contact_rolls[gear], tangential)
        found.append(((place.ahead(gear), place.flank), (start, view.near, view.first, axes)))
        start += len(view.near)
    return found


def _matched(
    now: list[tuple[_Flank, _Nodes]], before: list[tuple[_Flank, _Nodes]]
) -> list[tuple[_Flank, _Nodes, _Nodes]]:
    """Contact nodes now and a step before that are on the same flank, and those that have none beside them."""
    left, found = list(before), []
    for flank, nodes in now:
        same = next((place for place, (other, _) in enumerate(left) if other == flank), None)
        found.append((flank, nodes, NO_NODES if same is None else left.pop(same)[1]))
    return found + [(flank, NO_NODES, nodes) for flank, nodes in left]


def _earlier_tangent(place: Place, gear: int, turned: tuple[float, float]) -> np.ndarray:
    """e_y (1, 2) at the material point as it stood `turned` (rad, of either gear) before: that tooth's frame then."""
    return directions(place.contact_rolls[gear] - place.turn * turned[gear], True)[1:]
