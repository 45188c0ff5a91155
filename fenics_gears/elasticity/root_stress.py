"""Stress in a tooth's fillets per force on the flanks, in the plane or over the face in slices. There is a row for each
fillet point and slice, so that a time step's stress is one small product.

The rows come by reciprocity (Betti): one solve serves a fillet point in a slice, and one a dof of a flank in a slice. A
swept section has few elements along a fillet; what it errs by hardly depends on the load, so that a finer section in
plane strain corrects it.
"""

from dataclasses import dataclass

import numpy as np

from fenics_gears.geometry.gear import Gear
from fenics_gears.geometry.gear_data import Material

from .cache import Cache, kept
from .gear_compliance import similar_inputs
from .slice_averages import slice_averages

# Right-hand sides in memory at once.
COLUMNS = 64
ONE_SLICE = np.zeros(1), np.ones(1)


@dataclass(frozen=True)
class RootStressRows:
    """Stress along the surface at the fillet points of a tooth per force on flank nodes: MPa per N/mm in the plane,
    where there is one slice, MPa/N over the face.

    rows: (2 reach + 1, S, 2 p, d): rows[reach + m]: the tooth m pitches ahead (counter-clockwise) of the loaded one.
    First the drive side's p points, then the coast side's. The d dofs of the loaded tooth are by flank, slice, node and
    component in its own frame, not mirrored. tangent_angle: (p,), rad, between the fillet's tangent and the tooth's
    centreline; the last point is the one at 30 degrees.
    """

    rows: np.ndarray
    tangent_angle: np.ndarray

    @property
    def reach(self) -> int:
        """Largest distance, in pitches, of a loaded tooth that is known."""
        return len(self.rows) // 2


def root_stress_rows(
    gear: Gear,
    material: Material,
    discretisation,
    reach: int,
    coast_flank: bool = False,
    cache: Cache | None = None,
    slices: tuple[np.ndarray, np.ndarray] = ONE_SLICE,
) -> RootStressRows:
    """The rows of a gear, or of its transverse section over the face, from the cache or by solving, on the mesh of its
    compliance.

    discretisation: of the plane section (Discretisation), or of the body over the face (FaceDiscretisation), which
    takes many slices. slices: of the face, middles from the gear's mid-width and widths (S,), mm; stress is averaged
    over a slice, and its force spreads over it.
    """
    over_face = len(slices[0]) > 1
    inputs = similar_inputs("root stress", gear, material, discretisation, coast_flank)
    inputs |= {"slices": [gear.in_modules(*each.tolist()) for each in (slices if over_face else ())]}
    inputs |= {"reach": reach, "both flanks": coast_flank}
    averages = np.ones((1, 1))
    if over_face:
        averages = slice_averages(gear.module * discretisation.in_modules_of(gear).sweep.heights, 2, *slices)

    def compute() -> tuple[dict, dict]:
        return _computed(gear, discretisation, material.poissons_ratio, averages, reach, coast_flank), {}

    arrays, _ = kept(cache, inputs, compute)
    # A stress is a force over a length or an area, which is in modules there.
    unit = gear.module**2 if over_face else gear.module
    return RootStressRows(arrays["unit_rows"] / unit, arrays["tangent_angle"])


def _computed(
    gear: Gear, discretisation, poissons_ratio: float, averages: np.ndarray, reach: int, coast_flank: bool
) -> dict[str, np.ndarray]:
    """Rows for lengths in modules, and the points' angles."""
    # A run whose gears are all in the cache needs neither gmsh nor DOLFINx.
    from .computed_root_stress import computed_rows

    return computed_rows(gear, discretisation, poissons_ratio, averages, reach, coast_flank)
