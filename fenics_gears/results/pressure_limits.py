"""Warnings of a finished run about stress: pressure that no mesh resolves, and materials that would yield."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from fenics_gears.inputs.tree import GEARS
from fenics_gears.scene.data import Scene

if TYPE_CHECKING:
    from fenics_gears.geometry.relief import Reliefs

# Peak pressure of a line contact over yield strength at which the material below yields by Tresca's criterion. The
# largest shear stress is 0.300 of the pressure (Johnson, Contact Mechanics, 1985, eq. 6.4).
LINE_CONTACT = 1.67


def warnings_of_pressure(scene: Scene, watched: Mapping[str, np.ndarray], numbers: Mapping) -> list[str]:
    """A sentence for each, from what was `watched` at every step and the `numbers` (attributes) of the result."""
    return [*yielding(scene, numbers), *_sharp_edge(scene, watched), *_undercut_edge(watched), *_kink(scene, numbers)]


def _sharp_edge(scene: Scene, watched: Mapping[str, np.ndarray]) -> list[str]:
    """Contact on the sharp edge of a tip, where linear elasticity has infinite pressure."""
    touched = {gear: watched[f"on the {gear}'s tip"] for gear in GEARS}
    steps = int((touched["pinion"] | touched["wheel"]).sum())
    if not steps:
        return []
    gears = [gear for gear, at in touched.items() if at.any()]
    named = " and ".join(f"the {gear}'s" for gear in gears)
    return [
        f"contact reaches the sharp edge of {named} tip in {steps} of {len(touched['pinion'])} steps: the pressure"
        f" there does not converge with the mesh, forces and transmission error do; {_off_the_edge(scene, gears)}"
    ]


def _undercut_edge(watched: Mapping[str, np.ndarray]) -> list[str]:
    sentences = []
    for gear in GEARS:
        at = watched[f"on the {gear}'s form circle"]
        if at.any():
            sentences.append(
                f"contact reaches the edge at the form circle of the undercut {gear} in {int(at.sum())} of {len(at)}"
                " steps: the pressure there does not converge with the mesh, forces and transmission error do;"
                f" [root_relief.{gear}] takes the load off the edge"
            )
    return sentences


def yielding(scene: Scene, numbers: Mapping) -> list[str]:
    """Stresses above what the materials bear without yielding, where their yield strength is known."""
    sentences = []
    pressure = numbers.get("peak_contact_pressure", 0.0)
    for gear, material in zip(GEARS, scene.gears.materials):
        strength = material.yield_strength
        if strength is None:
            continue
        limit = LINE_CONTACT * strength
        root = numbers.get(f"largest_root_stress_{gear}", 0.0)
        if pressure > limit:
            sentences.append(
                f"the peak contact pressure, {pressure:.4g} MPa, is above what the {gear}'s material bears below the"
                f" flank without yielding, {limit:.4g} MPa: {LINE_CONTACT:g} times its yield strength of {strength:g}"
                " MPa (Johnson, Contact Mechanics, 1985, eq. 6.4); the model is elastic"
            )
        if root > strength:
            sentences.append(
                f"the largest root stress of the {gear}, {root:.4g} MPa, is above its yield strength of {strength:g}"
                " MPa; the model is elastic"
            )
    return sentences


def _kink(scene: Scene, numbers: Mapping) -> list[str]:
    """More pressure at the kink where a linear relief starts than elsewhere: linear elasticity has infinite pressure
    there."""
    largest = numbers.get("peak_kink_pressure", 0.0)
    elsewhere = numbers.get("peak_contact_pressure", 0.0)
    if largest <= elsewhere:
        return []
    linear = {section: _linear(getattr(scene, section)) for section in ("tip_relief", "root_relief")}
    named = ((section.replace("_", " "), gears) for section, gears in linear.items() if gears)
    starts = " or ".join(f"the linear {words} of the {' or the '.join(gears)}" for words, gears in named)
    remedies = ", ".join(f'{section}.shape = "parabolic"' for section, gears in linear.items() if gears)
    return [
        f"near the kink where {starts} starts the pressure reaches {largest:.4g} MPa and does not converge with the"
        f" mesh; forces and transmission error do. The peak contact pressure, {elsewhere:.4g} MPa, is without it;"
        f" {remedies} starts without a kink"
    ]


def _linear(reliefs: Reliefs | None) -> list[str]:
    own = {gear: getattr(reliefs, gear, None) for gear in GEARS}
    return [gear for gear, relief in own.items() if relief is not None and relief.power == 1 and relief.depth > 0.0]


def _off_the_edge(scene: Scene, gears: list[str]) -> str:
    reliefs = [getattr(scene.tip_relief, gear) for gear in gears] if scene.tip_relief is not None else []
    if None in reliefs:
        without = (gear for gear, relief in zip(gears, reliefs) if relief is None)
        ways = [f"[tip_relief.{gear}] takes the load off the edge" for gear in without]
    elif reliefs:
        ways = ["a deeper or longer tip relief takes more load off the edge"]
        if any(relief.power == 1 for relief in reliefs):
            ways.append('tip_relief.shape = "parabolic" is steeper at the tip')
    else:
        ways = ["[tip_relief] takes the load off the edge"]
    if scene.corner_contact is None or not min(scene.corner_contact.edge_radii) > 0.0:
        ways.append("[corner_contact] with an edge_radius rounds it")
    return ", ".join(ways)
