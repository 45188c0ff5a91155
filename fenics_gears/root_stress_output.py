"""``[output] root_stress``: the stages that add it to a result: rows of both gears, stresses of the march, a quasi-static run beside it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import xarray as xr

from fenics_gears.contact.errors import ContactNotConverged
from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.dynamics.drivetrain import drivetrain
from fenics_gears.dynamics.march import March, Marcher, Record
from fenics_gears.effects import effects_on, missing_needs, without
from fenics_gears.elasticity.cache import Cache
from fenics_gears.elasticity.root_stress import RootStressRows, root_stress_rows
from fenics_gears.model import Model, model
from fenics_gears.progress import Progress
from fenics_gears.results.root_stress_variables import RootStress, peaks, root_stress_variables
from fenics_gears.scene.data import Scene
from fenics_gears.simulation import tooth_reach


def with_root_stress(result: xr.Dataset, built: Model, cycle: Cycle, march: March, progress: Progress, cache: Cache | None) -> xr.Dataset:
    """The result of a march with the root stress of its stored steps and, of a complete run with inertia, its dynamic factors."""
    rows = []
    for name in ("pinion", "wheel"):
        progress.stage(f"root stress of the {name}")
        rows.append(gear_rows(built, name, cache))
    stress = RootStress(built.pair, cycle, (rows[0], rows[1]))
    result = result.merge(root_stress_variables(stress, march.records, result["pair"].values), combine_attrs="override")
    if built.scene.inertia is None or not result.attrs["complete"]:
        return result
    progress.stage("quasi-static run")
    return result.assign_attrs(dynamic_factors(built, cycle, march, stress))


def gear_rows(built: Model, name: str, cache: Cache | None) -> RootStressRows:
    """Root stress rows of the "pinion" or the "wheel", on the mesh of its compliance."""
    resolution = built.resolution
    return root_stress_rows(
        getattr(built.pair, name),
        built.scene.gears.material,
        element=resolution.element,
        flank_element_size=resolution.flank_element_size,
        body_element_size=resolution.body_element_size,
        # Pairs are numbered by their drive flanks' teeth; the wheel's tooth of a coast pair stands one beside.
        reach=tooth_reach(built).farthest + 1,
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


def dynamic_factors(built: Model, cycle: Cycle, march: March, stress: RootStress) -> dict[str, float | str]:
    """Largest force of a tooth pair and largest root stress of a march over those of the same scene without inertia.

    An empty mapping with a reason where the quasi-static scene has no solution: the factors are then not defined.
    """
    scene = quasi_static(built.scene)
    still = model(replace(scene, accuracy=replace(scene.accuracy, steps_per_mesh_cycle=cycle.steps)))
    # Where cycles differ they are all gone through, else one is as good as any.
    varied = any(effect.gaps is not None or effect.load is not None for effect in effects_on(scene))
    steps, kept = (built.steps, built.stored_steps) if varied else (cycle.steps, cycle.steps + 1)
    friction = scene.friction.coefficient if scene.friction else 0.0
    marcher = Marcher(cycle, drivetrain(scene, built.pair), still.time_step, friction, loads=still.loads)
    try:
        reference = marcher.run(steps, kept)
    except ContactNotConverged as failure:
        return {"dynamic_factor_unknown": f"the quasi-static run has no solution: {str(failure).splitlines()[0]}"}
    if reference.interrupted:
        return {"dynamic_factor_unknown": "the quasi-static run was interrupted"}
    (stress_moving, force_moving), (stress_still, force_still) = (peaks(stress, each.records, largest_pair_force) for each in (march, reference))
    if not stress_still or not force_still:
        return {"dynamic_factor_unknown": "without inertia nothing touches"}
    return {
        "quasi_static_pair_normal_force": force_still,
        "quasi_static_root_stress": stress_still,
        "dynamic_factor_by_force": force_moving / force_still,
        "dynamic_factor_by_stress": stress_moving / stress_still,
    }


def largest_pair_force(record: Record) -> float:
    """Largest normal force (N) of a tooth pair, on drive or coast flanks, at a step."""
    ends = np.cumsum([len(pair.offsets) for pair in record.position.operator.pairs])
    return max((float(force.sum()) for force in np.split(record.solution.forces, ends)[: len(ends)]), default=0.0)
