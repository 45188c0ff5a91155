"""A checkout of somebody else's, and no home, as in a container; needs root."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
NOBODY = 65534


@pytest.fixture
def as_another():
    """Runs Python as a user who may write one folder only; that folder."""
    setpriv = shutil.which("setpriv")
    if os.geteuid() != 0 or setpriv is None:
        pytest.skip("only root can become another user")
    folder = Path(f"/tmp/fenics_gears_another_{os.getpid()}")
    folder.mkdir()
    os.chown(folder, NOBODY, NOBODY)
    become = [setpriv, f"--reuid={NOBODY}", f"--regid={NOBODY}", "--clear-groups"]
    environment = {"PATH": os.environ["PATH"], "PYTHONPATH": str(ROOT), "HOME": "/nonexistent", "TMPDIR": str(folder)}

    def run(*arguments):
        call = [*become, sys.executable, "-P", *arguments]
        return subprocess.run(call, cwd=folder, env=environment, capture_output=True, text=True, timeout=600)

    if run("-c", "import fenics_gears").returncode:
        shutil.rmtree(folder)
        pytest.skip("the checkout or its Python cannot be read by others")
    yield run, folder
    shutil.rmtree(folder)


def test_compiled_loops_find_a_place(as_another):
    """Numba refuses to be loaded where nothing can be written; a sentence says where it writes."""
    run, folder = as_another
    program = "from fenics_gears.system import environment; environment.prepare()\n"
    program += "from fenics_gears.contact import laws; print(laws.next_status._cache.cache_path)"
    first, second = run("-c", program), run("-c", program)
    assert first.returncode == 0, first.stderr
    assert first.stdout.startswith(str(folder)) and first.stderr.count("\n") == 1 and "XDG_CACHE_HOME" in first.stderr
    assert second.stderr == "" and second.stdout == first.stdout


@pytest.mark.nightly
def test_every_command_runs(as_another):
    """matplotlib, DOLFINx and the cache of gears have places."""
    run, folder = as_another
    shutil.copy(ROOT / "demos" / "lundvall2004.toml", folder)
    study = (
        'scene = "lundvall2004.toml"\nwithout = ["inertia", "damping"]\n[sweep]\nfriction.coefficient = [0.05, 0.1]\n'
    )
    (folder / "study.toml").write_text(study)
    made = "results/lundvall2004"
    for command in (
        "check lundvall2004.toml",
        "run lundvall2004.toml",
        f"picture {made}",
        f"report {made}",
        "study study.toml",
    ):
        done = run("-m", "fenics_gears", *command.split(), "--quiet")
        assert done.returncode == 0 and "Traceback" not in done.stderr, done.stderr
        assert "Matplotlib" not in done.stderr and done.stderr.count("\n") <= 1
    assert (folder / made / "report.html").exists() and (folder / "results" / "study" / "study.nc").exists()
