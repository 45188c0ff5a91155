"""Tooth root stress and its limit by ISO 6336-3:2006, method B, for endurance (Y_NT = 1), solid rims (Y_B = 1) and teeth of ordinary depth (Y_DT = 1)."""

from __future__ import annotations

from dataclasses import dataclass
from math import acos, cos, degrees, pi, radians, sin, sqrt, tan

from fenics_gears.geometry.gear import Gear
from fenics_gears.geometry.involute import involute_function
from fenics_gears.rating.finish import Finish
from fenics_gears.rating.load_factors import LoadFactors
from fenics_gears.rating.operation import Operation

# Of the standard's test gear: sigma_FE = 2 sigma_Flim.
STRESS_CORRECTION_OF_TEST_GEAR = 2.0


@dataclass(frozen=True)
class ToothForm:
    """Y_F and Y_S of a tooth loaded at the outer point of single contact, and its notch parameter q_s."""

    form: float
    stress_correction: float
    notch: float


@dataclass(frozen=True)
class RootStress:
    """Nominal stress sigma_F0 (MPa), stress sigma_F and limit sigma_FG of one gear."""

    nominal: float
    stress: float
    limit: float


def root_stresses(operation: Operation, finish: Finish, factors: LoadFactors) -> tuple[RootStress, RootStress]:
    """Of pinion and wheel: F_t / (b m_n) Y_F Y_S Y_beta, raised by the load factors; the limit by Y_delta_relT, Y_RrelT and Y_X of case-hardened steel."""
    return tuple(_of_gear(operation, finish, factors, gear) for gear in (operation.pair.pinion, operation.pair.wheel))


def _of_gear(operation: Operation, finish: Finish, factors: LoadFactors, gear: Gear) -> RootStress:
    tooth = tooth_form(gear, operation.pair.contact_ratio)
    nominal = operation.tangential_force / (operation.face_width * gear.normal_module) * tooth.form * tooth.stress_correction * helix_angle_factor(operation)
    stress = nominal * finish.application_factor * factors.dynamic * factors.face_root * factors.transverse_root
    notch = 0.9434 + 0.0231 * sqrt(1.0 + 2.0 * tooth.notch)
    surface = 1.120 if finish.root_roughness < 1.0 else 1.674 - 0.529 * (finish.root_roughness + 1.0) ** 0.1
    size = 1.05 - 0.01 * min(max(gear.normal_module, 5.0), 25.0)
    return RootStress(nominal, stress, STRESS_CORRECTION_OF_TEST_GEAR * finish.root_limit * notch * surface * size)


def helix_angle_factor(operation: Operation) -> float:
    """Y_beta."""
    return 1.0 - min(operation.pair.overlap_ratio, 1.0) * min(degrees(operation.helix_angle), 30.0) / 120.0


def tooth_form(gear: Gear, contact_ratio: float) -> ToothForm:
    """The tooth of the virtual spur gear, cut by a rack whose rounding may stand out by s_pr; lengths in normal modules (ISO 6336-3:2006 sections 6 and 7).

    Y_F = 6 h cos(alpha_Fen) / (s^2 cos(alpha_n)), s the chord and h the lever arm at the 30 degree tangents;
    Y_S = (1.2 + 0.13 s/h) q^(1 / (1.21 + 2.3 h/s)) with q = s/(2 rho).
    """
    alpha, beta, module = gear.normal_pressure_angle, gear.helix_angle, gear.normal_module
    shift = gear.profile_shift * gear.module / module
    base_cosine = cos(_base_helix(gear))
    z = gear.teeth / (base_cosine**2 * cos(beta))
    depth_of_rack, tip = gear.dedendum / module, gear.rack_tip_radius / module
    land = 0.25 * pi - depth_of_rack * tan(alpha) - (1.0 - sin(alpha)) * tip / cos(alpha) + gear.protuberance / (module * cos(alpha))
    depth = tip - depth_of_rack + shift
    theta = pi / 6.0
    for _ in range(50):
        theta = 2.0 * depth / z * tan(theta) - (2.0 / z * (0.5 * pi - land) - pi / 3.0)
    beyond = depth / cos(theta) - tip
    chord = z * sin(pi / 3.0 - theta) + sqrt(3.0) * beyond
    radius = tip + 2.0 * depth**2 / (cos(theta) * (z * cos(theta) ** 2 - 2.0 * depth))
    base = 0.5 * z * cos(alpha)
    addendum_circle = 0.5 * z + (gear.tip_form_radius - gear.reference_radius) / module
    load = sqrt((sqrt(addendum_circle**2 - base**2) - pi * cos(alpha) * (contact_ratio / base_cosine**2 - 1.0)) ** 2 + base**2)
    at_load = acos(base / load)
    half_tooth = (0.5 * pi + 2.0 * shift * tan(alpha)) / z + involute_function(tan(alpha)) - involute_function(tan(at_load))
    lean = at_load - half_tooth
    arm = 0.5 * ((cos(half_tooth) - sin(half_tooth) * tan(lean)) * 2.0 * load - z * cos(pi / 3.0 - theta) - beyond)
    notch = 0.5 * chord / radius
    return ToothForm(6.0 * arm * cos(lean) / (chord**2 * cos(alpha)), (1.2 + 0.13 * chord / arm) * notch ** (1.0 / (1.21 + 2.3 * arm / chord)), notch)


def _base_helix(gear: Gear) -> float:
    return radians(0.0) if not gear.helix_angle else acos(sqrt(1.0 - (sin(gear.helix_angle) * cos(gear.normal_pressure_angle)) ** 2))
