"""Dynamic factors of a run with ``[inertia]`` (K_v of ISO 6336-1, by a computation): the same scene is marched without
inertia beside it, by the same contact operators."""

from collections.abc import Mapping
from dataclasses import replace
from weakref import WeakKeyDictionary

import numpy as np

from fenics_gears.contact.errors import ContactNotConverged
from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.dynamics.march import Marcher
from fenics_gears.effects import common_period, effects_on, missing_needs, without
from fenics_gears.model.model import Model, model_of
from fenics_gears.model.resolution import EVERY_STEP
from fenics_gears.results.dataset import RunResult
from fenics_gears.results.extrema import Extrema, pair_force
from fenics_gears.results.recorder import Recorder
from fenics_gears.results.settled import settled_steps
from fenics_gears.scene.data import Scene

Peaks = tuple[float, float]
LARGEST_STRESS = ("root_stress_maximum", "root_stress_at_30_degrees")
DIFFERENT_CYCLES = "mesh cycles differ: [output] root_stress = true runs the scene without inertia beside"


def wanted(scene: Scene) -> bool:
    """Whether a scene has dynamic factors: of elastic teeth with inertia, condensed once."""
    elastic = scene.tooth_elasticity is not None
    condensed_once = scene.accuracy.condensation != EVERY_STEP
    return scene.inertia is not None and elastic and condensed_once


def quasi_static(scene: Scene) -> Scene:
    """The scene without inertia and without the effects that need it."""
    sections = [effect.section for effect in effects_on(scene)]
    left = [name for name in sections if name != "inertia"]
    while needing := {effect.section for effect, _ in missing_needs(left)}:
        left = [name for name in left if name not in needing]
    return without(scene, *(name for name in sections if name not in left))


def dynamic_factors(recorder: Recorder, result: RunResult) -> dict[str, float | str]:
    """Largest force of a tooth pair and, if taken, largest root stress of a run's settled steps, over those of the same
    scene without inertia. A reason stands in their place where that scene has no solution. So it does without root
    stress where mesh cycles differ: a second march as long as the run's own would be needed."""
    model = recorder.model
    cycle = recorder.cycle
    scene = quasi_static(model.scene)
    if common_period(scene) != 1 and recorder.stress is None:
        return {"dynamic_factor_unknown": DIFFERENT_CYCLES}
    # Where cycles differ the whole period is marched, as far as the run did; else one cycle is as good as any.
    period = min(common_period(scene), model.scene.motion.mesh_cycles)
    motion = replace(scene.motion, mesh_cycles=period, recorded_cycles=1)
    still = at_rest(model, replace(scene, motion=motion), cycle.steps)
    peaks_still = _peaks_still(still, recorder)
    if isinstance(peaks_still, str):
        return {"dynamic_factor_unknown": peaks_still}
    counted = settled_steps(result)
    moving = {name: result[name][counted] for name in LARGEST_STRESS if name in result}
    stress_moving, force_moving = _peaks(moving, result.attrs.get("largest_pair_force", 0.0))
    stress_still, force_still = peaks_still
    if not force_still:
        return {"dynamic_factor_unknown": "without inertia nothing touches"}
    factors: dict[str, float | str] = {"quasi_static_pair_normal_force": force_still}
    factors["dynamic_factor_by_force"] = force_moving / force_still
    if stress_still:
        factors |= {"quasi_static_root_stress": stress_still, "dynamic_factor_by_stress": stress_moving / stress_still}
    return factors


def at_rest(model: Model, scene: Scene, steps: int) -> Model:
    """The model of a quasi-static scene on the contact equations of another model with so many steps a mesh cycle."""
    still = model_of(replace(scene, accuracy=replace(scene.accuracy, steps_per_mesh_cycle=steps)))
    if model.drivetrain.mass is None or not model.drivetrain.elastic:
        return still
    # At rest modes of shafts stand still; the contact equations have them all the same.
    return replace(still, drivetrain=replace(model.drivetrain, mass=None, damping=None, mesh=None))


# Peaks of quasi-static marches, which runs on the same cycle, such as those of a study, have in common.
_PEAKS_OF_CYCLES: WeakKeyDictionary[Cycle, dict[tuple, Peaks]] = WeakKeyDictionary()


def _peaks_still(still: Model, recorder: Recorder) -> Peaks | str:
    """The peaks of the quasi-static model, or why there are none."""
    cycle = recorder.cycle
    drivetrain = still.drivetrain
    equations = still.equations_of_motion
    # Without mass and loads that vary nothing depends on time, nor on the mesh frequency.
    numbers = [each.tobytes() for each in (drivetrain.radii, drivetrain.stiffness, drivetrain.load)]
    key = (drivetrain.coordinates, *numbers, equations.friction, still.steps)
    known = _PEAKS_OF_CYCLES.setdefault(cycle, {})
    shared = not still.loads and recorder.stress is None
    if shared and key in known:
        return known[key]
    reference = Recorder(still, cycle, stress=recorder.stress)
    try:
        march = Marcher(cycle, equations).run(still.steps, 1, observe=reference.take)
    except ContactNotConverged as failure:
        return f"the quasi-static run has no solution: {str(failure).splitlines()[0]}"
    if march.interrupted:
        return "the quasi-static run was interrupted"
    reference.finish()
    peaks = _peaks(reference.arrays, _largest_force(reference))
    if shared:
        known[key] = peaks
    return peaks


def _largest_force(recorder: Recorder) -> float:
    """Largest normal force, N, of a tooth pair of a quasi-static march, as its own result has it."""
    curves = recorder.arrays
    extrema = Extrema(recorder.model, recorder.cycle, curves["mesh_phase"], curves["transmission_error"])
    return extrema.largest([pair_force(curves)])[0].value


def _peaks(curves: Mapping[str, np.ndarray], force: float) -> Peaks:
    """Largest root stress (MPa), 0 where there is none, and the largest `force` (N) of a tooth pair."""
    stresses = (float(np.nanmax(curves[name], initial=0.0)) for name in LARGEST_STRESS if name in curves)
    return max(stresses, default=0.0), force
