"""Deviations of the teeth of both gears, as a scene gives them: ``[flank_errors]``."""

from dataclasses import dataclass, replace

from fenics_gears.inputs.fields import choice, file_name, quantities, quantity, whole_number
from fenics_gears.inputs.section import Section
from fenics_gears.inputs.tree import PerGear

# Where a measured curve is zero.
REFERENCE_POINT = "reference point"
MEAN = "mean"
HELIX = ("helix_slope", "helix_form")
LISTS = ("pitch", "profile_slope", "profile_form", *HELIX)


def lists_of(scene) -> tuple[str, ...]:
    """The deviations that teeth of a scene have."""
    return LISTS if scene.three_dimensional else tuple(name for name in LISTS if name not in HELIX)


# Tables of curves: the field of their data, and the name of the columns that say where a point lies.
CURVES = {"profile_curves": ("measured_profile", "ALONG_PROFILE"), "helix_curves": ("measured_helix", "ALONG_FACE")}
REPLACED = {"profile_curves": ("profile_slope", "profile_form"), "helix_curves": HELIX}
TABLES = ("file", *CURVES)


def _deviations(example: str, meaning: str, over_face: bool = False, closed: bool = False):
    drawn = "random values within `tolerance_class`; without a class, zero"
    otherwise = f"{drawn}; not allowed in a plane scene" if over_face else drawn
    limits = "-100 mm to 100 mm"
    marks = {"over_face": over_face, "closed": closed}
    return quantities(limits, example, meaning=meaning, otherwise=otherwise, small=True, **marks)


@dataclass(frozen=True)
class Waviness(Section):
    """``[flank_errors.pinion.waviness]`` and the wheel's: a sinusoidal undulation around the gear."""

    amplitude: float = quantity(
        "1e-6 um to 100 mm",
        "1 um",
        meaning="amplitude",
        below="For flanks without waviness, leave the section out.",
        small=True,
    )
    waves: int = whole_number(1, 1_000_000, 37, meaning="number of waves per revolution of the gear")
    phase: float = quantity(
        "-360 deg to 360 deg", "90 deg", meaning="phase of the wave at the first tooth", default="0 deg"
    )


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
    (mm, from mid-width to the right) of a helix.
    """

    along: str
    curves: tuple[MeasuredCurve, ...]


@dataclass(frozen=True, kw_only=True)
class GearErrors(Section):
    """``[flank_errors.pinion]`` and ``[flank_errors.wheel]``: deviations of each tooth, as lists or as a table in a
    file."""

    file: str | None = file_name(
        ".csv",
        "pinion.csv",
        meaning=(
            "table with a line for each tooth: the column `tooth`, counted from 1, and any of the columns `pitch (um)`,"
            " `profile_slope (um)`, `profile_form (um)`, `helix_slope (um)` and `helix_form (um)`; relative to the"
            " folder of the scene file"
        ),
        otherwise="no table",
    )

    pitch: tuple[float, ...] | None = _deviations(
        "3.5 um", "single pitch deviations, positive where the pitch is too long; their sum must be zero", closed=True
    )
    profile_slope: tuple[float, ...] | None = _deviations(
        "4 um", "profile slope deviations, positive with material in excess towards the tip"
    )
    profile_form: tuple[float, ...] | None = _deviations(
        "3 um", "profile form deviations, positive with material in excess in the middle of the flank"
    )
    helix_slope: tuple[float, ...] | None = _deviations(
        "5 um",
        "helix slope deviations over the face width, positive with material in excess towards the right end",
        over_face=True,
    )
    helix_form: tuple[float, ...] | None = _deviations(
        "3 um", "helix form deviations, positive with material in excess in the middle of the face", over_face=True
    )
    profile_curves: str | None = file_name(
        ".csv",
        "pinion_profile.csv",
        meaning="measured profiles: a table with a line for each point, the columns `tooth`, `deviation (um)`, positive"
        " with material in excess, and `roll_length (mm)`, `roll_angle (deg)` or `diameter (mm)`; a tooth without a"
        " curve has the mean of the curves; in place of `profile_slope` and `profile_form`",
        otherwise="no curves",
    )
    helix_curves: str | None = file_name(
        ".csv",
        "pinion_helix.csv",
        meaning="measured helices: the same with `face_position (mm)` from mid-width to the right; in place of"
        " `helix_slope` and `helix_form`",
        otherwise="no curves; not allowed in a plane scene",
        over_face=True,
    )
    anchor: str = choice(
        REFERENCE_POINT,
        MEAN,
        meaning=(
            "where measured curves are zero: at the V point of a profile, on the cylinder of diameter d + 2 x m (ISO"
            " 21771), and at mid-width of a helix, each within the active profile and the face; or in the mean over"
            " them"
        ),
        default=REFERENCE_POINT,
        otherwise=f'"{REFERENCE_POINT}"',
    )
    waviness: Waviness | None = None
    # Of a gear with several mates, whose pitches are listed as another mesh counts its teeth: which of them is the
    # first one here.
    first: int = 0
    # Read from the tables: the columns of `file`, whose values are in the fields of these names, and the measured
    # curves. `problem`: the field that names a wrong table, and what is wrong.
    columns: tuple[str, ...] = ()
    measured_profile: MeasuredCurves | None = None
    measured_helix: MeasuredCurves | None = None
    problem: tuple[str, str] | tuple[()] = ()

    @property
    def in_the_mean(self) -> bool:
        """Whether measured curves are zero in the mean and not at one place."""
        return self.anchor == MEAN


@dataclass(frozen=True, kw_only=True)
class FlankErrors(Section, PerGear):
    """``[flank_errors]``: deviations that are not given are random values within a tolerance class."""

    tolerance_class: int | None = whole_number(
        1,
        11,
        6,
        meaning="flank tolerance class of ISO 1328-1 that limits the random deviations",
        otherwise="no random deviations",
    )
    seed: int = whole_number(0, 2**31 - 1, 1, meaning="seed of the random numbers", default=1)
    pinion: GearErrors = GearErrors()
    wheel: GearErrors = GearErrors()


def counted_from(own: GearErrors, first: int, teeth: int, turn: float) -> GearErrors:
    """Deviations of a gear of so many `teeth` as they are counted from the tooth `first`, 0 for the first one that is
    listed; `turn` (rad): from one tooth to the next, as of Side. Pitches stay as they are."""

    def rolled(name: str) -> tuple[float, ...] | None:
        values = getattr(own, name)
        return None if values is None else (*values[first:], *values[:first])

    def moved(measured: MeasuredCurves | None) -> MeasuredCurves | None:
        if measured is None:
            return None
        curves = [replace(each, tooth=(each.tooth - 1 - first) % teeth + 1) for each in measured.curves]
        return replace(measured, curves=tuple(curves))

    lists = {name: rolled(name) for name in LISTS if name != "pitch"}
    waves = own.waviness
    if waves is not None:
        waves = replace(waves, phase=waves.phase + waves.waves * turn * first)
    curves = {"measured_profile": moved(own.measured_profile), "measured_helix": moved(own.measured_helix)}
    # The values of a table are lists now.
    return replace(own, **lists, **curves, waviness=waves, file=None, columns=())
