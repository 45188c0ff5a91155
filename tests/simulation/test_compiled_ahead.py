"""What is compiled before the first run."""

import io
import os
import subprocess
import sys
from pathlib import Path

import pytest

from fenics_gears.simulation import compiled_ahead
from fenics_gears.simulation.warm_up import compile_loops
from fenics_gears.system.progress import LineProgress

ROOT = Path(__file__).parents[2]


@pytest.fixture
def places(tmp_path, monkeypatch):
    """Two folders of sources, one with compiled loops, and where numba keeps what it compiles of them; commands that
    were started."""
    package = tmp_path / "package"
    for folder in ("contact", "results"):
        (package / folder / "__pycache__").mkdir(parents=True)
    (package / "contact" / "laws.py").write_text("from numba import njit\n")
    (package / "results" / "files.py").write_text("")
    started = []
    monkeypatch.setattr(compiled_ahead, "PACKAGE", package)
    monkeypatch.setattr(compiled_ahead, "_compiling", lambda: started.append("compiling") or [0, 0])
    folders = [package / name for name in ("contact", "results")]

    def kept_in(place):
        found = {folder: place / folder.name for folder in folders} if place else {}
        for folder in found.values():
            folder.mkdir(parents=True, exist_ok=True)
        found = found or {folder: folder / "__pycache__" for folder in folders}
        monkeypatch.setattr(compiled_ahead, "_places", lambda: found)

    kept_in(None)
    return package, started, kept_in


def test_compiled_once_for_the_same_sources_and_said(places):
    """The second run finds the mark; the first says what it waits for before it waits."""
    _, started, _ = places
    said = io.StringIO()
    for _ in range(2):
        lines = LineProgress(said)
        compile_loops(lines)
    assert started == ["compiling"] and said.getvalue().startswith("compiling, once for these sources")


def test_what_was_compiled_of_other_sources_goes(places):
    """Numba compares the source of a loop with its file, not those of the loops that it calls; sources without loops
    do not matter."""
    package, started, _ = places
    compile_loops(LineProgress(io.StringIO()))
    stale = package / "results" / "__pycache__" / "crests.nbc"
    stale.touch()
    (package / "results" / "files.py").write_text("changed")
    compile_loops(LineProgress(io.StringIO()))
    assert stale.exists() and len(started) == 1
    (package / "contact" / "laws.py").write_text("from numba import njit  # changed\n")
    compile_loops(LineProgress(io.StringIO()))
    assert not stale.exists() and len(started) == 2


def test_who_cannot_write_beside_the_sources_takes_what_lies_there(places, tmp_path):
    """As in a container whose image was compiled by root."""
    package, started, kept_in = places
    compile_loops(LineProgress(io.StringIO()))
    (package / "contact" / "__pycache__" / "laws.1.nbc").write_text("code")
    kept_in(tmp_path / "cache")
    compile_loops(LineProgress(io.StringIO()))
    assert len(started) == 1 and (tmp_path / "cache" / "contact" / "laws.1.nbc").read_text() == "code"


def test_of_processes_that_start_together_one_compiles(tmp_path):
    """Each holds the lock for a while and finds whether another was there before."""
    program = (
        "import sys, time, pathlib; from fenics_gears.system.output import one_at_a_time\n"
        "done = pathlib.Path(sys.argv[1], 'done')\n"
        "with one_at_a_time(pathlib.Path(sys.argv[1], 'lock')):\n"
        "    if not done.exists(): time.sleep(0.2); done.touch(); print('compiled')\n"
    )
    environment = os.environ | {"PYTHONPATH": str(ROOT)}
    call = [sys.executable, "-P", "-c", program, str(tmp_path)]
    processes = [subprocess.Popen(call, env=environment, stdout=subprocess.PIPE, text=True) for _ in range(6)]
    assert sorted(process.communicate(timeout=60)[0] for process in processes) == [""] * 5 + ["compiled\n"]


def test_every_folder_with_loops_is_looked_after():
    """Files of a folder that is left out would outlive a change of its sources."""
    names = {Path(line.rsplit(" ", 1)[1]).parent for line in compiled_ahead._sources().splitlines()}
    loops = {folder.relative_to(compiled_ahead.PACKAGE) for folder in compiled_ahead._places()}
    # The module that compiles ahead names numba's functions without having loops.
    assert names - {Path("simulation")} == loops


def test_a_process_that_compiles_ends_with_the_one_that_started_it():
    """A killed run closes its end of the pipe, as the system does; before, the compilers of each went on beside those
    of the next."""
    program = "import time; from fenics_gears.simulation.compiled_ahead import end_with_its_parent as ends; ends()\n"
    call = [sys.executable, "-P", "-c", f"{program}print(flush=True); time.sleep(60)"]
    environment = os.environ | {"PYTHONPATH": str(ROOT)}
    with subprocess.Popen(call, env=environment, stdin=subprocess.PIPE, stdout=subprocess.PIPE) as compiler:
        compiler.stdout.readline()
        assert compiler.poll() is None
        compiler.stdin.close()
        assert compiler.wait(timeout=30) == 1


def test_a_process_that_compiles_ends_without_an_error_while_its_parent_waits():
    """Identity: what has compiled all ends with exit code 0. Before, Python aborted at its end (-6): a thread held
    the standard input, and every first run said that compiling ahead had failed."""
    program = "import time; from fenics_gears.simulation.compiled_ahead import end_with_its_parent as ends; ends()\n"
    call = [sys.executable, "-P", "-c", f"{program}time.sleep(0.2)"]
    environment = os.environ | {"PYTHONPATH": str(ROOT)}
    with subprocess.Popen(call, env=environment, stdin=subprocess.PIPE) as compiler:
        assert compiler.wait(timeout=30) == 0
