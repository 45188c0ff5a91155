"""Profile shifts that a scene leaves out. Loaded where it does.

Without a centre distance they are 0. With it one of them is what that of the mate leaves of their sum (ISO 21771):
x1 + x2 = (z1 + z2) (inv(alpha_wt) - inv(alpha_t)) / (2 tan(alpha_n)), without backlash.
"""

from dataclasses import replace
from math import acos

from fenics_gears.geometry.gear import DECIMALS_IN_MODULES
from fenics_gears.geometry.gear_checks import refuse
from fenics_gears.geometry.involute import sum_of_profile_shifts
from fenics_gears.inputs.tree import GEARS

from .gear_schema import Gears
from .schema import Derived

BY_DISTANCE = "x1 + x2 = (z1 + z2) (inv(alpha_wt) - inv(alpha_t))/(2 tan(alpha_n)), without backlash"


def with_profile_shifts(pair: Gears) -> tuple[Gears, list[Derived]]:
    """The section with the profile shift of either gear, where no measure gives it, and what was derived. Raises
    GeometryError where the centre distance fixes the sum of two shifts alone."""
    given = pair.pinion, pair.wheel
    left_out = [name for name, gear in zip(GEARS, given) if gear.profile_shift is None and gear.measure is None]
    total = 0.0 if pair.centre_distance is None else _sum_of_shifts(pair)
    shifts = dict.fromkeys(left_out, 0.0)
    formula = "0 where it is left out"
    if pair.centre_distance is not None and len(left_out) == 1:
        (name,) = left_out
        mate = given[1 - GEARS.index(name)]
        if mate.profile_shift is not None:
            shifts[name] = round(total - mate.profile_shift, DECIMALS_IN_MODULES)
            formula = BY_DISTANCE
        else:
            refuse(
                name,
                f"gears.{name}.profile_shift is missing; with gears.centre_distance and a measured tooth thickness of"
                f" the other gear it does not follow. Allowed: gears.{name}.profile_shift, or a measured thickness",
            )
    elif abs(round(total, DECIMALS_IN_MODULES)) > 0.0:
        refuse(
            "pair",
            f"both profile shifts are left out, and gears.centre_distance = {pair.centre_distance:.6g} mm gives only"
            f" their sum, {total:.6g}: give gears.pinion.profile_shift or gears.wheel.profile_shift",
        )
    completed = {name: replace(getattr(pair, name), profile_shift=shift) for name, shift in shifts.items()}
    words = [Derived(f"{name} profile shift", shift, "modules", formula) for name, shift in shifts.items()]
    return replace(pair, **completed), words


def _sum_of_shifts(pair: Gears) -> float:
    """Sum of both profile shifts that leaves no backlash at the centre distance; 0 where that is too small for any."""
    teeth = pair.pinion.teeth + pair.wheel.teeth
    sign = 1.0 if pair.wheel.teeth > 0 else -1.0
    without_shift = pair.rack_gear(pair.pinion.teeth, 0.0)
    bases = without_shift.base_radius / pair.pinion.teeth * teeth
    cosine = bases / (sign * pair.centre_distance)
    if not cosine < 1.0:
        return 0.0
    return sum_of_profile_shifts(teeth, acos(cosine), without_shift.pressure_angle, pair.pressure_angle)
