"""The root stress of a gear per force on its flanks: stresses of one sector are recovered and joined to the ring."""

import numpy as np
from scipy import sparse

from fenics_gears.geometry.gear import Gear
from fenics_gears.geometry.gear_data import Material

from .face.fine_fillet import fine_over_swept
from .fillet_points import POINTS, POINTS_OVER_FACE, fillet_curve, fillet_rows
from .recovery import gear_recovery

# Right-hand sides in memory at once.
COLUMNS = 64


def computed_rows(
    gear: Gear, discretisation, poissons_ratio: float, averages: np.ndarray, reach: int, coast_flank: bool
) -> dict[str, np.ndarray]:
    """Rows for lengths in modules, and the points' angles."""
    over_face = averages.shape[1] > 1
    curve = fillet_curve(gear.of_module_one, POINTS_OVER_FACE if over_face else POINTS)
    with gear_recovery(gear, Material(1.0, poissons_ratio), discretisation, coast_flank) as recovery:
        stress = fillet_rows(recovery, curve, averages)
        flanks = _slice_loads(recovery.sector, averages, coast_flank)
        at_flanks, from_points = _moved(recovery.sector, stress.T.tocsc(), flanks)
        _, from_flanks = _moved(recovery.sector, flanks.tocsc(), flanks[:, :0])
        rows = recovery.between_teeth(from_points, from_flanks, reach)
    rows[reach] += at_flanks.T
    rows = rows.reshape(len(rows), len(averages), 2 * len(curve.length), -1)
    if over_face:
        sizes = discretisation.in_modules_of(gear).sizes
        rows *= fine_over_swept(gear.of_module_one, sizes, poissons_ratio, curve)[:, None]
    rows[:, :, np.tile(~np.isfinite(curve.length), 2)] = np.nan
    return {"unit_rows": rows, "tangent_angle": curve.tangent_angle}


def _slice_loads(sector, averages: np.ndarray, coast_flank: bool) -> sparse.csr_matrix:
    """Loads (dofs, d) of unit forces on the nodes of the flanks in the slices."""
    parts = []
    components = sector.components
    for side in ("flank", "coast") if coast_flank else ("flank",):
        at = sector.flank_nodes(side).reshape(averages.shape[1], -1)
        spread = sparse.kron(averages.T, sparse.eye(components * at.shape[1]), format="csr")
        dofs = (components * at[:, :, None] + np.arange(components)).ravel()
        placed = (np.ones(len(dofs)), (dofs, np.arange(len(dofs))))
        parts.append(sparse.csr_matrix(placed, shape=(components * sector.nodes, len(dofs))) @ spread)
    return sparse.hstack(parts, format="csr")


def _moved(sector, loads: sparse.csc_matrix, averaged: sparse.csr_matrix) -> tuple[np.ndarray, np.ndarray]:
    """Of loads (dofs, k) on a sector with free cuts: the displacement (d, k) on average over `averaged` (dofs, d), and
    that of the cuts (2 c, k)."""
    displacement = np.empty((averaged.shape[1], loads.shape[1]))
    at_cuts = []
    columns = averaged.T.tocsr()
    for first in range(0, loads.shape[1], COLUMNS):
        part = slice(first, first + COLUMNS)
        moved = sector.free_motion(loads[:, part].toarray())
        displacement[:, part] = columns @ moved
        at_cuts.append(sector.at_cuts(moved))
    return displacement, np.hstack(at_cuts)
