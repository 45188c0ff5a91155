"""Relief of the flanks towards tip and root: how much material is gone at each roll angle."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import KW_ONLY, dataclass
from math import degrees, isfinite, sqrt
from typing import Any

import numpy as np

from fenics_gears.errors import GeometryError
from fenics_gears.inputs.allowed import Measured
from fenics_gears.inputs.fields import choice, either, number, quantity
from fenics_gears.inputs.section import Section
from fenics_gears.inputs.tree import GEARS, PerGear

from .gear import Gear
from .involute import arc_length
from .pair import GearPair

LINEAR = "linear"
PARABOLIC = "parabolic"
POWERS = {LINEAR: 1, PARABOLIC: 2}

# Each alone says where a relief starts.
STARTS = ("start", "length_on_path", "length_on_flank")
# And how it grows.
GROWTH = ("shape", "exponent")


def start_field(word: str, word_meaning: str) -> Any:
    """The field that says where a relief starts: ``word``, a roll angle or a diameter."""
    return either(
        ("1e-3 deg to 360 deg", "29.61 deg"),
        ("0.1 mm to 100 m", "80.1 mm"),
        words=(word,),
        meaning=(
            f"start of the relief: a roll angle, the {word_meaning} (with a contact ratio above 2, of double tooth"
            " contact, and so on), or a diameter, which is accepted for one gear only"
        ),
        otherwise="follows from a length; start or length is required where there is a depth",
    )


def length_field(measured: str) -> Any:
    return quantity(
        "1e-3 um to 100 m",
        "3 mm",
        meaning=f"length of the relief {measured}, from its start to its end",
        otherwise="follows from `start`",
    )


@dataclass(frozen=True)
class Relief(Section):
    """``[tip_relief.pinion]`` and ``[tip_relief.wheel]``; fields that are left out are taken from ``[tip_relief]``, and
    the defaults hold if that section leaves them out too."""

    alternatives = (STARTS, GROWTH)

    depth: float | None = quantity(
        "0 um to 100 mm",
        "31 um",
        meaning=(
            "depth at the end of the relief, normal to the flank in the transverse section, which is along the line of"
            " action there"
        ),
        otherwise="no relief",
    )
    start: float | Measured | str | None = start_field("HPSTC", "highest point of single tooth contact")
    _: KW_ONLY
    length_on_path: float | None = length_field("on the path of contact (length of roll: base radius times roll angle)")
    length_on_flank: float | None = length_field("along the flank (arc of the involute)")
    shape: str | None = choice(
        LINEAR,
        PARABOLIC,
        meaning="growth of the relief with the roll angle: `linear` starts with a kink, at which the pressure does not"
        " converge as the mesh is refined; `parabolic` starts without a kink",
        otherwise="`linear`",
    )
    exponent: float | None = number(
        1.5,
        lowest=1.0,
        highest=10.0,
        meaning="growth with this power of the roll angle, in place of `shape`: 1 is linear, 2 parabolic",
        otherwise="that of `shape`",
    )

    @property
    def length(self) -> float | None:
        """Length (mm) of the relief on the path of contact or along the flank, where the scene has one."""
        return self.length_on_flank if self.length_on_path is None else self.length_on_path

    @property
    def start_roll_angle(self) -> float | None:
        """Roll angle (rad) of the start, where the scene has one."""
        return self.start if isinstance(self.start, (int, float)) else None

    @property
    def start_diameter(self) -> float | None:
        """Diameter (mm) of the start, where the scene has one."""
        return self.start.number if isinstance(self.start, Measured) else None

    @property
    def power(self) -> float:
        return POWERS[self.shape or LINEAR] if self.exponent is None else self.exponent


@dataclass(frozen=True)
class RootReliefOfGear(Relief):
    """``[root_relief.pinion]`` and ``[root_relief.wheel]``; fields that are left out are taken from ``[root_relief]``,
    and the defaults hold if that section leaves them out too."""

    start: float | Measured | str | None = start_field("LPSTC", "lowest point of single tooth contact")


@dataclass(frozen=True)
class Reliefs(PerGear):
    """Relief of pinion and wheel; None for a gear without. One without start or length begins at HPSTC or LPSTC."""

    pinion: Relief | None
    wheel: Relief | None


@dataclass(frozen=True)
class ReliefCurve:
    """Material removed along the flank's normal, mm: nothing up to the start, then
    ``depth ((v - start)/(end - start))^power``, whichever way the end lies; roll angles in rad, ``power`` 1 or more.
    """

    depth: float
    start_roll_angle: float
    end_roll_angle: float
    power: float = 1

    def __call__(self, roll_angle) -> np.ndarray:
        """Removal (mm, not negative) at roll angles (rad, any shape); it goes on growing beyond the end."""
        length = self.end_roll_angle - self.start_roll_angle
        return (
            self.depth
            * np.maximum((np.asarray(roll_angle, dtype=float) - self.start_roll_angle) / length, 0.0) ** self.power
        )

    @classmethod
    def side_by_side(cls, curves: Sequence[ReliefCurve], counts: Sequence[int]) -> ReliefCurve | None:
        """One curve for roll angles of several flanks one after the other, so many of each; None where powers
        differ."""
        if len({curve.power for curve in curves}) > 1:
            return None
        ends = np.array([(curve.depth, curve.start_roll_angle, curve.end_roll_angle) for curve in curves])
        depth, start, end = np.repeat(ends, counts, axis=0).T
        return cls(depth, start, end, curves[0].power)

    @property
    def kinks(self) -> tuple[float, ...]:
        """Roll angle (rad) of the start where the relief is linear."""
        return (self.start_roll_angle,) if self.power == 1 and self.depth > 0.0 else ()


def side_by_side(removals: Sequence[Callable | None], counts: Sequence[int]) -> Callable | None:
    """One removal, a function of the roll angle, for roll angles of several flanks one after the other, so many of
    each; None where none has any."""
    kinds = {type(removal) for removal in removals}
    if kinds == {type(None)}:
        return None
    together = getattr(next(iter(kinds)), "side_by_side", None) if len(kinds) == 1 else None
    joined = None if together is None else together(removals, counts)
    return _one_by_one(removals, counts) if joined is None else joined


def _one_by_one(removals: Sequence[Callable | None], counts: Sequence[int]) -> Callable:
    ends = np.cumsum(counts)[:-1]

    def removed(roll_angle: np.ndarray) -> np.ndarray:
        parts = zip(removals, np.split(roll_angle, ends))
        return np.concatenate([np.zeros(len(rolls)) if of is None else of(rolls) for of, rolls in parts])

    return removed


@dataclass(frozen=True)
class _Side:
    """One end of a gear's flank: the gear, its name, the section of the scene, roll angle (rad) of the end and where
    relief usually starts."""

    gear: Gear
    name: str
    section: str
    end: float
    usual_start: float

    @property
    def at_tip(self) -> bool:
        """Whether the end is the tip, not the form circle."""
        return self.section == "tip_relief"

    @property
    def written_end(self) -> str:
        """The end as messages name it."""
        return "tip" if self.at_tip else "form circle"

    def refused(self, problem: str, field: str) -> GeometryError:
        """The error of a relief that this end cannot have."""
        return GeometryError(f"{self.name}: {problem}: change {self.section}.{self.name}.{field}")


def tip_reliefs(pair: GearPair, reliefs: Reliefs) -> tuple[ReliefCurve | None, ReliefCurve | None]:
    """Relief of pinion and wheel from HPSTC, unless the scene gives another start, to the tip; None for a gear without.

    Raises GeometryError for a relief that starts off the involute or at its own end, or whose depth is negative or more
    than half the tooth's thickness.
    """
    ends = [gear.tip_roll_angle for gear in pair.gears]
    return _curves(pair, reliefs, "tip_relief", ends, pair.hpstc_roll_angles)


def root_reliefs(pair: GearPair, reliefs: Reliefs) -> tuple[ReliefCurve | None, ReliefCurve | None]:
    """As `tip_reliefs`, from LPSTC to the form circle."""
    ends = [gear.form_roll_angle for gear in pair.gears]
    return _curves(pair, reliefs, "root_relief", ends, pair.lpstc_roll_angles)


def _curves(pair: GearPair, reliefs: Reliefs, section: str, ends, usual_starts):
    sides = (_Side(getattr(pair, name), name, section, *angles) for name, *angles in zip(GEARS, ends, usual_starts))
    own = ((getattr(reliefs, side.name), side) for side in sides)
    return tuple(None if relief is None else _curve(relief, side) for relief, side in own)


def _curve(relief: Relief, side: _Side) -> ReliefCurve:
    _check_depth(relief, side)
    start, written, field = _start(relief, side)
    gear = side.gear
    lowest, highest = gear.roll_ends
    base = abs(gear.base_radius)
    if not lowest <= start <= highest or start == side.end:
        raise side.refused(
            f"{side.section.replace('_', ' ')} starts at {written}, but its involute runs from"
            f" {degrees(gear.form_roll_angle):.4g} deg (form circle) to {degrees(gear.tip_roll_angle):.4g} deg (tip),"
            f" diameters {2.0 * abs(gear.form_radius):.6g} to {2.0 * abs(gear.tip_radius):.6g} mm,"
            f" {base * (highest - lowest):.4g} mm on the path of contact,"
            f" {arc_length(base, highest) - arc_length(base, lowest):.4g} mm along the flank",
            field,
        )
    return ReliefCurve(relief.depth, start, side.end, relief.power)


def _check_depth(relief: Relief, side: _Side) -> None:
    if not (isfinite(relief.depth) and relief.depth >= 0.0):
        raise side.refused(f"{side.section} depth {relief.depth} mm must be zero or a positive length", "depth")
    thickness = float(side.gear.tooth_thickness(side.gear.radius(side.end)))
    if relief.depth > 0.5 * thickness:
        raise side.refused(
            f"{side.section} depth {relief.depth:.4g} mm is more than half the tooth's thickness at the"
            f" {side.written_end}, {thickness:.4g} mm",
            "depth",
        )


def _start(relief: Relief, side: _Side) -> tuple[float, str, str]:
    """Roll angle (rad) of the start, negative for a diameter or a length that leads off the involute; the start as the
    scene has it, and the field that says so."""
    gear = side.gear
    from_end = -1.0 if side.at_tip else 1.0
    if (length := relief.length_on_path) is not None:
        written = f"{length:.6g} mm from the {side.written_end} on the path of contact"
        return side.end + from_end * length / gear.base_radius, written, "length_on_path"
    if (length := relief.length_on_flank) is not None:
        # An involute's arc from its base circle is rb v^2 / 2.
        square = side.end**2 + from_end * 2.0 * length / gear.base_radius
        written = f"{length:.6g} mm from the {side.written_end} along the flank"
        return sqrt(square) if square >= 0.0 else -1.0, written, "length_on_flank"
    if relief.start_diameter is not None:
        radius = 0.5 * relief.start_diameter
        start = float(gear.roll_angle(radius)) if radius >= abs(gear.base_radius) else -1.0
        return start, f"diameter {relief.start_diameter:.6g} mm", "start"
    start = side.usual_start if relief.start_roll_angle is None else relief.start_roll_angle
    return start, f"roll angle {degrees(start):.4g} deg", "start"
