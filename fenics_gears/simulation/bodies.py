"""The bodies of a model's gears: how each is divided into finite elements, what it depends on, and its elasticity."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fenics_gears.effects import effects_on, from_effects
from fenics_gears.elasticity.cache import Cache
from fenics_gears.elasticity.compliance import Bodies, Body
from fenics_gears.elasticity.element_sizes import Discretisation
from fenics_gears.inputs.tree import GEARS
from fenics_gears.model.model import Model
from fenics_gears.system.job import Job
from fenics_gears.system.progress import Progress

if TYPE_CHECKING:
    from fenics_gears.elasticity.face.discretisation import FaceDiscretisation
    from fenics_gears.elasticity.face_compliance_data import FaceCompliance


def gear_bodies(model: Model, progress: Progress, cache: Cache | None, job: Job | None = None) -> Bodies:
    """Pinion and wheel, from the cache or condensed; `job`: whose ranks share the work on each body over its face."""
    bodies = []
    for name in GEARS:
        progress.stage(f"condense {name}{_way(model, name, job)}")
        bodies.append(gear_body(model, name, cache, job))
    return bodies[0], bodies[1]


def gear_body(model: Model, name: str, cache: Cache | None, job: Job | None = None) -> Body:
    """The "pinion" or the "wheel" over the teeth that interact, from the cache or condensed."""
    return Body.of(_section(model, name, cache), _solid(model, name, cache, job))


def body_key(model: Model, name: str) -> tuple:
    """What the body of the "pinion" or the "wheel" depends on."""
    sections = (getattr(model.scene, effect.section) for effect in effects_on(model.scene) if effect.elasticity)
    own = tuple(found for each in sections if (found := getattr(each, name, None)) is not None)
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
    reach = model.touching.reach
    own = [each for each in from_effects(model.scene, "elasticity", model, name, reach, cache) if each is not None]
    if own:
        return own[0]
    # Imported here: rigid flanks have none.
    from fenics_gears.elasticity.gear_compliance import flank_compliance

    material, division = model.scene.gears.material_of(name), model.resolution.discretisation(GEARS.index(name))
    return flank_compliance(getattr(model.pair, name), material, division, reach, cache)


def _solid(model: Model, name: str, cache: Cache | None, job: Job | None) -> FaceCompliance | None:
    division = model.solid_discretisation(GEARS.index(name))
    if division is None:
        return None
    # Imported here: plane scenes have none.
    from fenics_gears.elasticity.face.compliance import face_compliance

    gear, material = getattr(model.pair, name), model.scene.gears.material_of(name)
    return face_compliance(gear, material, division, model.touching.reach, cache, job)


def _way(model: Model, name: str, job: Job | None) -> str:
    """Conjugate gradients, in words, where a body is condensed by them: they take a multiple of the time."""
    if model.solid_discretisation(GEARS.index(name)) is None:
        return ""
    from fenics_gears.model.face_cost import by_gradients

    return " by conjugate gradients" if by_gradients(model, GEARS.index(name), 1 if job is None else job.size) else ""
