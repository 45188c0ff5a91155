"""tests/debians/run without making a system: what it reads."""

from pathlib import Path

import pytest
from tests.debians.trial import SUITES, read_dockerfile

CHECKOUT = Path(__file__).parents[2]


def test_dockerfile_is_the_debian_13_case_of_the_script():
    """From Debian 13, by the one command that sets up every Debian."""
    docker = read_dockerfile()
    assert SUITES[docker.suite] == "Debian 13"
    assert all(each.startswith(f"{docker.copied_to}/gears --set-up-only") for each in docker.commands[:2])
    assert docker.entry_point == ["gears"] and f"{docker.copied_to}/gears /usr/local/bin/gears" in docker.commands[2]
    assert docker.environment["OMPI_ALLOW_RUN_AS_ROOT"] == "1"


def test_image_installs_before_it_copies_the_sources_and_is_not_run_as_root():
    """Docker keeps a layer until what was copied before it changes; what a container makes belongs to no root, and its
    caches outlive it."""
    lines = (CHECKOUT / "Dockerfile").read_text(encoding="utf-8").splitlines()
    steps = [line for line in lines if line and not line.startswith(("#", " "))]
    installs = next(at for at, line in enumerate(steps) if line.startswith("RUN"))
    copied = {line.split()[1] for line in steps[:installs] if line.startswith("COPY")}
    assert copied == {"gears", "setup"} and steps[installs + 1].startswith("COPY . ")
    assert read_dockerfile().user != "root"
    (volume,) = [line.split()[1] for line in steps if line.startswith("VOLUME")]
    assert read_dockerfile().environment["XDG_CACHE_HOME"] == volume


@pytest.mark.parametrize("suite", SUITES)
def test_every_suite_has_its_lists_of_packages(suite):
    """A release without would be set up as unstable."""
    assert (CHECKOUT / f"setup/{suite}.apt").exists() and (CHECKOUT / f"setup/{suite}-test.apt").exists()
