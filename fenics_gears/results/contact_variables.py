"""Contact and energy in the result: forces of the mesh, of tooth pairs and contact nodes, their reactions on the
shafts. Stored energies, and the work that supplies and takes them."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import pi
from typing import Protocol

import numpy as np
import xarray as xr
from numba import njit

from fenics_gears.contact.laws import NO_FORCE
from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.contact.mixed_form import product
from fenics_gears.contact.rigid_step import SAME_GAP
from fenics_gears.contact.tooth_pair import COAST, DRIVE
from fenics_gears.dynamics.clock import Clock
from fenics_gears.dynamics.drivetrain import Drivetrain
from fenics_gears.dynamics.energy_account import account, mean_load, quadratic
from fenics_gears.dynamics.stepping import VaryingLoad
from fenics_gears.dynamics.steps import Steps, forces_at, in_block, operator_at, smallest_openings
from fenics_gears.inputs.tree import GEARS
from fenics_gears.scene.data import Scene

from .side_by_side import SideBySide

Values = dict[str, np.ndarray]


class Curves(Protocol):
    """Values (steps, ...) of a result by name."""

    def __getitem__(self, name: str, /) -> np.ndarray: ...

    def __contains__(self, name: object, /) -> bool: ...


def mesh_variables(scene: Scene, nodes: SideBySide) -> Values:
    """Forces of the whole mesh at consecutive steps, on drive and coast flanks, and their reactions on both gears'
    centres."""
    steps = nodes.steps
    drive = nodes.drive
    layouts = nodes.layouts
    reactions = _summed(layouts.known("rows_of_normals"), layouts.places, nodes.normal, layouts.starts)

    def of_gears(rows: np.ndarray) -> np.ndarray:
        return rows.reshape(2, 3, len(steps)).transpose(1, 2, 0)

    if nodes.tangential is not None:
        reactions += _summed(layouts.known("rows_of_tangents"), layouts.places, nodes.tangential, layouts.starts)
    reaction_x, reaction_y, reaction_couple = of_gears(reactions[:6])
    values = normal_forces(scene, nodes) | {
        "reaction_x": reaction_x,
        "reaction_y": reaction_y,
        "reaction_couple": reaction_couple,
        "newton_iterations": steps.iterations,
        "closed_nodes": nodes.summed(nodes.closed),
    }
    if len(reactions) > 6:
        values |= dict(zip(("reaction_z", "reaction_moment_x", "reaction_moment_y"), of_gears(reactions[6:])))
    if scene.friction is not None:
        values["friction_force"] = nodes.summed(nodes.tangential * drive)
    if scene.coast_flanks is not None:
        if scene.friction is not None:
            values["coast_friction_force"] = nodes.summed(nodes.tangential * ~drive)
        for name, flank in (("drive_flank_opening", DRIVE), ("coast_flank_opening", COAST)):
            values[name] = np.maximum(smallest_openings(steps)[:, flank], 0.0)
    return values


def normal_forces(scene: Scene, nodes: SideBySide) -> Values:
    """Normal forces of the whole mesh at consecutive steps, on drive and coast flanks."""
    values = {"normal_force": nodes.summed(nodes.normal * nodes.drive)}
    if scene.coast_flanks is not None:
        values["coast_normal_force"] = nodes.summed(nodes.normal * ~nodes.drive)
    return values


@njit(cache=True)
def _summed(rows, places, forces, starts):
    """Sums (rows, s) of rows (rows, n) at places (N,) times forces (N,) over the nodes of each step."""
    sums = np.zeros((len(rows), len(starts) - 1))
    for s in range(len(starts) - 1):
        for node in range(starts[s], starts[s + 1]):
            # Few nodes are loaded.
            if forces[node] != 0.0:
                for row in range(len(rows)):
                    sums[row, s] += rows[row, places[node]] * forces[node]
    return sums


def largest_normal_force(result: Curves | xr.Dataset, steps: slice = slice(None)) -> float:
    """The largest contact force (N) of a mesh, on its drive or its coast flanks, in all steps or some."""
    forces = [result[name] for name in ("normal_force", "coast_normal_force") if name in result]
    return float(max(np.asarray(force)[steps].max(initial=0.0) for force in forces))


def mesh_force(result: Curves | xr.Dataset) -> np.ndarray:
    """Force (time,), N, of the drive flanks less that of the coast flanks.

    >>> mesh_force(xr.Dataset({"normal_force": ("time", [3.0, 4.0]), "coast_normal_force": ("time", [0.0, 1.0])}))
    array([3., 3.])
    """
    coast = np.asarray(result["coast_normal_force"]) if "coast_normal_force" in result else 0.0
    return np.asarray(result["normal_force"]) - coast


def pair_variables(scene: Scene, nodes: SideBySide) -> Values:
    """Forces of each tooth pair (steps, slots), on drive and coast flanks; zero where a pair does not touch. Pairs of
    rigid flanks with friction that touch together are given equal shares."""
    if scene.tooth_elasticity is None and scene.friction is None:
        return _rigid_pairs(scene, nodes)
    values = {"pair_normal_force": nodes.by_slot(nodes.normal * nodes.drive)}
    if scene.friction is not None:
        values["pair_friction_force"] = nodes.by_slot(nodes.tangential * nodes.drive)
    if scene.coast_flanks is not None:
        values["pair_coast_normal_force"] = nodes.by_slot(nodes.normal * ~nodes.drive)
    return values


def _rigid_pairs(scene: Scene, nodes: SideBySide) -> Values:
    """Forces of pairs of rigid flanks; not a number where several touch together: all with the gap of the node that has
    the force."""
    gap = np.concatenate([position.operator.gap for position in nodes.steps.positions])
    steps = len(nodes.steps)
    forces = {}
    for name, drive in (("pair_normal_force", True), ("pair_coast_normal_force", False)):
        if not drive and scene.coast_flanks is None:
            break
        of_side = nodes.drive == drive
        loaded = np.flatnonzero(of_side & (nodes.normal != 0.0))
        force = np.zeros(steps)
        largest_gap = np.full(steps, -np.inf)
        force[nodes.step[loaded]] = nodes.normal[loaded]
        largest_gap[nodes.step[loaded]] = gap[loaded] + SAME_GAP
        touching = nodes.by_slot(of_side & (gap <= largest_gap[nodes.step])) > 0
        force[touching.sum(axis=1) > 1] = np.nan
        forces[name] = np.where(touching, force[:, None], 0.0)
    return forces


def node_variables(scene: Scene, nodes: SideBySide) -> Values:
    """Pressure, traction and place of each contact node (steps, slots, slices, nodes); pressures are zero, places not a
    number where there is none."""
    pressure = nodes.normal / nodes.of("area")
    traction = None if scene.friction is None else nodes.tangential / nodes.of("area")
    values = {"contact_offset": nodes.over_nodes(nodes.of("offsets"), True, np.nan)}
    for side, drive in (("", True), ("coast_", False))[: 1 if scene.coast_flanks is None else 2]:
        values[f"{side}contact_pressure"] = nodes.over_nodes(pressure, drive, 0.0)
        values[f"{side}contact_roll_angle"] = nodes.over_nodes(nodes.of("rolls"), drive, np.nan)
        if traction is not None:
            values[f"{side}contact_traction"] = nodes.over_nodes(traction, drive, 0.0)
    return values


def watched_contact(nodes: SideBySide) -> Values:
    """Values of consecutive steps for the warnings: contact at the window's ends and on tips, rank of the
    compliance."""
    steps = nodes.steps
    watched = {
        "window reached": nodes.any(nodes.of("at_end") & nodes.closed),
        "dependent rows": nodes.layouts.dependent_rows,
        "rows": steps.kinds * np.diff(steps.starts),
    }
    if nodes.cycle.traits.has_pressure:
        pressed = nodes.normal > NO_FORCE
        edges = [f"on the {gear}'s {edge}" for edge in ("tip", "form circle") for gear in GEARS]
        watched |= {name: nodes.any(on & pressed) for name, on in zip(edges, nodes.of("on_edge"))}
    return watched


def energy_variables(scene: Scene, drivetrain: Drivetrain, steps: Steps) -> dict:
    """Elastic energy of the teeth, and of shafts, bearings and motion where the scene has them (N mm)."""
    parts = {}
    if scene.tooth_elasticity is not None:
        parts["energy_teeth"] = energy_of_teeth(steps)
    positions = steps.states[:, 0]
    velocities = steps.states[:, 1]
    if scene.bearings is not None:
        parts["energy_bearings"] = 0.5 * quadratic(positions, drivetrain.bearing_stiffness)
        if drivetrain.rolling is not None:
            parts["energy_bearings"] += drivetrain.rolling.energies(positions)
    if scene.shafts is not None:
        parts["energy_shafts"] = 0.5 * quadratic(positions, drivetrain.stiffness - drivetrain.bearing_stiffness)
    if scene.inertia is not None:
        parts["energy_kinetic"] = 0.5 * quadratic(velocities, drivetrain.mass)
    parts["energy"] = sum(parts.values(), np.zeros(len(steps)))
    return parts


def energy_of_teeth(steps: Steps) -> np.ndarray:
    """Half of p C p = p (G q - u) at each step (s,), N mm."""
    return _energy_of_teeth(steps.in_memory)


@njit(cache=True)
def _energy_of_teeth(block):
    steps = in_block(block)
    energies = np.zeros(len(steps.rows))
    for s in range(len(steps.rows)):
        jacobian = operator_at(steps, s).jacobian
        coordinates = steps.states[s, 0]
        forces = forces_at(steps, s)
        loads = steps.forces[forces]
        displacement = steps.displacement[forces]
        for row in range(len(loads)):
            if loads[row] != 0.0:
                energies[s] += 0.5 * loads[row] * (product(jacobian[row], coordinates) - displacement[row])
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
    """Work since the first of consecutive steps (N mm), which with the `energy` (time,) adds up but for round-off:

    energy - energy[0] = work_input - work_output - work_damping - work_friction + work_contact_changes + energy_defect.
    """
    work = account(drivetrain, clock, steps, energy, loads)
    carried = _carried(drivetrain, loads, steps.numbers, 2.0 * pi / (abs(scene.gears.wheel.teeth) * cycle.steps))
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
    """The side that drives and the work it does, from the first to the last step. Where the wheel drives, the work of
    both sides is negative."""
    done, taken = (float(np.subtract(*np.asarray(result[name])[[-1, 0]])) for name in ("work_input", "work_output"))
    return Transmitted(-taken, -done, True) if done + taken < 0.0 else Transmitted(done, taken, False)


def _carried(drivetrain: Drivetrain, loads: Sequence[VaryingLoad], numbers: np.ndarray, angle: float) -> np.ndarray:
    """Work (steps,), N mm, that the nominal motion does against the loads; it turns the wheel by `angle` (rad) a step.

    Both gears' arcs are as long. The wheel turns backwards, against a positive torque.
    """
    turned = abs(drivetrain.radii[drivetrain.driven]) * angle * drivetrain.nominal_motion
    done = -(mean_load(drivetrain, loads, numbers) @ turned) * np.diff(numbers)
    return np.concatenate(([0.0], np.cumsum(done)))[: len(numbers)]
