"""A gear that sits on its shaft without slip: hub and shaft give way together under the face.

Within the face, and as far beside it as the shaft's stress is not that of a beam, shaft, hub, web and rim are one body
of revolution (`elasticity.body_of_revolution`). Held at its left end it gives way, on circles of the rim and at its
right end, as `elastic_shaft_seat` has a shaft under teeth that are cut in give way. From that is taken

* what the shaft beside the face gives way as a beam: it is counted there;
* what the rim gives way with the bore held: the gear's body has that, by its own finite elements, teeth and all.

With T the motions of the rim per motion of the bore, C_b the compliance of the bore of the whole, what is left is
T C_b T^T: the body on its held bore and this make up the whole exactly. Harmonics 0 and 1 carry all forces and moments
from gear to shaft; the others do not leave the gear.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from fenics_gears.elasticity.body_of_revolution import BodyOfRevolution, Ring, flexibility, flexibility_outside

from .beam import OF_CYLINDER, Properties, flexibilities, gauss_rule
from .shaft_elements import SIX, carried

# Of the bore's radius: how far beside the face, and the size of elements.
MARGIN = 1.5
SIZE = 1.0 / 7.0


@dataclass(frozen=True)
class Hub:
    """The rings of a gear around its shaft, heights from mid-width: the gear's, and the shaft within the face."""

    gear: tuple[Ring, ...]
    shaft: Ring

    @property
    def outer(self) -> float:
        """Radius, mm, of the circles on which the gear's body is loaded."""
        return max(ring.outer for ring in self.gear)


def hub_flexibility(hub: Hub, heights: np.ndarray, axis: np.ndarray) -> np.ndarray:
    """Motions (h + a + 1, 6, h + a + 1, 6), over MOTIONS and the twist, of the rim at `heights` (h,), mm from
    mid-width, and of the shaft at those of its `axis` (a,) and at the right end of the face, per load there, with the
    shaft held at the left end of the face."""
    return _flexibility(hub, tuple(heights.tolist()), tuple(axis.tolist()))


@lru_cache(maxsize=8)
def _flexibility(hub: Hub, heights: tuple[float, ...], axis: tuple[float, ...]) -> np.ndarray:
    shaft = hub.shaft
    circles = np.array(heights)
    margin = MARGIN * shaft.outer
    size = SIZE * shaft.outer
    left = shaft.low - margin
    right = shaft.high + margin
    body = BodyOfRevolution([shaft._replace(low=left, high=right), *hub.gear], size)
    harmonics = []
    for order in (1, 0):
        stiffness = body.stiffness(order)
        rim = body.of_circles(hub.outer, circles, order)
        held, *free = (body.of_section(each, shaft.outer, order) for each in (left, *axis, right))
        of_order = flexibility(stiffness, held, np.concatenate([rim, *free]))
        within = body.nodes[:, 0] < shaft.outer + 1e-9
        of_order[: len(rim), : len(rim)] -= flexibility_outside(stiffness, within, rim)
        harmonics.append(of_order)
    motions = _over_motions(*harmonics)
    piece = _piece(shaft, margin, size)
    # The left end of the body carries all places, and the right end is carried by that of the face.
    carry = np.stack([carried(each - shaft.low) for each in (*heights, *axis, right)])
    motions -= np.einsum("pia,ab,qjb->piqj", carry, piece, carry)
    motions[-1, :, -1] -= piece
    back = carried(-margin)
    motions[-1] = np.einsum("ab,bqj->aqj", back, motions[-1])
    motions[:, :, -1] = np.einsum("piq,bq->pib", motions[:, :, -1], back)
    return motions


def _over_motions(first: np.ndarray, zeroth: np.ndarray) -> np.ndarray:
    """Motions (p, 6, p, 6) of what harmonic 1 (2 p, 2 p) and harmonic 0 do: bending is alike in both planes."""
    first, zeroth = (each.reshape(len(each) // 2, 2, -1, 2) for each in (first, zeroth))
    flexibility = np.zeros((len(first), SIX, len(first), SIX))
    # A positive tilt about x moves what lies further along the axis to negative y.
    for motions, part, sense in (([0, 4], first, 1.0), ([1, 3], first, -1.0), ([2, 5], zeroth, 1.0)):
        for row, column in np.ndindex(2, 2):
            flexibility[:, motions[row], :, motions[column]] = sense ** (row + column) * part[:, row, :, column]
    return flexibility


def _piece(shaft: Ring, length: float, size: float) -> np.ndarray:
    """Flexibility (6, 6) of a piece of the shaft beside the face, as a beam whose shear is that of the elements: half
    of that of a piece twice as long, so that each end has what is local to it once."""
    both = BodyOfRevolution([shaft._replace(low=0.0, high=2.0 * length)], size)
    ends = [both.of_section(place, shaft.outer, 1) for place in (0.0, 2.0 * length)]
    whole = flexibility(both.stiffness(1), *ends)[0, 0]
    points, weights = gauss_rule(OF_CYLINDER)
    area = np.pi * (shaft.outer**2 - shaft.inner**2)
    second = 0.25 * np.pi * (shaft.outer**4 - shaft.inner**4)
    bending = 1.0 / (shaft.modulus * second)
    shear = (whole - bending * (2.0 * length) ** 3 / 3.0) / (2.0 * length)
    flexible = shear, 1.0 / (shaft.modulus * area), bending, (1.0 + shaft.ratio) * bending
    along = Properties(
        0.5 * length * (1.0 + points), 0.5 * length * weights, *(np.full(len(points), each) for each in flexible)
    )
    return flexibilities(along, np.array([0.0, length]))[0]
