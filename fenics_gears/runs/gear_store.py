"""What runs of one process share in memory: the gears condensed last, and the contact operators of the last mesh
cycle."""

from __future__ import annotations

import functools
from dataclasses import replace

from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.effects import effects_on
from fenics_gears.elasticity.cache import Cache
from fenics_gears.elasticity.compliance import FlankCompliance, Reach
from fenics_gears.model.model import Model
from fenics_gears.scene.data import Scene
from fenics_gears.simulation.elastic_route import Compliances, gear_compliance, mesh_cycle
from fenics_gears.simulation.routes import CONDENSED, ON_FACE, prepared, route_of
from fenics_gears.system.progress import Progress

GEARS = ("pinion", "wheel")
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
        self._gears: dict[tuple, FlankCompliance] = {}
        self._bodies: dict[tuple, object] = {}
        self._most, self._cycles = most, cycles
        self._operators_key: tuple | None = None
        self._operators: tuple[Compliances, Cycle] | None = None
        self._cycle_key: tuple | None = None
        self._cycle: Cycle | None = None

    def prepared(self, model: Model, progress: Progress, cache: Cache | None) -> tuple[Compliances, Cycle]:
        """Compliances and mesh cycle for ``simulate``, kept or made."""
        if not self._cycles:
            return self._made(model, progress, cache)
        key, shared = operators_key(model), True
        if key != self._operators_key:
            self._operators_key = self._operators = self._cycle_key = self._cycle = (
                None  # frees its memory before the next is made
            )
            unrelieved = replace(model, removal=(None, None)) if differs_in_gaps_alone(model) else model
            self._operators, self._operators_key, shared = self._made(unrelieved, progress, cache), key, False
        compliances, cycle = self._operators
        if cycle_key(model) != self._cycle_key:
            self._cycle, self._cycle_key = (
                relieved(cycle, model) if differs_in_gaps_alone(model) else cycle,
                cycle_key(model),
            )
        if shared:
            compliances = tuple(replace(gear, timings={**gear.timings, **NO_TIME}) for gear in compliances)
        return compliances, self._cycle

    def gear(self, model: Model, name: str, reach: Reach, cache: Cache | None) -> FlankCompliance:
        """Flank compliance of the "pinion" or the "wheel", kept, from the cache, or condensed."""
        key = gear_key(model, name, reach)
        # Last in the dictionary, last to be given up.
        self._gears[key] = self._gears.pop(key, None) or gear_compliance(model, name, reach, cache)
        return self._gears[key]

    def _made(self, model: Model, progress: Progress, cache: Cache | None) -> tuple[Compliances, Cycle]:
        if route_of(model) not in (CONDENSED, ON_FACE):
            return prepared(model, progress, cache)
        reach = model.touching.reach
        compliances = tuple(self.gear(model, name, reach, cache) for name in GEARS)
        self._forget(self._gears)
        if model.face is None:
            return compliances, mesh_cycle(model, compliances)
        # Imported here: plane scenes have none.
        from fenics_gears.simulation.face_route import face_cycle

        bodies = tuple(self.body(model, name, reach, cache) for name in GEARS)
        return (*compliances, *bodies), face_cycle(model, compliances, bodies)

    def body(self, model: Model, name: str, reach: Reach, cache: Cache | None):
        """Compliance of the "pinion" or the "wheel" over its face, kept, from the cache, or condensed."""
        from fenics_gears.simulation.face_route import gear_body

        key = body_key(model, name, reach)
        self._bodies[key] = self._bodies.pop(key, None) or gear_body(model, name, reach, cache)
        self._forget(self._bodies)
        return self._bodies[key]

    def _forget(self, kept: dict) -> None:
        while self._most is not None and len(kept) > self._most:
            del kept[next(iter(kept))]


@functools.lru_cache(maxsize=1)
def own_gear_store() -> GearStore:
    """The store of this process."""
    return GearStore()


def gear_key(model: Model, name: str, reach: Reach) -> tuple:
    """What a gear's flank compliance depends on."""
    sections = (getattr(model.scene, effect.section) for effect in effects_on(model.scene) if effect.elasticity)
    own = tuple(found for each in sections if (found := getattr(each, name, None)) is not None)
    return (
        getattr(model.pair, name),
        model.scene.gears.material_of(name),
        model.resolution.discretisation(GEARS.index(name)),
        reach,
        own,
    )


def body_key(model: Model, name: str, reach: Reach) -> tuple:
    """What a gear's compliance over the face depends on."""
    # Imported here: plane scenes have none.
    from fenics_gears.model.face_resolution import face_discretisation

    return (
        getattr(model.pair, name),
        model.scene.gears.material_of(name),
        face_discretisation(model, GEARS.index(name)),
        reach,
    )


def differs_in_gaps_alone(model: Model) -> bool:
    """Whether a scene with reliefs has the contact operators of one without: along the line of action, on teeth that
    are all alike."""
    scene = model.scene
    others = (
        scene.corner_contact,
        *(getattr(scene, effect.section) for effect in effects_on(scene) if effect.gaps or effect.elasticity),
    )
    return model.removal != (None, None) and route_of(model) is CONDENSED and all(each is None for each in others)


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
    own = None if apart else _reliefs(scene)
    return (
        scene.gears,
        in_operators,
        scene.coast_flanks is not None,
        (accuracy, springs, _over_face(model)),
        own,
        tuple(model.drivetrain.indices),
        scene.friction is not None,
    )


def _over_face(model: Model) -> tuple | None:
    """What operators over a face depend on beside; None in the plane."""
    if model.face is None:
        return None
    from fenics_gears.model.face_resolution import face_discretisation

    divided = tuple(face_discretisation(model, gear) for gear in range(len(GEARS)))
    return model.face.slices, divided, model.scene.lead_modifications, model.scene.misalignment


def cycle_key(model: Model) -> tuple:
    """What the contact equations of a mesh cycle depend on."""
    return *operators_key(model), _reliefs(model.scene)


def _reliefs(scene: Scene) -> tuple:
    return tuple(getattr(scene, effect.section) for effect in effects_on(scene) if effect.removal)
