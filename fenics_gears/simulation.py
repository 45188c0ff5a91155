"""A scene from its data to its result: the stages of a run, in order."""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import TYPE_CHECKING

import xarray as xr

from fenics_gears.contact.errors import ContactNotConverged
from fenics_gears.contact.mesh_cycle import Cycle, MeshCycle
from fenics_gears.contact.mesh_cycle import tooth_reach as reach_of_contact
from fenics_gears.contact.tooth_pair import Flanks
from fenics_gears.dynamics.march import March, Marcher
from fenics_gears.effects import effects_on
from fenics_gears.elasticity.cache import Cache, user_cache
from fenics_gears.elasticity.compliance import FlankCompliance, Reach
from fenics_gears.model import Model, model
from fenics_gears.progress import Progress, SilentProgress
from fenics_gears.resolution import EVERY_STEP
from fenics_gears.results import dataset
from fenics_gears.results.recorder import Recorder
from fenics_gears.scene.data import ELASTIC, ISO_6336, LAST_CYCLES, STIFFNESS_TABLE, Scene
from fenics_gears.validity import worst_first
from fenics_gears.warm_up import compile_kernels

if TYPE_CHECKING:
    from fenics_gears.elasticity.remeshing import RemeshedStiffness

Compliances = tuple[FlankCompliance, FlankCompliance]
Preparation = Callable[[Model, Progress, Cache | None], "tuple[Compliances | tuple[RemeshedStiffness, RemeshedStiffness], Cycle]"]


def simulate(
    scene: Scene,
    *,
    progress: Progress | None = None,
    cache: Cache | None = None,
    preparation: Preparation | None = None,
    comm=None,
) -> xr.Dataset:
    """Run a scene and return its result (docs/result.md).

    `preparation`: what comes before the march, `prepared` unless given; a study keeps what its runs share. `comm`: communicator
    of rank 0 of an MPI job whose other ranks call `assist`; they share the remeshing of `condensation = "every step"`.
    `[accuracy] target`: settings are chosen first, by runs of their own, and the result tells its estimated error.
    Ctrl-C during the march returns what was done, with the attribute `complete` 0. Raises GeometryError before any
    computation; ComputationError when a stage fails, with what was done before as its attribute `partial`.
    """
    progress = progress if progress is not None else SilentProgress()
    if scene.accuracy.target is not None:
        # Imported here: settings are chosen by simulating scenes that have them.
        from fenics_gears.studies.accuracy_target.run import simulate_to_target

        return simulate_to_target(scene, progress=progress, cache=cache, preparation=preparation, comm=comm)
    built = model(scene)
    preparation = preparation or functools.partial(prepared, comm=comm)
    cache = cache if cache is not None else user_cache()
    gears, cycle = preparation(built, progress, cache)
    progress.stage("compile")
    compiled = compile_kernels(tangential=scene.friction is not None)
    stress = None
    # A scene less its elastic teeth, as the cost of effects is measured by, has no stresses; a scene file is refused that asks for both.
    if scene.output.root_stress and scene.resolves_contact and scene.accuracy.condensation != EVERY_STEP:
        from fenics_gears.root_stress_output import root_stress

        stress = root_stress(built, cycle, progress, cache)
    recorder = Recorder(built, cycle, stress=stress)
    friction = scene.friction.coefficient if scene.friction else 0.0
    marcher = Marcher(cycle, built.drivetrain, built.time_step, friction, built.pace, built.clock, built.loads)
    progress.stage("march")
    try:
        march = marcher.run(built.steps, min(LAST_CYCLES, scene.motion.mesh_cycles) * cycle.steps + 1, progress.update, recorder.take)
    except ContactNotConverged as failure:
        failure.partial = _result(recorder, failure.partial, gears, compiled, complete=False)
        raise
    result = _result(recorder, march, gears, compiled, complete=not march.interrupted)
    if scene.inertia is None or not result.attrs["complete"]:
        return result
    from fenics_gears import dynamic_factor

    if not dynamic_factor.wanted(scene):
        return result
    progress.stage("quasi-static run")
    return result.assign_attrs(dynamic_factor.dynamic_factors(recorder, result))


def assist(scene: Scene, comm) -> None:
    """What the other ranks of a job do while rank 0 calls `simulate(scene, comm=comm)`: their share of the remeshing, if there is any."""
    built = model(scene)
    if built.resolution.condensation == EVERY_STEP and scene.tooth_elasticity is not None:
        from fenics_gears.reference_route import remeshed

        remeshed(built, SilentProgress(), None, comm)


def prepared(built: Model, progress: Progress, cache: Cache | None, comm=None):
    """The gears' elasticity and the contact operators on it, by the model and the condensation that the scene asks for."""
    chosen = built.scene.accuracy.model
    if built.scene.tooth_elasticity is None:
        return (), rigid_cycle(built)
    if built.resolution.condensation == EVERY_STEP:
        # Imported here: a run whose gears are all in the cache needs neither gmsh nor DOLFINx.
        from fenics_gears.reference_route import remeshed

        gears, cycle = remeshed(built, progress, cache, comm)
        return gears, deviating(built, cycle)
    if chosen == ISO_6336:
        from fenics_gears.mesh_springs import iso_cycle

        return (), deviating(built, iso_cycle(built))
    compliances = gear_compliances(built, progress, cache)
    if chosen == STIFFNESS_TABLE:
        from fenics_gears.mesh_springs import table_cycle

        progress.stage("tabulate the mesh stiffness")
        compliances, cycle = table_cycle(built, compliances)
        return compliances, deviating(built, cycle)
    return compliances, mesh_cycle(built, compliances)


def gear_compliances(built: Model, progress: Progress, cache: Cache | None) -> Compliances:
    """Flank compliance of pinion and wheel, reaching as many teeth as can be loaded together."""
    compliances, reach = [], tooth_reach(built)
    for name in ("pinion", "wheel"):
        progress.stage(f"condense {name}")
        compliances.append(gear_compliance(built, name, reach, cache))
    return compliances[0], compliances[1]


def tooth_reach(built: Model) -> Reach:
    """How far apart teeth are that can be loaded together."""
    resolution = built.resolution
    return reach_of_contact(
        built.pair, resolution.contact_grid, resolution.steps_per_mesh_cycle, built.scene.coast_flanks is not None, built.corner
    )


def gear_compliance(built: Model, name: str, reach: Reach, cache: Cache | None) -> FlankCompliance:
    """Flank compliance of the "pinion" or the "wheel" over the teeth within reach, from the cache where it is there."""
    for effect in effects_on(built.scene):
        own = effect.elasticity and effect.elasticity(getattr(built.scene, effect.section), built, name, reach, cache)
        if own is not None:
            return own
    # Imported here: rigid flanks have none.
    from fenics_gears.elasticity.gear_compliance import flank_compliance

    resolution = built.resolution
    return flank_compliance(
        getattr(built.pair, name),
        built.scene.gears.material_of(name),
        element=resolution.element,
        flank_element_size=resolution.flank_element_size,
        reach=reach,
        body_element_size=resolution.body_element_size,
        elastic_teeth=resolution.elastic_teeth,
        cache=cache,
    )


def mesh_cycle(built: Model, compliances: Compliances) -> Cycle:
    """The contact operators of one mesh cycle, for the centre coordinates and the friction that the scene has."""
    cycle = _cycle_of(compliances)(
        Flanks(built.pair, compliances, built.removal),
        built.resolution.contact_grid,
        built.resolution.steps_per_mesh_cycle,
        built.drivetrain.indices,
        tangential=built.scene.friction is not None,
        corner=built.corner,
    )
    return deviating(built, cycle)


def _cycle_of(compliances: Compliances):
    """One mesh cycle for all where all teeth are alike."""
    if all(each.alike for each in compliances):
        return MeshCycle
    from fenics_gears.contact.whole_body_cycle import WholeBodyCycle

    return WholeBodyCycle


def rigid_cycle(built: Model) -> Cycle:
    """The contact of one mesh cycle between flanks that do not give way."""
    if built.scene.friction is None:
        from fenics_gears.contact.rigid_cycle import RigidCycle as kind
    else:
        from fenics_gears.contact.rigid_friction import RigidFrictionCycle as kind

    resolution = built.resolution
    coast = built.scene.coast_flanks is not None
    cycle = kind(
        built.pair, built.removal, resolution.contact_grid, resolution.steps_per_mesh_cycle, built.drivetrain.indices, coast
    )
    return deviating(built, cycle)


def deviating(built: Model, cycle: Cycle) -> Cycle:
    """The cycle with what the scene's effects add to its gaps from step to step."""
    scene = built.scene
    effects = [effect for effect in effects_on(scene) if effect.gaps is not None]
    if not effects:
        return cycle
    from fenics_gears.contact.deviating_cycle import DeviatingCycle

    return DeviatingCycle(cycle, [effect.gaps(getattr(scene, effect.section), built) for effect in effects])


def _result(recorder: Recorder, march: March, gears, compiled: float, complete: bool) -> xr.Dataset:
    result, built, cycle = dataset(recorder, march), recorder.built, recorder.cycle
    resolution = built.resolution
    stopped = {} if complete else {"stopped": "interrupted" if march.interrupted else "failed"}
    return result.assign_attrs(
        stopped,
        complete=int(complete),
        warnings="\n".join(worst_first([*built.warnings, *result.attrs["warnings"].splitlines()])),
        base_radius_wheel=built.pair.wheel.base_radius,
        element=resolution.element,
        flank_element_size=resolution.flank_element_size,
        contact_length=resolution.contact_grid.length,
        contact_nodes=(cycle.grid if cycle.resolves_flanks else resolution.contact_grid).nodes,
        steps_per_mesh_cycle=resolution.steps_per_mesh_cycle,
        condensation=resolution.condensation,
        model=built.scene.accuracy.model or ELASTIC,
        time_mesh=sum(gear.timings["time_mesh"] for gear in gears),
        time_condense=sum(gear.timings["time_condense"] for gear in gears),
        time_compile=compiled + sum(gear.timings["time_compile"] for gear in gears),
    )
