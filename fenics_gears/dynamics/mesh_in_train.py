"""One mesh of a train by itself, as its contact equations know it."""

from __future__ import annotations

from collections.abc import Sequence
from math import isfinite
from typing import TYPE_CHECKING

import numpy as np

from fenics_gears.geometry.pair import GearPair

from .drivetrain import Drivetrain

if TYPE_CHECKING:
    from .seat_of_mesh import SeatOfMesh


def drivetrain_of_mesh(
    pair: GearPair,
    wheel_torque: float,
    names: tuple[str, ...] = ("rotation_1", "rotation_2"),
    supports: Sequence[tuple[float, float] | None] = (),
    seats: Sequence[SeatOfMesh] = (),
) -> Drivetrain:
    """Both gears of one mesh of a train, whose coordinates follow from those of all gears; `supports` as of the
    train; `seats`: those that give way."""
    turning = ("rotation", "tilt")
    radii = np.array([pair.base_radii[int(name[-1]) - 1] if name.startswith(turning) else 1.0 for name in names])
    load = np.array([wheel_torque if name == "rotation_2" else 0.0 for name in names]) / np.abs(radii)
    nothing = np.zeros((len(names), len(names)))
    in_bearings = nothing.copy()
    for number, support in enumerate(supports, 1):
        for axis, own in zip("xy", support or ()):
            place = names.index(f"centre_{axis}{number}")
            in_bearings[place, place] = own if isfinite(own) else 0.0
    stiffness = nothing.copy()
    for seat in seats:
        places = [names.index(name) for name in seat.of_face]
        radii[places] = seat.radii_of_face(pair)
        stiffness[np.ix_(places, places)] = seat.stiffness_of_face / np.outer(radii[places], radii[places])
    return Drivetrain(names, radii, stiffness, load, None, None, bearing_stiffness=in_bearings, seats=tuple(seats))
