"""What runs of one process share in memory: the gears condensed last, and the contact operators of the last mesh
cycle."""

from __future__ import annotations

import functools
from dataclasses import replace

from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.effects import effects_on
from fenics_gears.elasticity.cache import Cache
from fenics_gears.elasticity.compliance import Bodies, Body
from fenics_gears.inputs.tree import GEARS
from fenics_gears.model.model import Model
from fenics_gears.scene.data import Scene
from fenics_gears.simulation.bodies import body_key, gear_body
from fenics_gears.simulation.elastic_route import mesh_cycle
from fenics_gears.simulation.routes import CONDENSED, prepared, route_of
from fenics_gears.system.progress import Progress

NO_TIME = {"time_mesh": 0.0, "time_compile": 0.0, "time_condense": 0.0}


class GearStore:
    """Keeps the gears used last and, with `cycles`, the last mesh cycle, so that a frequency sweep builds its operators
    once.

    Two runs share gears that are the same bodies at the same resolution, and a mesh cycle when gears, flanks, contact
    grid, steps, moving coordinates and the presence of friction are the same: speed, masses, springs, torque and
    coefficient may differ. Where only reliefs differ they share its operators, and each relief has gaps of its own.
    Shared gears keep the times that condensing them took; with a shared mesh cycle these times are zero. `most`: how
    many gears are kept, None for all.
    """

    def __init__(self, most: int | None = 2, cycles: bool = True):
        self._gears: dict[tuple, Body] = {}
        self._most, self._cycles = most, cycles
        self._operators_key: tuple | None = None
        self._operators: tuple[Bodies, Cycle] | None = None
        self._cycle_key: tuple | None = None
        self._cycle: Cycle | None = None

    def prepared(self, model: Model, progress: Progress, cache: Cache | None) -> tuple[Bodies, Cycle]:
        """Bodies and mesh cycle for ``simulate``, kept or made."""
        if not self._cycles:
            return self._made(model, progress, cache)
        key, shared = operators_key(model), True
        if key != self._operators_key:
            self._operators_key = self._operators = self._cycle_key = self._cycle = (
                None  # frees its memory before the next is made
            )
            unrelieved = replace(model, removal=(None, None)) if differs_in_gaps_alone(model) else model
            self._operators, self._operators_key, shared = self._made(unrelieved, progress, cache), key, False
        bodies, cycle = self._operators
        if cycle_key(model) != self._cycle_key:
            self._cycle, self._cycle_key = (
                relieved(cycle, model) if differs_in_gaps_alone(model) else cycle,
                cycle_key(model),
            )
        if shared:
            bodies = tuple(replace(gear, timings={**gear.timings, **NO_TIME}) for gear in bodies)
        return bodies, self._cycle

    def body(self, model: Model, name: str, cache: Cache | None) -> Body:
        """The "pinion" or the "wheel", kept, from the cache, or condensed."""
        key = body_key(model, name)
        # Last in the dictionary, last to be given up.
        self._gears[key] = found = self._gears.pop(key, None) or gear_body(model, name, cache)
        while self._most is not None and len(self._gears) > self._most:
            del self._gears[next(iter(self._gears))]
        return found

    def _made(self, model: Model, progress: Progress, cache: Cache | None) -> tuple[Bodies, Cycle]:
        if route_of(model) is not CONDENSED:
            return prepared(model, progress, cache)
        pinion, wheel = (self.body(model, name, cache) for name in GEARS)
        return (pinion, wheel), mesh_cycle(model, (pinion, wheel))


@functools.lru_cache(maxsize=1)
def own_gear_store() -> GearStore:
    """The store of this process."""
    return GearStore()


def differs_in_gaps_alone(model: Model) -> bool:
    """Whether a scene with reliefs has the contact operators of one without: along the line of action, on teeth that
    are all alike."""
    scene = model.scene
    others = (
        scene.corner_contact,
        *(getattr(scene, effect.section) for effect in effects_on(scene) if effect.gaps or effect.elasticity),
    )
    plane = model.face.slices == 1 and route_of(model) is CONDENSED
    return plane and model.removal != (None, None) and all(each is None for each in others)


def relieved(cycle: Cycle, model: Model) -> Cycle:
    """A mesh cycle with the model's reliefs, on the operators of one without."""
    from fenics_gears.contact import relief_gaps

    return relief_gaps.relieved(cycle, model.removal)


def operators_key(model: Model) -> tuple:
    """What the contact operators of a mesh cycle depend on, their gaps apart where reliefs change nothing else."""
    scene, resolution = model.scene, model.resolution
    accuracy = (
        resolution.condensation,
        resolution.discretisation(0),
        resolution.discretisation(1),
        resolution.contact_grid,
        resolution.steps_per_mesh_cycle,
    )
    in_operators = (
        scene.corner_contact,
        *(getattr(scene, effect.section) for effect in effects_on(scene) if effect.gaps or effect.elasticity),
    )
    apart = model.removal == (None, None) or differs_in_gaps_alone(model)
    springs = scene.accuracy.model, None if scene.resolves_contact else scene.load
    own, divided = None if apart else _reliefs(scene), tuple(model.solid_discretisation(gear) for gear in (0, 1))
    return (
        scene.gears,
        in_operators,
        scene.coast_flanks is not None,
        (accuracy, springs, model.face.slices, divided, scene.lead_modifications, scene.misalignment),
        own,
        tuple(model.drivetrain.indices),
        scene.friction is not None,
    )


def cycle_key(model: Model) -> tuple:
    """What the contact equations of a mesh cycle depend on."""
    return *operators_key(model), _reliefs(model.scene)


def _reliefs(scene: Scene) -> tuple:
    return tuple(getattr(scene, effect.section) for effect in effects_on(scene) if effect.removal)
