"""A gear that is cut into its elastic shaft, or whose hub gives way with it: what does so within the face.

All of shaft and bearings is C, motions of places within the face per load there. With R, the motions of these places as
parts of a rigid gear, C = R K^-1 R^T + D: K = (R^T C^-1 R)^-1 is the stiffness of a seat that is rigid over its width,
which the drivetrain has in any case, and D >= 0 what is left, which joins the compliance of the flanks (Schur's
complement the other way round). Under D the gear moves so that shaft and bearings beside the face feel neither force
nor moment of it in sum; the split is exact.
"""

from __future__ import annotations

import numpy as np

from .elastic_shaft import SIX, ElasticShaft, beam_flexibility, carried, properties


def seat_compliance(shaft: ElasticShaft, heights: np.ndarray) -> np.ndarray:
    """D (h, 6, h, 6): motions of places at `heights` (h,), mm from the gear's middle, per load there, over MOTIONS and
    the twist, counter-clockwise.

    The face is a cantilever from its left end; w and v are what the shaft on either side of it holds, as motions of the
    gear's middle: K_L w + K_R v = 0 is the condition on which D moves.
    """
    left, right = (_six(shaft.stiffness_beside(side), side, shaft) for side in (-1.0, 1.0))
    free = _within_the_face(shaft, heights).reshape(SIX * (len(heights) + 1), -1)
    to_middle = carried_with_twist(-0.5 * shaft.seat)
    both = left + right
    held = left @ np.linalg.solve(both, right)
    at_end = to_middle @ free[-SIX:]
    given = np.linalg.solve(np.eye(SIX) + at_end[:, -SIX:] @ to_middle.T @ held, at_end)
    cantilever = free - at_end.T @ held @ given
    follows = np.concatenate([carried_with_twist(each) for each in heights]) @ np.linalg.solve(both, right) @ to_middle
    motion = np.concatenate([np.eye(SIX * len(heights)), -follows], axis=1)
    found = motion @ cantilever @ motion.T
    return (0.5 * (found + found.T)).reshape(len(heights), SIX, len(heights), SIX)


def _within_the_face(shaft: ElasticShaft, heights: np.ndarray) -> np.ndarray:
    """Motions (h + 1, 6, h + 1, 6) of places within the face, and of its right end, per load there, with its left end
    held."""
    if shaft.hub is not None:
        # Imported here: few gears have a hub that gives way.
        from .elastic_shaft_hub import hub_flexibility

        return hub_flexibility(shaft.hub, heights)
    begin, end = shaft.seat_ends
    places = np.append(shaft.gear_at + heights, end)
    along = properties(shaft.sections, shaft.material, {*places, begin})
    within = along._replace(weights=np.where((along.places > begin) & (along.places < end), along.weights, 0.0))
    return beam_flexibility(within, places, places, (begin, begin))


def _six(stiffness: np.ndarray, side: float, shaft: ElasticShaft) -> np.ndarray:
    """A stiffness (5, 5) with that of the twist, which is all on the coupling's side: how large does not matter."""
    found = np.zeros((SIX, SIX))
    found[:-1, :-1] = stiffness
    found[-1, -1] = float((shaft.torque_at - shaft.gear_at) * side > 0.0)
    return found


def carried_with_twist(distance: float) -> np.ndarray:
    """Motions (6, 6), the twist among them, of a place at a distance (mm) along a rigid axis per motion of its
    origin."""
    found = np.eye(SIX)
    found[:-1, :-1] = carried(distance)
    return found
