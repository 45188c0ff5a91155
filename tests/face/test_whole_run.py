"""Bodies of a helical pair: in which order and in which process they are computed."""

from math import radians
from threading import Event

import numpy as np
import pytest
from tests.benchmarks.third_dimension.pairs import MODULE, scene_of, standard_pair

from fenics_gears import ComputationError, model_of
from fenics_gears.elasticity.cache import Cache
from fenics_gears.inputs.tree import GEARS
from fenics_gears.runs import condensing
from fenics_gears.runs.gear_store import GearStore
from fenics_gears.scene.data import Accuracy
from fenics_gears.simulation import bodies, solids
from fenics_gears.simulation.bodies import gear_bodies
from fenics_gears.simulation.solids import begun as begun_bodies
from fenics_gears.simulation.solids import solid_of
from fenics_gears.system import second_process
from fenics_gears.system.memory import MEMORY_VARIABLE
from fenics_gears.system.progress import SilentProgress
from fenics_gears.system.second_process import SecondProcess

HELIX_ANGLE = radians(20.0)
COARSE = Accuracy(
    element="P1",
    flank_element_size=0.3,
    contact_nodes=12,
    steps_per_mesh_cycle=6,
    slices=5,
    layers=2,
    body_element_size=3.0,
)


@pytest.fixture(scope="module")
def scene():
    return scene_of(standard_pair(3.0 * MODULE, HELIX_ANGLE, bore=0.8), COARSE)


def test_the_wheels_body_is_begun_before_the_sections(scene, monkeypatch):
    """Order of events: the first section waits for it; its error ends both."""
    begun = Event()

    def fails(*given):
        begun.set()
        raise ComputationError("begun")

    monkeypatch.setattr(SecondProcess, "together", fails)
    for module in (second_process, solids):
        monkeypatch.setattr(module, "threads", lambda: 2)
    monkeypatch.setattr(bodies, "_section", lambda *given: begun.wait(timeout=60))
    monkeypatch.setattr(solids, "solid_of", lambda *given: given[-1] and solid_of(*given))
    with pytest.raises(ComputationError, match="begun"):
        gear_bodies(model_of(scene), SilentProgress(), None)
    assert begun.is_set()


def test_both_bodies_at_once_are_those_one_after_the_other(scene, monkeypatch, tmp_path):
    """The same bodies with one thread; no process for what the cache has or memory does not hold. The first gear of
    a study brings the second."""
    model, started = model_of(scene), []
    together = SecondProcess.together
    monkeypatch.setattr(SecondProcess, "together", lambda *given: started.append(given) or together(*given))

    def both(threads, cache=None):
        for module in (second_process, solids):
            monkeypatch.setattr(module, "threads", lambda: threads)
        with begun_bodies(model, SilentProgress(), cache) as bodies:
            return bodies()

    expected, kept = both(1), Cache(tmp_path)
    assert not started
    store = GearStore()
    for name, value in (("own_gear_store", store), ("user_cache", kept), ("threads", 2)):
        monkeypatch.setattr(condensing, name, lambda value=value: value)
    for module in (second_process, solids):
        monkeypatch.setattr(module, "threads", lambda: 2)
    condensing.condense(condensing.GearTask(scene, "pinion"))
    found = [store.body(model, name, None).solid for name in GEARS]
    assert len(started) == 1 and not any(body.timings["from_cache"] for body in found)
    for one, other in zip(found, expected):
        np.testing.assert_allclose(one.blocks, other.blocks, rtol=0.0, atol=1e-13 * abs(other.blocks).max())
    assert all(body.timings["from_cache"] for body in both(2, kept))
    monkeypatch.setenv(MEMORY_VARIABLE, "300 MB")
    assert np.array_equal(both(2)[1].blocks, expected[1].blocks) and len(started) == 1
