"""The paper's scenes at small resolutions."""

from dataclasses import replace

import pytest

from fenics_gears import simulate
from fenics_gears.model.resolution import EVERY_STEP, ONCE
from fenics_gears.scene.data import Accuracy, Motion

WINDOW = 1.5
STEPS = 12


@pytest.fixture(scope="session")
def reference_cache(suite_cache):
    """Positions remeshed once for all scenes that differ in loads and effects only."""
    return suite_cache


@pytest.fixture(scope="session")
def paper_cases(paper_scene):
    static = replace(paper_scene, inertia=None, damping=None, motion=Motion(200.0, 2, 1))
    dynamic = replace(paper_scene, motion=Motion(200.0, 10, 1))
    return {
        "static": static,
        "static frictionless": replace(static, friction=None),
        "200 Hz": dynamic,
        "200 Hz frictionless": replace(dynamic, friction=None),
    }


@pytest.fixture(scope="session")
def both_routes(reference_cache):
    """Results of both routes at equal flank resolution; `preparation` is for the reference."""
    known = {}

    def run(scene, element="P2", size=0.08, steps=STEPS, preparation=None):
        # By identity: scenes that are kept stay the only ones of theirs.
        key = id(scene), element, size, steps, preparation
        if key not in known:
            known[key] = scene, *march(scene, element, size, steps, preparation)
        return known[key][1:]

    def march(scene, element, size, steps, preparation):
        accuracy = Accuracy(
            element=element,
            flank_element_size=size,
            contact_length=WINDOW,
            contact_nodes=round(WINDOW / size) + 1,
            steps_per_mesh_cycle=steps,
        )
        fast = simulate(replace(scene, accuracy=replace(accuracy, condensation=ONCE)), cache=reference_cache)
        slow_scene = replace(scene, accuracy=replace(accuracy, condensation=EVERY_STEP))
        return fast, simulate(slow_scene, cache=reference_cache, preparation=preparation)

    return run
