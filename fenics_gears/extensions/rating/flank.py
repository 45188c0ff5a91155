"""Contact stress and its limit by ISO 6336-2:2006, method B, for endurance (Z_NT = 1), and equal hardness of both gears
(Z_W = 1)."""

from dataclasses import dataclass
from math import cos, pi, sin, sqrt, tan

from .load_factors import LoadFactors, contact_ratio_factor
from .operation import Operation


@dataclass(frozen=True)
class FlankStress:
    """Nominal stress sigma_H0 (MPa) at the pitch point, stress sigma_H of pinion and wheel, and the limit sigma_HG."""

    nominal: float
    stress: tuple[float, float]
    limit: float


def flank_stress(operation: Operation, factors: LoadFactors) -> FlankStress:
    """Stresses of both gears by Z_H, Z_E, Z_eps, Z_beta, Z_B and Z_D."""
    pair = operation.pair
    ratio = pair.wheel.teeth / pair.pinion.teeth
    area = 2.0 * pair.pinion.reference_radius * operation.face_width
    finish = operation.finish
    load = operation.tangential_force / area * (ratio + 1.0) / ratio
    by_shape = zone_factor(operation) * elasticity_factor(operation) * contact_ratio_factor(operation)
    nominal = by_shape * sqrt(load / cos(operation.helix_angle))
    raised = nominal * sqrt(finish.application_factor * factors.dynamic * factors.face * factors.transverse)
    of_gears = tuple(raised * each for each in single_pair_factors(operation))
    return FlankStress(nominal, of_gears, finish.flank_limit * _film(operation))


def zone_factor(operation: Operation) -> float:
    """Z_H."""
    working = operation.pair.operating_pressure_angle
    transverse = operation.pair.pinion.pressure_angle
    return sqrt(2.0 * cos(operation.base_helix_angle) * cos(working) / (cos(transverse) ** 2 * sin(working)))


def elasticity_factor(operation: Operation) -> float:
    """Z_E, sqrt(MPa)."""
    return 1.0 / sqrt(pi * sum((1.0 - each.poissons_ratio**2) / each.youngs_modulus for each in operation.materials))


def single_pair_factors(operation: Operation) -> tuple[float, float]:
    """Z_B and Z_D: from the pitch point to the inner points of single contact; with an overlap they lose their
    weight."""
    pair = operation.pair
    working = pair.operating_pressure_angle
    overlap = min(pair.overlap_ratio, 1.0)

    # Where contact ends on either gear: at the tip, at its chamfer, or where the mate is cut away.
    ends = pair.pinion_roll_angle(pair.path_end), pair.wheel_roll_angle(pair.path_start)
    pitches = [gear.angular_pitch for gear in pair.gears]

    def factor(own: int, other: int) -> float:
        before = ends[own] - pitches[own]
        behind = ends[other] - (pair.contact_ratio - 1.0) * pitches[other]
        return tan(working) / sqrt(before * behind)

    pinion, wheel = (max(each - overlap * (each - 1.0), 1.0) for each in (factor(0, 1), factor(1, 0)))
    return pinion, wheel


def _film(operation: Operation) -> float:
    """Z_L Z_v Z_R: oil, speed and roughness."""
    finish = operation.finish
    limit = min(max(finish.flank_limit, 850.0), 1200.0)
    oil = limit / 4375.0 + 0.6357
    lubricant = oil + 4.0 * (1.0 - oil) / (1.2 + 134.0 / finish.viscosity_grade) ** 2
    speed = oil + 0.02 + 2.0 * (0.98 - oil) / sqrt(0.8 + 32.0 / operation.pitch_line_speed)
    rough = finish.flank_roughness * (10.0 / operation.reduced_radius) ** (1.0 / 3.0)
    return lubricant * speed * (3.0 / rough) ** (0.32 - 2e-4 * limit)
