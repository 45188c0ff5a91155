"""Flank compliance of an internal gear whose outer circle is free but for springs at points of it.

With all springs spread evenly over its teeth they are alike, and one is condensed as of any ring (`elasticity.ring`).
Springs at points differ from those by D at the outer circles s of the teeth: with the even ring's compliance C_0, the
ring on points has ``C = C_0 - C_0s (1 + D C_ss)^-1 D C_s0`` (Woodbury).
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property
from math import floor, pi

import numpy as np

from fenics_gears.geometry.gear import Gear
from fenics_gears.geometry.gear_data import Material

from ..cache import Cache, kept
from ..compliance import FlankCompliance
from ..element_sizes import Discretisation
from ..elements import element_named
from ..gear_compliance import similar_inputs
from .compliance import WholeBodyCompliance

# Even springs of a tooth per face width, by Young's modulus: from stiffer ones a ring between few points would be found
# as a small difference.
MOST_EVEN = 1.0
# Angles of points (k,), rad, counter-clockwise from the centreline of tooth 0, and the radial and tangential stiffness
# of each per face width, N/mm^2. A point takes the mean motion of the outer circle over a pitch, between two sectors of
# both by its angle.
Points = tuple[tuple[float, ...], tuple[float, float]]


@dataclass(frozen=True)
class RingOnPoints(FlankCompliance):
    """A ring on points as one on even springs, whose flank compliance it has, and what makes it that on points.

    even: (teeth, 2, 2n), mm per N/mm: mean radial and tangential motion of the outer circle of the sector m ahead of a
    loaded flank. points_by_even: (2 k, 2 teeth), N/mm per mm: radial (outwards) and tangential (counter-clockwise) line
    forces of the points on the ring by these motions of all sectors. loosened: (2 teeth, 2 teeth), N/mm per mm: by
    them the forces that change the even ring into that on points, symmetric. `first`: teeth are counted from this one.
    """

    even: np.ndarray = field(kw_only=True)
    points_by_even: np.ndarray = field(kw_only=True)
    loosened: np.ndarray = field(kw_only=True)
    first: int = 0

    @property
    def teeth(self) -> int:
        """Number of teeth."""
        return len(self.even)

    def counted_from(self, tooth: int) -> RingOnPoints:
        """The same ring, whose tooth of that number is called 0."""
        return replace(self, first=self.first + tooth)

    def moved(self, tooth: int) -> np.ndarray:
        """Motions (2 teeth, 2n) of the even ring's outer circle under line forces on the flank of a tooth."""
        return np.roll(self.even, self.first + tooth, axis=0).reshape(2 * self.teeth, -1)

    @cached_property
    def openings(self) -> dict[int, np.ndarray]:
        """Line forces (2 k, 2n) of the points on the ring by those on the flank of each tooth, N/mm per N/mm."""
        known = replace(self, first=0)
        return {tooth: self.points_by_even @ known.moved(tooth) for tooth in range(self.teeth)}

    def by_teeth(self, offsets: int) -> WholeBodyCompliance:
        """The same as a body whose teeth differ, known over so many `offsets`."""
        moved = [self.moved(tooth) for tooth in range(self.teeth)]
        blocks = []
        for tooth, own in enumerate(moved):
            forces = self.loosened @ own
            ahead = [self.blocks[each] - moved[(tooth + each) % self.teeth].T @ forces for each in range(offsets + 1)]
            ahead[0] = 0.5 * (ahead[0] + ahead[0].T)
            blocks.append(tuple(ahead))
        rolls = (self.roll_angle,) * self.teeth
        return WholeBodyCompliance(rolls, self.element_order, tuple(blocks), self.openings, self.timings)


def ring_on_points(
    gear: Gear,
    material: Material,
    division: Discretisation,
    points: Points,
    tooth_offsets: int,
    cache: Cache | None = None,
) -> RingOnPoints:
    """A ring on `points`, its flanks' interaction known over so many teeth; its even ring from the cache or computed.
    Raises ComputationError when a stage fails."""
    angles, stiffness = points
    teeth = gear.tooth_count
    springs = springs_of_sectors(angles, stiffness, gear.teeth)
    relative = np.minimum(len(angles) / teeth * np.array(stiffness) / material.youngs_modulus, MOST_EVEN)
    even = relative * material.youngs_modulus
    inputs = similar_inputs("ring on points", gear, material, division, False) | {"springs": relative.tolist()}

    def computed() -> tuple[dict, dict]:
        # Finite elements are loaded where they are needed.
        from .ring_on_springs import ring_on_springs

        return ring_on_springs(gear, material.poissons_ratio, division, relative)

    arrays, timings = kept(cache, inputs, computed)
    by_forces, by_flank = (arrays[name] / material.youngs_modulus for name in ("by_forces", "even"))
    ahead = np.arange(teeth)
    between = by_forces[(ahead[:, None] - ahead) % teeth].swapaxes(1, 2).reshape(2 * teeth, 2 * teeth)
    differ = (springs.sum(axis=0) - even).ravel()
    # How the outer circles move by how those of the even ring do.
    true = np.linalg.inv(np.eye(2 * teeth) + between * differ)
    loosened = differ[:, None] * true
    of_points = springs[:, None] * np.eye(2)[:, None]
    return RingOnPoints(
        arrays["roll_angle"],
        element_named(division.element).order,
        arrays["blocks"][: min(tooth_offsets, teeth - 1) + 1] / material.youngs_modulus,
        timings,
        even=by_flank,
        points_by_even=-of_points.reshape(2 * len(angles), -1) @ true,
        loosened=0.5 * (loosened + loosened.T),
    )


def springs_of_sectors(angles: tuple[float, ...], springs: tuple[float, float], teeth: int) -> np.ndarray:
    """Radial and tangential stiffness (points, teeth, 2) that each point has in each sector."""
    shares = np.zeros((len(angles), abs(teeth)))
    for own, angle in zip(shares, angles):
        place = angle * teeth / (2.0 * pi)
        first = floor(place)
        own[first % len(own)] += 1.0 - (place - first)
        own[(first + 1) % len(own)] += place - first
    return shares[:, :, None] * np.array(springs)
