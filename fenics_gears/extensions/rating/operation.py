"""What a rating is about: the pair under its nominal load."""

from dataclasses import dataclass
from functools import cached_property
from math import pi, tan

import numpy as np

from fenics_gears import GearPair, Material, base_helix_angle, mesh_factor, single_stiffness

from .finish import Finish


@dataclass(frozen=True)
class Operation:
    """The pair with its load: torque of the pinion (N mm), speed of the pinion (1/min), tip relief C_a (um), reduced
    mass of both gears (kg/mm of face width).

    `misalignment`: of flanks over the common face (um), as the scene has it and its shafts bend; None of a scene that
    names none and has rigid shafts. `shafts` (s, s): gap (mm) in slices of the common face by bending shafts, per
    transverse force (N); None of rigid shafts. `opening` (s,): the gap of the unloaded flanks.
    """

    pair: GearPair
    materials: tuple[Material, Material]
    pinion_torque: float
    pinion_speed: float
    tip_relief: float
    reduced_mass: float
    gears: object
    finish: Finish = Finish()
    misalignment: float | None = None
    shafts: np.ndarray | None = None
    opening: np.ndarray | None = None

    @property
    def face_width(self) -> float:
        """Common face width b, mm."""
        return self.pair.face_width

    @cached_property
    def tangential_force(self) -> float:
        """F_t (N) at the reference circle."""
        return self.pinion_torque / self.pair.pinion.reference_radius

    def line_load(self, factors: float = 1.0) -> float:
        """K_A F_t / b, N/mm, by further factors."""
        return self.finish.application_factor * factors * self.tangential_force / self.face_width

    @property
    def base_force(self) -> float:
        """Force (N) along the line of action in the transverse section."""
        return self.pinion_torque / self.pair.pinion.base_radius

    @property
    def pitch_line_speed(self) -> float:
        """v (m/s) at the reference circle."""
        return 2e-3 * pi * self.pair.pinion.reference_radius * self.pinion_speed / 60.0

    @property
    def helix_angle(self) -> float:
        """beta, rad."""
        return self.pair.pinion.helix_angle

    @property
    def base_helix_angle(self) -> float:
        """beta_b, rad."""
        return base_helix_angle(self.pair.pinion)

    @cached_property
    def single_stiffness(self) -> float:
        """c', N/(mm um)."""
        return single_stiffness(self.gears)[1]

    @property
    def mesh_stiffness(self) -> float:
        """c_gamma_alpha, N/(mm um)."""
        return self.single_stiffness * mesh_factor(self.pair.contact_ratio)

    @property
    def reduced_radius(self) -> float:
        """Reduced radius of curvature (mm) at the pitch point, in the transverse section."""
        angle = self.pair.operating_pressure_angle
        first, second = (gear.base_radius * tan(angle) for gear in self.pair.gears)
        return first * second / (first + second)


# Density of steel, kg/mm^3.
DENSITY = 7.83e-6


def solid_reduced_mass(pair: GearPair) -> float:
    """Reduced mass (kg/mm of face width) of two solid steel gears, ISO 6336-1:2006 eq. (30): discs of the mean of tip
    and root diameter."""

    def mass(gear) -> float:
        mean = gear.tip_radius + gear.root_radius
        return 0.125 * pi * DENSITY * mean**4 / (4.0 * gear.base_radius**2)

    first, second = map(mass, pair.gears)
    return first * second / (first + second)
