"""Curves of an elastic mesh besides its forces: its stiffness, and its largest pressure with where that is."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.contact.mesh_stiffness import mesh_stiffness
from fenics_gears.contact.pressure import largest_pressure
from fenics_gears.dynamics.march import Record
from fenics_gears.scene.data import Scene

STIFFNESS = ("mesh_stiffness", "mesh_stiffness_tangent", "loaded_pairs")
PRESSURE = ("largest_contact_pressure", "largest_contact_pressure_pair", "largest_contact_pressure_roll_angle", "largest_edge_pressure")


def names(scene: Scene) -> tuple[str, ...]:
    """Of the curves that a scene has: none with rigid flanks, no pressure where contact is not spread over nodes."""
    if scene.tooth_elasticity is None:
        return ()
    return STIFFNESS + PRESSURE if scene.resolves_contact else STIFFNESS


def step_values(scene: Scene, cycle: Cycle, record: Record, first_number: int) -> tuple[float, ...]:
    """The values of `names` at a step; `first_number`: of the pair that reaches the start of contact at mesh phase 0."""
    operator, solution = record.position.operator, record.solution
    found = mesh_stiffness(operator, solution)
    stiffness = found.secant, found.tangent, found.pairs
    if not scene.resolves_contact:
        return stiffness
    peak = largest_pressure(cycle.pair, cycle.grid, operator.pairs, solution.forces[: operator.nodes])
    number = 0.0 if peak.place is None else float(cycle.pair_number(record.step, peak.place.index) + first_number)
    return *stiffness, peak.pressure, number, peak.pinion_roll, peak.at_edge


def mesh_curves(scene: Scene, cycle: Cycle, records: Sequence[Record], first_number: int) -> dict[str, np.ndarray]:
    """The curves over some steps."""
    known = names(scene)
    if not known:
        return {}
    values = np.array([step_values(scene, cycle, record, first_number) for record in records]).reshape(len(records), len(known))
    return {name: values[:, place] for place, name in enumerate(known)}
