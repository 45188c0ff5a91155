"""Contact in the result: forces of the mesh, of each tooth pair and of each contact node, their reactions, the mesh's stiffness and its largest pressure."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import xarray as xr

from fenics_gears.contact.laws import NO_FORCE
from fenics_gears.contact.mesh_stiffness import mesh_stiffness
from fenics_gears.contact.pressure import read_off
from fenics_gears.contact.tooth_pair import COAST, DRIVE
from fenics_gears.dynamics.march import Record, smallest_opening
from fenics_gears.results.side_by_side import SideBySide
from fenics_gears.scene.data import Scene

Values = dict[str, np.ndarray]


def mesh_variables(scene: Scene, nodes: SideBySide) -> Values:
    """Forces of the whole mesh at consecutive records, on drive and on coast flanks, and their reactions on both gears' centres."""
    records, drive = nodes.records, nodes.drive
    reactions = np.array([layout.rows @ record.solution.forces for layout, record in zip(nodes.layouts, records)]).reshape(-1, 2, 3)
    values = {
        "normal_force": nodes.summed(nodes.normal * drive),
        "reaction_x": reactions[:, :, 0],
        "reaction_y": reactions[:, :, 1],
        "reaction_couple": reactions[:, :, 2],
        "newton_iterations": np.array([record.solution.iterations for record in records]),
        "closed_nodes": nodes.summed(nodes.closed),
    }
    if scene.friction is not None:
        values["friction_force"] = nodes.summed(nodes.tangential * drive)
    if scene.coast_flanks is not None:
        values["coast_normal_force"] = nodes.summed(nodes.normal * ~drive)
        if scene.friction is not None:
            values["coast_friction_force"] = nodes.summed(nodes.tangential * ~drive)
        for name, flank in (("drive_flank_opening", DRIVE), ("coast_flank_opening", COAST)):
            values[name] = np.array([max(smallest_opening(record, flank), 0.0) for record in records])
    return values


def largest_normal_force(result: xr.Dataset) -> float:
    """The largest contact force (N) of a mesh, on its drive or its coast flanks."""
    forces = [result[name].values.max(initial=0.0) for name in ("normal_force", "coast_normal_force") if name in result]
    return float(max(forces))


def pair_variables(scene: Scene, nodes: SideBySide) -> Values:
    """Forces of each tooth pair (records, slots), on drive and coast flanks; zero where a pair does not touch.

    Pairs of rigid flanks with friction that touch together are given equal shares.
    """
    if scene.tooth_elasticity is None and scene.friction is None:
        return _rigid_pairs(scene, nodes)
    values = {"pair_normal_force": nodes.by_slot(nodes.normal * nodes.drive)}
    if scene.friction is not None:
        values["pair_friction_force"] = nodes.by_slot(nodes.tangential * nodes.drive)
    if scene.coast_flanks is not None:
        values["pair_coast_normal_force"] = nodes.by_slot(nodes.normal * ~nodes.drive)
    return values


def _rigid_pairs(scene: Scene, nodes: SideBySide) -> Values:
    """Forces of pairs of rigid flanks; not a number where several pairs touch together, for their shares are not determined."""
    from fenics_gears.contact.rigid_cycle import pairs_that_touch

    sides = {"pair_normal_force": DRIVE} | ({"pair_coast_normal_force": COAST} if scene.coast_flanks is not None else {})
    force = {name: np.zeros((len(nodes.records), nodes.slots)) for name in sides}
    for i, record in enumerate(nodes.records):
        operator, forces = record.position.operator, _normal(record)
        for node in np.flatnonzero(forces):
            flank = operator.pairs[operator.node_pair[node]].place.flank
            name = next(each for each, side in sides.items() if side == flank)
            together = pairs_that_touch(operator, node)
            for pair in together:
                force[name][i, nodes.slot_of(i, operator.pairs[pair].place.index)] = forces[node] if len(together) == 1 else np.nan
    return force


def _normal(record: Record) -> np.ndarray:
    return record.solution.forces[: record.position.operator.nodes]


def node_variables(scene: Scene, nodes: SideBySide) -> Values:
    """Pressure, traction and place of each contact node (records, slots, nodes); pressures are zero, places not a number where there is none."""
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
    """What the run's warnings need of consecutive records: contact at the window's ends and on tips, rank of the compliance."""
    operators = [record.position.operator for record in nodes.records]
    found = {
        "window reached": nodes.any(nodes.of("at_end") & nodes.closed),
        "dependent rows": np.array([operator.dependent_rows for operator in operators]),
        "rows": np.array([len(operator.compliance) for operator in operators]),
    }
    if nodes.cycle.traits.has_pressure:
        pressed = nodes.normal > NO_FORCE
        found |= {f"on the {gear}'s tip": nodes.any(tip & pressed) for gear, tip in zip(("pinion", "wheel"), nodes.of("on_tip"))}
    return found


def stiffness_curves(nodes: SideBySide) -> Values:
    """Secant and tangent stiffness of the mesh, and how many pairs carry, at consecutive records of an elastic mesh."""
    found = [mesh_stiffness(record.position.operator, record.solution) for record in nodes.records]
    return {
        "mesh_stiffness": np.array([each.secant for each in found]),
        "mesh_stiffness_tangent": np.array([each.tangent for each in found]),
        "loaded_pairs": np.array([each.pairs for each in found]),
    }


def pressure_curves(nodes: SideBySide, fields: Mapping[str, np.ndarray]) -> Values:
    """The largest pressure of consecutive records, its tooth pair and its place, from their contact `fields`.

    Pairs that press with a tip's sharp edge are left out and have a largest pressure of their own: linear elasticity has infinite pressure
    there, and the number grows as contact nodes come closer.
    """
    pressed_edge = nodes.of("on_tip").any(axis=0) & (nodes.normal > NO_FORCE)
    highest, rolls, at_edge = [], [], []
    for side, drive in (("", True), ("coast_", False)):
        if f"{side}contact_pressure" not in fields:
            continue
        place = fields[f"{side}contact_roll_angle"]
        pressure = read_off(fields[f"{side}contact_pressure"], place)
        node = pressure.argmax(axis=-1)[..., None]
        highest.append(np.take_along_axis(pressure, node, -1)[..., 0])
        rolls.append(np.take_along_axis(place, node, -1)[..., 0])
        at_edge.append(nodes.by_slot(pressed_edge & (nodes.drive == drive)) > 0)
    pressure, edge = np.concatenate(highest, axis=1), np.concatenate(at_edge, axis=1)
    numbers = np.concatenate([nodes.pair_number] * len(highest), axis=1)
    off_edge = np.where(edge, 0.0, pressure)
    at = np.arange(len(pressure)), off_edge.argmax(axis=1)
    touching = off_edge[at] > 0.0
    return {
        "largest_contact_pressure": off_edge[at],
        "largest_contact_pressure_pair": np.where(touching, numbers[at], 0),
        "largest_contact_pressure_roll_angle": np.where(touching, np.concatenate(rolls, axis=1)[at], np.nan),
        "largest_edge_pressure": np.where(edge, pressure, 0.0).max(axis=1),
    }
