"""The ramps of this folder, and runs at a steady speed to compare them with: vibration of every mesh cycle.

A result with the pressures of every cycle would have gigabytes; here only the transmission error of each step is kept.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from fenics_gears import load_scene
from fenics_gears.dynamics.march import Marcher
from fenics_gears.effects.speed_ramp import SpeedRamp
from fenics_gears.elasticity.cache import user_cache
from fenics_gears.model.model import Model, model_of
from fenics_gears.system.progress import SilentProgress
from fenics_gears.scene.data import Motion, Scene
from fenics_gears.runs.gear_store import GearStore

HERE = Path(__file__).parent
# A run at a steady speed: so many cycles until it is steady, and so many to tell its amplitude from.
SETTLING_CYCLES, MEASURED_CYCLES = 150, 10


@dataclass(frozen=True)
class Sweep:
    """Mesh frequency (cycles,), Hz, and peak-to-peak transmission error (cycles,), rad, of every mesh cycle of a
    run."""

    frequency: np.ndarray
    amplitude: np.ndarray


def sweep(scene: Scene, store: GearStore, cycles: int | None = None) -> Sweep:
    """March a scene without friction, over more `cycles` than it has if asked to; after its ramp the speed is that of
    its end."""
    model = model_of(scene)
    _, cycle = store.prepared(model, SilentProgress(), user_cache())
    marcher = Marcher(cycle, model.equations_of_motion)
    cycles = cycles or scene.motion.mesh_cycles
    per_cycle = model.resolution.steps_per_mesh_cycle
    records = marcher.run(cycles * per_cycle, cycles * per_cycle + 1).records
    error = _transmission_error(model, np.array([record.state.position for record in records]))
    begins = per_cycle * np.arange(cycles)
    frequency = [cycles_a_second(model, begin, begin + per_cycle) for begin in begins]
    return Sweep(np.array(frequency), np.array([np.ptp(error[begin : begin + per_cycle + 1]) for begin in begins]))


def cycles_a_second(model: Model, first: int, last: int) -> float:
    """Mean mesh frequency (Hz) from one step to another."""
    return (last - first) / model.resolution.steps_per_mesh_cycle / model.clock.duration(first, last)


def _transmission_error(model: Model, states: np.ndarray) -> np.ndarray:
    ratio = model.pair.pinion.teeth / model.pair.wheel.teeth
    return model.drivetrain.value(states, "rotation_2") + ratio * model.drivetrain.value(states, "rotation_1")


def ramps(store: GearStore) -> dict[str, Sweep]:
    """Both ramps of this folder, by the names "up" and "down", less the cycles held before them."""
    found = {}
    for name in ("up", "down"):
        scene = load_scene(HERE / f"{name}.toml")
        passed, held = sweep(scene, store), scene.speed_ramp.hold_cycles
        found[name] = Sweep(passed.frequency[held:], passed.amplitude[held:])
    return found


def steady(name: str, frequency: float, store: GearStore) -> float:
    """Mean peak-to-peak transmission error (rad) at a steady mesh frequency (Hz) that is reached by the ramp "up" or
    "down"."""
    scene = load_scene(HERE / f"{name}.toml")
    start, end, ramp = scene.motion.mesh_frequency, scene.speed_ramp.end_frequency, scene.speed_ramp
    # As fast as the whole ramp.
    part = (frequency**2 - start**2) / (end**2 - start**2)
    ramped = ramp.hold_cycles + max(round(part * (scene.motion.mesh_cycles - ramp.hold_cycles)), 1)
    changed = replace(scene, motion=Motion(start, ramped, 1), speed_ramp=SpeedRamp(frequency, ramp.hold_cycles))
    passed = sweep(changed, store, ramped + SETTLING_CYCLES + MEASURED_CYCLES)
    return float(passed.amplitude[-MEASURED_CYCLES:].mean())
