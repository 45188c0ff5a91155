"""A coarse scene that a study can vary in a few seconds, and the command line alone and under mpirun."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

CHECKOUT = Path(__file__).parents[2]
DEMO = CHECKOUT / "demos" / "lundvall2004.toml"
ACCURACY = """[accuracy]
flank_element_size = "0.3 mm"
contact_length = "2.4 mm"
contact_nodes = 9
steps_per_mesh_cycle = 20
"""


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """A folder with the coarse scene `pair.toml`, and the present directory."""
    monkeypatch.chdir(tmp_path)
    text = DEMO.read_text(encoding="utf-8").replace("mesh_cycles = 30 ", "mesh_cycles = 2 ")
    (tmp_path / "pair.toml").write_text(text[: text.index("[accuracy]")] + ACCURACY, encoding="utf-8")
    return tmp_path


@pytest.fixture
def undrawn(monkeypatch):
    """Studies in this process are not drawn, which takes longer than their runs; the first test of test_run_study.py
    draws one."""
    monkeypatch.setattr("fenics_gears.show.plots.draw_study", lambda file: [])


def write_study(folder, text, name="study.toml"):
    """Write a study file of the coarse scene."""
    path = Path(folder) / name
    path.write_text('scene = "pair.toml"\n' + text, encoding="utf-8")
    return path


def environment():
    """This process's environment for the command line, without what an MPI in this process has left in it."""
    kept = {
        name: value
        for name, value in os.environ.items()
        if not name.startswith(("OMPI_", "PMIX_", "PRTE_", "PMI_", "SLURM_"))
    }
    root = {f"{prefix}_ALLOW_RUN_AS_ROOT{suffix}": "1" for prefix in ("OMPI", "PRTE") for suffix in ("", "_CONFIRM")}
    return {**kept, **root, "PYTHONPATH": str(CHECKOUT)}


def command(*arguments, ranks=0):
    """The call of `gears`, under mpirun where `ranks` is not 0."""
    call = [sys.executable, "-m", "fenics_gears", *map(str, arguments)]
    return [*mpirun(ranks), *call] if ranks else call


def mpirun(ranks):
    """The call of mpirun for more ranks than there may be cores; skips the test where there is none."""
    if not shutil.which("mpirun"):
        pytest.skip("no mpirun")
    version = subprocess.run(["mpirun", "--version"], capture_output=True, text=True, env=environment()).stdout
    return [
        "mpirun",
        *(["--oversubscribe"] if "Open MPI" in version or "open-mpi" in version else []),
        "-n",
        str(ranks),
    ]


def gears(folder, *arguments, ranks=0):
    """Run `gears` to its end."""
    return subprocess.run(
        command(*arguments, ranks=ranks), cwd=folder, env=environment(), capture_output=True, text=True, timeout=120
    )


def stamps(directory):
    """Inode and time of change of every case's file; the same only for a file that was not written again."""
    return {path.name: (path.stat().st_ino, path.stat().st_mtime_ns) for path in Path(directory, "cases").glob("*.nc")}
