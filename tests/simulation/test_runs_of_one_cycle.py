"""What runs on one mesh cycle have in common: layouts of contact nodes, the quasi-static run beside."""

from dataclasses import replace

import numpy as np
from tests.coarse import coarse_scene

from fenics_gears import simulate
from fenics_gears.results.recorder import Recorder
from fenics_gears.runs.gear_store import GearStore
from fenics_gears.scene.data import Motion
from fenics_gears.simulation import dynamic_factor


def variants(paper_scene) -> list:
    """A scene, the same at another speed and under another torque; those on one cycle have the same operators."""
    scene = replace(coarse_scene(paper_scene), motion=Motion(200.0, 2, 1))
    return [
        scene,
        replace(scene, motion=Motion(310.0, 2, 1)),
        replace(scene, load=replace(scene.load, wheel_torque=0.5 * scene.load.wheel_torque)),
    ]


def test_runs_that_share_a_cycle_are_those_that_do_not(paper_scene, monkeypatch):
    """Brute force: each run with a cycle of its own, to the last bit. The quasi-static run is made again for another
    torque only."""
    scenes, store, recorders = variants(paper_scene), GearStore(), []
    alone = [simulate(scene) for scene in scenes]
    monkeypatch.setattr(
        dynamic_factor, "Recorder", lambda *given, **named: recorders.append(given) or Recorder(*given, **named)
    )
    for scene, expected in zip(scenes, alone):
        found = simulate(scene, preparation=store.prepared)
        assert list(found.variables) == list(expected.variables)
        for name, variable in expected.variables.items():
            assert np.array_equal(found[name].values, variable.values, equal_nan=variable.dtype.kind == "f"), name
        assert {name: value for name, value in found.attrs.items() if not name.startswith("time_")} == {
            name: value for name, value in expected.attrs.items() if not name.startswith("time_")
        }
    assert len(recorders) == 2
