"""How much larger the stress at a fillet's points is on a fine section than on the one that is swept along a face."""

from dataclasses import replace

import numpy as np

from fenics_gears.geometry.gear import Gear
from fenics_gears.geometry.gear_data import Material

from ..element_sizes import Discretisation, ElementSizes
from ..elements import element_named
from ..fillet_points import FilletCurve, fillet_rows
from ..recovery import GearRecovery
from ..sector import plane_sector
from ..sector_mesh import sector_mesh

# The plane route's sizes in the fillet; on the flank, in modules, what the points next to it need.
ELEMENT, FLANK_SIZE = "P2", 0.1


def fine_over_swept(gear: Gear, swept: ElementSizes, poissons_ratio: float, curve: FilletCurve) -> np.ndarray:
    """Ratios (2 p,) at the points of both fillets, in plane strain under a force on the tip of the drive flank; gear
    and sizes in modules. One where the fillet has no such point. Under forces on the middle of the flank they differ by
    0.5 % where stress is large."""
    # A web is in the swept body; both sections of the ratio are without it.
    gear = replace(gear, web=None)
    angle, stresses = curve.outline.centreline_angle, []
    for sizes in (Discretisation(ELEMENT, FLANK_SIZE).sizes(gear, both_flanks=True), swept):
        sector = plane_sector(sector_mesh(gear, sizes), element_named(ELEMENT), poissons_ratio)
        with GearRecovery(gear, Material(1.0, poissons_ratio), sector) as recovery:
            flank = sector.flank_nodes("flank")
            forces = np.zeros((len(flank), 2))
            tip = (gear.sign * np.linalg.norm(sector.section.points[flank], axis=1)).argmax()
            forces[tip] = -np.sin(angle), np.cos(angle)
            stresses.append(fillet_rows(recovery, curve) @ recovery.recovered({0: forces}, [0]).displacement.ravel())
    return np.divide(*stresses, out=np.ones(len(stresses[0])), where=stresses[1] != 0.0)
