"""A gear that is cut into its elastic shaft, or whose hub gives way with it: what does so within the face.

All of shaft and bearings is C, motions of places within the face per load there. With R, the motions of these places as
parts of a rigid gear, C = R K^-1 R^T + D: K = (R^T C^-1 R)^-1 is the stiffness of a seat that is rigid over its width,
which the drivetrain has in any case, and D >= 0 what is left, which joins the compliance of the flanks (Schur's
complement the other way round). Under D the gear moves so that shaft and bearings beside the face feel neither force
nor moment of it in sum; the split is exact.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from .beam import SIX, beam_flexibility, properties
from .elastic_shaft import MOTIONS, ElasticShaft, carried

NOWHERE = np.empty(0)


class YieldingSeat(NamedTuple):
    """What a seat does under loads of the teeth (h, 6) within its face, over MOTIONS and the twist: the `compliance` D
    (h, 6, h, 6), motions of the shaft's `axis` (a, 6, h, 6) there, and of its `ends` (2, 6, h, 6), left and right of
    the face, as motions of the gear's middle."""

    compliance: np.ndarray
    axis: np.ndarray
    ends: np.ndarray


def seat_compliance(shaft: ElasticShaft, heights: np.ndarray) -> np.ndarray:
    """D (h, 6, h, 6): motions of places at `heights` (h,), mm from the gear's middle, per load there, over MOTIONS and
    the twist, counter-clockwise."""
    return yielding_seat(shaft, heights).compliance


def yielding_seat(shaft: ElasticShaft, heights: np.ndarray, axis: np.ndarray = NOWHERE) -> YieldingSeat:
    """The seat of a gear that is loaded at `heights` (h,), mm from its middle; `axis` (a,): heights within the face at
    which the shaft is asked for.

    The face is a cantilever from its left end; w and v are what the shaft on either side of it holds, as motions of the
    gear's middle: K_L w + K_R v = 0 is the condition on which D moves.
    """
    places, loaded = np.concatenate([heights, axis]), len(heights)
    left, right = (_six(shaft.stiffness_beside(side), side, shaft) for side in (-1.0, 1.0))
    free = _within_the_face(shaft, heights, axis).reshape(SIX * (len(places) + 1), -1)
    to_middle = carried_with_twist(-0.5 * shaft.seat)
    both = left + right
    held = left @ np.linalg.solve(both, right)
    at_end = to_middle @ free[-SIX:]
    given = np.linalg.solve(np.eye(SIX) + at_end[:, -SIX:] @ to_middle.T @ held, at_end)
    cantilever = free - at_end.T @ held @ given
    follows = np.concatenate([carried_with_twist(each) for each in places]) @ np.linalg.solve(both, right) @ to_middle
    motion = np.concatenate([np.eye(SIX * len(places)), -follows], axis=1)
    moved = cantilever @ motion.T
    found = motion @ moved
    found = (0.5 * (found + found.T)).reshape(len(places), SIX, len(places), SIX)[:, :, :loaded]
    apart = to_middle @ moved[-SIX:, : SIX * loaded]
    ends = np.stack([-np.linalg.solve(both, right @ apart), np.linalg.solve(both, left @ apart)])
    return YieldingSeat(found[:loaded], found[loaded:], ends.reshape(2, SIX, loaded, SIX))


class BentBySeat(NamedTuple):
    """What loads of the teeth (h, 6) do to a shaft by a seat that gives way, beside what they do by a rigid one:
    motions of the `teeth` (h, 6, h, 6), which is D, and of places on its `line` (p, 5, h, 6); loads on its `bearings`
    (5 b, h, 6)."""

    teeth: np.ndarray
    line: np.ndarray
    bearings: np.ndarray


def bent_by_seat(shaft: ElasticShaft, heights: np.ndarray, places: np.ndarray) -> BentBySeat:
    """A shaft whose gear is loaded at `heights` (h,), mm from its middle; `places` (p,), mm from the left end. What is
    beside the face follows its ends."""
    (begin, end), bearings = shaft.seat_ends, np.array([each.at for each in shaft.bearings])
    within = (places > begin) & (places < end)
    seat = yielding_seat(shaft, heights, places[within] - shaft.gear_at)
    loads = shaft.springs @ shaft.bearings_at_rest
    line = np.zeros((len(places), len(MOTIONS), len(heights), SIX))
    line[within], found = seat.axis[:, : len(MOTIONS)], np.zeros((len(loads), len(heights), SIX))
    for moved, side in zip(seat.ends[:, : len(MOTIONS)], (-1.0, 1.0)):
        beside, own = ((each - shaft.gear_at) * side > 0.0 for each in (places, bearings))
        beside &= ~within
        line[beside] = np.einsum("pmn,nhi->pmhi", shaft.deflection(places[beside])[:, :, : len(MOTIONS)], moved)
        rows = np.repeat(own, len(MOTIONS))
        found[rows] = np.einsum("bn,nhi->bhi", loads[rows], moved)
    return BentBySeat(seat.compliance, line, found)


def _within_the_face(shaft: ElasticShaft, heights: np.ndarray, axis: np.ndarray) -> np.ndarray:
    """Motions (h + a + 1, 6, h + a + 1, 6) of places within the face, the last ones of the shaft's `axis`, and of its
    right end, per load there, with its left end held."""
    if shaft.hub is not None:
        # Imported here: few gears have a hub that gives way.
        from .elastic_shaft_hub import hub_flexibility

        return hub_flexibility(shaft.hub, heights, axis)
    begin, end = shaft.seat_ends
    places = [*(shaft.gear_at + heights), *(shaft.gear_at + axis), end]
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
