"""Gears that tilt and move axially: a rigid shaft on two bearings, and how it moves flanks that have a width.

Gears move about their mid-width. A tilt theta (rad, about x along and y off the line of action) displaces the shaft at
the height z by theta_y z in x and by -theta_x z in y, so that bearings that do not stand at equal distances couple x
with theta_y and y with theta_x. Gyroscopic moments are left out: they shift a tilting frequency by half of J/J_t times
the speed of rotation (1/s), J_t being the moment of inertia about a diameter. J is 2 J_t at most, a flat disc's.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from math import sqrt
from typing import TYPE_CHECKING

import numpy as np

from fenics_gears.contact.kinematics import COORDINATES, approach
from fenics_gears.geometry.pair import GearPair
from fenics_gears.inputs.tree import GEARS

from .drivetrain import MeshSprings

if TYPE_CHECKING:
    from .bearings import Bearings
    from .frequencies import Vibration

# Shifts of natural frequencies that give a warning.
GYROSCOPIC = 0.05
# The tilt that moves the shaft in a direction, and how.
TILTS = {"x": ("tilt_y", 1.0), "y": ("tilt_x", -1.0)}


def gyroscopic_warnings(vibrations: Iterable[Vibration], speeds: Mapping[str, float]) -> list[str]:
    """A sentence where gyroscopic moments could matter to modes in which a gear tilts; `speeds` (1/s): of "pinion" and
    "wheel"."""
    tilting = [
        (speed / each.frequency, each, gear)
        for each in vibrations
        for gear, speed in speeds.items()
        if each.motion.startswith(f"{gear} tilts")
    ]
    share, mode, gear = max(tilting, key=lambda of_mode: of_mode[0], default=(0.0, None, ""))
    if share < GYROSCOPIC:
        return []
    return [
        f"gyroscopic moments are left out: at {60.0 * speeds[gear]:.4g} rpm they shift the natural frequency of about"
        f" {mode.frequency:.4g} Hz, at which the {gear} tilts, by up to {share:.0%}"
    ]


@dataclass(frozen=True)
class Tilting:
    """The gears of a `pair` whose `bearings` have places."""

    pair: GearPair
    bearings: Bearings

    @property
    def radii(self) -> dict[str, float]:
        """Their coordinates with mm per rad of each: tilts, and the axial one where the shaft is not held."""
        radii = {}
        for number, (gear, radius) in enumerate(zip(GEARS, self.pair.base_radii), 1):
            if self.bearings.places_of(gear) is not None:
                axial = {} if self.bearings.axial(gear) is None else {f"axial_{number}": 1.0}
                radii |= axial | {f"tilt_x{number}": radius, f"tilt_y{number}": radius}
        return radii

    def add_bearings(self, stiffness: np.ndarray, names: tuple[str, ...]) -> None:
        """Add the tilting springs, in N, mm and rad, and the axial ones.

        The translations' own stiffness is there already: both bearings together have it.
        """
        for number, gear in enumerate(GEARS, 1):
            places = self.bearings.places_of(gear)
            if places is None:
                continue
            for direction, (tilt, sense) in TILTS.items():
                centre = names.index(f"centre_{direction}{number}")
                turned = names.index(f"{tilt}{number}")
                each = 0.5 * self.bearings.of(gear, direction)
                stiffness[turned, turned] += each * sum(place**2 for place in places)
                stiffness[centre, turned] = stiffness[turned, centre] = sense * each * sum(places)
            if f"axial_{number}" in names:
                axial = names.index(f"axial_{number}")
                stiffness[axial, axial] += self.bearings.axial(gear)

    def mesh(self, names: tuple[str, ...]) -> MeshSprings:
        """How all coordinates of the pair move its flanks."""
        return mesh_over_face(self.pair, names)


def mesh_over_face(pair: GearPair, names: tuple[str, ...]) -> MeshSprings:
    """How coordinates move the contact of flanks that touch at the pitch point in the middle of the common face;
    coordinates as arc lengths (mm)."""
    # Gauss points: two springs at +- b/(2 sqrt 3) have the second moment of an even one over b.
    heights = np.array([-1.0, 1.0]) * pair.face_width / (2.0 * sqrt(3.0))
    normal = contact_normal(pair)
    normals = [moved(pair, names, (pair.pitch_point + pair.slope * height, height), normal) for height in heights]
    return MeshSprings(
        np.array(normals), moved(pair, names, (pair.pitch_point, 0.0), np.array([0.0, 1.0, 0.0]))[None, :]
    )


def contact_normal(pair: GearPair) -> np.ndarray:
    """Unit normal (3,) of touching flanks, along the line of action and the axis."""
    return pair.cosine * np.array([1.0, 0.0, -pair.slope])


def coast_normal(pair: GearPair) -> np.ndarray:
    """The same (3,) of touching coast flanks: mirrored at the line of centres, as the pinion approaches along it."""
    double = 2.0 * pair.operating_pressure_angle
    return pair.cosine * np.array([-np.cos(double), -np.sin(double), pair.slope])


def moved(pair: GearPair, names: tuple[str, ...], place: tuple[float, float], direction: np.ndarray) -> np.ndarray:
    """Relative displacement (k,) along a direction (3,), per coordinate, of flanks that touch at a place (mm): on the
    path of contact, and the height.

    The pinion approaches along the direction, the wheel against it.
    """
    along, height = place
    middles = zip(pair.sides, pair.gear_middles)
    points = [[(along - side.foot, -side.sense * side.gear.base_radius, height - middle)] for side, middle in middles]
    row = approach(pair.sides, np.array(points), direction[None])[0]
    return np.array([row[COORDINATES.index(name)] if name in COORDINATES else 0.0 for name in names])
