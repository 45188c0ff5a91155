"""What elastic shafts give way over the common face: the gap that they open between flanks under a line load."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from fenics_gears.contact.face import even_slices
from fenics_gears.geometry.pair import GearPair

from .elastic_shaft import NUMBERS, ElasticShaft
from .elastic_shaft_seat import carried_with_twist, seat_compliance

SLICES = 40


def middles_of_slices(pair: GearPair, slices: int = SLICES) -> np.ndarray:
    """Middles (slices,), mm, of equal slices of the common face.

    >>> from fenics_gears import gear_pair, load_scene
    >>> pair = gear_pair(load_scene("demos/lundvall2004.toml").gears)
    >>> (middles_of_slices(pair, 2) / pair.face_width).tolist()
    [-0.25, 0.25]
    """
    return even_slices(pair.face_width, slices)[0]


def face_compliance_of_shafts(shafts: Iterable[ElasticShaft], pair: GearPair, z: np.ndarray) -> np.ndarray:
    """How far bending shafts move the flanks apart along the face: entry (i, j) is the gap, in mm of the transverse
    section, that opens at z[i] by a transverse force of 1 N at z[j]. z (s,): heights on the common face, mm.

    The force acts along the line of action at the pitch point, without friction. Rotations of whole gears are left out.

    >>> from fenics_gears import gear_pair, load_scene
    >>> pair = gear_pair(load_scene("demos/lundvall2004.toml").gears)
    >>> face_compliance_of_shafts((), pair, middles_of_slices(pair, 2)).tolist()  # rigid shafts
    [[0.0, 0.0], [0.0, 0.0]]
    """
    found = np.zeros((len(z), len(z)))
    along = pair.pitch_point, pair.pitch_point - pair.line_of_action_length
    across = -pair.pinion.base_radius, pair.wheel.base_radius
    for shaft in shafts:
        gear = list(NUMBERS).index(shaft.gear)
        x, y, lean = along[gear], across[gear], -pair.slope
        row, heights = np.array([1.0, 0.0, lean, y * lean, -x * lean, -y]), z - pair.gear_middles[gear]
        moved = np.einsum("i,sij->sj", row, [carried_with_twist(each) for each in heights])[:, :-1]
        found += moved @ np.linalg.solve(shaft.stiffness, moved.T)
        if shaft.yields_within:
            found += np.einsum("i,sitj,j->st", row, seat_compliance(shaft, heights), row)
    return found
