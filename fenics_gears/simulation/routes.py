"""The routes from a model to its contact equations: one row for each, with what it offers.

Each route is imported when it is taken: a run whose gears are all in the cache needs neither gmsh nor DOLFINx.
"""

import importlib
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.elasticity.cache import Cache
from fenics_gears.model.model import Model
from fenics_gears.model.resolution import EVERY_STEP
from fenics_gears.scene.data import ELASTIC, ISO_6336, STIFFNESS_TABLE
from fenics_gears.system.job import Job
from fenics_gears.system.progress import Progress

Prepared = tuple[tuple[Any, ...], Cycle]
Preparation = Callable[[Model, Progress, Cache | None], Prepared]


@dataclass(frozen=True)
class Route:
    """A way to the contact equations: the function `module:function` that takes (model, progress, cache, job) and
    returns gears and cycle. `condensed_once`: its gears are flank compliances that other runs can share. Further
    functions, empty where the route has none: `stresses`, which takes (model, cycle, progress, cache) and recovers root
    stresses; `proposal`, which takes (dataset, recorder, progress) and adds lead modifications to a run over the
    face."""

    function: str
    condensed_once: bool = False
    stresses: str = ""
    proposal: str = ""

    def __call__(self, model: Model, progress: Progress, cache: Cache | None, job: Job | None = None) -> Prepared:
        return function_named(self.function)(model, progress, cache, job)


def function_named(name: str) -> Callable:
    """The function `module:function` of this folder."""
    module, _, function = name.partition(":")
    return getattr(importlib.import_module(f"fenics_gears.simulation.{module}"), function)


RIGID = Route("rigid_route:rigid_route")
REMESHED = Route("reference_route:reference_route")
ISO_SPRINGS = Route("mesh_springs:iso_route")
TABLE_SPRINGS = Route("mesh_springs:table_route", condensed_once=True)
CONDENSED = Route(
    "elastic_route:elastic_route",
    condensed_once=True,
    stresses="root_stress:root_stress",
    proposal="lead_correction:add_proposal",
)
BY_MODEL = {None: CONDENSED, ELASTIC: CONDENSED, ISO_6336: ISO_SPRINGS, STIFFNESS_TABLE: TABLE_SPRINGS}


def route_of(model: Model) -> Route:
    if model.scene.tooth_elasticity is None:
        return RIGID
    return REMESHED if model.resolution.condensation == EVERY_STEP else BY_MODEL[model.scene.accuracy.model]


def prepared(model: Model, progress: Progress, cache: Cache | None, job: Job | None = None) -> Prepared:
    """The gears' elasticity and the contact equations on it, by the model's route."""
    return route_of(model)(model, progress, cache, job)
