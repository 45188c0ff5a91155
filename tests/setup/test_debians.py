"""tests/debians/run without making a system: what it reads, counts and calls green. It itself is tried by being run."""

from pathlib import Path

import pytest
from tests.debians.dockerfile import read_dockerfile
from tests.debians.root import Call
from tests.debians.trial import OF_RANKS, QUICK, QUICK_OF_RANKS, RANKS, SUITES, Counts, Trial

CHECKOUT = Path(__file__).parents[2]


def green(suite, logs):
    """A trial in which all went well."""
    trial = Trial(suite, logs, versions={"DOLFINx": "0.9.0"}, is_whole=True)
    trial.calls["first command"] = Call(0, 1.0, "")
    trial.tests = {ranks: Counts(10, 0, 1, 2.0, complete=True) for ranks in (1, *RANKS)}
    return trial


def test_dockerfile_is_the_debian_13_case_of_the_script():
    """Issue 7: it starts from Debian 13, is set up by the one command that sets up every Debian, and its container runs
    the program."""
    docker = read_dockerfile(CHECKOUT / "Dockerfile")
    assert SUITES[docker.suite] == "Debian 13"
    assert docker.commands[0].startswith(f"{docker.copied_to}/gears --set-up-only")
    assert docker.entry_point == ["gears"] and f"{docker.copied_to}/gears /usr/local/bin/gears" in docker.commands[1]
    assert docker.environment["OMPI_ALLOW_RUN_AS_ROOT"] == "1"


@pytest.mark.parametrize(
    ("step", "told"),
    [
        ("USER gears", "USER"),
        ("FROM ubuntu:24.04", "must start from"),
        ("COPY setup /setup", "whole checkout"),
        ("WORKDIR /elsewhere", "once"),
    ],
)
def test_steps_that_the_script_would_not_carry_out_are_refused(tmp_path, step, told):
    """A Dockerfile that does more than what is tried must not be called tried."""
    text = (CHECKOUT / "Dockerfile").read_text(encoding="utf-8")
    name = step.split()[0]
    lines = [line for line in text.splitlines() if name == "WORKDIR" or not line.startswith(name)]
    (tmp_path / "Dockerfile").write_text("\n".join([*lines, step]), encoding="utf-8")
    with pytest.raises(ValueError, match=told):
        read_dockerfile(tmp_path / "Dockerfile")


@pytest.mark.parametrize("suite", SUITES)
def test_every_suite_has_its_lists_of_packages(suite):
    """Without a list of its own a release would be set up as unstable."""
    assert (CHECKOUT / f"setup/{suite}.apt").exists() and (CHECKOUT / f"setup/{suite}-test.apt").exists()


def test_tests_that_are_chosen_exist():
    """pytest given a path that is gone runs nothing."""
    assert [path for path in (*OF_RANKS, *QUICK, *QUICK_OF_RANKS) if not (CHECKOUT / path).exists()] == []
