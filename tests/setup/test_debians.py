"""tests/debians/run without making a system: what it reads."""

from pathlib import Path

import pytest
from tests.debians.trial import OF_RANKS, SUITES, read_dockerfile

CHECKOUT = Path(__file__).parents[2]


def test_dockerfile_is_the_debian_13_case_of_the_script():
    """From Debian 13, by the one command that sets up every Debian."""
    docker = read_dockerfile()
    assert SUITES[docker.suite] == "Debian 13"
    assert docker.commands[0].startswith(f"{docker.copied_to}/gears --set-up-only")
    assert docker.entry_point == ["gears"] and f"{docker.copied_to}/gears /usr/local/bin/gears" in docker.commands[1]
    assert docker.environment["OMPI_ALLOW_RUN_AS_ROOT"] == "1"


@pytest.mark.parametrize("suite", SUITES)
def test_every_suite_has_its_lists_of_packages(suite):
    """A release without would be set up as unstable."""
    assert (CHECKOUT / f"setup/{suite}.apt").exists() and (CHECKOUT / f"setup/{suite}-test.apt").exists()


def test_tests_that_are_chosen_exist():
    """pytest given a path that is gone runs nothing."""
    assert [path for path in OF_RANKS if not (CHECKOUT / path).exists()] == []
