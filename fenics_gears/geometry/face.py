"""Gap between the flanks along the face by lead modifications and misalignment.

Amounts are in the transverse section along the line of action, as a measuring machine has them (ISO 1328-1); along the
contact normal an opening is ``GearPair.cosine`` times as long. z (mm) runs along the axis from the middle of the common
face; `left` is -z, `right` is +z.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from .lead_modification import LeadModification, LeadModifications
from .misalignment import Misalignment
from .pair import GearPair


def face_opening(
    pair: GearPair, lead_modifications: LeadModifications | None, misalignment: Misalignment | None, z, position=None
) -> np.ndarray:
    """Gap (mm, along the line of action, positive where material is gone) at places z (mm, any shape) on the face.

    `position` (mm from T1, of z's shape): of the contact, on which the gap of misaligned helical gears depends; the
    pitch point unless given.

    >>> from fenics_gears import gear_pair, load_scene
    >>> scene = load_scene("demos/misaligned_spur/misaligned.toml")
    >>> face_opening(gear_pair(scene.gears), scene.lead_modifications, scene.misalignment, [0.0, 10.0]).round(4)
    array([0.    , 0.0133])
    """
    z = np.asarray(z, dtype=float)
    opening = np.zeros_like(z)
    if lead_modifications is not None:
        gears = zip(lead_modifications.of_gears, pair.gear_middles, pair.face_widths)
        opening += sum(lead_removal(own, z - middle, width) for own, middle, width in gears if own is not None)
    if misalignment is not None:
        opening += misalignment_opening(pair, misalignment, z, pair.pitch_point if position is None else position)
    return opening


def lead_removal(modification: LeadModification, place, face_width: float) -> np.ndarray:
    """Material (mm, along the line of action) that a lead modification removes from a gear at places (mm, any shape)
    from its mid-width, over its own face width b (ISO 21771).

    Crowning is the parabola C (2 z/b)^2. The helix slope grows with z from nothing at the left end (right, where
    negative). End relief grows with the distance from its start or with its square.
    """
    share = np.asarray(place, dtype=float) / face_width
    removed = modification.crowning * (2.0 * share) ** 2
    removed += modification.helix_slope * share + 0.5 * abs(modification.helix_slope)
    relief = modification.end_relief
    if relief is not None:
        for end in relief.ends:
            beyond = end * share * face_width - (0.5 * face_width - relief.length)
            removed += relief.depth * (np.maximum(beyond, 0.0) / relief.length) ** relief.power
    return removed


def coast_face_opening(pair: GearPair, misalignment: Misalignment, z, position) -> np.ndarray:
    """The gap of coast flanks along their own line of action by misaligned axes; position: mm from its start."""
    double = 2.0 * pair.operating_pressure_angle
    cosine = np.cos(double)
    sine = np.sin(double)
    # Mirrored about the line of centres, with the other hand.
    mirrored = replace(misalignment, in_plane=-cosine * misalignment.in_plane - sine * misalignment.out_of_plane)
    return misalignment_opening(pair, mirrored, z, position, -pair.slope)


def misalignment_opening(
    pair: GearPair, misalignment: Misalignment, z, position, slope: float | None = None
) -> np.ndarray:
    """Gap (mm, along the line of action) by a tilted axis of the wheel, at places z on the face and positions (mm from
    T1) of the contact. `slope`: of the lines of contact, the pair's unless given.

    The wheel turns by small angles, the scene's amounts over the common face width, about the pitch point in the middle
    of the common face. About another point all gaps of a helical pair would also open or close alike, which only turns
    the wheel. The point of contact is at (position - pitch point, 0, z) from there, the contact normal is (c, 0, -c
    tau). Along it the point moves by c (z + tau (position - pitch point)) for an angle of 1 in the plane of action, and
    not at all for an angle out of it. Terms of second order are left out.
    """
    slope = pair.slope if slope is None else slope
    leaning = slope * (np.asarray(position, dtype=float) - pair.pitch_point)
    return misalignment.in_plane / pair.face_width * (np.asarray(z, dtype=float) + leaning)
