"""A scene from its data to its result: the stages of a run, in order."""

from __future__ import annotations

import functools
from typing import TYPE_CHECKING

import numpy as np
import xarray as xr

from fenics_gears.contact.errors import ContactNotConverged
from fenics_gears.dynamics.march import March, Marcher
from fenics_gears.effects import effects_on
from fenics_gears.elasticity.cache import Cache, user_cache
from fenics_gears.errors import ComputationError
from fenics_gears.model.cost import expected_cost, too_large
from fenics_gears.model.model import Model, model_of
from fenics_gears.results.dataset import dataset
from fenics_gears.results.recorder import Recorder
from fenics_gears.results.validity import worst_first
from fenics_gears.scene.data import ELASTIC, LAST_CYCLES, Scene
from fenics_gears.simulation.routes import Preparation, prepared, route_of
from fenics_gears.simulation.warm_up import compile_kernels
from fenics_gears.system.job import Job
from fenics_gears.system.memory import allowed_memory, give_back
from fenics_gears.system.progress import Progress, SilentProgress

if TYPE_CHECKING:
    from fenics_gears.results.journal import Place


def simulate(
    scene: Scene,
    *,
    progress: Progress | None = None,
    cache: Cache | None = None,
    preparation: Preparation | None = None,
    job: Job | None = None,
    journal: Place | None = None,
) -> xr.Dataset:
    """Run a scene whose settings are decided and return its result (docs/result.md); `studies.simulate` chooses them by
    a target first.

    `preparation`: what comes before the march, `prepared` unless given; a study keeps what its runs share. `job`: of
        rank 0,
    whose ranks share the bodies over the face and the remeshing of `condensation = "every step"`.
    `journal`: where a march that lasts longer than a few seconds is written down as it goes (`results.journal`); the
        caller removes it.
    Ctrl-C during the march returns what was done, with the attribute `complete` 0. Raises GeometryError before any
    computation, ComputationError where the run does not fit into the memory it may take; and when a stage fails, with
    what was done before as its attribute `partial`.
    """
    try:
        return _simulated(scene, progress or SilentProgress(), cache or user_cache(), preparation, job, journal)
    finally:
        # Here, where the run's own arrays are free.
        give_back()


def _simulated(
    scene: Scene,
    progress: Progress,
    cache: Cache,
    preparation: Preparation | None,
    job: Job | None,
    journal: Place | None,
) -> xr.Dataset:
    model = model_of(scene)
    for_operators = memory_for_operators(model, 1 if job is None else job.size)
    gears, cycle = (preparation or functools.partial(prepared, job=job))(model, progress, cache)
    cycle.kept.most = for_operators
    progress.stage("compile")
    compiled = compile_kernels(tangential=scene.friction is not None)
    recorder = Recorder(model, cycle, stress=root_stress_of(model, cycle, progress, cache), journal=journal)
    march = _marched(recorder, gears, compiled, progress)
    result = result_of(recorder, march, gears, compiled, "interrupted" if march.interrupted else "")
    return _with_dynamic_factors(recorder, result, progress)


def memory_for_operators(model: Model, ranks: int = 1) -> float:
    """Bytes that contact operators may take beside all else; raises ComputationError where a run does not fit without
    keeping any."""
    allowed, cost = allowed_memory(), expected_cost(model, ranks)
    if said := too_large(model, cost, allowed):
        raise ComputationError(said)
    return allowed - cost.held


def root_stress_of(model: Model, cycle, progress: Progress, cache: Cache):
    """What the recorder needs for root stresses where they are asked for; None for routes without stresses, such as
    rigid flanks."""
    if not (model.scene.output.root_stress and route_of(model).stresses):
        return None
    from fenics_gears.simulation.root_stress import root_stress

    return root_stress(model, cycle, progress, cache)


def _marched(recorder: Recorder, gears, compiled: float, progress: Progress) -> March:
    """The march through time, recorded as it goes; a failure carries the result so far."""
    model, cycle = recorder.model, recorder.cycle
    scene = model.scene
    progress.stage("march")
    try:
        judged = 0 if cycle.traits.prescribes_friction else min(LAST_CYCLES, scene.motion.mesh_cycles) * cycle.steps + 1
        return Marcher(cycle, model.equations_of_motion).run(model.steps, 1, progress.update, recorder.take, judged)
    except ContactNotConverged as failure:
        failure.partial = result_of(recorder, failure.partial, gears, compiled, "failed")
        failure.reason += _varying_load(model, failure.step)
        raise


def _varying_load(model: Model, step: float | None) -> str:
    """That effects load the gears by more than the torque does at a step without solution, in words; empty where they
    do not."""
    names = " and ".join(f"[{each.section}]" for each in effects_on(model.scene) if each.load is not None)
    if not names or step is None:
        return ""
    loads = model.drivetrain.load, sum(load(step) for load in model.loads)
    torque, varying = (float(np.abs(load).max()) for load in loads)
    if varying <= torque:
        return ""
    ways = "smaller amplitudes"
    if model.scene.speed_ramp is not None:
        ways = "a longer ramp (motion.mesh_cycles), ends of [speed_ramp] nearer to each other"
    return (
        f". The torque loads the teeth with {torque:.4g} N, {names} with {varying:.4g} N, which can pull them apart or "
        f"wedge them. Allowed: {ways} or a higher torque"
    )


def _with_dynamic_factors(recorder: Recorder, result: xr.Dataset, progress: Progress) -> xr.Dataset:
    """The result with its dynamic factors, which need a second, quasi-static run; only for complete runs with
    inertia."""
    if recorder.model.scene.inertia is None or not result.attrs["complete"]:
        return result
    from fenics_gears.simulation import dynamic_factor

    if not dynamic_factor.wanted(recorder.model.scene):
        return result
    progress.stage("quasi-static run")
    result.attrs.update(dynamic_factor.dynamic_factors(recorder, result))
    return result


def result_of(recorder: Recorder, march: March, gears, compiled: float, stopped: str) -> xr.Dataset:
    """The dataset of a recorded march; `stopped`: why it did not come to its end, empty where it did."""
    result, model, cycle = dataset(recorder, march), recorder.model, recorder.cycle
    resolution = model.resolution
    result.attrs.update(
        {"stopped": stopped} if stopped else {},
        complete=int(not stopped),
        warnings="\n".join(worst_first([*model.warnings, *result.attrs["warnings"].splitlines()])),
        base_radius_wheel=model.pair.wheel.base_radius,
        element=resolution.element,
        flank_element_size=resolution.flank_element_size,
        contact_length=resolution.contact_grid.length,
        contact_nodes=(cycle.grid if cycle.traits.nodes_on_flanks else resolution.contact_grid).nodes,
        steps_per_mesh_cycle=resolution.steps_per_mesh_cycle,
        condensation=resolution.condensation,
        model=model.scene.accuracy.model or ELASTIC,
        time_mesh=sum(gear.timings["time_mesh"] for gear in gears),
        time_condense=sum(gear.timings["time_condense"] for gear in gears),
        time_compile=compiled + sum(gear.timings["time_compile"] for gear in gears),
    )
    return result
