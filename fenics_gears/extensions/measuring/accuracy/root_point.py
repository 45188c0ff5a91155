"""Peak stress at one material point of the pinion's tooth root: where the fillet's tangent is at 30 degrees to the
tooth's centreline. This point is the same on all meshes, which the place of the largest stress is not."""

from functools import lru_cache

import numpy as np
import xarray as xr

from fenics_gears.measuring import Cycle, Model, root_stress_rows, stored_forces

PINION = 0


def peak_root_stress(run: xr.Dataset, model: Model, cycle: Cycle) -> float:
    """Largest tension (MPa) at the point over the last stored mesh cycle, of both fillets: it is that on the loaded
    side. run: a result of `model` with contact fields; cycle: its mesh cycle."""
    rows = _rows(
        model.pair.pinion, model.scene.gears.material_of("pinion"), model.resolution.discretisation(0),
        model.touching.reach.farthest + 1,
        model.scene.coast_flanks is not None,
    )  # fmt: skip
    point = point_rows(rows)
    steps = range(run.sizes["contact_time"] - cycle.steps, run.sizes["contact_time"])
    stresses = [_stress(point, stored_forces(run, model, cycle, index), model) for index in steps]
    return max(stresses, default=0.0)


def point_rows(rows) -> np.ndarray:
    """Rows (2 reach + 1, 2, d) of the point on either side; of the fillet's middle where the fillet has no such
    tangent."""
    of_plane = rows.rows[:, 0]
    points = of_plane.shape[1] // 2
    place = points - 1 if np.isfinite(of_plane[rows.reach, points - 1]).all() else (points - 1) // 2
    return of_plane[:, [place, points + place]]


def _stress(point: np.ndarray, stored, model) -> float:
    """Larger stress (MPa) of both sides of the loaded teeth at a stored step; 0 where none is loaded."""
    forces = stored.on_flanks(model, PINION)
    reach = len(point) // 2
    loads = {tooth: force.ravel() for tooth, force in forces.items()}
    of_teeth = [sum(point[reach + tooth - loaded] @ load for loaded, load in loads.items()) for tooth in loads]
    return float(np.max(of_teeth, initial=0.0))


_rows = lru_cache(maxsize=64)(root_stress_rows)
