"""A swept tooth sector that half a turn does not map on itself (`fold`), as with a web towards one end of the face:
condensed as a whole."""

from __future__ import annotations

from time import perf_counter

import numpy as np

from fenics_gears.elasticity.condensation import CondensedBody, by_radius, dofs_of, without
from fenics_gears.elasticity.face.layers import Sweep, swept_nodes
from fenics_gears.elasticity.face.swept_stiffness import ELEMENT, SectionForms, swept_stiffness
from fenics_gears.elasticity.mesh_data import BodyMesh
from fenics_gears.elasticity.mumps import Factor


def condensed_whole_sector(mesh: BodyMesh, sweep: Sweep, poissons_ratio: float, both: bool = False) -> CondensedBody:
    """A swept sector condensed onto "flank" (with `both` the coast flank's
    nodes after the drive flank's), "lower" and "upper", hub held, Young's modulus 1 MPa; dofs in the
    section's frame turned with it."""
    clock = perf_counter()
    section = SectionForms(mesh, poissons_ratio, sweep.web)
    compiled = perf_counter()
    nodes, heights, there = section.nodes.points, len(sweep.heights), section.material(sweep).ravel()
    hub = mesh.edge_nodes("hub", ELEMENT.order)
    lines = {
        "flank": [by_radius(mesh.edge_nodes(side, ELEMENT.order)) for side in ("flank", *(("coast",) if both else ()))],
        "lower": [by_radius(without(mesh.edge_nodes("lower cut", ELEMENT.order), hub))],
        "upper": [by_radius(without(mesh.edge_nodes("upper cut", ELEMENT.order), hub))],
    }
    numbers = {
        name: np.concatenate([swept_nodes(nodes, line, heights) for line in part]) for name, part in lines.items()
    }
    numbers = {name: own[there[own]] for name, own in numbers.items()}
    there[swept_nodes(nodes, hub, heights)] = False
    free, number = dofs_of(np.flatnonzero(there), 3), np.cumsum(there) - 1
    stiffness = swept_stiffness(section, sweep)[free][:, free]
    assembled, kept = perf_counter(), dofs_of(number[np.concatenate(list(numbers.values()))], 3)
    factor = Factor(stiffness, "the body's stiffness", kept)
    try:
        condensed = factor.schur()
    finally:
        factor.close()
    points = {
        name: np.column_stack([nodes[own % len(nodes)], sweep.heights[own // len(nodes)]])
        for name, own in numbers.items()
    }
    timings = {
        "time_compile": compiled - clock,
        "time_assemble": assembled - compiled,
        "time_schur": perf_counter() - assembled,
        "unknowns": len(free),
        "condensed_unknowns": len(condensed),
    }
    return CondensedBody(points, condensed, timings)
