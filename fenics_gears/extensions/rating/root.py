"""Tooth root stress and its limit by ISO 6336-3:2006, method B, for endurance (Y_NT = 1), solid rims (Y_B = 1) and
teeth of ordinary depth (Y_DT = 1)."""

from dataclasses import dataclass, replace
from math import acos, cos, degrees, pi, sin, sqrt, tan

from fenics_gears import Gear, base_helix_angle, involute_function

from .load_factors import LoadFactors
from .operation import Operation

# Of the standard's test gear: sigma_FE = 2 sigma_Flim.
STRESS_CORRECTION_OF_TEST_GEAR = 2.0


@dataclass(frozen=True)
class ToothForm:
    """Y_F and Y_S of a tooth loaded at the outer point of single contact, and its notch parameter q_s."""

    form: float
    stress_correction: float
    notch: float


@dataclass(frozen=True)
class NominalRootStress:
    """Nominal stress sigma_F0 (MPa), stress sigma_F and limit sigma_FG of one gear."""

    nominal: float
    stress: float
    limit: float


def root_stresses(operation: Operation, factors: LoadFactors) -> tuple[NominalRootStress, NominalRootStress]:
    """Of pinion and wheel: F_t / (b m_n) Y_F Y_S Y_beta, raised by the load factors; the limit by Y_delta_relT, Y_RrelT
    and Y_X of case-hardened steel."""
    pair = operation.pair
    return _of_gear(operation, factors, pair.pinion), _of_gear(operation, factors, pair.wheel)


def _of_gear(operation: Operation, factors: LoadFactors, gear: Gear) -> NominalRootStress:
    tooth = form_at_outer_point(gear, operation.pair.contact_ratio)
    finish = operation.finish
    load = operation.tangential_force / (operation.face_width * gear.normal_module)
    nominal = load * tooth.form * tooth.stress_correction * helix_angle_factor(operation)
    stress = nominal * finish.application_factor * factors.dynamic * factors.face_root * factors.transverse_root
    notch = 0.9434 + 0.0231 * sqrt(1.0 + 2.0 * tooth.notch)
    surface = 1.120 if finish.root_roughness < 1.0 else 1.674 - 0.529 * (finish.root_roughness + 1.0) ** 0.1
    size = 1.05 - 0.01 * min(max(gear.normal_module, 5.0), 25.0)
    return NominalRootStress(
        nominal, stress, STRESS_CORRECTION_OF_TEST_GEAR * finish.root_limit * notch * surface * size
    )


def helix_angle_factor(operation: Operation) -> float:
    """Y_beta."""
    return 1.0 - min(operation.pair.overlap_ratio, 1.0) * min(degrees(operation.helix_angle), 30.0) / 120.0


def virtual_gear(gear: Gear) -> Gear:
    """The virtual spur gear in the normal section: z_n = z/(cos(beta_b)^2 cos(beta)) teeth, tip and root as far from
    the reference circle."""
    teeth = gear.teeth / (cos(base_helix_angle(gear)) ** 2 * cos(gear.helix_angle))
    module = gear.normal_module
    away = 0.5 * teeth * module - gear.reference_radius
    return replace(
        gear, teeth=teeth, module=module, pressure_angle=gear.normal_pressure_angle,
        profile_shift=gear.profile_shift * gear.module / module,
        tip_radius=gear.tip_radius + away, root_radius=gear.root_radius + away, helix_angle=0.0,
    )  # fmt: skip


def form_at_outer_point(gear: Gear, contact_ratio: float) -> ToothForm:
    """Of the virtual gear, loaded at its outer point of single contact."""
    virtual = virtual_gear(gear)
    over_one = contact_ratio / cos(base_helix_angle(gear)) ** 2 - 1.0
    return tooth_form(virtual, virtual.tip_roll_angle - over_one * virtual.angular_pitch)


def tooth_form(gear: Gear, roll_angle: float) -> ToothForm:
    """The tooth of a spur gear loaded at a flank point, cut by a rack whose rounding may protrude by s_pr. Lengths are
    in modules (ISO 6336-3:2006 sections 6 and 7).

    Y_F = 6 h cos(alpha_Fen) / (s^2 cos(alpha_n)), s the chord and h the lever arm at the 30 degree tangents. Y_S = (1.2
    + 0.13 s/h) q^(1 / (1.21 + 2.3 h/s)) with q = s/(2 rho).
    """
    z = gear.teeth
    x = gear.profile_shift
    alpha = gear.pressure_angle
    module = gear.module
    depth_of_rack = gear.dedendum / module
    tip = gear.rack_tip_radius / module
    land = (
        0.25 * pi
        - depth_of_rack * tan(alpha)
        - (1.0 - sin(alpha)) * tip / cos(alpha)
        + gear.protuberance / (module * cos(alpha))
    )
    depth = tip - depth_of_rack + x
    theta = pi / 6.0
    for _ in range(50):
        theta = 2.0 * depth / z * tan(theta) - (2.0 / z * (0.5 * pi - land) - pi / 3.0)
    beyond = depth / cos(theta) - tip
    chord = z * sin(pi / 3.0 - theta) + sqrt(3.0) * beyond
    radius = tip + 2.0 * depth**2 / (cos(theta) * (z * cos(theta) ** 2 - 2.0 * depth))
    load_diameter = 2.0 * float(gear.radius(roll_angle)) / module
    at_load = acos(z * cos(alpha) / load_diameter)
    half_tooth = (0.5 * pi + 2.0 * x * tan(alpha)) / z + involute_function(tan(alpha)) - involute_function(tan(at_load))
    lean = at_load - half_tooth
    arm = 0.5 * ((cos(half_tooth) - sin(half_tooth) * tan(lean)) * load_diameter - z * cos(pi / 3.0 - theta) - beyond)
    notch = 0.5 * chord / radius
    return ToothForm(
        6.0 * arm * cos(lean) / (chord**2 * cos(alpha)),
        (1.2 + 0.13 * chord / arm) * notch ** (1.0 / (1.21 + 2.3 * arm / chord)),
        notch,
    )
