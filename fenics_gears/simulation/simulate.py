"""A scene whose settings are settled, from its data to its result: the stages of a run, in order."""

from __future__ import annotations

import functools
from collections.abc import Callable
from contextlib import suppress
from math import isinf
from typing import TYPE_CHECKING

import numpy as np
import xarray as xr

from fenics_gears.contact.errors import ContactNotConverged
from fenics_gears.dynamics.march import Marcher
from fenics_gears.dynamics.marched import March
from fenics_gears.effects import effects_on
from fenics_gears.elasticity.cache import Cache, user_cache, writing_meanwhile
from fenics_gears.errors import ComputationError, MemoryEnded, attempted
from fenics_gears.model.cost import expected_cost, too_large
from fenics_gears.model.cost_parts import ExpectedCost
from fenics_gears.model.drivetrain import bore_twist_stiffness
from fenics_gears.model.model import Model, model_of
from fenics_gears.results.dataset import RunResult
from fenics_gears.results.extrema import repeating_steps
from fenics_gears.results.recorder import Recorder
from fenics_gears.results.validity import worst_first
from fenics_gears.scene.data import ELASTIC, LAST_CYCLES, Scene
from fenics_gears.system.job import Job
from fenics_gears.system.memory import allowed_memory, give_back
from fenics_gears.system.progress import Progress, SilentProgress

from . import dynamic_factor
from .routes import Preparation, function_named, prepared, route_of
from .warm_up import compile_kernels, compile_loops

if TYPE_CHECKING:
    from fenics_gears.results.journal import JournalPlace

# The stage that marches through time.
MARCH = "march"
MICROMETRE = 1e-3
Ended = Callable[[RunResult], None]


def solved(
    scene: Scene | Model,
    *,
    progress: Progress | None = None,
    cache: Cache | None = None,
    preparation: Preparation | None = None,
    job: Job | None = None,
    journal: JournalPlace | None = None,
    ended: Ended | None = None,
) -> RunResult:
    """A run whose settings are settled, without proposed lead modifications; its dataset is put together when it is
    asked for. `ended`: is given the result as soon as the march ends; the rest and the errors are those of
    `runs.simulate`."""
    progress = progress or SilentProgress()
    try:
        # Here for what the model and its bodies call; `compile_kernels` of the march finds it done.
        compile_loops(progress)
        model = scene if isinstance(scene, Model) else model_of(scene)
        if model.scene.accuracy.target is not None:
            raise ValueError("the settings of a run with a target are to be settled first: `runs.simulate.settled`")
        prepare = preparation or functools.partial(prepared, job=job)
        alone = preparation is None
        with writing_meanwhile(cache or user_cache()) as kept:
            result = _simulated(model, progress, kept, prepare, journal, alone)
        if ended is not None:
            ended(result)
        _add_dynamic_factors(result, progress)
    except MemoryError:
        raise MemoryEnded("before the run was over") from None
    finally:
        # Here, where the run's own arrays are free.
        give_back()
    return result


def _simulated(
    model: Model, progress: Progress, cache: Cache, prepare: Preparation, journal: JournalPlace | None, alone: bool
) -> RunResult:
    """`alone`: whether no other run comes to the same contact operators."""
    for_operators = memory_for_operators(expected_cost(model), functools.partial(too_large, model))
    gears, cycle = prepare(model, progress, cache)
    cycle.kept.most = for_operators
    cycle.kept.needed = not alone or model.steps > cycle.steps
    progress.stage("compile")
    compiled = compile_kernels(model.scene.friction is not None, cycle.traits.rigid)

    stress = root_stress_of(model, cycle, progress, cache)
    recorder = Recorder(model, cycle, stress=stress, journal=journal)
    progress.stage(MARCH)
    march = _marched(recorder, gears, compiled, progress)
    return result_of(recorder, march, gears, compiled, "interrupted" if march.interrupted else "")


def memory_for_operators(cost: ExpectedCost, refusal: Callable[[ExpectedCost, float], str]) -> float:
    """Bytes that contact operators may take beside all else; raises ComputationError where a run of this cost does not
    fit without any, with the `refusal` of it in the allowed memory (bytes)."""
    allowed = allowed_memory()
    if cost.held > allowed:
        raise ComputationError(refusal(cost, allowed))
    return allowed - cost.held


def root_stress_of(model: Model, cycle, progress: Progress, cache: Cache):
    """What the recorder needs for root stresses where they are asked for; None for routes without stresses."""
    recovered = route_of(model).stresses
    if not (model.scene.output.root_stress and recovered):
        return None
    return function_named(recovered)(model, cycle, progress, cache)


def _marched(recorder: Recorder, gears, compiled: float, progress: Progress) -> March:
    """The march through time, recorded as it goes; a failure carries the result so far."""
    model = recorder.model
    cycle = recorder.cycle
    scene = model.scene
    try:
        judged = 0 if cycle.traits.rigid else min(LAST_CYCLES, scene.motion.mesh_cycles) * cycle.steps + 1
        return Marcher(cycle, model.equations_of_motion).run(
            model.steps, 1, progress.update, recorder.take, judged, repeating_steps(model)
        )
    except ContactNotConverged as failure:
        failure.partial = result_of(recorder, failure.partial, gears, compiled, "failed").dataset
        failure.reason += _varying_load(model, failure.step)
        raise
    except MemoryEnded as failure:
        # The result takes some too.
        cycle.give_up()
        failure.partial = result_of(recorder, failure.partial, gears, compiled, "failed").dataset
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


def _add_dynamic_factors(result: RunResult, progress: Progress) -> None:
    """Give the result its dynamic factors, which need a second, quasi-static run; only complete runs with inertia have
    them."""
    recorder = result.recorder
    if recorder.model.scene.inertia is None or not result.attrs["complete"]:
        return
    if dynamic_factor.wanted(recorder.model.scene):
        progress.stage("quasi-static run")
        factors = attempted(result.attrs, "dynamic factor", lambda: dynamic_factor.dynamic_factors(recorder, result))
        result.attrs.update(factors or {})


def with_lead_correction(result: RunResult, progress: Progress) -> xr.Dataset:
    """The result's dataset with the lead modifications that are proposed for its pinion, where there are any."""
    model = result.recorder.model
    dataset = result.dataset
    proposal = route_of(model).proposal
    if model.scene.three_dimensional and result.attrs["complete"] and proposal:
        function_named(proposal)(dataset, result.recorder, progress)
    return dataset


def result_of(recorder: Recorder, march: March, gears, compiled: float, stopped: str) -> RunResult:
    """The result of a recorded march; `stopped`: why it did not come to its end, empty where it did."""
    model = recorder.model
    cycle = recorder.cycle
    result = None
    resolution = model.resolution
    with suppress(MemoryError):
        result = RunResult(recorder, march)
    if result is None:
        # Not within a handler, which would hold what was made until memory ended.
        cycle.give_up()
        result = RunResult(recorder, march)
    twist = bore_twist_stiffness(model.scene, model.pair)
    result.attrs.update(
        {"stopped": stopped} if stopped else {},
        **({} if isinf(twist) else {"bore_twist_stiffness": twist * MICROMETRE / model.pair.face_width}),
        complete=int(not stopped),
        warnings="\n".join(worst_first([*model.warnings, *result.attrs["warnings"].splitlines()])),
        base_radius_wheel=abs(model.pair.wheel.base_radius),
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
