"""The characteristic data of a pair, as ``gears check`` prints them, and what points of its path are called."""

from math import atan, cos, degrees

from fenics_gears.inputs.tree import GEARS

from .gear import Gear
from .gear_data import NOT_GIVEN, ROUNDING, MeasuredOver
from .pair import GearPair
from .sliding import specific_sliding
from .tooth_thickness import ball_diameter, base_tangent_length, dimension_over_balls, normal_thickness, spanned_teeth


def characteristics(
    pair: GearPair, measured_over: MeasuredOver = (NOT_GIVEN, NOT_GIVEN)
) -> list[tuple[str, float, str]]:
    """Rows (label, value, unit) on the pair, then on each gear; lengths in mm, angles in deg. `measured_over`: teeth
    that are spanned and diameter of the ball of either gear, None for what suits the gear."""
    of_gears = [row for name, own in zip(GEARS, measured_over) for row in _gear_rows(pair, name, own)]
    return [*_pair_rows(pair), *of_gears]


def _rounded(length: float) -> float:
    return 0.0 if abs(length) < ROUNDING else length


def _pair_rows(pair: GearPair) -> list[tuple[str, float, str]]:
    # Before what follows from it: one that is round-off is none, whatever it is measured along.
    backlash = _rounded(pair.backlash)
    return [
        ("operating pressure angle", degrees(pair.operating_pressure_angle), "deg"),
        ("base pitch", pair.base_pitch, "mm"),
        ("contact ratio", pair.contact_ratio, ""),
        *(_helix_rows(pair) if pair.helix is not None else []),
        ("length of the line of action T1 to T2", abs(pair.line_of_action_length), "mm"),
        ("start of contact, from T1", pair.path_start, "mm"),
        ("pitch point, from T1", pair.pitch_point, "mm"),
        ("end of contact, from T1", pair.path_end, "mm"),
        ("pitch point, from T2 (e)", abs(pair.pitch_point_to_wheel_tangent), "mm"),
        ("backlash along the line of action", backlash, "mm"),
        ("circumferential backlash at the pitch circles (j_wt)", backlash / cos(pair.operating_pressure_angle), "mm"),
        *([("normal backlash (j_bn)", backlash * pair.cosine, "mm")] if pair.helix is not None else []),
        ("centre distance without backlash", abs(pair.centre_distance_without_backlash), "mm"),
    ]


def _helix_rows(pair: GearPair) -> list[tuple[str, float, str]]:
    return [
        ("overlap ratio", pair.overlap_ratio, ""),
        ("total contact ratio", pair.total_contact_ratio, ""),
        ("helix angle at the reference cylinder", degrees(pair.pinion.helix_angle), "deg"),
        ("base helix angle", degrees(atan(abs(pair.slope))), "deg"),
        ("transverse module", pair.pinion.module, "mm"),
        ("transverse pressure angle", degrees(pair.pinion.pressure_angle), "deg"),
    ]


def _measures(gear: Gear, measured_over: tuple[int | None, float | None]) -> list[tuple[str, float, str]]:
    """Over teeth and balls; of an internal gear, whose spaces no caliper spans, between balls."""
    teeth, ball = measured_over
    ball = ball or ball_diameter(gear)
    if gear.internal:
        return [(f"dimension between balls of {ball:.6g} mm (M_d)", -dimension_over_balls(gear, ball), "mm")]
    teeth = teeth or spanned_teeth(gear)
    return [
        (f"base tangent length over {teeth} teeth (W_k)", base_tangent_length(gear, teeth), "mm"),
        (f"dimension over balls of {ball:.6g} mm (M_d)", dimension_over_balls(gear, ball), "mm"),
    ]


def contact_by_fewest(pair: GearPair) -> tuple[str, str]:
    """Name of contact by the fewest pairs, and its letters in LPSTC and HPSTC: "single tooth contact", "STC". Above a
    contact ratio of 2 no pair is ever alone."""
    pairs = max(pair.fewest_pairs, 1)
    known = {1: ("single tooth contact", "STC"), 2: ("double tooth contact", "DTC")}
    return known.get(pairs, (f"contact by {pairs} pairs", f"{pairs}TC"))


def _gear_rows(
    pair: GearPair, name: str, measured_over: tuple[int | None, float | None]
) -> list[tuple[str, float, str]]:
    gear = getattr(pair, name)
    number = GEARS.index(name)
    # Where its active profile starts and where its tip meets the mate.
    lowest, tip = (pair.path_start, pair.path_end) if name == "pinion" else (pair.path_end, pair.path_start)
    contact, letters = contact_by_fewest(pair)
    lowest_words, highest_words = (
        "" if letters == "STC" else f", {which} point of {contact}" for which in ("lowest", "highest")
    )
    rows = [
        ("reference diameter", 2.0 * abs(gear.reference_radius), "mm"),
        ("base diameter", 2.0 * abs(gear.base_radius), "mm"),
        ("form diameter", 2.0 * abs(gear.form_radius), "mm"),
        ("diameter, start of active profile (SAP)", 2.0 * abs(float(gear.radius(pair.sap_roll_angles[number]))), "mm"),
        ("diameter, end of active profile (EAP)", 2.0 * abs(float(gear.radius(pair.eap_roll_angles[number]))), "mm"),
        ("tip form diameter", 2.0 * abs(gear.tip_form_radius), "mm"),
        *([("width of the web over the face width", gear.web.share, "")] if gear.web is not None else []),
        *([("offset of the web over the face width", gear.web.offset, "")] if gear.web and gear.web.offset else []),
        ("dedendum", gear.dedendum / gear.normal_module, "modules"),
        ("normal tooth thickness at the reference circle", normal_thickness(gear), "mm"),
        *_measures(gear, measured_over),
        ("tooth thickness at the tip", gear.tip_thickness, "mm"),
        ("tip clearance", pair.tip_clearances[number], "mm"),
        ("roll angle, form circle", degrees(gear.form_roll_angle), "deg"),
        ("roll angle, start of active profile", degrees(pair.sap_roll_angles[number]), "deg"),
        (f"roll angle, LP{letters}", degrees(pair.lpstc_roll_angles[number]), f"deg{lowest_words}"),
        (f"roll angle, HP{letters}", degrees(pair.hpstc_roll_angles[number]), f"deg{highest_words}"),
        ("roll angle, tip", degrees(gear.tip_roll_angle), "deg"),
        ("specific sliding, start of active profile", float(specific_sliding(pair, lowest)[number]), ""),
        ("specific sliding, tip", float(specific_sliding(pair, tip)[number]), ""),
    ]
    return [(f"{name} {label}", value, unit) for label, value, unit in rows]
