"""How much too stiff a rigid bore makes a gear with a thin rim."""

from __future__ import annotations

from math import exp
from typing import TYPE_CHECKING

from fenics_gears.inputs.tree import GEARS
from fenics_gears.scene.data import ELASTIC

if TYPE_CHECKING:
    from fenics_gears.geometry.gear import Gear
    from fenics_gears.model.model import Model

# Tooth and rim on a rigid ring give way by so many per cent less than in a solid body, over the rim's thickness in
# parts of the root radius:
# STIFFEST exp(-thickness/FALL), within 4 of what is measured for 20 to 80 teeth (docs/drawing.md, thin rims).
STIFFEST, FALL = 45.0, 0.19
# Per cent from which there is a warning; about twice what the transmission error of a pair misses by one such gear.
NOTABLE = 10.0


def too_stiff(gear: Gear) -> float:
    """Per cent by which tooth and rim of a gear, its bore being a rigid ring, give way less than in a solid body, apart
    from the body's turn as a whole."""
    return STIFFEST * exp(-(gear.root_radius - gear.bore_radius) / (FALL * gear.root_radius))


def rim_warnings(model: Model) -> list[str]:
    """A sentence on each gear of finite elements whose rim is thin for a rigid bore."""
    scene, found = model.scene, []
    if scene.tooth_elasticity is None or scene.accuracy.model not in (None, ELASTIC):
        return []
    for name in GEARS:
        gear, off = getattr(model.pair, name), too_stiff(getattr(model.pair, name))
        if off < NOTABLE or getattr(scene.body_meshes, name, None) is not None:
            continue
        rim = gear.root_radius - gear.bore_radius
        found.append(
            f"{name}: thin rim: {rim:.4g} mm = {rim / gear.normal_module:.3g} modules between bore and root circle, "
            f"and the bore is a rigid ring: tooth and rim give way about {off:.0f}% less than in a solid body, "
            "where a rim on a flexible seat gives way more: take a smaller "
            f"gears.{name}.bore_diameter where rim and shaft are one body, or in a plane scene "
            f"[gears.{name}.web] for a rim on a web, [body_meshes] for any other seat"
        )
    return found
