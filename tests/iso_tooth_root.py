"""Nominal tooth root stress by ISO 6336-3 method B (DIN 3990-3 has the same factors), for load at the outer point of single tooth contact."""

from math import acos, asin, cos, pi, radians, sin, sqrt, tan

from fenics_gears.geometry.gear import Gear
from fenics_gears.geometry.involute import involute_function
from fenics_gears.geometry.pair import GearPair


def form_and_stress_correction(gear: Gear, roll_angle: float) -> tuple[float, float]:
    """Form factor Y_F and stress correction factor Y_S for load at a flank point, of a gear cut by a rack without protuberance.

    Y_F = 6 h cos(alpha_Fen) / (s^2 cos(alpha)), lengths in modules, s the chord and h the arm at the 30 degree tangents;
    Y_S = (1.2 + 0.13 s/h) (s / 2 rho)^(1 / (1.21 + 2.3 h/s)).
    """
    z, x, alpha, module = gear.teeth, gear.profile_shift, gear.pressure_angle, gear.module
    addendum, tip_radius = gear.dedendum / module, gear.rack_tip_radius / module
    land = 0.25 * pi - addendum * tan(alpha) - (1.0 - sin(alpha)) * tip_radius / cos(alpha)
    depth = tip_radius - addendum + x
    third = 2.0 / z * (0.5 * pi - land) - pi / 3.0
    theta = pi / 6.0
    for _ in range(50):
        theta = 2.0 * depth / z * tan(theta) - third
    beyond = depth / cos(theta) - tip_radius
    chord = z * sin(pi / 3.0 - theta) + sqrt(3.0) * beyond
    radius = tip_radius + 2.0 * depth**2 / (cos(theta) * (z * cos(theta) ** 2 - 2.0 * depth))
    load_diameter = 2.0 * float(gear.radius(roll_angle)) / module
    at_load = acos(z * cos(alpha) / load_diameter)
    half_tooth = (0.5 * pi + 2.0 * x * tan(alpha)) / z + involute_function(tan(alpha)) - involute_function(tan(at_load))
    lean = at_load - half_tooth
    arm = 0.5 * ((cos(half_tooth) - sin(half_tooth) * tan(lean)) * load_diameter - z * cos(pi / 3.0 - theta) - beyond)
    form = 6.0 * arm * cos(lean) / (chord**2 * cos(alpha))
    notch = chord / (2.0 * radius)
    return form, (1.2 + 0.13 * chord / arm) * notch ** (1.0 / (1.21 + 2.3 * arm / chord))


def nominal_root_stress(gear: Gear, roll_angle: float, line_force: float) -> float:
    """sigma_F0 (MPa) of a normal line force (N/mm) at a flank point: F_t / (b m) Y_F Y_S."""
    form, correction = form_and_stress_correction(gear, roll_angle)
    return line_force * cos(gear.pressure_angle) / gear.module * form * correction


def standard_gear(teeth: int, profile_shift: float = 0.0, module: float = 3.0) -> Gear:
    """A gear of ISO 53 profile A."""
    reference, shift = 0.5 * teeth * module, profile_shift * module
    root = reference + shift - 1.25 * module
    return Gear(teeth, module, radians(20.0), profile_shift, reference + shift + module, root, 0.55 * root, 0.38 * module)


def virtual_gear(gear: Gear) -> Gear:
    """The virtual spur gear of a helical one, in its normal section: z_n = z/(cos(beta_b)^2 cos(beta)) teeth, tip and root as far from the reference circle."""
    helix_angle, module = gear.helix_angle, gear.normal_module
    base = asin(sin(helix_angle) * cos(gear.normal_pressure_angle))
    teeth = gear.teeth / (cos(base) ** 2 * cos(helix_angle))
    away = 0.5 * teeth * module - gear.reference_radius
    shift = gear.profile_shift * gear.module / module
    return Gear(teeth, module, gear.normal_pressure_angle, shift, gear.tip_radius + away, gear.root_radius + away, gear.bore_radius, gear.rack_tip_radius)


def helical_form_and_stress_correction(pair: GearPair, name: str) -> tuple[float, float, float]:
    """Y_F, Y_S of the "pinion" or the "wheel" with load at the outer point of single contact of the virtual gears, and their contact ratio epsilon_alphan."""
    gear, base = getattr(pair, name), asin(sin(pair.pinion.helix_angle) * cos(pair.pinion.normal_pressure_angle))
    virtual, contact_ratio = virtual_gear(gear), pair.contact_ratio / cos(base) ** 2
    roll = virtual.tip_roll_angle - (contact_ratio - 1.0) * virtual.angular_pitch
    return *form_and_stress_correction(virtual, roll), contact_ratio


def helix_angle_factor(overlap_ratio: float, degrees: float) -> float:
    """Y_beta of ISO 6336-3:2006 (DIN 3990-3): 1 - epsilon_beta beta/120 deg, overlap ratios above 1 and helix angles above 30 deg as these."""
    return 1.0 - min(overlap_ratio, 1.0) * min(degrees, 30.0) / 120.0


def load_sharing_factor(overlap_ratio: float, contact_ratio: float) -> float:
    """f_epsilon of ISO 6336-3:2019 for contact ratios epsilon_alphan below 2: what load the highest loaded pair has of the whole, in the root."""
    overlap = min(overlap_ratio, 1.0)
    return sqrt(1.0 - overlap + overlap / contact_ratio)
