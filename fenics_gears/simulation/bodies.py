"""The bodies of a model's gears: how each is divided into finite elements, what it depends on, and its elasticity."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from fenics_gears.effects import effects_on, from_effects
from fenics_gears.elasticity.cache import Cache
from fenics_gears.elasticity.compliance import Bodies, Body
from fenics_gears.elasticity.element_sizes import Discretisation
from fenics_gears.inputs.tree import GEARS
from fenics_gears.model.model import Model
from fenics_gears.system.progress import Progress

if TYPE_CHECKING:
    from fenics_gears.elasticity.face.discretisation import FaceDiscretisation
    from fenics_gears.elasticity.face_compliance_data import FaceCompliance


def gear_bodies(model: Model, progress: Progress, cache: Cache | None) -> Bodies:
    """Pinion and wheel, from the cache or condensed."""
    bodies = []
    for name in GEARS:
        progress.stage(f"condense {name}")
        bodies.append(gear_body(model, name, cache))
    pinion, wheel = bodies
    return pinion, wheel


def gear_body(model: Model, name: str, cache: Cache | None) -> Body:
    """The "pinion" or the "wheel" over the teeth that interact, from the cache or condensed."""
    section = _section(model, name, cache)
    return Body.of(section, _solid(model, name, cache) if model.scene.three_dimensional else None)


def body_key(model: Model, name: str) -> tuple:
    sections = (getattr(model.scene, effect.section) for effect in effects_on(model.scene) if effect.elasticity)
    own = tuple(given for each in sections if (given := getattr(each, name, None)) is not None)
    number = GEARS.index(name)
    return (
        getattr(model.pair, name),
        model.scene.gears.material_of(name),
        (model.resolution.discretisation(number), discretisation_of(model, number)),
        model.touching.reach,
        own,
    )


def discretisation_of(model: Model, gear: int) -> Discretisation | FaceDiscretisation:
    """How the body of a gear, 0 or 1, is divided in as many dimensions as stresses are recovered in."""
    return model.solid_discretisation(gear) or model.resolution.discretisation(gear)


def _section(model: Model, name: str, cache: Cache | None):
    from fenics_gears.elasticity.gear_compliance import flank_compliance

    reach = model.touching.reach
    for own in from_effects(model.scene, "elasticity", model, name, reach, cache):
        if own is not None:
            return own
    material = model.scene.gears.material_of(name)
    division = model.resolution.discretisation(GEARS.index(name))
    gear = getattr(model.pair, name)
    if gear.web is not None and model.scene.three_dimensional:
        # The web is in the body; here it would be in both sections of which one corrects the other.
        gear = replace(gear, web=None)
    return flank_compliance(gear, material, division, reach, cache)


def _solid(model: Model, name: str, cache: Cache | None) -> FaceCompliance:
    """The body in three dimensions."""
    # Plane runs need none of it.
    from fenics_gears.elasticity.face.compliance import face_compliance
    from fenics_gears.model.face_resolution import face_discretisation

    gear = getattr(model.pair, name)
    material = model.scene.gears.material_of(name)
    division = face_discretisation(model, GEARS.index(name))
    return face_compliance(gear, material, division, model.touching.reach, cache)
