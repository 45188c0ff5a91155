"""What the runs of one process share: the gears condensed last, and the contact operators of the last mesh cycle."""

from __future__ import annotations

import functools
from dataclasses import replace

from fenics_gears.contact.mesh_cycle import MeshCycle
from fenics_gears.effects import EFFECTS
from fenics_gears.elasticity.cache import Cache
from fenics_gears.elasticity.compliance import FlankCompliance, Reach
from fenics_gears.model.model import Model
from fenics_gears.model.resolution import EVERY_STEP
from fenics_gears.scene.data import ISO_6336
from fenics_gears.simulation.elastic_route import Compliances, gear_compliance, mesh_cycle, tooth_reach
from fenics_gears.simulation.routes import prepared
from fenics_gears.system.progress import Progress

GEARS = ("pinion", "wheel")
NO_TIME = {"time_mesh": 0.0, "time_compile": 0.0, "time_condense": 0.0}


class GearStore:
    """Keeps the gears used last and, if wanted, the last mesh cycle; a frequency sweep builds its operators once.

    Two runs share gears that are the same bodies at the same resolution, and a mesh cycle when gears, flanks, contact grid,
    steps, moving coordinates and the presence of friction are the same: speed, masses, springs, torque and coefficient may differ.
    Gears that are shared keep the times that they took, those of a mesh cycle that is took none. `most`: how many gears; all for None.
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
        if model.resolution.condensation == EVERY_STEP or not model.scene.resolves_contact:
            return prepared(model, progress, cache)
        reach = tooth_reach(model)
        compliances = tuple(self.gear(model, name, reach, cache) for name in GEARS)
        while self._most is not None and len(self._gears) > self._most:
            del self._gears[next(iter(self._gears))]
        return compliances, mesh_cycle(model, compliances)


@functools.lru_cache(maxsize=1)
def own_gear_store() -> GearStore:
    """That of this process."""
    return GearStore()


def has_gears(model: Model) -> bool:
    """Whether a scene's model needs the gears' elasticity."""
    return model.scene.tooth_elasticity is not None and model.scene.accuracy.model != ISO_6336


def gear_key(model: Model, name: str, reach: Reach) -> tuple:
    """What a gear's flank compliance depends on."""
    own = tuple(getattr(getattr(model.scene, effect.section), name, None) for effect in EFFECTS if effect.elasticity)
    return getattr(model.pair, name), model.scene.gears.material_of(name), model.resolution.discretisation, reach, own


def cycle_key(model: Model) -> tuple:
    """What the contact operators of a mesh cycle depend on."""
    scene, resolution = model.scene, model.resolution
    accuracy = resolution.condensation, resolution.discretisation, resolution.contact_grid, resolution.steps_per_mesh_cycle
    in_operators = (scene.corner_contact, *(getattr(scene, effect.section) for effect in EFFECTS if effect.removal or effect.gaps or effect.elasticity))
    springs = scene.accuracy.model, None if scene.resolves_contact else scene.load
    return scene.gears, in_operators, scene.coast_flanks is not None, (accuracy, springs), tuple(model.drivetrain.indices), scene.friction is not None
