"""Energy in the result: what the drivetrain and the teeth store, and the work that supplies and takes it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import pi

import numpy as np
import xarray as xr
from numba import njit

from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.dynamics.clock import Clock
from fenics_gears.dynamics.drivetrain import ON_BEARINGS, Drivetrain
from fenics_gears.dynamics.energy_account import account, mean_load, quadratic
from fenics_gears.dynamics.stepping import VaryingLoad
from fenics_gears.dynamics.steps import Steps, forces_at, in_block, operator_at
from fenics_gears.results.contact_variables import Curves
from fenics_gears.scene.data import Scene


def energy_variables(scene: Scene, drivetrain: Drivetrain, steps: Steps) -> dict:
    """Elastic energy of the teeth, and of shafts, bearings and motion where the scene has them (N mm)."""
    parts = {}
    if scene.tooth_elasticity is not None:
        parts["energy_teeth"] = energy_of_teeth(steps)
    on_bearings = np.array([name in ON_BEARINGS for name in drivetrain.coordinates])
    positions, velocities = steps.states[:, 0], steps.states[:, 1]
    if scene.bearings is not None:
        parts["energy_bearings"] = 0.5 * quadratic(positions * on_bearings, drivetrain.stiffness)
    if scene.shafts is not None:
        parts["energy_shafts"] = 0.5 * quadratic(positions * ~on_bearings, drivetrain.stiffness)
    if scene.inertia is not None:
        parts["energy_kinetic"] = 0.5 * quadratic(velocities, drivetrain.mass)
    parts["energy"] = sum(parts.values(), np.zeros(len(steps)))
    return parts


def energy_of_teeth(steps: Steps) -> np.ndarray:
    """Half of p C p at each step (s,), N mm."""
    return _energy_of_teeth(steps.in_memory)


@njit(cache=True)
def _energy_of_teeth(block):
    steps = in_block(block)
    energies = np.zeros(len(steps.rows))
    for s in range(len(steps.rows)):
        compliance, loads, energy = operator_at(steps, s).compliance, steps.forces[forces_at(steps, s)], 0.0
        loaded = np.flatnonzero(loads)
        for i in loaded:
            displaced = 0.0
            for j in loaded:
                displaced += compliance[i, j] * loads[j]
            energy += 0.5 * loads[i] * displaced
        energies[s] = energy
    return energies


def work_variables(
    scene: Scene,
    cycle: Cycle,
    drivetrain: Drivetrain,
    clock: Clock,
    loads: Sequence[VaryingLoad],
    steps: Steps,
    energy: np.ndarray,
) -> dict:
    """Work since the first of consecutive steps (N mm), which with the `energy` (time,) adds up to nothing but
    round-off:

    energy - energy[0] = work_input - work_output - work_damping - work_friction + work_contact_changes + energy_defect.
    """
    work = account(drivetrain, clock, steps, energy, loads)
    carried = _carried(drivetrain, loads, steps.numbers, 2.0 * pi / (scene.gears.wheel.teeth * cycle.steps))
    values = {
        "work_input": carried + work.rotation,
        "work_output": carried - work.load,
        "work_contact_changes": work.changes,
        "energy_defect": work.defect,
    }
    if scene.damping is not None:
        values["work_damping"] = work.damping
    if scene.friction is not None:
        values["work_friction"] = work.friction
    return values


@dataclass(frozen=True)
class Transmitted:
    """Work over some steps, N mm: of whichever gear's shaft drives, and done on the other's."""

    drive: float
    load: float
    wheel_drives: bool


def transmitted(result: Curves | xr.Dataset) -> Transmitted:
    """The side that drives and the work it does, from the first to the last step of a result.

    Where the wheel drives, the work of the pinion's side and of the wheel's side are negative.
    """
    at_pinion, at_wheel = (
        float(np.subtract(*np.asarray(result[name])[[-1, 0]])) for name in ("work_input", "work_output")
    )
    if at_pinion + at_wheel < 0.0:
        return Transmitted(-at_wheel, -at_pinion, True)
    return Transmitted(at_pinion, at_wheel, False)


def _carried(drivetrain: Drivetrain, loads: Sequence[VaryingLoad], numbers: np.ndarray, angle: float) -> np.ndarray:
    """Work (steps,), N mm, that the nominal motion does against the loads; it turns the wheel by `angle` (rad) a step.

    Both gears' arcs are as long. The wheel turns backwards, against a positive torque.
    """
    turned = np.zeros(len(drivetrain.coordinates))
    wheel = drivetrain.coordinates.index("rotation_2")
    arc = drivetrain.radii[wheel] * angle
    turned[wheel] = -arc
    if "rotation_1" in drivetrain.coordinates:
        turned[drivetrain.coordinates.index("rotation_1")] = arc
    done = -(mean_load(drivetrain, loads, numbers) @ turned) * np.diff(numbers)
    return np.concatenate(([0.0], np.cumsum(done)))[: len(numbers)]
