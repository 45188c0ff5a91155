"""The drivetrain of a scene: its sections, put together by `dynamics.train`."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from math import inf, isfinite, pi, sqrt
from typing import TYPE_CHECKING

import numpy as np

from fenics_gears.dynamics.drivetrain import Drivetrain
from fenics_gears.dynamics.inertia import Inertia
from fenics_gears.dynamics.train import TrainParts, coordinates_of_mesh, train_drivetrain
from fenics_gears.errors import SceneError
from fenics_gears.geometry.gear import Gear
from fenics_gears.geometry.gear_data import LumpedGear, Material, rough_pair_stiffness
from fenics_gears.geometry.iso_6336 import pair_stiffness, theoretical_stiffness
from fenics_gears.geometry.pair import GearPair, gear_pair
from fenics_gears.geometry.train_graph import TrainGraph
from fenics_gears.inputs.tree import GEARS, SHAFTS
from fenics_gears.scene.data import ISO_6336, RIGID_TEETH, Scene

if TYPE_CHECKING:
    from fenics_gears.dynamics.elastic_shaft import ElasticShaft
    from fenics_gears.dynamics.shaft_system import ShaftSystem
    from fenics_gears.dynamics.tilting import Tilting
    from fenics_gears.geometry.section import CrossSection

# Harmonics of the mesh that shafts follow with all of their modes.
HARMONICS = 10
# The load's moment of inertia over the wheel's, at most: their sum keeps six digits of the wheel's.
MOST_OF_WHEEL = 1e10


def drivetrain(scene: Scene, pair: GearPair) -> Drivetrain:
    """The drivetrain that the scene's sections call for; what no section frees does not appear.

    Raises SceneError for a load so heavy that the wheel is nothing beside it.
    """
    gears = {} if scene.inertia is None else lumped_gears(scene, pair)
    systems = _shaft_systems(scene, pair, gears)
    parts = _parts(scene, pair, gears, systems)
    stiffness = mesh_stiffness(scene, pair)
    if not systems:
        return train_drivetrain(parts, scene.damping, stiffness)
    # Of few scenes.
    from fenics_gears.dynamics.train_shafts import shafts_of_pair, with_bent_shafts

    bent = shafts_of_pair(systems, pair, scene.load.wheel_torque, gears)
    names = coordinates_of_mesh(parts, 0) + bent.names_in(0)
    whole = with_bent_shafts(train_drivetrain(parts), bent, [names], scene.damping, stiffness)
    return replace(whole, seats=tuple(bent.seats_in(0)))


def _parts(
    scene: Scene, pair: GearPair, gears: Mapping[str, LumpedGear], systems: tuple[ShaftSystem, ...]
) -> TrainParts:
    """A pair as a train of one mesh."""
    bent = {shaft.name: shaft for system in systems for shaft in system.shafts}
    torsion = [_torsion(scene, shaft, bent.get(gear)) for gear, shaft in zip(GEARS, SHAFTS)]
    loads = {} if scene.inertia is None else _loads(scene.inertia, gears["wheel"], isfinite(torsion[1]))
    return TrainParts(
        TrainGraph(((0, 1),), (0, 1), internal=frozenset((0,) if pair.wheel.internal else ())),
        (pair,),
        (np.eye(2),),
        (0.0, scene.load.wheel_torque),
        torsion,
        tuple(gears.values()),
        [support_of(scene, gear) for gear in GEARS],
        loads,
        tilting=_tilting(scene, pair),
    )


def _tilting(scene: Scene, pair: GearPair) -> Tilting | None:
    if scene.bearings is None or scene.bearings.places is None:
        return None
    # Of few scenes.
    from fenics_gears.dynamics.tilting import Tilting

    return Tilting(pair, scene.bearings)


def _torsion(scene: Scene, shaft: str, bent: ElasticShaft | None) -> float:
    """Torsional stiffness (N mm/rad) of the "input" or the "output" shaft; 0 of one that bends, whose own it is."""
    if bent is not None:
        return 0.0 if bent.coupled is None else inf
    given = None if scene.shafts is None else scene.shafts.of(shaft)
    return inf if given is None else given


def _loads(inertia: Inertia, wheel: LumpedGear, twists: bool) -> dict[int, float]:
    """Moment of inertia (N mm s^2) of the load, which `twists` against the wheel or turns with it. Raises SceneError
    for one beside which the wheel's own is round-off."""
    if not twists:
        return {} if inertia.load is None else {1: inertia.load.moment_of_inertia}
    end = inertia.shaft_end
    if end > MOST_OF_WHEEL * wheel.moment_of_inertia:
        raise SceneError(
            f"inertia.load: a moment of inertia of {end / wheel.moment_of_inertia:.3g} times the wheel's; allowed are"
            f" up to {MOST_OF_WHEEL:g} times, beyond which the far end of the output shaft stands still all the same."
            " Lower inertia.load.moment_of_inertia, or raise that of [inertia.wheel]"
        )
    return {1: end}


def support_of(scene: Scene, gear: str) -> tuple[float, float] | None:
    """Stiffness (N/mm) of a gear's support along and off the line of action, infinite where it is fixed; None where it
    is in both."""
    if scene.bearings is None:
        return None
    found = [scene.bearings.of(gear, axis) for axis in "xy"]
    along, off = (inf if each is None else each for each in found)
    return None if found == [None, None] else (along, off)


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


def bore_twist_stiffness(scene: Scene, pair: GearPair) -> float:
    """Approximate stiffness (N/mm) along the line of action of both bodies, which twist between their roots and the
    bores where they are held. Infinite where none twists, as on shafts that bend or with given meshes.

    A ring of width b(r) and shear modulus G under a torque T twists by T/(2 pi G) times the integral of dr/(b r^3): the
    closed form of a disc that is sheared around its axis. Along the line of action, at the base circle of radius r_b,
    the body is a spring of r_b^2 times that twist by T.
    """
    if scene.tooth_elasticity is None or scene.accuracy.model in (ISO_6336, RIGID_TEETH):
        return inf
    flexibility = 0.0
    for name, material, width in zip(GEARS, scene.gears.materials, pair.face_widths):
        on_shaft = scene.shafts is not None and name in (scene.shafts.sections or {})
        given = scene.body_meshes is not None and getattr(scene.body_meshes, name) is not None
        if not (on_shaft or given):
            flexibility += _flexibility_of(getattr(pair, name), material, width)
    return 1.0 / flexibility if flexibility else inf


def _flexibility_of(gear: Gear, material: Material, width: float) -> float:
    """mm/N along the line of action."""
    shear_modulus = 0.5 * material.youngs_modulus / (1.0 + material.poissons_ratio)
    rings = [(gear.bore_radius, gear.root_radius, 1.0)]
    if gear.web is not None:
        ends = gear.bore_radius, gear.web.hub_radius, gear.web.rim_radius, gear.root_radius
        rings = list(zip(ends, ends[1:], (1.0, gear.web.share, 1.0)))
    twist = sum(0.5 * (inner**-2 - outer**-2) / share for inner, outer, share in rings)
    body = gear.base_radius**2 * abs(twist) / (2.0 * pi * shear_modulus * width)
    if gear.foundation is None:
        return body
    # A rigid ring on its springs: it turns by the tangential ones, and moves by both.
    half_circle = pi * abs(gear.bore_radius) * width
    radial, tangential = (each * material.youngs_modulus * half_circle for each in gear.foundation)
    turning = 2.0 * tangential * gear.bore_radius**2
    return body + gear.base_radius**2 / turning + 1.0 / (radial + tangential)


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
