"""Stress in a tooth's fillets over its face per force on the slices of the flanks: what `elasticity.root_stress` is in
the plane.

By reciprocity (Betti) one solve serves a fillet point in a slice, and one a dof of a flank in a slice; ring and
neighbours follow by dense products. The swept section has few elements along a fillet. What it errs by at a point
hardly depends on the load, so that a finer section in plane strain corrects it.
"""

from __future__ import annotations

from dataclasses import asdict

import numpy as np
from scipy import sparse

from fenics_gears.elasticity.cache import Cache, kept
from fenics_gears.elasticity.face.discretisation import FaceDiscretisation
from fenics_gears.elasticity.root_stress import RootStressRows
from fenics_gears.elasticity.slice_averages import slice_averages
from fenics_gears.geometry.gear import Gear
from fenics_gears.geometry.gear_data import Material
from fenics_gears.numbers_version import NUMBERS_VERSION

# Right-hand sides in memory at once.
COLUMNS = 64


def face_root_stress_rows(
    gear: Gear,
    material: Material,
    discretisation: FaceDiscretisation,
    slices: tuple[np.ndarray, np.ndarray],
    reach: int,
    coast_flank: bool = False,
    cache: Cache | None = None,
) -> RootStressRows:
    """The rows (2 reach + 1, S, 2 p, d) of a gear, MPa/N, from the cache or by solving, on the mesh of its face
    compliance.

    gear: its transverse section. slices: middles from the gear's mid-width and widths (S,), mm; stress is averaged over
        a slice, and its force spreads
    over it. d: dofs of the loaded tooth by flank, slice, node and component (x, y, z) in its own frame at that height,
    not mirrored.
    """
    scaled, similar = discretisation.in_modules_of(gear), gear.of_module_one
    averages = slice_averages(gear.module * scaled.sweep.heights, 2, *slices)
    inputs = {
        "kind": "root stress over the face",
        "version": NUMBERS_VERSION,
        "gear": asdict(similar),
        "poissons_ratio": material.poissons_ratio,
        "face": asdict(scaled),
        # The rule that lays the layers may change while their number does not.
        "boundaries": scaled.sweep.boundaries.tolist(),
        "sizes": asdict(scaled.sizes),
        "slices": [gear.in_modules(*each.tolist()) for each in slices],
        "reach": reach,
        "both flanks": coast_flank,
    }
    arrays, _ = kept(
        cache, inputs, lambda: (_computed(similar, scaled, material.poissons_ratio, averages, reach, coast_flank), {})
    )
    # A stress is a force over an area, which is in modules there.
    return RootStressRows(arrays["unit_rows"] / gear.module**2, arrays["tangent_angle"])


def _computed(
    gear: Gear, face: FaceDiscretisation, poissons_ratio: float, averages: np.ndarray, reach: int, coast_flank: bool
) -> dict[str, np.ndarray]:
    # Imported here: a run whose gears are all in the cache needs neither gmsh nor DOLFINx.
    from fenics_gears.elasticity.face.fine_fillet import fine_over_swept
    from fenics_gears.elasticity.face.recovery import FaceRecovery
    from fenics_gears.elasticity.fillet_points import POINTS_OVER_FACE, fillet_curve

    curve = fillet_curve(gear, POINTS_OVER_FACE)
    with FaceRecovery(gear, Material(1.0, poissons_ratio), face, coast_flank) as recovery:
        stress = _fillet_rows(recovery, curve, averages)
        flanks = _slice_loads(recovery, averages)
        at_flanks, from_points = _moved(recovery, stress.T.tocsc(), flanks)
        _, from_flanks = _moved(recovery, flanks.tocsc(), flanks[:, :0])
        rows = recovery.between_teeth(from_points, from_flanks, reach)
    rows[reach] += at_flanks.T
    rows = rows.reshape(len(rows), len(averages), 2 * len(curve.length), -1)
    rows *= fine_over_swept(gear, face.sizes, poissons_ratio, curve)[:, None]
    rows[:, :, np.tile(~np.isfinite(curve.length), 2)] = np.nan
    return {"unit_rows": rows, "tangent_angle": curve.tangent_angle}


def _fillet_rows(recovery, curve, averages: np.ndarray) -> sparse.csr_matrix:
    """Stress (S 2 p, 3 n h) per displacement: at the points of the drive side's fillet, then the coast side's, slice by
    slice.

    Along the fillet's profile and across the tooth's trace, which is the direction that a section normal to the tooth
    has.
    """
    from fenics_gears.elasticity.fillet_points import fillet_weights

    body, twist, parts = recovery.body, recovery.body.sweep.twist, []
    held = np.unique(np.concatenate([body.lower, body.upper, body.hub]) % len(body.section.points))
    for side in (0, 1):
        nodes, weights, tangents = (np.nan_to_num(each) for each in fillet_weights(curve, body.section, held, side))
        x, y = (weights @ body.section.points[nodes]).T
        trace = np.column_stack([-twist * y, twist * x, np.ones(len(x))])
        profile = np.pad(tangents, ((0, 0), (0, 1)))
        across = profile - ((profile * trace).sum(axis=1) / (trace**2).sum(axis=1))[:, None] * trace
        length = np.linalg.norm(across, axis=1)[:, None]
        directions = np.divide(across, length, out=np.zeros_like(across), where=length > 0.0)
        parts.append(recovery.stress.rows(nodes, weights, directions, averages))
    points = len(curve.length)
    order = np.arange(2 * points * len(averages)).reshape(2, len(averages), points).swapaxes(0, 1).ravel()
    return sparse.vstack(parts, format="csr")[order]


def _slice_loads(recovery, averages: np.ndarray) -> sparse.csr_matrix:
    """Loads (3 n h, d) of unit forces on the nodes of the flanks in the slices."""
    body, parts = recovery.body, []
    for side in recovery.sides:
        at = body.flank_nodes(side).reshape(averages.shape[1], -1)
        spread = sparse.kron(averages.T, sparse.eye(3 * at.shape[1]), format="csr")
        dofs = (3 * at[:, :, None] + np.arange(3)).ravel()
        parts.append(
            sparse.csr_matrix((np.ones(len(dofs)), (dofs, np.arange(len(dofs)))), shape=(3 * body.nodes, len(dofs)))
            @ spread
        )
    return sparse.hstack(parts, format="csr")


def _moved(recovery, loads: sparse.csc_matrix, seen: sparse.csr_matrix) -> tuple[np.ndarray, np.ndarray]:
    """Of loads (3 n h, k) on a sector with free cuts: the displacement (d, k) that `seen` (3 n h, d) averages, and that
    of the cuts (2 c, k)."""
    averaged, at_cuts, columns = np.empty((seen.shape[1], loads.shape[1])), [], seen.T.tocsr()
    for first in range(0, loads.shape[1], COLUMNS):
        part = slice(first, first + COLUMNS)
        moved = recovery.body.free_motion(loads[:, part].toarray())
        averaged[:, part] = columns @ moved
        at_cuts.append(recovery.body.at_cuts(moved))
    return averaged, np.hstack(at_cuts)
