"""Stress in a tooth's fillets per force on the flanks: a row for each fillet point, so that a time step's stress is one
small product.

The rows come by reciprocity (Betti): under the load that is dual to the stress at a fillet point, the displacement of
the flanks is that stress per unit force on them. One solve for each fillet point serves all flank nodes of all teeth.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass

import numpy as np

from fenics_gears.elasticity.cache import Cache, kept
from fenics_gears.elasticity.element_sizes import Discretisation
from fenics_gears.elasticity.elements import element_named
from fenics_gears.geometry.gear import Gear
from fenics_gears.geometry.gear_data import Material
from fenics_gears.numbers_version import NUMBERS_VERSION


@dataclass(frozen=True)
class RootStressRows:
    """Stress along the surface at the fillet points of a tooth per line force on flank nodes, MPa per N/mm.

    rows: (2 reach + 1, 2 p, d): rows[reach + m] are those of the tooth m pitches ahead (counter-clockwise) of the
        loaded one; the drive
    side's p points, then the coast side's; d dofs of the loaded tooth's flank or flanks in its own frame, as the flank
    compliance has them
    but not mirrored. tangent_angle: (p,), rad, between the fillet's tangent and the tooth's centreline; the last point
    is the one at 30 degrees.
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
    discretisation: Discretisation,
    reach: int,
    coast_flank: bool = False,
    cache: Cache | None = None,
) -> RootStressRows:
    """The rows of a gear, from the cache or by solving; settings as in `flank_compliance`. Stress does not depend on
    Young's modulus."""
    chosen = element_named(discretisation.element)
    sizes = discretisation.sizes(gear, both_flanks=coast_flank).in_modules_of(gear)
    similar = gear.of_module_one
    inputs = {
        "kind": "root stress",
        "version": NUMBERS_VERSION,
        "gear": asdict(similar),
        "poissons_ratio": material.poissons_ratio,
        "element": chosen.name,
        "sizes": asdict(sizes),
        "reach": reach,
    }
    arrays, _ = kept(cache, inputs, lambda: (_computed(similar, material, chosen, sizes, reach), {}))
    # A stress is a force over a length, which is in modules there.
    return RootStressRows(arrays["unit_rows"] / gear.module, arrays["tangent_angle"])


def _computed(gear: Gear, material: Material, element, sizes, reach: int) -> dict[str, np.ndarray]:
    # Imported here: a run whose gears are all in the cache needs neither gmsh nor DOLFINx.
    from fenics_gears.elasticity.condensation import dofs_of
    from fenics_gears.elasticity.fillet_points import fillet_curve, fillet_rows
    from fenics_gears.elasticity.recovery import GearRecovery
    from fenics_gears.elasticity.sector_mesh import sector_mesh

    mesh = sector_mesh(gear, sizes, element.quadrilateral)
    with GearRecovery(gear, material, mesh, element) as recovery:
        curve = fillet_curve(gear)
        wanted = fillet_rows(curve, recovery.interior, recovery.nodal_stress)
        sides = ("flank", "coast") if sizes.both_flanks else ("flank",)
        flank = np.concatenate([dofs_of(recovery.interior.flank_nodes(side)) for side in sides])
        # A tooth m pitches ahead of the loaded one: the loaded one is m pitches behind the tooth whose stress is
        # wanted.
        responses = recovery.unit_displacement({0: np.nan_to_num(wanted).T}, [-m for m in range(-reach, reach + 1)])
    rows = np.stack([response[flank].T for response in responses])
    rows[:, ~np.isfinite(wanted).all(axis=1)] = np.nan
    return {"unit_rows": rows, "tangent_angle": curve.tangent_angle}
