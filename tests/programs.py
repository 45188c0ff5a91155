"""Programs that tests start."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

CHECKOUT = Path(__file__).parents[1]
DEMO = CHECKOUT / "demos" / "lundvall2004.toml"


def environment(**more):
    """This process's and `more`, without what an MPI in this process has left."""
    kept = {
        name: value
        for name, value in os.environ.items()
        if not name.startswith(("OMPI_", "PMIX_", "PRTE_", "PMI_", "SLURM_"))
    }
    root = {f"{prefix}_ALLOW_RUN_AS_ROOT{suffix}": "1" for prefix in ("OMPI", "PRTE") for suffix in ("", "_CONFIRM")}
    return {**kept, **root, "PYTHONPATH": str(CHECKOUT), **more}


def mpirun(ranks):
    if not shutil.which("mpirun"):
        pytest.skip("no mpirun")
    version = subprocess.run(["mpirun", "--version"], capture_output=True, text=True, env=environment()).stdout
    over = ["--oversubscribe"] if "Open MPI" in version or "open-mpi" in version else []
    return ["mpirun", *over, "-n", str(ranks)]


def command(*arguments, ranks=0):
    """The call of `gears`, under mpirun where `ranks` is not 0."""
    return [*(mpirun(ranks) if ranks else ()), sys.executable, "-m", "fenics_gears", *map(str, arguments)]


def ended(call, folder=CHECKOUT, *, ends=None, given=None, timeout=240, **more):
    """A call that has ended; `ends`: the exit code that it must have, `given`: its input, `more`: variables of its
    environment."""
    done = subprocess.run(
        call, input=given, cwd=folder, env=environment(**more), capture_output=True, text=True, timeout=timeout
    )
    assert ends is None or done.returncode == ends, done.stderr
    return done


def python(*arguments, folder=CHECKOUT, ranks=0, ends=0, **options):
    call = [*(mpirun(ranks) if ranks else ()), sys.executable, *map(str, arguments)]
    return ended(call, folder, ends=ends, **options)


def gears(folder, *arguments, ranks=0):
    return ended(command(*arguments, ranks=ranks), folder, timeout=120)
