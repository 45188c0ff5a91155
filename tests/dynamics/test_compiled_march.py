"""The compiled march against the plain one: the same bits, methods and counts."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from tests.coarse import COARSE, coarse_scene, cycle_of, frictionless, quasi_static
from tests.hard_cases.random_scenes import valid_scenes
from tests.hard_cases.test_any_scene import on_stand_ins

from fenics_gears import load_scene
from fenics_gears.contact.errors import ContactNotConverged
from fenics_gears.dynamics.march import Marcher
from fenics_gears.dynamics.stepping import KnownSets
from fenics_gears.effects.coast_flanks import CoastFlanks
from fenics_gears.effects.friction import Friction
from fenics_gears.effects.speed_ramp import SpeedRamp
from fenics_gears.model.model import Model, model_of
from fenics_gears.results.dataset import RunResult
from fenics_gears.results.recorder import Recorder
from fenics_gears.scene.data import RIGID_TEETH, Accuracy, Motion
from fenics_gears.simulation.elastic_route import mesh_cycle

DEMOS = sorted(path for path in (Path(__file__).parents[2] / "demos").rglob("*.toml") if "[gears" in path.read_text())
RIGID = Accuracy(model=RIGID_TEETH, steps_per_mesh_cycle=20)
SCENES = {
    "friction": lambda scene: scene,
    "quasi-static": lambda scene: frictionless(quasi_static(scene)),
    "coast flanks, undamped, from contact to contact": lambda scene: replace(
        scene, coast_flanks=CoastFlanks(), damping=None, motion=Motion(150.0, 6, 1)
    ),
    "backward Euler": lambda scene: replace(scene, motion=Motion(2e5, 3, 1)),
    "steps that change": lambda scene: replace(scene, speed_ramp=SpeedRamp(250.0), motion=Motion(150.0, 4, 1)),
    "friction beyond Newton": lambda scene: replace(quasi_static(scene), friction=Friction(2.0)),
    "springs": lambda scene: replace(scene, accuracy=replace(COARSE, model="ISO 6336-1")),
    "rigid flanks": lambda scene: replace(scene, accuracy=RIGID),
    "rigid flanks that rattle": lambda scene: replace(
        scene, accuracy=RIGID, coast_flanks=CoastFlanks(), friction=None, damping=None, motion=Motion(1e3, 6, 1)
    ),
}


def marched(model: Model, cycle, plain: bool):
    recorder = Recorder(model, cycle)
    # Both begin with what neither has found.
    cycle.shared(KnownSets).clear()
    try:
        march = Marcher(cycle, model.equations_of_motion, plain=plain).run(model.steps, 1, observe=recorder.take)
        failure = ""
    except ContactNotConverged as failed:
        march, failure = failed.partial, str(failed)
    return march, RunResult(recorder, march).dataset, failure


def assert_the_same(model: Model, cycle) -> set[str]:
    (one, fast, failed), (other, slow, failed_too) = (marched(model, cycle, plain) for plain in (False, True))
    assert (one.steps, one.steps_by_method, one.newton_iterations) == (
        other.steps,
        other.steps_by_method,
        other.newton_iterations,
    )
    assert (one.separations, one.locked, failed) == (other.separations, other.locked, failed_too)
    for name, variable in fast.variables.items():
        np.testing.assert_array_equal(variable.values, slow.variables[name].values, name)
    return {method for method, count in one.steps_by_method.items() if count}


@pytest.mark.parametrize("name", SCENES)
def test_scenes(paper_scene, name):
    """Every effect that changes the equations of a step."""
    model = model_of(SCENES[name](coarse_scene(paper_scene)))
    cycle = cycle_of(model)
    assert not cycle.traits.own_solver
    methods = assert_the_same(model, cycle)
    assert len(methods) > 1 if "beyond" in name else methods


@pytest.mark.nightly
@settings(max_examples=200, deadline=None)
@given(valid_scenes().filter(lambda scene: scene.tooth_elasticity is not None))
def test_many_random_scenes(scene):
    """On stand-in gears."""
    model = model_of(scene)
    assert_the_same(model, mesh_cycle(model, on_stand_ins(model)))


@pytest.mark.nightly
@pytest.mark.parametrize("path", DEMOS, ids=lambda path: path.stem)
def test_demos(path):
    """Every scene of the demonstrations that is not a study."""
    model = model_of(load_scene(path))
    cycle = cycle_of(model)
    if not cycle.traits.own_solver:
        assert_the_same(model, cycle)
