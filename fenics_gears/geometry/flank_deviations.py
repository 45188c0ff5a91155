"""Deviations of every tooth of a gear: as a scene gives them, or drawn within a flank tolerance class.

A pitch deviation belongs to the reference circle. Slope and form are deviations from the mean of the flank's used part, from the start of
active profile to the tip, so that they do not displace the flank as a whole: slope rises by its value from one end to the
other, form is one wave over that length, as wide as its value. Slope and form of the helix are the like along the face of the gear, and are only there
where flanks have one.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fenics_gears.geometry.flank_error_data import FlankErrors, GearErrors, Waviness
from fenics_gears.geometry.flank_tolerance import FlankTolerance, flank_tolerance, helix_tolerance
from fenics_gears.geometry.gear import Gear
from fenics_gears.geometry.pair import GearPair

PITCH, SLOPE, FORM, HELIX_SLOPE, HELIX_FORM = range(5)  # each has random numbers of its own, so that giving one leaves the others as they are


@dataclass(frozen=True)
class HelixDeviations:
    """Deviations along the face (z,), mm, over its ``width`` (mm) with mid-width at the height ``middle`` (mm).

    ``slope``: excess of material at the right end over that at the left one. ``form``: excess in the middle over that at both ends.
    """

    slope: np.ndarray
    form: np.ndarray
    width: float
    middle: float


@dataclass(frozen=True)
class FlankDeviations:
    """Deviations of a gear with z teeth, counted as they mesh: arrays (z,), mm, and the waviness that all share.

    ``index``: cumulative pitch deviation, the arc on the reference circle by which a tooth comes late; zero for the last tooth. ``slope``: excess of material at the tip over that at the start of active profile. ``form``: excess in the middle over that at
    both ends. ``active_profile``: roll angles (rad) of its start and its end. ``helix``: None in the plane.
    """

    index: np.ndarray
    slope: np.ndarray
    form: np.ndarray
    waviness: Waviness | None
    active_profile: tuple[float, float]
    helix: HelixDeviations | None = None

    @property
    def single_pitch(self) -> np.ndarray:
        """Deviation (z,), mm, of the pitch from the tooth before to each tooth."""
        return np.diff(self.index, prepend=self.index[-1])


def flank_deviations(errors: FlankErrors, pair: GearPair, middles: tuple[float, float] | None = None) -> tuple[FlankDeviations, FlankDeviations]:
    """Deviations of pinion and wheel; `middles` (mm): heights of their mid-widths, None in the plane."""
    gears = zip((pair.pinion, pair.wheel), (errors.pinion, errors.wheel), pair.sap_roll_angles)
    faces = (None, None) if middles is None else tuple(zip(pair.face_widths, middles))
    return tuple(_of_gear(gear, own, errors, number, start, faces[number]) for number, (gear, own, start) in enumerate(gears))


def _of_gear(
    gear: Gear, own: GearErrors, errors: FlankErrors, number: int, start: float, face: tuple[float, float] | None
) -> FlankDeviations:
    tolerance = None
    if errors.tolerance_class is not None:
        tolerance = flank_tolerance(2.0 * gear.reference_radius, gear.normal_module, errors.tolerance_class)

    def draws(kind: int) -> np.ndarray:
        return np.random.default_rng((errors.seed, number, kind)).uniform(-1.0, 1.0, gear.teeth)

    def values(given: tuple[float, ...] | None, drawn) -> np.ndarray:
        if given is not None:
            return np.array(given, dtype=float)
        return np.zeros(gear.teeth) if tolerance is None else drawn(tolerance)

    def along_face(width: float, middle: float) -> HelixDeviations:
        allowed = None if tolerance is None else helix_tolerance(2.0 * gear.reference_radius, width, errors.tolerance_class)
        slope = values(own.helix_slope, lambda limits: allowed.slope * draws(HELIX_SLOPE))
        return HelixDeviations(slope, values(own.helix_form, lambda limits: allowed.form * draws(HELIX_FORM)), width, middle)

    pitch = values(own.pitch, lambda limits: drawn_pitch(limits, draws(PITCH)))
    # The mean, left by rounding of the values, is taken off, so that after a turn the first tooth stands where it was.
    index = np.cumsum(pitch - pitch.mean())
    return FlankDeviations(
        index=index - index[-1],
        slope=values(own.profile_slope, lambda limits: limits.profile_slope * draws(SLOPE)),
        form=values(own.profile_form, lambda limits: limits.profile_form * draws(FORM)),
        waviness=own.waviness,
        active_profile=(start, gear.tip_roll_angle),
        helix=None if face is None else along_face(*face),
    )


def drawn_pitch(limits: FlankTolerance, draws: np.ndarray) -> np.ndarray:
    """Single pitch deviations (z,), mm, of a gear just within its class: the single or the cumulative one reaches its tolerance.

    ``draws`` (z,): random numbers between -1 and 1.
    """
    pitch = draws - draws.mean()
    cumulative = np.ptp(np.cumsum(pitch))
    return pitch * min(limits.single_pitch / np.abs(pitch).max(), limits.cumulative_pitch / cumulative)
