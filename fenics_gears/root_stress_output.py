"""``[output] root_stress``: the stages that add it to a result: rows of both gears, stresses of the march, a quasi-static run beside it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import xarray as xr

from fenics_gears.contact.errors import ContactNotConverged
from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.dynamics.drivetrain import drivetrain
from fenics_gears.dynamics.march import Marcher
from fenics_gears.effects import common_period, effects_on, missing_needs, without
from fenics_gears.elasticity.cache import Cache
from fenics_gears.elasticity.root_stress import RootStressRows, root_stress_rows
from fenics_gears.model import Model, model
from fenics_gears.progress import Progress
from fenics_gears.results.recorder import Recorder
from fenics_gears.results.root_stress_variables import RootStress
from fenics_gears.results.settled import of_settled
from fenics_gears.scene.data import Scene
from fenics_gears.simulation import tooth_reach

LARGEST_STRESS, LARGEST_FORCE = ("root_stress_maximum", "root_stress_at_30_degrees"), ("pair_normal_force", "pair_coast_normal_force")


def root_stress(built: Model, cycle: Cycle, progress: Progress, cache: Cache | None) -> RootStress:
    """The root stress of both gears at the steps of a cycle, ready to be taken at each."""
    rows = []
    for name in ("pinion", "wheel"):
        progress.stage(f"root stress of the {name}")
        rows.append(gear_rows(built, name, cache))
    return RootStress(built.pair, cycle, (rows[0], rows[1]))


def gear_rows(built: Model, name: str, cache: Cache | None) -> RootStressRows:
    """Root stress rows of the "pinion" or the "wheel", on the mesh of its compliance."""
    resolution = built.resolution
    return root_stress_rows(
        getattr(built.pair, name),
        built.scene.gears.material,
        element=resolution.element,
        flank_element_size=resolution.flank_element_size,
        body_element_size=resolution.body_element_size,
        reach=tooth_reach(built),
        coast_flank=built.scene.coast_flanks is not None,
        cache=cache,
    )


def quasi_static(scene: Scene) -> Scene:
    """The scene without inertia and without what needs it."""
    sections = [effect.section for effect in effects_on(scene)]
    removed = {"inertia"}
    while needing := {effect.section for effect, _ in missing_needs([name for name in sections if name not in removed])}:
        removed |= needing
    return without(scene, *(name for name in sections if name in removed))


def dynamic_factors(recorder: Recorder, result: xr.Dataset) -> dict[str, float | str]:
    """Largest force of a tooth pair and largest root stress of a run over those of the same scene without inertia.

    An empty mapping with a reason where the quasi-static scene has no solution: the factors are then not defined.
    """
    built, cycle = recorder.built, recorder.cycle
    scene = quasi_static(built.scene)
    # Where cycles differ all of their period is gone through that was run, else one is as good as any.
    period = min(common_period(scene), built.scene.motion.mesh_cycles)
    motion = replace(scene.motion, mesh_cycles=period, recorded_cycles=1)
    still = model(replace(scene, motion=motion, accuracy=replace(scene.accuracy, steps_per_mesh_cycle=cycle.steps)))
    friction = scene.friction.coefficient if scene.friction else 0.0
    marcher = Marcher(cycle, drivetrain(scene, built.pair), still.time_step, friction, loads=still.loads)
    reference = Recorder(still, cycle, stress=recorder.stress)
    try:
        march = marcher.run(still.steps, 1, observe=reference.take)
    except ContactNotConverged as failure:
        return {"dynamic_factor_unknown": f"the quasi-static run has no solution: {str(failure).splitlines()[0]}"}
    if march.interrupted:
        return {"dynamic_factor_unknown": "the quasi-static run was interrupted"}
    reference.finish()
    moving = {name: of_settled(result)[name].values for name in result.data_vars if name in LARGEST_FORCE + LARGEST_STRESS}
    (stress_moving, force_moving), (stress_still, force_still) = _peaks(moving), _peaks(reference.arrays)
    if not stress_still or not force_still:
        return {"dynamic_factor_unknown": "without inertia nothing touches"}
    return {
        "quasi_static_pair_normal_force": force_still,
        "quasi_static_root_stress": stress_still,
        "dynamic_factor_by_force": force_moving / force_still,
        "dynamic_factor_by_stress": stress_moving / stress_still,
    }


def _peaks(curves: Mapping[str, np.ndarray]) -> tuple[float, float]:
    """Largest root stress (MPa) and largest normal force (N) of a tooth pair."""
    return tuple(
        max(float(np.nanmax(curves[name], initial=0.0)) for name in names if name in curves) for names in (LARGEST_STRESS, LARGEST_FORCE)
    )
