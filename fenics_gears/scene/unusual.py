"""Remarks on derived figures that leave what is usual: one of the figures they follow from is then likely wrong. None
of them is refused."""

from math import tan

from .gear_schema import Gears

# Modules. Charts for the choice of profile shifts, as in DIN 3992 and ISO/TR 4467, stay within about these.
USUAL_SHIFTS = (-0.5, 1.0)
# Modules; profile shifts of 1.2 in sum need 0.18 with 40 teeth in sum, and less with more teeth.
LARGEST_SHORTENING = 0.2


def recommended_backlash(module: float, distance: float) -> float:
    """Smallest recommended normal backlash, mm, of ISO/TR 10064-2 (annex A): 2/3 (0.06 + 0.0005 a + 0.03 m_n)."""
    return 2.0 / 3.0 * (0.06 + 0.0005 * distance + 0.03 * module)


def of_profile_shift(name: str, shift: float) -> str:
    """Of a profile shift that follows from a measured thickness alone."""
    low, high = USUAL_SHIFTS
    if low <= shift <= high:
        return ""
    return (
        f"{name}: the profile shift that follows from its tooth thickness is {shift:.3g} modules; usual are {low:g} "
        f"to {high:g}: check the measure, gears.{name}.teeth and gears.module"
    )


def of_allowance(pair: Gears, name: str, allowance: float, distance: float) -> str:
    """Of a measured tooth thickness that departs from that of the profile shift by `allowance`, modules of profile
    shift."""
    thickness = 2.0 * allowance * pair.module * tan(pair.pressure_angle)
    usual = recommended_backlash(pair.module, distance)
    if abs(thickness) <= usual:
        return ""
    return (
        f"{name}: the measured tooth thickness is {abs(thickness):.3g} mm {'more' if thickness > 0.0 else 'less'} "
        f"than that of profile_shift; allowances are usually less than {usual:.2g} mm (2/3 (0.06 + 0.0005 a + 0.03 "
        f"m_n) of ISO/TR 10064-2): check the measure and gears.{name}.profile_shift"
    )


def of_thinning(pair: Gears, overlap: float, distance: float, nominal_distance: float, thinner: float) -> str:
    """Of teeth that the centre distance makes thinner, beyond their backlash. `overlap`, mm: along the pitch circles,
    of teeth with the profile shifts of the scene."""
    usual = recommended_backlash(pair.module, distance)
    if overlap <= usual:
        return ""
    return (
        f"gears.centre_distance = {distance:.6g} mm is {nominal_distance - distance:.3g} mm less than that of both "
        f"profile shifts without backlash: their teeth would overlap by {overlap:.3g} mm and were made {thinner:.3g} "
        f"mm thinner on each gear to fit with gears.backlash = {pair.backlash:.4g} mm; usual is an overlap of less "
        f"than {usual:.2g} mm (ISO/TR 10064-2): check gears.centre_distance and both profile shifts"
    )


def of_shortening(shortening: float) -> str:
    """Of tips that the centre distance makes shorter."""
    if shortening <= LARGEST_SHORTENING:
        return ""
    return (
        f"both tips were shortened by {shortening:.3g} modules to keep the tip clearance; usual are "
        f"{LARGEST_SHORTENING:g} at most: check gears.centre_distance and both profile shifts"
    )
