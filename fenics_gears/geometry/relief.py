"""Relief of the flanks towards tip and root: how much material is gone at each roll angle."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import degrees, isfinite, sqrt
from typing import TYPE_CHECKING

import numpy as np

from fenics_gears.errors import GeometryError
from fenics_gears.inputs.tree import GEARS

from .gear import Gear
from .pair import GearPair

if TYPE_CHECKING:
    from fenics_gears.effects.relief import Relief, Reliefs


@dataclass(frozen=True)
class ReliefCurve:
    """Material removed along the flank's normal: nothing up to the start, ``depth`` (mm) at the end; roll angles in
    rad.

    ``depth ((v - start)/(end - start))^power``, whichever way the end lies; ``power`` 1 or more.
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
    found = None if together is None else together(removals, counts)
    return _one_by_one(removals, counts) if found is None else found


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
    def field(self) -> str:
        """The gear's section."""
        return f"{self.section}.{self.name}"

    @property
    def words(self) -> str:
        """The section's name in a sentence."""
        return self.section.replace("_", " ")


def tip_reliefs(pair: GearPair, reliefs: Reliefs) -> tuple[ReliefCurve | None, ReliefCurve | None]:
    """Relief of pinion and wheel from HPSTC, unless the scene gives another start, to the tip; None for a gear without.

    Raises GeometryError as ``relief_curve`` does.
    """
    ends = pair.pinion.tip_roll_angle, pair.wheel.tip_roll_angle
    return _curves(pair, reliefs, "tip_relief", ends, pair.hpstc_roll_angles)


def root_reliefs(pair: GearPair, reliefs: Reliefs) -> tuple[ReliefCurve | None, ReliefCurve | None]:
    """As `tip_reliefs`, from LPSTC to the form circle."""
    ends = pair.pinion.form_roll_angle, pair.wheel.form_roll_angle
    return _curves(pair, reliefs, "root_relief", ends, pair.lpstc_roll_angles)


def _curves(pair: GearPair, reliefs: Reliefs, section: str, ends, usual_starts):
    sides = (_Side(getattr(pair, name), name, section, *angles) for name, *angles in zip(GEARS, ends, usual_starts))
    own = ((getattr(reliefs, side.name), side) for side in sides)
    return tuple(None if relief is None else relief_curve(relief, side) for relief, side in own)


def relief_curve(relief: Relief, side: _Side) -> ReliefCurve:
    """Relief at one end of a gear's flank.

    Raises GeometryError when it would start off the involute or at its own end, or when its depth is negative or more
    than half the tooth's thickness.
    """
    _check_depth(relief, side)
    start, gear = _start(relief, side), side.gear
    lowest, highest = gear.form_roll_angle, gear.tip_roll_angle
    if not lowest <= start <= highest or start == side.end:
        raise GeometryError(
            f"{side.name}: {side.words} starts at {_written_start(relief, start, side)}, but its involute runs from"
            f" {degrees(lowest):.4g} deg (form circle) to {degrees(highest):.4g} deg (tip), diameters"
            f" {2.0 * gear.form_radius:.6g} to {2.0 * gear.tip_radius:.6g} mm,"
            f" {gear.base_radius * (highest - lowest):.4g} mm on the path of contact,"
            f" {0.5 * gear.base_radius * (highest**2 - lowest**2):.4g} mm along the flank: change"
            f" {side.field}.{_changed(relief)}"
        )
    return ReliefCurve(relief.depth, start, side.end, relief.power)


def _check_depth(relief: Relief, side: _Side) -> None:
    if not (isfinite(relief.depth) and relief.depth >= 0.0):
        raise GeometryError(
            f"{side.name}: {side.section} depth {relief.depth} mm; it must be zero or a positive length"
        )
    thickness = float(side.gear.tooth_thickness(side.gear.radius(side.end)))
    if relief.depth > 0.5 * thickness:
        end = "tip" if side.section == "tip_relief" else "form circle"
        left = "no tip would be left" if end == "tip" else "nothing of the tooth would be left there"
        raise GeometryError(
            f"{side.name}: {side.section} depth {relief.depth:.4g} mm is more than half the tooth's thickness at the"
            f" {end}, {thickness:.4g} mm: {left}; lower {side.field}.depth"
        )


def _start(relief: Relief, side: _Side) -> float:
    """Roll angle (rad) of the start; negative for a diameter or a length that leads off the involute."""
    gear, from_end = side.gear, 1.0 if side.section == "root_relief" else -1.0
    if relief.length_on_path is not None:
        return side.end + from_end * relief.length_on_path / gear.base_radius
    if relief.length_on_flank is not None:
        # An involute's arc from its base circle is rb v^2 / 2.
        square = side.end**2 + from_end * 2.0 * relief.length_on_flank / gear.base_radius
        return sqrt(square) if square >= 0.0 else -1.0
    if relief.start_diameter is None:
        return side.usual_start if relief.start_roll_angle is None else relief.start_roll_angle
    radius = 0.5 * relief.start_diameter
    return float(gear.roll_angle(radius)) if radius >= gear.base_radius else -1.0


def _written_start(relief: Relief, start: float, side: _Side) -> str:
    end = "tip" if side.section == "tip_relief" else "form circle"
    if relief.length_on_path is not None:
        return f"{relief.length_on_path:.6g} mm from the {end} on the path of contact"
    if relief.length_on_flank is not None:
        return f"{relief.length_on_flank:.6g} mm from the {end} along the flank"
    if relief.start_diameter is not None:
        return f"diameter {relief.start_diameter:.6g} mm"
    return f"roll angle {degrees(start):.4g} deg"


def _changed(relief: Relief) -> str:
    lengths = (name for name in ("length_on_path", "length_on_flank") if getattr(relief, name) is not None)
    return next(lengths, "start")
