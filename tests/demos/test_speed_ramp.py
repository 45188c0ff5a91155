"""The demonstration of jumps between branches of vibration."""

from dataclasses import replace

import numpy as np
import pytest
from demos.speed_ramp import sweeps
from demos.speed_ramp.picture import draw
from tests.coarse import COARSE

from fenics_gears import load_scene, model_of
from fenics_gears.runs.gear_store import GearStore
from fenics_gears.scene.data import Motion


def test_both_scenes_are_one_pair_each_way_and_warn_of_pressures_alone():
    """The demonstration's own words; its elements are those of vibration, not of pressures under its light load."""
    up, down = (load_scene(sweeps.HERE / f"{name}.toml") for name in ("up", "down"))
    assert (
        (up.motion.mesh_frequency, up.speed_ramp.end_frequency)
        == (down.speed_ramp.end_frequency, down.motion.mesh_frequency)
        == (150.0, 260.0)
    )
    same = {"title": "", "name": "", "motion": down.motion, "speed_ramp": down.speed_ramp}
    assert replace(up, **same) == replace(down, **same)
    warnings = [*model_of(up).warnings, *model_of(down).warnings]
    assert all("the peak contact pressure may be off" in words for words in warnings), warnings


def coarsened(path):
    """At the coarse settings, its ramp twice as fast."""
    scene = load_scene(path)
    accuracy = replace(COARSE, contact_length=2.0, contact_nodes=12, steps_per_mesh_cycle=60)
    return replace(
        scene,
        accuracy=accuracy,
        motion=Motion(scene.motion.mesh_frequency, 165, 1),
        speed_ramp=replace(scene.speed_ramp, hold_cycles=5),
    )


@pytest.mark.nightly
@pytest.mark.parametrize("frequency", [200.0, 240.0])
def test_two_steady_vibrations_at_one_speed(monkeypatch, frequency):
    """Kahraman and Singh, Journal of Sound and Vibration 142, 1990: at 200 Hz several times as large from above as
    from below; at 240 Hz the same."""
    monkeypatch.setattr(sweeps, "load_scene", coarsened)
    monkeypatch.setattr(sweeps, "SETTLING_CYCLES", 60 if frequency == 200.0 else 120)
    store = GearStore()
    below, above = (sweeps.steady(name, frequency, store) for name in ("up", "down"))
    if frequency == 200.0:
        assert above > 4.0 * below
    else:
        assert above == pytest.approx(below, rel=0.05)


def test_the_picture_has_both_ways():
    """Two lines, two rows of rings."""
    frequency = np.linspace(150.0, 260.0, 12)
    passed = {
        "up": sweeps.Sweep(frequency, 1e-3 * frequency / 200.0),
        "down": sweeps.Sweep(frequency[::-1], 1e-3 * np.ones(12)),
    }
    (axes,) = draw(
        passed, np.array([180.0, 200.0]), {"up": np.array([1e-3, 2e-3]), "down": np.array([3e-3, 4e-3])}, 50.0
    ).axes
    assert [list(line.get_xdata()) for line in axes.get_lines()][1] == [180.0, 200.0]
    assert len(axes.get_lines()) == 4 and axes.get_xlim() == (150.0, 260.0)
    assert list(axes.get_lines()[2].get_ydata()) == pytest.approx([50.0] * 12)
