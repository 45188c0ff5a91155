"""The bodies of a model's gears: how each is divided into finite elements, what it depends on, and its elasticity."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

from fenics_gears.effects import effects_on, from_effects
from fenics_gears.elasticity.cache import Cache
from fenics_gears.elasticity.compliance import Bodies, Body
from fenics_gears.elasticity.element_sizes import Discretisation
from fenics_gears.inputs.tree import GEARS
from fenics_gears.model.face_cost import both_at_once
from fenics_gears.model.face_resolution import face_discretisation
from fenics_gears.model.model import Model
from fenics_gears.system.progress import Progress
from fenics_gears.system.second_process import second_process, threads

if TYPE_CHECKING:
    from fenics_gears.elasticity.face.discretisation import FaceDiscretisation
    from fenics_gears.elasticity.face_compliance_data import FaceCompliance
    from fenics_gears.system.second_process import SecondProcess

    Solids = tuple[FaceCompliance | None, FaceCompliance | None]


def gear_bodies(model: Model, progress: Progress, cache: Cache | None) -> Bodies:
    """Pinion and wheel, from the cache or condensed."""
    with _begun(model, progress, cache) as solids:
        sections = []
        for name in GEARS:
            progress.stage(f"condense {name}")
            sections.append(_section(model, name, cache))
        pinion, wheel = map(Body.of, sections, solids())
        return pinion, wheel


def gear_body(model: Model, name: str, cache: Cache | None) -> Body:
    """The "pinion" or the "wheel" over the teeth that interact, from the cache or condensed."""
    solid = None if model.solid_discretisation(GEARS.index(name)) is None else solid_of(model, name, cache)
    return Body.of(_section(model, name, cache), solid)


def body_key(model: Model, name: str) -> tuple:
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


def solids_of(model: Model, progress: Progress, cache: Cache | None) -> Solids:
    """Both bodies in three dimensions, at once where there are cores and memory for it; None of a plane scene."""
    with _begun(model, progress, cache) as solids:
        return solids()


@contextmanager
def _begun(model: Model, progress: Progress, cache: Cache | None) -> Iterator[Callable[[], Solids]]:
    """What gives both bodies in three dimensions. Where there are cores and memory for both at once, a second process
    begins the wheel's here: to start it takes as long as both gears' sections."""
    if model.solid_discretisation(0) is None:
        yield lambda: (None, None)
        return

    def begin(number: int) -> None:
        progress.stage(f"condense {GEARS[number]}'s body")

    def by(wheel: Callable[[], FaceCompliance]) -> Solids:
        begin(0)
        pinion = solid_of(model, GEARS[0], cache)
        begin(1)
        return pinion, wheel()

    if threads() > 1 and both_at_once(model):
        with ThreadPoolExecutor(1) as waiting, second_process() as second:
            yield partial(by, waiting.submit(solid_of, model, GEARS[1], cache, second).result)
    else:
        yield partial(by, lambda: solid_of(model, GEARS[1], cache))


def solid_of(model: Model, name: str, cache: Cache | None, process: SecondProcess | None = None) -> FaceCompliance:
    """The body of the "pinion" or the "wheel" in three dimensions, from the cache or condensed."""
    from fenics_gears.elasticity.face.compliance import face_compliance

    gear = getattr(model.pair, name)
    material = model.scene.gears.material_of(name)
    division = face_discretisation(model, GEARS.index(name))
    return face_compliance(gear, material, division, model.touching.reach, cache, process)
