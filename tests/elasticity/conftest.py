"""The gears and meshes that the tests of elasticity share; coarse, so that dense brute force stays quick."""

from functools import lru_cache
from math import radians

import pytest

from fenics_gears.elasticity.element_sizes import ElementSizes
from fenics_gears.elasticity.elements import ELEMENTS
from fenics_gears.elasticity.sector_mesh import sector_mesh
from fenics_gears.geometry.gear import Gear
from fenics_gears.scene.data import Material

COARSE = ElementSizes(flank=0.8, fillet=0.4, coast=1.0, body=3.0)


@pytest.fixture(scope="session")
def pinion():
    """Pinion of Lundvall, Stroemberg, Klarbring (2004), Table 2."""
    return Gear(16, 4.5, radians(20.0), 0.196, 41.32, 31.25, 15.0, 0.38 * 4.5)


@pytest.fixture(scope="session")
def steel():
    return Material(206e3, 0.3)


@pytest.fixture(scope="session")
def coarse_sector(pinion):
    """Coarse sector mesh of the pinion for an element's name."""
    return lru_cache(lambda name: sector_mesh(pinion, COARSE, ELEMENTS[name].quadrilateral))
