"""What runs of one process share in memory: the gears condensed last, and the contact operators of the last mesh cycle."""

from __future__ import annotations

import functools
from dataclasses import replace

from fenics_gears.contact.mesh_cycle import MeshCycle
from fenics_gears.effects import EFFECTS
from fenics_gears.elasticity.cache import Cache
from fenics_gears.elasticity.compliance import FlankCompliance, Reach
from fenics_gears.model.model import Model
from fenics_gears.simulation.elastic_route import Compliances, gear_compliance, mesh_cycle
from fenics_gears.simulation.routes import CONDENSED, prepared, route_of
from fenics_gears.system.progress import Progress

GEARS = ("pinion", "wheel")
NO_TIME = {"time_mesh": 0.0, "time_compile": 0.0, "time_condense": 0.0}


class GearStore:
    """Keeps the gears used last and, with `cycles`, the last mesh cycle, so that a frequency sweep builds its operators once.

    Two runs share gears that are the same bodies at the same resolution, and a mesh cycle when gears, flanks, contact grid,
    steps, moving coordinates and the presence of friction are the same: speed, masses, springs, torque and coefficient may differ.
    Shared gears keep the times that condensing them took; with a shared mesh cycle these times are zero. `most`: how many gears are kept,
    None for all.
    """

    def __init__(self, most: int | None = 2, cycles: bool = True):
        self._gears: dict[tuple, FlankCompliance] = {}
        self._most, self._cycles = most, cycles
        self._cycle_key: tuple | None = None
        self._prepared: tuple[Compliances, MeshCycle] | None = None

    def prepared(self, model: Model, progress: Progress, cache: Cache | None) -> tuple[Compliances, MeshCycle]:
        """Compliances and mesh cycle for ``simulate``, kept or made."""
        key = cycle_key(model)
        if self._cycles and key == self._cycle_key:
            compliances, cycle = self._prepared
            return tuple(replace(gear, timings={**gear.timings, **NO_TIME}) for gear in compliances), cycle
        self._cycle_key = self._prepared = None  # frees its memory before the next is made
        made = self._made(model, progress, cache)
        if self._cycles:
            self._cycle_key, self._prepared = key, made
        return made

    def gear(self, model: Model, name: str, reach: Reach, cache: Cache | None) -> FlankCompliance:
        """Flank compliance of the "pinion" or the "wheel", kept, from the cache, or condensed."""
        key = gear_key(model, name, reach)
        # Last in the dictionary, last to be given up.
        self._gears[key] = self._gears.pop(key, None) or gear_compliance(model, name, reach, cache)
        return self._gears[key]

    def _made(self, model: Model, progress: Progress, cache: Cache | None) -> tuple[Compliances, MeshCycle]:
        if route_of(model) is not CONDENSED:
            return prepared(model, progress, cache)
        reach = model.touching.reach
        compliances = tuple(self.gear(model, name, reach, cache) for name in GEARS)
        while self._most is not None and len(self._gears) > self._most:
            del self._gears[next(iter(self._gears))]
        return compliances, mesh_cycle(model, compliances)


@functools.lru_cache(maxsize=1)
def own_gear_store() -> GearStore:
    """The store of this process."""
    return GearStore()


def gear_key(model: Model, name: str, reach: Reach) -> tuple:
    """What a gear's flank compliance depends on."""
    own = tuple(getattr(getattr(model.scene, effect.section), name, None) for effect in EFFECTS if effect.elasticity)
    return getattr(model.pair, name), model.scene.gears.material_of(name), model.resolution.discretisation(GEARS.index(name)), reach, own


def cycle_key(model: Model) -> tuple:
    """What the contact operators of a mesh cycle depend on."""
    scene, resolution = model.scene, model.resolution
    accuracy = resolution.condensation, resolution.discretisation(0), resolution.discretisation(1), resolution.contact_grid, resolution.steps_per_mesh_cycle
    in_operators = (scene.corner_contact, *(getattr(scene, effect.section) for effect in EFFECTS if effect.removal or effect.gaps or effect.elasticity))
    springs = scene.accuracy.model, None if scene.resolves_contact else scene.load
    return scene.gears, in_operators, scene.coast_flanks is not None, (accuracy, springs), tuple(model.drivetrain.indices), scene.friction is not None
