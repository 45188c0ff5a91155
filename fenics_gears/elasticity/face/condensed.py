"""A swept tooth sector condensed onto its flanks and cuts."""

from __future__ import annotations

from time import perf_counter

import numpy as np
from scipy import sparse
from scipy.spatial import cKDTree

from fenics_gears.elasticity.condensation import CondensedBody, by_radius, dofs_of, without
from fenics_gears.elasticity.face.layers import Sweep
from fenics_gears.elasticity.face.swept_stiffness import ELEMENT, SectionForms, swept_stiffness
from fenics_gears.elasticity.mesh_data import BodyMesh
from fenics_gears.elasticity.mumps import Factor, distributed
from fenics_gears.errors import ComputationError


def condensed_swept_sector(
    mesh: BodyMesh, sweep: Sweep, poissons_ratio: float, sides: tuple[str, ...] = ("flank",), comm=None
) -> CondensedBody:
    """A swept sector condensed onto "flank" (of each of the `sides`), "lower" and "upper" (the cuts without their hub nodes), hub held."""
    hub = mesh.edge_nodes("hub", ELEMENT.order)
    lines = {
        "flank": [by_radius(mesh.edge_nodes(side, ELEMENT.order)) for side in sides],
        **{name: [by_radius(without(mesh.edge_nodes(f"{name} cut", ELEMENT.order), hub))] for name in ("lower", "upper")},
    }
    return condense_swept(mesh, sweep, poissons_ratio, lines, hub, comm)


def condense_swept(
    mesh: BodyMesh, sweep: Sweep, poissons_ratio: float, lines: dict[str, list[np.ndarray]], held: np.ndarray | None = None, comm=None
) -> CondensedBody:
    """Schur complement of a swept body onto groups of surfaces, each swept from nodes (k, 2) of the section.

    A surface's nodes go by height, then as given; points are (X, Y, z), displacements (x, y, z) in the section's frame turned with it.
    held: (j, 2), nodes of the section whose surface does not move. comm: communicator over whose ranks the heights are shared out, for assembly
    and factorisation; every rank calls this and gets the result.
    """
    clock = perf_counter()
    section = SectionForms(mesh, poissons_ratio)
    compiled = perf_counter()
    nodes, heights = section.nodes.points, sweep.heights
    surfaces = {name: np.concatenate([swept_nodes(nodes, line, len(heights)) for line in group]) for name, group in lines.items()}
    own = range(len(heights)) if comm is None else range(*np.linspace(0, len(heights), comm.size + 1).astype(int)[[comm.rank, comm.rank + 1]])
    free = np.ones(3 * len(nodes), dtype=bool)
    if held is not None:
        free[dofs_of(swept_nodes(nodes, held, 1), 3)] = False
    stiffness = swept_stiffness(section, sweep, own)[np.tile(free, len(own))][:, np.tile(free, len(heights))]
    number = np.cumsum(np.tile(free, len(heights))) - 1
    assembled = perf_counter()
    condensed = _condensed(stiffness, number[dofs_of(np.concatenate([*surfaces.values()]), 3)], comm)
    timings = {
        "time_compile": compiled - clock,
        "time_assemble": assembled - compiled,
        "time_schur": perf_counter() - assembled,
        "unknowns": stiffness.shape[1],
        "condensed_unknowns": len(condensed),
    }
    points = {name: np.column_stack([nodes[at % len(nodes)], heights[at // len(nodes)]]) for name, at in surfaces.items()}
    return CondensedBody(points, condensed, timings)


def _condensed(rows: sparse.csr_matrix, dofs: np.ndarray, comm) -> np.ndarray:
    factor = Factor(rows if comm is None else distributed(rows, comm), "the body's stiffness", dofs)
    try:
        condensed = factor.schur()
    finally:
        factor.close()
    if comm is None:
        return condensed
    # mpi4py does not know the type of an array made from C's memory.
    everywhere = np.empty((len(dofs),) * 2)
    if condensed is not None:
        everywhere[:] = condensed
    comm.Bcast(everywhere)
    return everywhere


def swept_nodes(nodes: np.ndarray, line: np.ndarray, heights: int) -> np.ndarray:
    """Numbers (heights k,) of the body's nodes swept from nodes (k, 2) of the section (n, 2), by height."""
    distance, found = cKDTree(nodes).query(line)
    if distance.max(initial=0.0) > 1e-9 * np.abs(nodes).max():
        raise ComputationError("swept body: a node of the section's boundary is not among the nodes of its elements")
    return (len(nodes) * np.arange(heights)[:, None] + found).ravel()
