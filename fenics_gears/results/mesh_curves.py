"""Curves of an elastic mesh besides its forces: its stiffness, and its largest pressure with where that is."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numba import njit

from fenics_gears.contact.laws import NO_FORCE
from fenics_gears.contact.mesh_stiffness import mesh_stiffness
from fenics_gears.contact.pressure import read_off
from fenics_gears.dynamics.steps import Steps, forces_at, in_block, nodes_at, operator_at
from fenics_gears.results.beside_edges import EDGE, KINK, NOTHING, EdgesAndKinks
from fenics_gears.results.side_by_side import SideBySide

Curves = dict[str, np.ndarray]


def stiffness_curves(steps: Steps) -> Curves:
    """Secant and tangent stiffness of the mesh, and how many pairs carry, at consecutive steps of an elastic mesh."""
    secant, tangent, pairs = _stiffness(steps.in_memory)
    return {"mesh_stiffness": secant, "mesh_stiffness_tangent": tangent, "loaded_pairs": pairs}


@njit(cache=True)
def _stiffness(block):
    steps = in_block(block)
    found = np.zeros((3, len(steps.rows)))
    for s in range(len(steps.rows)):
        forces, status = steps.forces[forces_at(steps, s)], steps.status[nodes_at(steps, s)]
        found[:, s] = mesh_stiffness(operator_at(steps, s), status, forces, steps.states[s, 0])
    return found


def _together(parts: np.ndarray) -> np.ndarray:
    """Values of the slices of tooth pairs, one after the other at each step."""
    return parts.reshape(len(parts), -1)


def pressure_curves(nodes: SideBySide, fields: Mapping[str, np.ndarray], singular: EdgesAndKinks) -> Curves:
    """The largest pressure of consecutive steps, its tooth pair and its place, from their contact `fields`.

    What is beside an edge or a kink is left out and has a largest pressure of its own, as have pairs that press with
    the sharp edge of a tip, or of an undercut involute, and slices near the ends of the face: linear elasticity has
    infinite pressure there, and the number grows as contact nodes come closer.
    """
    pressed_edge, beside = nodes.of("on_edge").any(axis=0) & (nodes.normal > NO_FORCE), singular.beside(nodes)
    largest, rolls = {kind: [] for kind in (NOTHING, KINK, EDGE)}, []
    for side, drive in (("", True), ("coast_", False)):
        if f"{side}contact_pressure" not in fields:
            continue
        place = fields[f"{side}contact_roll_angle"]
        pressure = read_off(fields[f"{side}contact_pressure"], place)
        presses_edge = nodes.by_slice(pressed_edge & (nodes.drive == drive))[..., None] > 0
        kinds = np.where(presses_edge, EDGE, nodes.over_nodes(beside, drive, NOTHING))
        for kind, found in largest.items():
            found.append(_together(np.where(kinds == kind, pressure, 0.0).max(axis=-1)))
        node = np.where(kinds == NOTHING, pressure, 0.0).argmax(axis=-1)[..., None]
        rolls.append(_together(np.take_along_axis(place, node, -1)[..., 0]))
    pressures = {kind: np.concatenate(found, axis=1) for kind, found in largest.items()}
    repeated = np.repeat(nodes.pair_number, rolls[0].shape[1] // nodes.pair_number.shape[1], axis=1)
    numbers, off_edge = np.concatenate([repeated] * len(rolls), axis=1), pressures[NOTHING]
    at = np.arange(len(off_edge)), off_edge.argmax(axis=1)
    touching = off_edge[at] > 0.0
    return {
        "largest_contact_pressure": off_edge[at],
        "largest_contact_pressure_pair": np.where(touching, numbers[at], 0),
        "largest_contact_pressure_roll_angle": np.where(touching, np.concatenate(rolls, axis=1)[at], np.nan),
        "largest_edge_pressure": pressures[EDGE].max(axis=1),
        "largest_kink_pressure": pressures[KINK].max(axis=1),
    }
