"""The gears and meshes that the tests of elasticity share; coarse, so that dense brute force stays quick."""

import pytest
from tests.coarse_sector import PINION, STEEL, coarse_sector_mesh


@pytest.fixture(scope="session")
def pinion():
    """Pinion of Lundvall, Stroemberg, Klarbring (2004), Table 2."""
    return PINION


@pytest.fixture(scope="session")
def steel():
    return STEEL


@pytest.fixture(scope="session")
def coarse_sector():
    """Coarse sector mesh of the pinion for an element's name."""
    return coarse_sector_mesh
