"""Advice that helps: of the changes that could mend an impossible gear, those after which the pair can run, tried, with
the amount."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from math import cos

from fenics_gears.errors import GeometryError

from .gear_checks import Remedy
from .gear_data import GearPairData
from .involute import centre_distance_of_shifts

# Changes that are tried, in modules; between the last that does not help and the first that does it is halved so often.
STEPS = (0.02, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.75, 0.9, 1.1, 1.3, 1.6, 2.0, 2.5, 3.0, 4.0, 6.0, 9.0, 14.0, 20.0)
# Axes may be far apart by a slip, and only a narrow range helps.
STEPS_OF_AXES = (0.02, 0.1, *(0.25 * number for number in range(1, 25)))
HALVINGS = 6
TEETH_MORE = (1, 2, 3, 4, 6, 8, 10, 12)
# Part of a change by which it may be larger for fewer digits.
ROUNDED = 0.25
# As many changes are told.
MOST_TOLD = 2


def advice(data: GearPairData, remedies: Sequence[Remedy], build: Callable[[GearPairData], object]) -> str:
    """The remedies that help, as the end of a message; ``build`` raises for a pair that cannot run."""
    if not remedies:
        return ""

    def runs(changed: GearPairData) -> bool:
        try:
            build(changed)
        except (GeometryError, ArithmeticError, ValueError):
            return False
        return True

    helpful = []
    for each in remedies:
        helpful += [words for words in (_tried(data, *each, runs),) if words]
        if len(helpful) == MOST_TOLD:
            break
    if helpful:
        return ": " + ", or ".join(helpful)
    fields = dict.fromkeys(f"gears.{field}" for _, field in remedies)
    return (
        f". No change of {' or '.join(fields)} alone mends it: check gears.module, the teeth and all diameters together"
    )


def _tried(data: GearPairData, how: str, field: str, runs: Callable[[GearPairData], bool]) -> str:
    """The change in words, the least that helps; empty where none does."""
    sign = 1.0 if how == "raise" else -1.0
    gear, _, name = field.rpartition(".")
    if name == "teeth":
        more = (number for number in TEETH_MORE if runs(_with_teeth(data, gear, number)))
        number = next(more, None)
        return "" if number is None else _in_words(data, _with_teeth(data, gear, number), how, gear, name)
    change = _with_shift if name == "profile_shift" else _with_size
    low = 0.0
    for high in STEPS_OF_AXES if name == "centre_distance" else STEPS:
        if runs(change(data, gear, name, sign * high)):
            break
        low = high
    else:
        return ""
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if runs(change(data, gear, name, sign * middle)) else (middle, high)
    for step in _round_steps(data, gear, name, sign, high):
        if runs(changed := change(data, gear, name, step)):
            return _in_words(data, changed, how, gear, name)
    return ""


def _round_steps(data: GearPairData, gear: str, name: str, sign: float, step: float) -> Iterator[float]:
    """Steps (modules) at least as large that lead to a number with few digits, the fewest first."""
    size = _value(data, gear, name)
    scale = 1.0 if name in ("profile_shift", "rack_tip_radius") else data.module
    for digits in range(1, 6):
        unit = 10.0 ** (round(_magnitude(size)) - digits)
        reached = size + sign * step * scale
        rounded = unit * (reached // unit + (1.0 if sign > 0.0 else 0.0))
        if abs(rounded - reached) <= ROUNDED * step * scale:
            yield (rounded - size) / scale
    yield sign * step


def _magnitude(size: float) -> int:
    return len(str(int(abs(size)))) if abs(size) >= 1.0 else 0


def _value(data: GearPairData, gear: str, name: str) -> float:
    return getattr(getattr(data, gear) if gear else data, name)


def _with_size(data: GearPairData, gear: str, name: str, step: float) -> GearPairData:
    scale = 1.0 if name == "rack_tip_radius" else data.module
    size = _value(data, gear, name) + step * scale
    return _changed(data, gear, **{name: max(size, 0.0) if name == "rack_tip_radius" else size})


def _with_shift(data: GearPairData, gear: str, name: str, step: float) -> GearPairData:
    """Another profile shift with its diameters, and the axes as far apart, but so far that the teeth have
    room."""
    own = getattr(data, gear)
    wider = step * data.module
    sizes = {each: getattr(own, each) + 2.0 * wider for each in ("tip_diameter", "root_diameter")}
    shifted = _changed(data, gear, profile_shift=own.profile_shift + step, **sizes)
    linear = data.centre_distance + wider
    if linear <= 0.0:
        return replace(shifted, centre_distance=linear)
    teeth = data.pinion.teeth + data.wheel.teeth
    shifts = shifted.pinion.profile_shift + shifted.wheel.profile_shift
    least = centre_distance_of_shifts(teeth, shifts, data.module, data.pressure_angle, data.helix_angle)
    return replace(shifted, centre_distance=max(linear, least))


def _with_teeth(data: GearPairData, gear: str, more: int) -> GearPairData:
    own = getattr(data, gear)
    more = more if own.teeth > 0 else -more
    wider = more * data.module / cos(data.helix_angle)
    sizes = {each: getattr(own, each) + wider for each in ("tip_diameter", "root_diameter")}
    changed = _changed(data, gear, teeth=own.teeth + more, **sizes)
    return replace(changed, centre_distance=data.centre_distance + 0.5 * wider)


def _changed(data: GearPairData, gear: str, **values: float) -> GearPairData:
    return replace(data, **{gear: replace(getattr(data, gear), **values)}) if gear else replace(data, **values)


def _in_words(data: GearPairData, changed: GearPairData, how: str, gear: str, name: str) -> str:
    unit = "" if name in ("profile_shift", "rack_tip_radius", "teeth") else " mm"
    value = _value(changed, gear, name)
    # Diameters of an internal gear are negative here, and written without sign.
    written = value if name in ("profile_shift", "teeth") else abs(value)
    if written != value or name == "teeth" and value < 0:
        how = "change" if name == "teeth" else {"raise": "lower", "lower": "raise"}[how]
    words = f"{how} gears.{gear + '.' if gear else ''}{name} to {written:.6g}{unit}"
    if name not in ("profile_shift", "teeth"):
        return words
    own = getattr(data, gear)
    other = getattr(changed, gear)
    return (
        f"{words} with gears.{gear}.tip_diameter = {abs(other.tip_diameter):.6g} mm, root_diameter ="
        f" {abs(own.root_diameter + other.tip_diameter - own.tip_diameter):.6g} mm and gears.centre_distance ="
        f" {abs(changed.centre_distance):.6g} mm"
    )
