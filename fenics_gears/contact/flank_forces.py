"""Forces on the nodes of either gear's flanks from forces at contact nodes, `N^T p`, as the flank compliance has
them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fenics_gears.contact.compliance_product import directions
from fenics_gears.contact.tooth_pair import COAST, ToothPair
from fenics_gears.geometry.gear import Gear

# A tooth pair counted on is a tooth ahead (counter-clockwise) on the pinion, and behind on the wheel.
SENSE_OF_TEETH = (1, -1)


def flank_rows(gear: int, pair: ToothPair, tangential: bool) -> np.ndarray:
    """Forces (2 f, n or 2 n) on flank nodes, in the tooth's frame, per unit force at the pair's contact nodes, normals
    first.

    `gear`: 0 the pinion, 1 the wheel. A positive contact force pushes on the flank; that of friction acts against e_y
    of the tooth's frame. The coast flank's are in the frame mirrored at the tooth's centreline, as its compliance is.
    """
    weights = pair.interpolation[gear].weights
    axes = directions(pair.place.contact_rolls[gear], tangential)
    return -np.hstack([np.einsum("nf,d->fdn", weights, axis).reshape(-1, len(weights)) for axis in axes])


def sector_of(gear: int, pair: ToothPair) -> int:
    """Pitches, counter-clockwise, from the tooth of pair 0 to the one of this pair."""
    return SENSE_OF_TEETH[gear] * pair.place.teeth[gear]


def flank_forces(
    gear: int, data: Gear, pairs: Sequence[ToothPair], forces: Sequence[np.ndarray], face_width: float
) -> dict[int, np.ndarray]:
    """Line forces (2 f,) or, with coast flanks, (4 f,), N/mm, on the flank nodes of a gear's loaded teeth, in each
    tooth's own frame.

    `forces`: of each pair's contact nodes, (n,) or (2 n,) with friction's, N. Teeth go by `sector_of`.
    """
    both = any(pair.place.flank == COAST for pair in pairs)
    result: dict[int, np.ndarray] = {}
    for pair, force in zip(pairs, forces):
        nodes = len(pair.offsets)
        line = flank_rows(gear, pair, len(force) > nodes) @ force / face_width
        total = result.setdefault(sector_of(gear, pair), np.zeros(len(line) * (2 if both else 1)))
        if pair.place.flank == COAST:
            total[len(line) :] += unmirrored(data, line)
        else:
            total[: len(line)] += line
    return result


def unmirrored(gear: Gear, forces: np.ndarray) -> np.ndarray:
    """Forces (2 f, ...) on a coast flank in the tooth's own frame, from those in the frame mirrored at its
    centreline."""
    mirror = centreline_mirror(gear)
    return np.einsum("xy,fy...->fx...", mirror, forces.reshape(-1, 2, *forces.shape[1:])).reshape(forces.shape)


def centreline_mirror(gear: Gear) -> np.ndarray:
    """Reflection (2, 2) at the tooth's centreline in its body frame."""
    angle = 2.0 * (-0.5 * np.pi - gear.tooth_half_angle_at_base)
    return np.array([[np.cos(angle), np.sin(angle)], [np.sin(angle), -np.cos(angle)]])
