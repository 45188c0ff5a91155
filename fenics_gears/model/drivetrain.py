"""The drivetrain of a scene: its sections, put together by `dynamics.drivetrain`."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from math import inf, isfinite, pi, sqrt
from typing import TYPE_CHECKING

from fenics_gears.dynamics.assembled_drivetrain import Supports, assembled
from fenics_gears.dynamics.drivetrain import Drivetrain
from fenics_gears.geometry.gear_data import LumpedGear, rough_pair_stiffness
from fenics_gears.geometry.iso_6336 import pair_stiffness, theoretical_stiffness
from fenics_gears.geometry.pair import GearPair, gear_pair
from fenics_gears.inputs.tree import GEARS
from fenics_gears.scene.data import ISO_6336, Scene

from .bore_twist import bore_twist_stiffness

if TYPE_CHECKING:
    from fenics_gears.dynamics.elastic_shaft import ElasticShaft
    from fenics_gears.dynamics.shaft_system import ShaftSystem
    from fenics_gears.geometry.section import CrossSection

# Harmonics of the mesh that shafts follow with all of their modes.
HARMONICS = 10


def drivetrain(scene: Scene, pair: GearPair) -> Drivetrain:
    """The drivetrain that the scene's sections call for; what no section frees does not appear.

    Raises SceneError for a load so heavy that the wheel is nothing beside it.
    """
    gears = {} if scene.inertia is None else lumped_gears(scene, pair)
    systems = _shaft_systems(scene, pair, gears)
    supports = Supports(scene.shafts, scene.bearings, scene.inertia, gears, scene.damping, systems)
    return assembled(pair, scene.load.wheel_torque, supports, mesh_stiffness(scene, pair))


def _shaft_systems(scene: Scene, pair: GearPair, gears: Mapping[str, LumpedGear]) -> tuple[ShaftSystem, ...]:
    if scene.shafts is None or scene.shafts.of_pair is None:
        return ()
    from fenics_gears.effects.elastic_shaft_rules import systems_at_work

    systems = systems_at_work(scene, pair)
    if scene.inertia is None:
        return systems
    up_to = 2.0 * highest_of_interest(scene, pair, gears)

    def vibrating(shaft: ElasticShaft) -> ElasticShaft:
        given = scene.shafts.sections[shaft.name].material.density
        return replace(shaft, density=given or scene.inertia.of(shaft.name).density, up_to=up_to)

    return tuple(replace(each, shafts=tuple(map(vibrating, each.shafts))) for each in systems)


def highest_of_interest(scene: Scene, pair: GearPair, gears: Mapping[str, LumpedGear], faster: float = 1.0) -> float:
    """Frequency (Hz) up to which shafts need their own modes: that of the highest mesh harmonic of interest, or roughly
    the resonance of both gears on the mesh, whichever is higher. `faster`: how often the scene's speed the train
    reaches."""
    along = sum(getattr(pair, name).base_radius ** 2 / each.moment_of_inertia for name, each in gears.items())
    stiffness = mesh_stiffness(scene, pair)
    resonance = sqrt(stiffness * along) / (2.0 * pi) if isfinite(stiffness) else 0.0
    return max(HARMONICS * faster * scene.mesh_frequencies[1], resonance)


def mesh_stiffness(scene: Scene, pair: GearPair | None = None) -> float:
    """Stiffness (N/mm), about, of one tooth pair along the line of action in a run; infinite if rigid. `pair`: the
    scene's, where it is known.

    By ISO 6336-1, method B, where the scene takes that model. Otherwise by its theory, without its adjustment to
    measurements, in series with the twist of both bodies on their bores.

    >>> from fenics_gears import load_scene
    >>> round(mesh_stiffness(load_scene("demos/lundvall2004.toml")), -3)
    203000.0
    """
    if scene.tooth_elasticity is None:
        return inf
    pair = pair or gear_pair(scene.gears)
    if scene.accuracy.model == ISO_6336:
        return pair_stiffness(scene.gears, line_load(scene, pair))
    theory = theoretical_stiffness(scene.gears)
    teeth = theory if theory > 0.0 else rough_pair_stiffness(scene.tooth_elasticity, scene.gears.face_width)
    return 1.0 / (1.0 / teeth + 1.0 / bore_twist_stiffness(scene, pair))


def line_load(scene: Scene, pair: GearPair) -> float:
    """N/mm, of the wheel's torque over the face."""
    return pair.force_of(scene.load.wheel_torque) / pair.face_width


def lumped_gears(scene: Scene, pair: GearPair) -> dict[str, LumpedGear]:
    """What "pinion" and "wheel" of a scene with inertia are in the equations of motion.

    >>> from fenics_gears import gear_pair, load_scene
    >>> scene = load_scene("demos/lundvall2004.toml")
    >>> lumped_gears(scene, gear_pair(scene.gears))["wheel"].moment_of_inertia  # N mm s^2
    24.5
    """
    found = {}
    for name, width in zip(GEARS, pair.face_widths):
        given = scene.inertia.of(name)
        mass = given.mass
        moment = given.moment_of_inertia
        if mass is None or moment is None:
            body = _section(scene, pair, name)
            per_area = given.density * width
            mass = per_area * body.area if mass is None else mass
            moment = per_area * body.polar_moment if moment is None else moment
        found[name] = LumpedGear(mass, moment, width, given.tilting_moment_of_inertia)
    return found


def _section(scene: Scene, pair: GearPair, name: str) -> CrossSection:
    """The gear's cross-section: that of its outline, or of its own mesh with all its holes."""
    # Loaded where a density gives the mass.
    from fenics_gears.geometry.section import cells_section, gear_section

    if scene.body_meshes is None or getattr(scene.body_meshes, name) is None:
        return gear_section(getattr(pair, name))
    mesh = scene.body_meshes.body_of(name, pair, scene.accuracy.element or "P2").mesh
    return cells_section(mesh.points, mesh.cells)
