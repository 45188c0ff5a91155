"""Dynamic factors of a run with ``[inertia]``: how much larger forces and stresses are than at rest (K_v of ISO 6336-1, by a computation).

The same scene is marched without inertia beside it, by the same contact operators.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import xarray as xr

from fenics_gears.contact.errors import ContactNotConverged
from fenics_gears.dynamics.march import Marcher
from fenics_gears.effects import common_period, effects_on, missing_needs, without
from fenics_gears.model.model import model_of
from fenics_gears.model.resolution import EVERY_STEP
from fenics_gears.results.recorder import Recorder
from fenics_gears.results.settled import of_settled
from fenics_gears.scene.data import Scene

LARGEST_STRESS, LARGEST_FORCE = ("root_stress_maximum", "root_stress_at_30_degrees"), ("pair_normal_force", "pair_coast_normal_force")
DIFFERENT_CYCLES = "mesh cycles differ: [output] root_stress = true runs the scene without inertia beside"


def wanted(scene: Scene) -> bool:
    """Whether a scene has dynamic factors: of elastic teeth with inertia, condensed once."""
    return scene.inertia is not None and scene.tooth_elasticity is not None and scene.accuracy.condensation != EVERY_STEP


def quasi_static(scene: Scene) -> Scene:
    """The scene without inertia and without what needs it."""
    sections = [effect.section for effect in effects_on(scene)]
    removed = {"inertia"}
    while needing := {effect.section for effect, _ in missing_needs([name for name in sections if name not in removed])}:
        removed |= needing
    return without(scene, *(name for name in sections if name in removed))


def dynamic_factors(recorder: Recorder, result: xr.Dataset) -> dict[str, float | str]:
    """Largest force of a tooth pair and, if taken, largest root stress of a run's settled steps over those of the same scene without inertia.

    A reason stands in their place where the quasi-static scene has no solution, or where mesh cycles differ, so that a second march as long as
    the run's own were needed, and root stress is not asked for.
    """
    model, cycle = recorder.model, recorder.cycle
    scene = quasi_static(model.scene)
    if common_period(scene) != 1 and recorder.stress is None:
        return {"dynamic_factor_unknown": DIFFERENT_CYCLES}
    # Where cycles differ the whole period is marched, as far as the run did; else one cycle is as good as any.
    period = min(common_period(scene), model.scene.motion.mesh_cycles)
    motion = replace(scene.motion, mesh_cycles=period, recorded_cycles=1)
    still = model_of(replace(scene, motion=motion, accuracy=replace(scene.accuracy, steps_per_mesh_cycle=cycle.steps)))
    reference = Recorder(still, cycle, stress=recorder.stress)
    try:
        march = Marcher(cycle, still.equations_of_motion).run(still.steps, 1, observe=reference.take)
    except ContactNotConverged as failure:
        return {"dynamic_factor_unknown": f"the quasi-static run has no solution: {str(failure).splitlines()[0]}"}
    if march.interrupted:
        return {"dynamic_factor_unknown": "the quasi-static run was interrupted"}
    reference.finish()
    counted = of_settled(result)
    moving = {name: counted[name].values for name in LARGEST_FORCE + LARGEST_STRESS if name in counted}
    (stress_moving, force_moving), (stress_still, force_still) = _peaks(moving), _peaks(reference.arrays)
    if not force_still:
        return {"dynamic_factor_unknown": "without inertia nothing touches"}
    factors = {"quasi_static_pair_normal_force": force_still, "dynamic_factor_by_force": force_moving / force_still}
    if stress_still:
        factors |= {"quasi_static_root_stress": stress_still, "dynamic_factor_by_stress": stress_moving / stress_still}
    return factors


def _peaks(curves: Mapping[str, np.ndarray]) -> tuple[float, float]:
    """Largest root stress (MPa) and largest normal force (N) of a tooth pair; 0 where there are none."""
    return tuple(
        max((float(np.nanmax(curves[name], initial=0.0)) for name in names if name in curves), default=0.0) for names in (LARGEST_STRESS, LARGEST_FORCE)
    )
