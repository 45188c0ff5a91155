"""Mass and moment of inertia of each gear: as the scene gives them, or of its body by a density."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fenics_gears.geometry.pair import GearPair
from fenics_gears.scene.data import Scene
from fenics_gears.inputs.tree import GEARS

if TYPE_CHECKING:
    from fenics_gears.geometry.section import CrossSection


@dataclass(frozen=True)
class LumpedGear:
    """`mass`, N s^2/mm, and `moment_of_inertia`, N mm s^2, at a gear's centre."""

    mass: float
    moment_of_inertia: float


def lumped_gears(scene: Scene, pair: GearPair) -> dict[str, LumpedGear]:
    """What "pinion" and "wheel" of a scene with inertia are in the equations of motion."""
    return {name: _lumped(scene, pair, name, pair.face_widths[number]) for number, name in enumerate(GEARS)}


def _lumped(scene: Scene, pair: GearPair, name: str, width: float) -> LumpedGear:
    given = scene.inertia.of(name)
    if None not in (given.mass, given.moment_of_inertia):
        return LumpedGear(given.mass, given.moment_of_inertia)
    section, per_area = _section(scene, pair, name), given.density * width
    mass = per_area * section.area if given.mass is None else given.mass
    return LumpedGear(mass, per_area * section.polar_moment if given.moment_of_inertia is None else given.moment_of_inertia)


def _section(scene: Scene, pair: GearPair, name: str) -> CrossSection:
    """The gear's cross-section: that of its outline, or of its own mesh with all its holes."""
    from fenics_gears.geometry.section import cells_section, gear_section

    if scene.body_meshes is None or getattr(scene.body_meshes, name) is None:
        return gear_section(getattr(pair, name))
    from fenics_gears.effects.body_meshes import given_mesh

    mesh = given_mesh(scene.body_meshes, name, pair, scene.accuracy.element or "P2")
    return cells_section(mesh.points, mesh.cells)
