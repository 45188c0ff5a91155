"""Departures from the involute that all teeth of a gear share."""

from __future__ import annotations

from dataclasses import dataclass
from math import degrees, isfinite

import numpy as np

from fenics_gears.errors import GeometryError
from fenics_gears.geometry.gear import Gear
from fenics_gears.geometry.pair import GearPair
from fenics_gears.scene.data import Scene
from fenics_gears.effects import effects_on
from fenics_gears.effects.tip_relief import Relief, TipRelief


@dataclass(frozen=True)
class LinearRelief:
    """Material removed along the flank's normal, linear in the roll angle; depth in mm at the tip, roll angles in rad."""

    depth: float
    start_roll_angle: float
    tip_roll_angle: float

    def __call__(self, roll_angle) -> np.ndarray:
        """Removal (mm, not negative) at roll angles (rad, any shape); it goes on growing beyond the tip."""
        slope = self.depth / (self.tip_roll_angle - self.start_roll_angle)
        return slope * np.maximum(np.asarray(roll_angle, dtype=float) - self.start_roll_angle, 0.0)


@dataclass(frozen=True)
class Removals:
    """Several effects that take material from one flank."""

    parts: tuple

    def __call__(self, roll_angle) -> np.ndarray:
        """Removal (mm) at roll angles (rad, any shape) by all of them together."""
        return sum(part(roll_angle) for part in self.parts)


def removals(scene: Scene, pair: GearPair) -> tuple:
    """Material that the scene's effects remove from the drive flanks of pinion and wheel: functions of the roll angle, or None.

    Raises GeometryError where an effect asks for what the flank does not have.
    """
    effects = [each for each in effects_on(scene) if each.removal is not None]
    found = [effect.removal(getattr(scene, effect.section), pair) for effect in effects]
    parts = [tuple(part for part in of_gear if part is not None) for of_gear in zip(*found)] or [(), ()]
    return tuple(Removals(of_gear) if len(of_gear) > 1 else (of_gear[0] if of_gear else None) for of_gear in parts)


def tip_reliefs(pair: GearPair, reliefs: TipRelief) -> tuple[LinearRelief | None, LinearRelief | None]:
    """Relief of pinion and wheel; None for a gear that has none. Raises GeometryError as ``linear_relief`` does."""
    gears = (
        (reliefs.pinion, pair.pinion, pair.pinion_hpstc_roll_angle, "pinion"),
        (reliefs.wheel, pair.wheel, pair.wheel_hpstc_roll_angle, "wheel"),
    )
    return tuple(
        None if relief is None else linear_relief(relief, gear, hpstc, name) for relief, gear, hpstc, name in gears
    )


def linear_relief(relief: Relief, gear: Gear, hpstc_roll_angle: float, name: str) -> LinearRelief:
    """Relief of one gear, from the HPSTC (rad) where the scene names no start.

    Raises GeometryError when it would start beyond the tip or below the involute, or when its depth is no length.
    """
    start = hpstc_roll_angle if relief.start_roll_angle is None else relief.start_roll_angle
    lowest, tip = gear.form_roll_angle, gear.tip_roll_angle
    if not (isfinite(relief.depth) and relief.depth >= 0.0):
        raise GeometryError(f"{name}: tip_relief depth {relief.depth} mm; it must be zero or a positive length")
    if relief.depth > 0.5 * gear.tip_thickness:
        raise GeometryError(
            f"{name}: tip_relief depth {relief.depth:.4g} mm is more than half the tooth's thickness at the tip, {gear.tip_thickness:.4g} mm: "
            f"no tip would be left; lower tip_relief.{name}.depth"
        )
    if not lowest <= start < tip:
        raise GeometryError(
            f"{name}: tip relief starts at roll angle {degrees(start):.4g} deg, but its involute runs from "
            f"{degrees(lowest):.4g} deg (form circle) to {degrees(tip):.4g} deg (tip): change tip_relief.{name}.start"
        )
    return LinearRelief(depth=relief.depth, start_roll_angle=start, tip_roll_angle=tip)
