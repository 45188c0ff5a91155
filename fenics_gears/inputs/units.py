"""Quantities with units, converted once to N, mm, s and rad.

The list of units is closed: no prefix is guessed, so that "Mm" is a mistake. An angle has a dimension of its own, so
that "N m" is no torsional stiffness and "Hz" no angular speed.
"""

import functools
import math
import re
from collections import Counter

from .problem import did_you_mean

# What the units of the program measure.
# A ratio is a dimension too, so that a percentage is no bare number.
_BASE = {"mm": "length", "N": "force", "s": "time", "rad": "angle", "ratio": "ratio"}
# Each further unit as a number of units above it.
_UNITS = {
    "mm": (1.0, "mm"),
    "um": (0.001, "mm"),
    "cm": (10.0, "mm"),
    "dm": (100.0, "mm"),
    "m": (1000.0, "mm"),
    "in": (25.4, "mm"),
    "ft": (304.8, "mm"),
    "mil": (0.0254, "mm"),
    "N": (1.0, "N"),
    "mN": (0.001, "N"),
    "kN": (1000.0, "N"),
    "MN": (1e6, "N"),
    "lbf": (4.4482216152605, "N"),
    "s": (1.0, "s"),
    "us": (1e-6, "s"),
    "ms": (0.001, "s"),
    "min": (60.0, "s"),
    "h": (3600.0, "s"),
    "rad": (1.0, "rad"),
    "mrad": (0.001, "rad"),
    "urad": (1e-6, "rad"),
    "deg": (math.pi / 180, "rad"),
    "degree": (1.0, "deg"),
    "arcmin": (math.pi / 10800, "rad"),
    "arcsec": (math.pi / 648000, "rad"),
    "rev": (2 * math.pi, "rad"),
    "r": (1.0, "rev"),
    "U": (1.0, "rev"),
    "Nmm": (1.0, "N mm"),
    "Nm": (1000.0, "N mm"),
    "kNm": (1e6, "N mm"),
    "W": (1000.0, "N mm/s"),
    "kW": (1000.0, "W"),
    "MW": (1000.0, "kW"),
    # The mechanical horsepower, 550 ft lbf/s, and the metric one, 75 kgf m/s.
    "hp": (550.0, "ft lbf/s"),
    "PS": (735.49875, "W"),
    "Pa": (1e-6, "N/mm^2"),
    "mPa": (1e-9, "N/mm^2"),
    "kPa": (1e-3, "N/mm^2"),
    "MPa": (1.0, "N/mm^2"),
    "GPa": (1000.0, "N/mm^2"),
    "bar": (0.1, "N/mm^2"),
    "psi": (4.4482216152605 / 25.4**2, "N/mm^2"),
    "ksi": (1000.0, "psi"),
    "Mpsi": (1e6, "psi"),
    "g": (1e-6, "N s^2/mm"),
    "kg": (0.001, "N s^2/mm"),
    "t": (1.0, "N s^2/mm"),
    "lb": (0.45359237e-3, "N s^2/mm"),
    "Hz": (1.0, "1/s"),
    "kHz": (1000.0, "1/s"),
    "rpm": (1.0, "rev/min"),
    "percent": (0.01, "ratio"),
}

A_FREQUENCY = "a frequency (1/time)"
AN_ANGULAR_SPEED = "an angular speed"
# What a dimension is called, by its unit inside the program.
_KINDS = {
    "mm": "a length",
    "N": "a force",
    "s": "a time",
    "rad": "an angle",
    "N mm": "a torque",
    "N mm/s": "a power",
    "N/mm^2": "a stress",
    "N/mm": "a stiffness",
    "N/mm^3": "a stiffness per area",
    "N mm/rad": "a torsional stiffness",
    "N s^2/mm": "a mass",
    "N s^2/mm^4": "a density",
    "N mm s^2": "a moment of inertia",
    "1/s": A_FREQUENCY,
    "1/mm": "a diametral pitch (1/length)",
    "rad/s": AN_ANGULAR_SPEED,
    "mm/s": "a speed",
    "N s/mm^2": "a dynamic viscosity",
    "mm^2": "an area",
    "percent": "a percentage",
}

_QUANTITY = re.compile(r"\s*([+-]?(?:(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?|inf|nan))(?![.,\d])\s*(.*?)\s*", re.DOTALL)
_SPELLINGS = str.maketrans(
    {"µ": "u", "μ": "u", "°": " deg", "%": " percent", "·": "*", "⋅": "*", "¹": "^1", "²": "^2", "³": "^3", "⁴": "^4"}
)
_NEGATIVE_POWER = re.compile("⁻([¹²³⁴])")
_DIGITS = str.maketrans("¹²³⁴", "1234")
# What a drawing or a data sheet writes for revolutions a minute, without blanks: ISO 80000-3 counts a revolution as 1.
_PER_MINUTE = {"1/min", "min^-1", "min**-1"}
# Torques as they are written in inches and feet, "in-lb" or "ft lb": a pound of these is one of force.
_POUNDS = re.compile(r"(in|ft)[ *-]*lbf?|lbf?[ *-]*(in|ft)")
# Names with whole powers, joined by blanks, "*" and "/", one level of brackets.
_FACTOR = r"[A-Za-z]+(?:\s*(?:\^|\*\*)\s*-?\d{1,2})?"
_JOINT = r"(?:\s*[*/]\s*|\s+)"
_BRACKETS = rf"\(\s*{_FACTOR}(?:{_JOINT}{_FACTOR})*\s*\)"
_ITEM = rf"(?:{_FACTOR}|{_BRACKETS})"
_LONGEST_UNIT = 40
_UNIT_TEXT = re.compile(rf"(?:1\s*/\s*)?{_ITEM}(?:{_JOINT}{_ITEM})*")
_ITEMS = re.compile(
    r"(?P<joint>/?)\s*(?:\((?P<inner>[^)]*)\)|(?P<name>[A-Za-z]+)(?:\s*(?:\^|\*\*)\s*(?P<power>-?\d+))?)"
)


class QuantityError(ValueError):
    """A text that is no quantity; the message completes "the value ..." to whole sentences."""


def quantity(text: str) -> tuple[float, str]:
    """The number in N, mm, s, rad that ``text`` stands for, and what kind of quantity it is ("a length").

    The number may be infinite or NaN; raises QuantityError where there is no number or the unit is unknown.

    >>> quantity("437 N m")
    (437000.0, 'a torque')
    >>> quantity("750 rpm")[1]
    'an angular speed'
    >>> quantity("4.5 Mm")
    Traceback (most recent call last):
        ...
    fenics_gears.inputs.units.QuantityError: has the unknown unit "Mm". Did you mean "mm"?
    """
    return _quantity(text, ())


def _quantity(text: str, kinds: tuple[str, ...]) -> tuple[float, str]:
    """As `quantity` gives it; a unit that is unknown may have been meant for one of `kinds`, or of any if there are
    none."""
    match = _QUANTITY.fullmatch(text)
    if match is None:
        raise QuantityError(_why_no_number(text))
    factor, kind = _unit(match[2], kinds)
    return float(match[1]) * factor, kind


def of_kind(text: str, *kinds: str) -> tuple[float, str]:
    """The number and its kind, as ``quantity`` gives them, of one of some kinds. Where an angular speed is wanted,
    1/min is revolutions a minute.

    1/s is not taken for one: it stands for revolutions in some papers and for radians in others. Raises QuantityError
    for another kind too.

    >>> of_kind("60 min^-1", "an angular speed")[0] == quantity("60 rpm")[0]
    True
    """
    if AN_ANGULAR_SPEED in kinds and _tidy(unit_of(text)).replace(" ", "") in _PER_MINUTE:
        number = quantity(text)[0]
        return 2.0 * math.pi * number, AN_ANGULAR_SPEED
    number, kind = _quantity(text, kinds)
    if kind not in kinds:
        pound = ' A pound of force is "lbf".' if re.search(r"\blb\b", unit_of(text)) else ""
        raise QuantityError(f"is {kind}, not {' or '.join(kinds)}.{pound}")
    return number, kind


def unit_of(text: str) -> str:
    """The unit as written in ``text``.

    >>> unit_of("0.203e9 N mm/rad")
    'N mm/rad'
    """
    match = _QUANTITY.fullmatch(text)
    return match[2] if match else ""


def names_by_kind() -> dict[str, list[str]]:
    """The names of units that have one word, by the kind of quantity that they stand for.

    >>> names_by_kind()["a length"]
    ['mm', 'um', 'cm', 'dm', 'm', 'in', 'ft', 'mil']
    """
    names: dict[str, list[str]] = {}
    for name in _UNITS:
        names.setdefault(_unit(name)[1], []).append(name)
    return names


def own_unit(kind: str) -> str:
    """The unit of the program for a kind of quantity.

    >>> own_unit("a torque")
    'N mm'
    """
    return next(unit for unit, each in _KINDS.items() if each == kind)


# A number is written with the fewest of so many digits that read as the same number.
DIGITS = (3, 6, 9, 12, 15, 16, 17)


def text_of(value: float, kind: str, usual: str) -> str:
    """A quantity of a kind with its unit, the usual one if that gives it bit for bit.

    >>> text_of(437000.0, "a torque", "N m")
    '437 N m'
    >>> text_of(0.031, "a length", "um"), text_of(0.031, "a length", "mm")
    ('31 um', '0.031 mm')
    """
    own = own_unit(kind)
    for unit in (usual, own):
        quotient = float(value) / quantity(f"1 {unit}")[0]
        # The quotient and then the product with the factor are rounded: the number may be a neighbour of the quotient.
        for number in (quotient, math.nextafter(quotient, math.inf), math.nextafter(quotient, -math.inf)):
            for digits in DIGITS:
                text = f"{number:.{digits}g} {unit}"
                if quantity(text)[0] == value:
                    return text
    return f"{quotient!r} {own}"


def _tidy(written: str) -> str:
    """A unit in plain letters: "µm" as "um", "min⁻¹" as "min^-1", "in-lb" as "lbf in"."""
    powers = _NEGATIVE_POWER.sub(lambda match: f"^-{match[1].translate(_DIGITS)}", written)
    plain = powers.translate(_SPELLINGS).strip()
    pounds = _POUNDS.fullmatch(plain)
    return f"lbf {pounds[1] or pounds[2]}" if pounds else plain


@functools.cache
def _unit(written: str, kinds: tuple[str, ...] = ()) -> tuple[float, str]:
    """The factor from the unit to N, mm, s, rad, and its kind; where it is unknown, it was to be one of `kinds`."""
    if not written:
        return 1.0, "a number without unit"
    tidy = _tidy(written)
    if len(tidy) > _LONGEST_UNIT or not _UNIT_TEXT.fullmatch(tidy):
        raise QuantityError(f'has the unit "{written[:_LONGEST_UNIT]}", which is not understood.')
    unknown = [word for word in re.findall(r"[A-Za-z]+", tidy) if word not in _UNITS]
    if unknown:
        meant = did_you_mean(unknown[0], _part_of(kinds), likeness=0.5)
        raise QuantityError(f'has the unknown unit "{unknown[0]}".{meant}')
    try:
        factor, powers = _product(tidy)
    except ArithmeticError:  # "m^99 m^99" leaves the range of numbers
        factor = math.inf
    if not 0.0 < factor < math.inf:
        raise QuantityError(f'has the unit "{written}", which is not understood.')
    return factor, _kind(powers)


@functools.cache
def _part_of(kinds: tuple[str, ...]) -> list[str]:
    """Names of the units that bring a product or quotient nearer to one of these kinds; all where these have none."""
    wanted = [_product(unit)[1] for unit, kind in _KINDS.items() if kind in kinds]
    return [name for name in _UNITS if not wanted or any(_is_part(_product(name)[1], each) for each in wanted)]


def _is_part(powers: Counter, wanted: Counter) -> bool:
    """Whether fewer powers are left of a kind when it is divided, or multiplied, by a unit of such powers."""
    left = [sum(abs(wanted[name] + sign * powers[name]) for name in _BASE.values()) for sign in (-1, 1)]
    return min(left) < sum(map(abs, wanted.values()))


def _product(tidy: str) -> tuple[float, Counter]:
    """Factor of a product of known units to N, mm, s, rad, and its powers of length, force, time and angle."""
    factor = 1.0
    powers: Counter[str] = Counter()
    for item in _ITEMS.finditer(tidy):
        number, own = _product(item["inner"]) if item["inner"] else _in_base_units(item["name"])
        power = int(item["power"] or 1) * (-1 if item["joint"] else 1)
        factor *= number**power
        for dimension, count in own.items():
            powers[dimension] += count * power
    return factor, powers


@functools.cache
def _in_base_units(name: str) -> tuple[float, Counter]:
    if name in _BASE:
        return 1.0, Counter({_BASE[name]: 1})
    number, others = _UNITS[name]
    factor, powers = _product(others)
    return number * factor, powers


def _kind(powers: Counter) -> str:
    """What a quantity of these powers is called; the powers themselves where they have no name."""
    ordered = _sorted_powers(powers)
    if not ordered:
        return "a number without unit"
    return _kinds_by_powers().get(ordered) or "a quantity in " + " ".join(
        f"{name}^{power:g}" for name, power in ordered
    )


@functools.cache
def _kinds_by_powers() -> dict[tuple, str]:
    return {_sorted_powers(_product(unit)[1]): kind for unit, kind in _KINDS.items()}


def _sorted_powers(powers: Counter) -> tuple[tuple[str, int], ...]:
    return tuple(sorted((name, power) for name, power in powers.items() if power))


def _why_no_number(text: str) -> str:
    if not text.strip():
        return "is empty."
    if re.match(r"\s*[+-]?\d+,\d", text):
        return "has a comma; the decimal sign is a point."
    return "does not begin with a number."
