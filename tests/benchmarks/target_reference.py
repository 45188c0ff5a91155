"""The reference that settings are judged by: a fine mesh carried on to its limit by order 2, and what many steps
add."""

from dataclasses import dataclass, replace

import numpy as np

from fenics_gears.model.cost import expected_cost
from fenics_gears.model.model import model_of
from fenics_gears.runs.settings.measures import JUDGED, Answer, comparable, judged_answer
from fenics_gears.runs.settings.setting import Setting, own_setting, without_settings
from fenics_gears.runs.timed import run_sharing, shared_gears
from fenics_gears.scene.data import Scene

# Meshes in parts of the default, and steps in a mesh cycle: the fine mesh has few, the coarser one few and many.
FINE, COARSER, FEW, MANY = 0.5, 1.0, 120, 960


@dataclass(frozen=True)
class Reference:
    """The judged measures at the limit, and the largest distance of that limit from the fine run."""

    answer: Answer
    uncertainty: float


def at_sizes(scene: Scene, mesh: float, steps: int) -> Setting:
    """A whole setting by the size of its mesh, in that of the scene's defaults, and its steps."""
    default = own_setting(without_settings(scene))
    return replace(default, flank=mesh * default.flank, spacing=mesh * default.spacing, body=mesh, steps=steps)


def counted_seconds(scene: Scene, setting: Setting) -> float:
    """What a run with a setting costs, by its operations: repeats whatever else the machine does."""
    expected = expected_cost(model_of(setting.of(scene)))
    return (expected.condensing or 0.0) + expected.marching


def reference(scene: Scene) -> Reference:
    gears = shared_gears(4)

    def run(mesh: float, steps: int) -> Answer:
        return judged_answer(run_sharing(model_of(at_sizes(scene, mesh, steps).of(scene)), gears)[0])

    fine, coarser = run(FINE, FEW), run(COARSER, FEW)
    many = run(COARSER, MANY) if scene.friction is not None or scene.inertia is not None else coarser
    found, uncertainty = {}, 0.0
    for name in JUDGED:
        one, two, three = comparable([fine[name], coarser[name], many[name]], name)
        away = (one - two) / ((COARSER / FINE) ** 2 - 1.0)
        found[name] = one + away + three - two
        uncertainty = max(uncertainty, float(np.linalg.norm(away) / np.linalg.norm(found[name])))
    return Reference(found, uncertainty)
