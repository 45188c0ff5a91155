"""The gears and meshes that the tests of elasticity share; coarse, for dense brute force."""

import pytest
from tests.coarse_sector import PINION, STEEL, coarse_sector_mesh


@pytest.fixture(scope="session")
def pinion():
    return PINION


@pytest.fixture(scope="session")
def steel():
    return STEEL


@pytest.fixture(scope="session")
def coarse_sector():
    return coarse_sector_mesh
