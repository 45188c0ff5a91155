"""Energy in the result: what the drivetrain and the teeth hold, and the account of where it comes from and goes."""

from __future__ import annotations

from math import pi

import numpy as np

from fenics_gears.dynamics.drivetrain import TRANSLATIONS, Drivetrain
from fenics_gears.dynamics.energy_account import account
from fenics_gears.dynamics.march import Record
from fenics_gears.scene.data import Scene


def energy_variables(scene: Scene, drivetrain: Drivetrain, records: list[Record]) -> dict:
    """Elastic energy of the teeth, and of shafts, bearings and motion where the scene has them (N mm)."""
    parts = {}
    if scene.tooth_elasticity is not None:
        teeth = [0.5 * r.solution.forces @ r.position.operator.compliance @ r.solution.forces for r in records]
        parts["energy_teeth"] = np.array(teeth)
    translations = np.array([name in TRANSLATIONS for name in drivetrain.coordinates])
    states = np.array([record.state.position for record in records]).reshape(len(records), len(translations))
    if scene.bearings is not None:
        parts["energy_bearings"] = _quadratic(states * translations, drivetrain.stiffness)
    if scene.shafts is not None:
        parts["energy_shafts"] = _quadratic(states * ~translations, drivetrain.stiffness)
    if scene.inertia is not None:
        velocities = np.array([record.state.velocity for record in records]).reshape(states.shape)
        parts["energy_kinetic"] = _quadratic(velocities, drivetrain.mass)
    parts["energy"] = sum(parts.values(), np.zeros(len(records)))
    return {name: (("time",), energy) for name, energy in parts.items()}


def _quadratic(states: np.ndarray, matrix: np.ndarray) -> np.ndarray:
    return 0.5 * np.einsum("ti,ij,tj->t", states, matrix, states)


def work_variables(scene: Scene, drivetrain: Drivetrain, records: list[Record], time_step: float, energy: np.ndarray) -> dict:
    """Work since the first stored step (N mm), which with the `energy` (time,) adds up to nothing but round-off:

    energy - energy[0] = work_input - work_output - work_damping - work_friction + work_contact_changes + energy_defect.
    """
    work = account(drivetrain, time_step, records, energy)
    turned = 2.0 * pi * scene.motion.mesh_frequency / scene.gears.wheel.teeth * time_step * np.arange(len(records))
    # The nominal motion turns the wheel backwards, against a positive couple.
    carried = scene.load.wheel_torque * turned
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
    return {name: (("time",), value) for name, value in values.items()}
