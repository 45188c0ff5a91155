"""The core does without any extension, in a copy of the checkout."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from tests.docs.blocks import ROOT
from tests.paper_text import coarse_text

# Tests of the whole program, or of its installation.
OF_THE_WHOLE = ("extensions", "docs", "demos", "setup", "benchmarks", "debians", "hard_cases", "evidence", "release")
MODULES_AND_COMMANDS = """
import importlib, pkgutil, fenics_gears
from fenics_gears.commands.cli import main
for each in pkgutil.walk_packages(fenics_gears.__path__, "fenics_gears."):
    if not each.name.endswith("__main__"):
        importlib.import_module(each.name)
assert all(hasattr(fenics_gears, name) for name in fenics_gears.__all__)
assert main(["check", "pair.toml"]) == 0
assert main(["run", "pair.toml", "-o", "out", "--quiet", "--no-pictures"]) == 0
main(["--help"])
"""


@pytest.fixture(scope="module")
def core(tmp_path_factory):
    """Compiled kernels come along, which know their source by its time."""
    folder = tmp_path_factory.mktemp("core")
    shutil.copytree(ROOT / "fenics_gears", folder / "fenics_gears", ignore=shutil.ignore_patterns("extensions"))
    shutil.copytree(ROOT / "tests", folder / "tests", ignore=shutil.ignore_patterns("extensions", "__pycache__"))
    for name in ("demos", "meshes", "docs"):
        (folder / name).symlink_to(ROOT / name)
    shutil.copy2(ROOT / "pyproject.toml", folder)
    return folder


def python(folder, *arguments, timeout=300):
    return subprocess.run(
        [sys.executable, "-P", *map(str, arguments)],
        cwd=folder,
        env={**os.environ, "PYTHONPATH": str(folder)},
        capture_output=True,
        text=True,
        timeout=timeout,
    )


@pytest.mark.nightly
def test_its_modules_load_and_a_scene_runs(core):
    """The contract that the core imports no extension, by doing."""
    (core / "pair.toml").write_text(coarse_text())
    done = python(core, "-c", MODULES_AND_COMMANDS)
    assert done.returncode == 0 and done.stderr == "" and (core / "out" / "run.nc").exists(), done.stderr
    assert "parameter study" in done.stdout and "optimize" not in done.stdout


@pytest.mark.nightly
@pytest.mark.parametrize(
    "folder",
    sorted(each.name for each in (ROOT / "tests").iterdir() if each.is_dir() and each.name not in OF_THE_WHOLE),
)
def test_its_tests_pass(core, folder):
    """Those that the suite runs by day and that start no mpirun themselves."""
    if not list(Path(ROOT, "tests", folder).rglob("test_*.py")):
        pytest.skip("no tests")
    call = ("-m", "pytest", "-n", "0", "-q", "-m", "not nightly and not ranks", f"tests/{folder}")
    done = python(core, *call, timeout=1800)
    if done.returncode == pytest.ExitCode.NO_TESTS_COLLECTED:
        pytest.skip("no tests by day")
    assert done.returncode == 0, done.stdout[-3000:]
