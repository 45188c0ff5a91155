"""Small swept bodies, and their rigid motions."""

from dataclasses import replace
from functools import lru_cache

import numpy as np
from tests.coarse_sector import PINION

from fenics_gears.elasticity.condensation import CondensedBody
from fenics_gears.elasticity.element_nodes import dofs_of
from fenics_gears.elasticity.element_sizes import ElementSizes
from fenics_gears.elasticity.face.layers import Sweep, swept_nodes
from fenics_gears.elasticity.face.swept_stiffness import SectionForms, swept_stiffness
from fenics_gears.elasticity.mumps import Factor
from fenics_gears.elasticity.sector_mesh import sector_mesh
from fenics_gears.geometry.outline import rotation

# In modules: as few elements as a sector takes.
GEAR = PINION.of_module_one
SIZES = ElementSizes(flank=0.6, fillet=0.6, coast=1.0, body=2.0, depth=0.0, growth=1.0, hub_angle=0.5)
TWIST = 0.06
TWISTED = Sweep(np.array([-1.5, 0.0, 1.5]), TWIST)


@lru_cache
def mesh(both_flanks: bool = False):
    return sector_mesh(GEAR, replace(SIZES, both_flanks=both_flanks))


@lru_cache
def section():
    return SectionForms(mesh(), 0.3)


def swept_points(section_points: np.ndarray, sweep: Sweep) -> np.ndarray:
    return np.vstack(
        [np.column_stack([section_points, np.full(len(section_points), height)]) for height in sweep.heights]
    )


def in_place(points: np.ndarray, twist: float) -> np.ndarray:
    """Points (k, 3) from (X, Y, z)."""
    return np.stack([rotation(twist * point[2], 3) @ point for point in points])


def in_frame(displacements: np.ndarray, points: np.ndarray, twist: float) -> np.ndarray:
    """Displacements (k, 3, j) by their components in the section's frame at each point's height, as dofs (3 k, j)."""
    return np.concatenate([rotation(twist * point[2], 3).T @ each for point, each in zip(points, displacements)])


def rigid_motions(points: np.ndarray, twist: float) -> np.ndarray:
    placed = in_place(points, twist)
    turning = np.stack([np.cross(axis, placed) for axis in np.eye(3)], axis=-1)
    return in_frame(np.concatenate([np.broadcast_to(np.eye(3), turning.shape), turning], axis=-1), points, twist)


def condense_swept(
    mesh, sweep: Sweep, poissons_ratio: float, lines: dict[str, np.ndarray], held: np.ndarray | None = None
) -> CondensedBody:
    """Brute force: Schur complement of a swept body onto surfaces swept from nodes (k, 2); nodes (j, 2)
    are held."""
    section = SectionForms(mesh, poissons_ratio)
    nodes, heights = section.nodes.points, sweep.heights
    surfaces = {name: swept_nodes(nodes, line, len(heights)) for name, line in lines.items()}
    free = np.ones(3 * len(nodes), dtype=bool)
    if held is not None:
        free[dofs_of(swept_nodes(nodes, held, 1), 3)] = False
    free = np.tile(free, len(heights))
    factor = Factor(
        swept_stiffness(section, sweep)[free][:, free],
        "a swept body",
        (np.cumsum(free) - 1)[dofs_of(np.concatenate([*surfaces.values()]), 3)],
    )
    try:
        points = {
            name: np.column_stack([nodes[at % len(nodes)], heights[at // len(nodes)]]) for name, at in surfaces.items()
        }
        return CondensedBody(points, factor.schur(), {})
    finally:
        factor.close()
