"""Contact in the result: forces of the mesh, of every tooth pair and of every contact node, and what they ask of the shafts."""

from __future__ import annotations

import numpy as np
import xarray as xr

from fenics_gears.contact.laws import OPEN
from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.contact.operator import rigid_rows
from fenics_gears.contact.tooth_pair import COAST, DRIVE
from fenics_gears.dynamics.march import Record, smallest_opening
from fenics_gears.effects import OVER_CONTACT_NODES
from fenics_gears.scene.data import Scene

COAST_NODE_VARIABLES = ("contact_pressure", "contact_traction", "contact_roll_angle")


def mesh_variables(scene: Scene, records: list[Record]) -> dict:
    """Forces of the whole mesh, on the drive flanks and on the coast flanks, and what all of them ask of either gear's centre."""
    on_drive = [record.position.operator.on_drive_flanks for record in records]
    normal = np.array([_normal(record)[drive].sum() for record, drive in zip(records, on_drive)])
    reactions = np.array([_reactions(record) for record in records]).reshape(len(records), 2, 3)
    values = {
        "normal_force": (("time",), normal),
        "reaction_x": (("time", "gear"), reactions[:, :, 0]),
        "reaction_y": (("time", "gear"), reactions[:, :, 1]),
        "reaction_couple": (("time", "gear"), reactions[:, :, 2]),
        "newton_iterations": (("time",), np.array([record.solution.iterations for record in records])),
        "closed_nodes": (("time",), np.array([np.count_nonzero(record.solution.status != OPEN) for record in records])),
    }
    if scene.friction is not None:
        tangential = [_tangential(record)[drive].sum() for record, drive in zip(records, on_drive)]
        values["friction_force"] = (("time",), np.array(tangential))
    if scene.coast_flanks is not None:
        coast = [_normal(record)[~drive].sum() for record, drive in zip(records, on_drive)]
        values["coast_normal_force"] = (("time",), np.array(coast))
        if scene.friction is not None:
            across = [_tangential(record)[~drive].sum() for record, drive in zip(records, on_drive)]
            values["coast_friction_force"] = (("time",), np.array(across))
        for name, flank in (("drive_flank_opening", DRIVE), ("coast_flank_opening", COAST)):
            openings = [max(smallest_opening(record, flank), 0.0) for record in records]
            values[name] = (("time",), np.array(openings))
    return values


def largest_normal_force(result: xr.Dataset) -> float:
    """The largest contact force (N) of a mesh, on its drive or its coast flanks."""
    forces = [result[name].values.max(initial=0.0) for name in ("normal_force", "coast_normal_force") if name in result]
    return float(max(forces))


def _normal(record: Record) -> np.ndarray:
    return record.solution.forces[: record.position.operator.nodes]


def _tangential(record: Record) -> np.ndarray:
    return record.solution.forces[record.position.operator.nodes :]


def _reactions(record: Record) -> np.ndarray:
    """Force (x, y), N, and couple (N mm) of the contact forces on pinion and wheel about their centres, (2, 3): -G^T p."""
    operator, forces = record.position.operator, record.solution.forces
    rows = rigid_rows(operator.pairs, operator.base_radii, operator.normal_arms, tangential=len(forces) > operator.nodes)
    return -(rows.T @ forces)[:6].reshape(2, 3) * np.array([[1.0, 1.0, radius] for radius in operator.base_radii])


def pair_variables(scene: Scene, cycle: Cycle, records: list[Record], numbers: list[int]) -> dict:
    """Forces of each tooth pair and the pressure over its contact nodes, on drive and coast flanks; zero where a pair does not touch."""
    if scene.tooth_elasticity is None:
        return (_rigid_pairs if scene.friction is None else _sharing_pairs)(scene, cycle, records, numbers)
    values = _flank_variables(scene, cycle, records, numbers, DRIVE)
    if scene.coast_flanks is not None:
        coast = _flank_variables(scene, cycle, records, numbers, COAST)
        values["pair_coast_normal_force"] = coast["pair_normal_force"]
        values |= {f"coast_{name}": data for name, data in coast.items() if name in COAST_NODE_VARIABLES}
    if not scene.resolves_contact:
        values = {name: data for name, data in values.items() if name not in OVER_CONTACT_NODES}
    return values


def _rigid_pairs(scene: Scene, cycle: Cycle, records: list[Record], numbers: list[int]) -> dict:
    """Forces of pairs of rigid flanks: that of the one pair that touches; not a number for pairs that touch together, whose shares
    are not determined."""
    from fenics_gears.contact.rigid_cycle import pairs_that_touch

    row = {number: i for i, number in enumerate(numbers)}
    sides = {"pair_normal_force": DRIVE} | ({"pair_coast_normal_force": COAST} if scene.coast_flanks is not None else {})
    force = {name: np.zeros((len(records), len(numbers))) for name in sides}
    for i, record in enumerate(records):
        operator, forces = record.position.operator, _normal(record)
        for node in np.flatnonzero(forces):
            flank = operator.pairs[operator.node_pair[node]].place.flank
            name = next(each for each, side in sides.items() if side == flank)
            together = pairs_that_touch(operator, node)
            for pair in together:
                number = int(cycle.pair_number(record.step, operator.pairs[pair].place.index))
                force[name][i, row[number]] = forces[node] if len(together) == 1 else np.nan
    return {name: (("time", "pair"), values) for name, values in force.items()}


def _sharing_pairs(scene: Scene, cycle: Cycle, records: list[Record], numbers: list[int]) -> dict:
    """Forces of pairs of rigid flanks whose shares are taken as even."""
    row = {number: i for i, number in enumerate(numbers)}
    sides = [("pair_normal_force", DRIVE, _normal), ("pair_friction_force", DRIVE, _tangential)]
    if scene.coast_flanks is not None:
        sides.append(("pair_coast_normal_force", COAST, _normal))
    values = {name: np.zeros((len(records), len(numbers))) for name, _, _ in sides}
    for i, record in enumerate(records):
        operator = record.position.operator
        for name, flank, forces in sides:
            on_side = np.flatnonzero(operator.on_drive_flanks == (flank == DRIVE))
            for node in on_side[forces(record)[on_side] != 0.0]:
                pair = operator.pairs[operator.node_pair[node]]
                values[name][i, row[int(cycle.pair_number(record.step, pair.place.index))]] += forces(record)[node]
    return {name: (("time", "pair"), force) for name, force in values.items()}


def _flank_variables(scene: Scene, cycle: Cycle, records: list[Record], numbers: list[int], flank: int) -> dict:
    row = {number: i for i, number in enumerate(numbers)}
    width, most = scene.gears.face_width, cycle.grid.nodes
    force = np.zeros((2, len(records), len(numbers)))
    stress = np.zeros((2, len(records), len(numbers), most))
    place = np.full((2, len(records), len(numbers), most), np.nan)
    for i, record in enumerate(records):
        normal, tangential, start = _normal(record), _tangential(record), 0
        for pair in record.position.operator.pairs:
            nodes = slice(start, start + len(pair.offsets))
            start = nodes.stop
            if pair.place.flank != flank:
                continue
            j, count = row[int(cycle.pair_number(record.step, pair.place.index))], len(pair.offsets)
            for kind, forces in enumerate((normal, tangential)):
                if len(forces):
                    force[kind, i, j] = forces[nodes].sum()
                    stress[kind, i, j, :count] = forces[nodes] / (pair.lengths * width)
            place[0, i, j, :count], place[1, i, j, :count] = pair.offsets, pair.pinion_roll
    over_nodes = ("time", "pair", "contact_node")
    values = {
        "pair_normal_force": (("time", "pair"), force[0]),
        "contact_pressure": (over_nodes, stress[0]),
        "contact_offset": (over_nodes, place[0]),
        "contact_roll_angle": (over_nodes, place[1]),
    }
    if scene.friction is not None:
        values["pair_friction_force"] = (("time", "pair"), force[1])
        values["contact_traction"] = (over_nodes, stress[1])
    return values
