"""The bodies of a model's gears: how each is divided into finite elements, what it depends on, and its elasticity."""

from __future__ import annotations

from contextlib import nullcontext
from dataclasses import replace
from types import ModuleType
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


def gear_bodies(model: Model, progress: Progress, cache: Cache | None) -> Bodies:
    """Pinion and wheel, from the cache or condensed."""
    over_face = model.scene.three_dimensional
    with _solids().begun(model, progress, cache) if over_face else nullcontext(lambda: (None, None)) as solids:
        sections = []
        for name in GEARS:
            progress.stage(f"condense {name}")
            sections.append(_section(model, name, cache))
        pinion, wheel = map(Body.of, sections, solids())
        return pinion, wheel


def gear_body(model: Model, name: str, cache: Cache | None) -> Body:
    """The "pinion" or the "wheel" over the teeth that interact, from the cache or condensed."""
    solid = _solids().solid_of(model, name, cache) if model.scene.three_dimensional else None
    return Body.of(_section(model, name, cache), solid)


def _solids() -> ModuleType:
    """Bodies in three dimensions; of scenes over the face alone."""
    from . import solids

    return solids


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
