"""What tests of several folders share."""

import os
import shutil
import tempfile
from dataclasses import replace
from pathlib import Path

# BLAS sums in another order with other numbers of threads; programs that tests start shall have the same bits as the
# tests' own process.
os.environ.update(OMP_NUM_THREADS="1", OPENBLAS_NUM_THREADS="1")
# Gears are condensed once for all tests, workers and programs that they start, and never taken from what a user's runs
# have kept.
IS_WORKER = "PYTEST_XDIST_WORKER" in os.environ
if not IS_WORKER:
    os.environ["FENICS_GEARS_CACHE"] = tempfile.mkdtemp(prefix="fenics_gears_tests_")
SUITE_CACHE = Path(os.environ["FENICS_GEARS_CACHE"])

from fenics_gears.system import environment

# As the command does: before numba is loaded, which another user of this checkout could not import otherwise.
environment.prepare()

import pytest
from hypothesis import HealthCheck, settings
from tests.stand_in import stand_in_compliance
from threadpoolctl import threadpool_limits

from fenics_gears.contact.tooth_pair import Flanks
from fenics_gears.elasticity.cache import Cache
from fenics_gears.geometry.pair import gear_pair
from fenics_gears.scene.data import Motion
from fenics_gears.scene.read import load_scene

# By day the suite draws the same examples on every run, so that a failure is the change's; by night the same tests draw
# new ones. Strategies that draw valid gears refuse many drawings on the way, and the first example may wait for a
# compiler.
PATIENT = [HealthCheck.filter_too_much, HealthCheck.too_slow]
settings.register_profile("suite", max_examples=8, derandomize=True, deadline=None, suppress_health_check=PATIENT)
settings.register_profile("explore", deadline=None, suppress_health_check=PATIENT, print_blob=True)
settings.load_profile("suite")

NIGHT = "nightly"
DEMOS = Path(__file__).parents[1] / "demos"
# The core's tests pass without extensions; pages, the evidence and demonstrations speak of these too.
EXTENSIONS = DEMOS.parent / "fenics_gears" / "extensions"
collect_ignore = [] if EXTENSIONS.is_dir() else ["extensions", "docs", "evidence", "demos", "release"]


def pytest_configure(config):
    if config.option.markexpr == NIGHT:
        settings.load_profile("explore")


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(config, items):
    """Tests of drawn examples run by day and by night."""
    if config.option.markexpr == NIGHT:
        for item in items:
            if getattr(item.obj, "is_hypothesis_test", False):
                item.add_marker(NIGHT)


def pytest_unconfigure():
    if not IS_WORKER:
        shutil.rmtree(SUITE_CACHE, ignore_errors=True)


@pytest.fixture(scope="session", autouse=True)
def one_thread():
    """On small matrices several threads of BLAS wait for one another."""
    with threadpool_limits(limits=1):
        yield


@pytest.fixture(scope="session")
def suite_cache():
    """The cache that all tests share, but those of caches."""
    return Cache(SUITE_CACHE)


@pytest.fixture(scope="session")
def paper_scene():
    """200 Hz, friction, all sections but tip relief."""
    return load_scene(DEMOS / "lundvall2004.toml")


@pytest.fixture(scope="session")
def quasi_static_scene(paper_scene):
    return replace(paper_scene, inertia=None, damping=None, motion=Motion(200.0, 1, 1))


@pytest.fixture(scope="session")
def paper_pair(paper_scene):
    return gear_pair(paper_scene.gears)


@pytest.fixture(scope="session")
def stand_in_flanks(paper_pair):
    """The paper's flanks on teeth without finite elements."""
    return Flanks(paper_pair, tuple(stand_in_compliance(gear) for gear in (paper_pair.pinion, paper_pair.wheel)))
