"""Tooth root stress by ISO 6336-3 method B (DIN 3990-3), load at the outer point of single tooth contact."""

from math import cos, radians, sqrt

import pytest

from fenics_gears import Gear, GearPair, base_helix_angle


def rated():
    """The rating extension's formulas; the test is skipped where it is not there."""
    return pytest.importorskip("fenics_gears.extensions.rating.root")


def form_and_stress_correction(gear: Gear, roll_angle: float) -> tuple[float, float]:
    """Y_F = 6 h cos(alpha_Fen) / (s^2 cos(alpha)), lengths in modules, s the chord and h the arm at the 30 degree
    tangents; Y_S = (1.2 + 0.13 s/h) (s / 2 rho)^(1 / (1.21 + 2.3 h/s)); without protuberance."""
    tooth = rated().tooth_form(gear, roll_angle)
    return tooth.form, tooth.stress_correction


def nominal_root_stress(gear: Gear, roll_angle: float, line_force: float) -> float:
    """sigma_F0 (MPa) of a line force (N/mm) at a flank point: F_t / (b m) Y_F Y_S."""
    form, correction = form_and_stress_correction(gear, roll_angle)
    return line_force * cos(gear.pressure_angle) / gear.module * form * correction


def standard_gear(teeth: int, profile_shift: float = 0.0, module: float = 3.0) -> Gear:
    reference, shift = 0.5 * teeth * module, profile_shift * module
    root = reference + shift - 1.25 * module
    return Gear(
        teeth, module, radians(20.0), profile_shift, reference + shift + module, root, 0.55 * root, 0.38 * module
    )


def helical_form_and_stress_correction(pair: GearPair, name: str) -> tuple[float, float, float]:
    """Y_F, Y_S of the "pinion" or the "wheel" by the virtual gears, and their contact ratio epsilon_alphan."""
    gear = getattr(pair, name)
    virtual, contact_ratio = rated().virtual_gear(gear), pair.contact_ratio / cos(base_helix_angle(gear)) ** 2
    roll = virtual.tip_roll_angle - (contact_ratio - 1.0) * virtual.angular_pitch
    return *form_and_stress_correction(virtual, roll), contact_ratio


def helix_angle_factor(overlap_ratio: float, degrees: float) -> float:
    """ISO 6336-3:2006 (DIN 3990-3): 1 - epsilon_beta beta/120 deg, overlap ratios up to 1 and helix angles up to 30
    deg."""
    return 1.0 - min(overlap_ratio, 1.0) * min(degrees, 30.0) / 120.0


def load_sharing_factor(overlap_ratio: float, contact_ratio: float) -> float:
    """f_epsilon of ISO 6336-3:2019 for epsilon_alphan below 2."""
    overlap = min(overlap_ratio, 1.0)
    return sqrt(1.0 - overlap + overlap / contact_ratio)
