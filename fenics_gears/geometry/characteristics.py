"""The pair's characteristic data in the terms of the field, for ``gears check`` to print."""

from __future__ import annotations

from math import degrees

from fenics_gears.geometry.gear import Gear
from fenics_gears.geometry.gear_checks import ROUNDING
from fenics_gears.geometry.pair import GearPair
from fenics_gears.geometry.sliding import specific_sliding


def characteristics(pair: GearPair) -> list[tuple[str, float, str]]:
    """Rows (label, value, unit) on the pair, then on each gear; lengths in mm, angles in deg."""
    return [*_pair_rows(pair), *_pinion_rows(pair), *_wheel_rows(pair)]


def _rounded(length: float) -> float:
    """A length (mm), zero where it is a rounding error."""
    return 0.0 if abs(length) < ROUNDING else length


def _pair_rows(pair: GearPair) -> list[tuple[str, float, str]]:
    return [
        ("operating pressure angle", degrees(pair.operating_pressure_angle), "deg"),
        ("base pitch", pair.base_pitch, "mm"),
        ("contact ratio", pair.contact_ratio, ""),
        ("length of the line of action T1 to T2", pair.line_of_action_length, "mm"),
        ("start of contact, from T1", pair.path_start, "mm"),
        ("pitch point, from T1", pair.pitch_point, "mm"),
        ("end of contact, from T1", pair.path_end, "mm"),
        ("pitch point, from T2 (e)", pair.pitch_point_to_wheel_tangent, "mm"),
        ("backlash along the line of action", _rounded(pair.backlash), "mm"),
        ("centre distance without backlash", pair.centre_distance_without_backlash, "mm"),
    ]


def _pinion_rows(pair: GearPair) -> list[tuple[str, float, str]]:
    return [
        *_gear_rows(pair.pinion, "pinion", pair.pinion_tip_clearance),
        ("pinion roll angle, start of active profile", degrees(pair.pinion_sap_roll_angle), "deg"),
        ("pinion roll angle, LPSTC", degrees(pair.pinion_lpstc_roll_angle), "deg"),
        ("pinion roll angle, HPSTC", degrees(pair.pinion_hpstc_roll_angle), "deg"),
        ("pinion roll angle, tip", degrees(pair.pinion_eap_roll_angle), "deg"),
        *_sliding_rows(pair, 0, "pinion", pair.path_start, pair.path_end),
    ]


def _wheel_rows(pair: GearPair) -> list[tuple[str, float, str]]:
    return [
        *_gear_rows(pair.wheel, "wheel", pair.wheel_tip_clearance),
        ("wheel roll angle, start of active profile", degrees(pair.wheel_sap_roll_angle), "deg"),
        ("wheel roll angle, LPSTC", degrees(pair.wheel_lpstc_roll_angle), "deg"),
        ("wheel roll angle, HPSTC", degrees(pair.wheel_hpstc_roll_angle), "deg"),
        ("wheel roll angle, tip", degrees(pair.wheel_eap_roll_angle), "deg"),
        *_sliding_rows(pair, 1, "wheel", pair.path_end, pair.path_start),
    ]


def _sliding_rows(pair: GearPair, gear: int, name: str, lowest: float, highest: float) -> list[tuple[str, float, str]]:
    """Specific sliding of a gear where its active profile starts and at its tip, positions (mm) on the line of action."""
    return [
        (f"{name} specific sliding, start of active profile", float(specific_sliding(pair, lowest)[gear]), ""),
        (f"{name} specific sliding, tip", float(specific_sliding(pair, highest)[gear]), ""),
    ]


def _gear_rows(gear: Gear, name: str, tip_clearance: float) -> list[tuple[str, float, str]]:
    return [
        (f"{name} reference diameter", 2.0 * gear.reference_radius, "mm"),
        (f"{name} base diameter", 2.0 * gear.base_radius, "mm"),
        (f"{name} form diameter", 2.0 * gear.form_radius, "mm"),
        (f"{name} dedendum", gear.dedendum / gear.module, "modules"),
        (f"{name} tooth thickness at the tip", gear.tip_thickness, "mm"),
        (f"{name} tip clearance", tip_clearance, "mm"),
        (f"{name} roll angle, form circle", degrees(gear.form_roll_angle), "deg"),
    ]
