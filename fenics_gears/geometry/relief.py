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
from .involute import arc_length
from .pair import GearPair

if TYPE_CHECKING:
    from fenics_gears.effects.relief import Relief, Reliefs


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
    ends = pair.pinion.tip_roll_angle, pair.wheel.tip_roll_angle
    return _curves(pair, reliefs, "tip_relief", ends, pair.hpstc_roll_angles)


def root_reliefs(pair: GearPair, reliefs: Reliefs) -> tuple[ReliefCurve | None, ReliefCurve | None]:
    """As `tip_reliefs`, from LPSTC to the form circle."""
    ends = pair.pinion.form_roll_angle, pair.wheel.form_roll_angle
    return _curves(pair, reliefs, "root_relief", ends, pair.lpstc_roll_angles)


def _curves(pair: GearPair, reliefs: Reliefs, section: str, ends, usual_starts):
    sides = (_Side(getattr(pair, name), name, section, *angles) for name, *angles in zip(GEARS, ends, usual_starts))
    own = ((getattr(reliefs, side.name), side) for side in sides)
    return tuple(None if relief is None else _curve(relief, side) for relief, side in own)


def _curve(relief: Relief, side: _Side) -> ReliefCurve:
    _check_depth(relief, side)
    start, written, field = _start(relief, side)
    gear = side.gear
    lowest, highest = gear.form_roll_angle, gear.tip_roll_angle
    if not lowest <= start <= highest or start == side.end:
        raise side.refused(
            f"{side.section.replace('_', ' ')} starts at {written}, but its involute runs from"
            f" {degrees(lowest):.4g} deg (form circle) to {degrees(highest):.4g} deg (tip), diameters"
            f" {2.0 * gear.form_radius:.6g} to {2.0 * gear.tip_radius:.6g} mm,"
            f" {gear.base_radius * (highest - lowest):.4g} mm on the path of contact,"
            f" {arc_length(gear.base_radius, highest) - arc_length(gear.base_radius, lowest):.4g} mm along the flank",
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
    gear, from_end = side.gear, -1.0 if side.at_tip else 1.0
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
        start = float(gear.roll_angle(radius)) if radius >= gear.base_radius else -1.0
        return start, f"diameter {relief.start_diameter:.6g} mm", "start"
    start = side.usual_start if relief.start_roll_angle is None else relief.start_roll_angle
    return start, f"roll angle {degrees(start):.4g} deg", "start"
