"""The scene in a result: its gear pair, and its operating conditions in one line."""

from __future__ import annotations

import xarray as xr

from fenics_gears.effects import effects_on
from fenics_gears.errors import GearsError
from fenics_gears.geometry.pair import GearPair, gear_pair
from fenics_gears.scene.data import Scene
from fenics_gears.scene.read import scene_from_text
from fenics_gears.show.units import factor


def scene_of(dataset: xr.Dataset) -> Scene | None:
    """The scene that a result was computed from; None where its text is no scene of this version."""
    try:
        return scene_from_text(str(dataset.attrs.get("scene", "")))
    except GearsError:
        return None


def gear_pair_of(dataset: xr.Dataset) -> GearPair | None:
    """The gear pair that a result was computed for, None as for ``scene_of``."""
    scene = scene_of(dataset)
    try:
        return None if scene is None else gear_pair(scene.gears)
    except GearsError:
        return None


def conditions(scene: Scene) -> str:
    """Load, speed, friction, modifications, errors and ripple of a scene: what tells apart two pictures of the same gears."""
    torque = scene.load.wheel_torque * factor("N mm", "N m")
    ramp = "" if scene.speed_ramp is None else f" to {scene.speed_ramp.end_frequency:g}"
    speed = "quasi-static" if scene.inertia is None else f"{scene.motion.mesh_frequency:g}{ramp} Hz mesh frequency"
    friction = "no friction" if scene.friction is None else f"friction coefficient {scene.friction.coefficient:g}"
    shapes = "".join(f", {each.section.replace('_', ' ')}" for each in effects_on(scene) if each.removal or each.gaps)
    ripple = "" if scene.torque_ripple is None else ", torque ripple"
    return f"{torque:g} N m on the wheel, {speed}, {friction}{shapes}{ripple}"
