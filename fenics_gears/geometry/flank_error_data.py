"""Deviations of single teeth as a scene gives them."""

from __future__ import annotations

from dataclasses import dataclass

# Where a measured curve is zero.
REFERENCE_POINT, MEAN = "reference point", "mean"


@dataclass(frozen=True)
class Waviness:
    """Undulation of all flanks of a gear, ``amplitude`` mm, ``waves`` a turn, ``phase`` in rad."""

    amplitude: float
    waves: int
    phase: float = 0.0


@dataclass(frozen=True)
class MeasuredCurve:
    """Deviations (mm, material in excess positive) of one tooth, counted from 1, at rising places; ``places`` as
    ``MeasuredCurves.along`` says."""

    tooth: int
    places: tuple[float, ...]
    deviations: tuple[float, ...]


@dataclass(frozen=True)
class MeasuredCurves:
    """Measured profiles or helices of some teeth of a gear.

    ``along``: what places are, "roll_length" (mm), "roll_angle" (rad) or "diameter" (mm) of a profile, "face_position"
        (mm, from mid-width to the
    right) of a helix.
    """

    along: str
    curves: tuple[MeasuredCurve, ...]


@dataclass(frozen=True)
class GearErrors:
    """Errors of one gear, mm, a value for each tooth; None for what the scene does not give. Those of the helix are
    over the gear's face width.

    ``file``: the table that the values of its ``columns`` are from; ``profile_curves``, ``helix_curves``: the tables of
        measured curves, which are in ``measured_profile``
    and ``measured_helix``, and ``anchor`` says where these are zero; ``problem``: the field that names a wrong table
    and what is wrong, in words, empty where nothing is.
    """

    pitch: tuple[float, ...] | None = None
    profile_slope: tuple[float, ...] | None = None
    profile_form: tuple[float, ...] | None = None
    helix_slope: tuple[float, ...] | None = None
    helix_form: tuple[float, ...] | None = None
    waviness: Waviness | None = None
    file: str | None = None
    columns: tuple[str, ...] = ()
    profile_curves: str | None = None
    helix_curves: str | None = None
    measured_profile: MeasuredCurves | None = None
    measured_helix: MeasuredCurves | None = None
    anchor: str = REFERENCE_POINT
    problem: tuple[str, str] | tuple[()] = ()


@dataclass(frozen=True)
class FlankErrors:
    """Errors of both gears' drive flanks; what is not given is drawn within a flank tolerance class, zero without
    one."""

    pinion: GearErrors = GearErrors()
    wheel: GearErrors = GearErrors()
    tolerance_class: int | None = None
    seed: int = 1
