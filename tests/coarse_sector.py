"""The gear and its coarse sector meshes that tests of elasticity share."""

from functools import lru_cache
from math import radians

import numpy as np

from fenics_gears import Gear
from fenics_gears.elasticity.element_sizes import ElementSizes
from fenics_gears.elasticity.elements import ELEMENTS
from fenics_gears.elasticity.ring import condensed_sector
from fenics_gears.elasticity.sector_mesh import sector_mesh
from fenics_gears.geometry.outline import centreline_mirror
from fenics_gears.scene.data import Material

# Pinion of Lundvall, Stroemberg, Klarbring (2004), Table 2.
PINION = Gear(16, 4.5, radians(20.0), 0.196, 41.32, 31.25, 15.0, 0.38 * 4.5)
STEEL = Material(206e3, 0.3)
COARSE = ElementSizes(flank=0.8, fillet=0.4, coast=1.0, body=3.0)


@lru_cache
def coarse_sector_mesh(name: str):
    return sector_mesh(PINION, COARSE, ELEMENTS[name].quadrilateral)


@lru_cache
def coarse_condensed_sector(name: str, poissons_ratio: float = 0.3):
    return condensed_sector(coarse_sector_mesh(name), ELEMENTS[name], poissons_ratio)


def relative(difference, reference) -> float:
    return float(np.abs(difference).max() / np.abs(reference).max())


def unmirrored(gear: Gear, forces: np.ndarray) -> np.ndarray:
    """Forces (2 f, ...) on a coast flank in the tooth's own frame, from those in the frame mirrored at its
    centreline."""
    found = np.einsum("xy,fy...->fx...", centreline_mirror(gear), forces.reshape(-1, 2, *forces.shape[1:]))
    return found.reshape(forces.shape)
