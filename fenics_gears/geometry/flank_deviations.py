"""Deviations of every tooth of a gear: as a scene gives them, or drawn within a flank tolerance class.

A pitch deviation belongs to the reference circle. Slope and form are deviations from the mean of the face, or of the
used flank from the start of active profile to the tip. Slope rises by its value from end to end; form is one wave, as
wide as its value. A measured curve replaces both. It is zero at the V point of the profile or at mid-width of the
helix, or else in its mean: the pitch deviation says where the flank is.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fenics_gears.errors import SceneError
from fenics_gears.inputs.tree import GEARS
from fenics_gears.inputs.written import as_written

from .flank_errors import FlankErrors, GearErrors, MeasuredCurve, MeasuredCurves, Waviness
from .flank_tolerance import FlankTolerance, HelixTolerance, flank_tolerance, helix_tolerance
from .gear import Gear
from .pair import GearPair

# Each has random numbers of its own, so that giving one leaves the others as they are.
PITCH, SLOPE, FORM, HELIX_SLOPE, HELIX_FORM = range(5)
# Evenly spaced points of a measured curve, from one end of the used part to the other.
CURVE_POINTS = 201


@dataclass(frozen=True)
class HelixDeviations:
    """Deviations along the face (z,), mm, over its ``width`` (mm) with mid-width at the height ``middle`` (mm).

    ``slope``: excess of material at the right end over the left one. ``form``: in the middle over both ends. ``curves``
    (z, CURVE_POINTS): measured excess from left to right, in place of both.
    """

    slope: np.ndarray
    form: np.ndarray
    width: float
    middle: float
    curves: np.ndarray | None = None


@dataclass(frozen=True)
class FlankDeviations:
    """Deviations of a gear with z teeth, counted as they mesh: arrays (z,), mm, and the waviness that all share.

    ``index``: cumulative pitch deviation, the arc on the reference circle by which a tooth comes late; zero for the
    last tooth that is listed. ``slope``: excess of material at the tip over the start of active profile. ``form``: in
    the middle over both ends. ``active_profile``: roll angles (rad) of its ends. ``helix``: None in the plane.
    ``curves`` (z, CURVE_POINTS): measured excess over the active profile, in place of slope and form.
    """

    index: np.ndarray
    slope: np.ndarray
    form: np.ndarray
    waviness: Waviness | None
    active_profile: tuple[float, float]
    helix: HelixDeviations | None = None
    curves: np.ndarray | None = None

    @property
    def single_pitch(self) -> np.ndarray:
        """Deviation (z,), mm, of the pitch from the tooth before to each tooth."""
        return np.diff(self.index, prepend=self.index[-1])


def flank_deviations(
    errors: FlankErrors, pair: GearPair, middles: tuple[float, float] | None = None
) -> tuple[FlankDeviations, FlankDeviations]:
    """Deviations of pinion and wheel; `middles` (mm): heights of their mid-widths, None in the plane."""
    gears = zip(pair.gears, errors.of_gears, pair.sap_roll_angles)
    faces = (None, None) if middles is None else tuple(zip(pair.face_widths, middles))
    first, second = (
        _of_gear(gear, own, errors, number, start, faces[number]) for number, (gear, own, start) in enumerate(gears)
    )
    return first, second


def _of_gear(
    gear: Gear, own: GearErrors, errors: FlankErrors, number: int, start: float, face: tuple[float, float] | None
) -> FlankDeviations:
    if own.problem:
        name, problem = own.problem
        raise SceneError(f"flank_errors.{GEARS[number]}.{name} = {as_written(getattr(own, name))}: {problem}")
    measured = own.measured_profile is not None
    level = np.zeros(gear.tooth_count)
    diameter = 2.0 * abs(gear.reference_radius)
    active_profile = (start, gear.tip_roll_angle)
    tolerance_class = errors.tolerance_class

    def values(given: tuple[float, ...] | None, drawn) -> np.ndarray:
        if given is not None:
            return np.array(given, dtype=float)
        return level if tolerance_class is None else drawn()

    def draws(kind: int) -> np.ndarray:
        return np.random.default_rng((errors.seed, number, kind)).uniform(-1.0, 1.0, gear.tooth_count)

    def limits() -> FlankTolerance:
        return flank_tolerance(diameter, gear.normal_module, tolerance_class)

    def along_face(width: float, middle: float) -> HelixDeviations:
        if own.measured_helix is not None:
            zero = None if own.in_the_mean else 0.0
            curves = _curves(own.measured_helix, gear, (-0.5 * width, 0.5 * width), zero)
            return HelixDeviations(level, level, width, middle, curves)

        def helix_limits() -> HelixTolerance:
            return helix_tolerance(diameter, width, tolerance_class)

        slope = values(own.helix_slope, lambda: helix_limits().slope * draws(HELIX_SLOPE))
        form = values(own.helix_form, lambda: helix_limits().form * draws(HELIX_FORM))
        return HelixDeviations(slope, form, width, middle)

    pitch = values(own.pitch, lambda: drawn_pitch(limits(), draws(PITCH)))
    # The mean, left by rounding of the values, is taken off, so that after a turn the first tooth is where it was.
    index = np.cumsum(pitch - pitch.mean())
    zero = None if own.in_the_mean else v_roll_angle(gear)
    return FlankDeviations(
        index=np.roll(index - index[-1], -own.first),
        slope=level if measured else values(own.profile_slope, lambda: limits().profile_slope * draws(SLOPE)),
        form=level if measured else values(own.profile_form, lambda: limits().profile_form * draws(FORM)),
        waviness=own.waviness,
        active_profile=active_profile,
        helix=None if face is None else along_face(*face),
        curves=_curves(own.measured_profile, gear, active_profile, zero) if measured else None,
    )


def v_roll_angle(gear: Gear) -> float:
    """Roll angle (rad) of the V point, on the cylinder of diameter d + 2 x m (ISO 21771)."""
    radius = gear.reference_radius + gear.profile_shift * gear.module
    return float(np.sqrt(max((radius / gear.base_radius) ** 2 - 1.0, 0.0)))


def _curves(measured: MeasuredCurves, gear: Gear, ends: tuple[float, float], zero: float | None) -> np.ndarray:
    """Deviations (z, CURVE_POINTS), mm, at even steps between the ends (rad or mm), the mean curve for a tooth that was
    not measured. `zero`: where each curve is zero, None for its mean."""
    at = np.linspace(*ends, CURVE_POINTS)
    by_tooth = {
        each.tooth: np.interp(at, _places(each, measured.along, gear), each.deviations) for each in measured.curves
    }
    mean = np.mean(list(by_tooth.values()), axis=0)
    curves = np.array([by_tooth.get(tooth, mean) for tooth in range(1, gear.tooth_count + 1)])
    if zero is not None:
        return curves - np.array([np.interp(zero, at, curve) for curve in curves])[:, None]
    sums = curves.mean(axis=1) * CURVE_POINTS - 0.5 * (curves[:, 0] + curves[:, -1])
    return curves - sums[:, None] / (CURVE_POINTS - 1)


def _places(curve: MeasuredCurve, along: str, gear: Gear) -> np.ndarray:
    """Roll angles (rad) of a profile's points, 0 below the base circle; positions on the face (mm) of a helix's."""
    places = np.array(curve.places)
    if along == "roll_length":
        return places / gear.base_radius
    if along == "diameter":
        return np.sqrt(np.maximum((0.5 * places / gear.base_radius) ** 2 - 1.0, 0.0))
    return places


def measured_share(curve: MeasuredCurve, along: str, pair: GearPair, name: str) -> float:
    """Share of the active profile, or of the face, of the gear `name` that a curve covers, from 0 to 1."""
    number = GEARS.index(name)
    gear = pair.gears[number]
    width = pair.face_widths[number]
    start = pair.sap_roll_angles[number]
    end = gear.tip_roll_angle
    if along == "face_position":
        start = -0.5 * width
        end = 0.5 * width
    places = _places(curve, along, gear)
    return max(min(places[-1], end) - max(places[0], start), 0.0) / (end - start)


def slope_and_form(deviations: FlankDeviations | HelixDeviations) -> tuple[np.ndarray, np.ndarray]:
    """Slope and form deviations (z,), mm: as given, or of measured curves by ISO 1328-1, the rise of the line of least
    squares and the range of what it leaves."""
    if deviations.curves is None:
        return deviations.slope, deviations.form
    along = np.linspace(-0.5, 0.5, CURVE_POINTS)
    slope = deviations.curves @ along / (along @ along)
    return slope, np.ptp(deviations.curves - np.outer(slope, along), axis=1)


def drawn_pitch(limits: FlankTolerance, draws: np.ndarray) -> np.ndarray:
    """Single pitch deviations (z,), mm, in proportion to `draws` (z,) less their mean, of a gear just within its class:
    the single or the cumulative one reaches its tolerance."""
    pitch = draws - draws.mean()
    cumulative = np.ptp(np.cumsum(pitch))
    return pitch * min(limits.single_pitch / np.abs(pitch).max(), limits.cumulative_pitch / cumulative)
