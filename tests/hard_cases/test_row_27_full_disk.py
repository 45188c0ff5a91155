"""Row 27: a full disk.

Authority throughout: hard case 27: recomputed or resumed; never a wrong number, never half a result under its final name. Where a number
is compared, the reference is the same run undisturbed, and the two are the same to the last bit.
"""

import errno
import os
import resource
import subprocess
import sys
from pathlib import Path

import pytest
from tests.hard_cases.kept_files import ARRAYS, KEY, left_over
from tests.studies.conftest import command, environment, folder, undrawn, write_study  # noqa: F401
from tests.studies.test_run_study import TWO, load

from fenics_gears import results
from fenics_gears.commands.cli import main
from fenics_gears.elasticity.cache import Cache


def within(size):
    """A process's files may have so many bytes and no more: what a full disk does to a file, in every C library and file system alike."""
    return lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))


def limited(folder, size, *arguments):
    """Run `gears` with a limit on its files."""
    return subprocess.run(
        command(*arguments), cwd=folder, env=environment(), capture_output=True, text=True, timeout=120, preexec_fn=within(size)
    )


@pytest.mark.parametrize("size", [pytest.param(100, marks=pytest.mark.nightly), 20_000])
def test_a_full_disk_leaves_no_half_result(folder, measured, size):
    """`gears run` on a full disk: exit code 3, the reason in words, nothing under a final name; with room again it runs.

    The gears are in the cache: what MPI does without room for its own files is not this program's.
    """
    assert main(["run", "pair.toml", "--output", "usual", "--quiet", "--no-pictures"]) == 0
    ended = limited(folder, size, "run", "pair.toml", "--output", "here", "--quiet", "--no-pictures")
    names, unfinished = left_over("here")
    measured(f"disk full after {size} bytes of a file", f"exit code {ended.returncode}, {len(names) + len(unfinished)} files", "3, none")
    assert ended.returncode == 3 and "could not be written: File too large" in ended.stderr and "Traceback" not in ended.stderr
    assert names == [] and unfinished == []
    assert main(["run", "pair.toml", "--output", "here", "--quiet", "--no-pictures"]) == 0
    assert results.load("here/run.nc").attrs["complete"] == 1


def test_an_earlier_result_survives_a_full_disk(folder, measured):
    """The whole result of before is still there, bit for bit."""
    assert main(["run", "pair.toml", "--output", "here", "--quiet", "--no-pictures"]) == 0
    before = {path.name: path.read_bytes() for path in Path("here").iterdir()}
    ended = limited(folder, 4096, "run", "pair.toml", "--output", "here", "--quiet", "--no-pictures")
    same = {path.name: path.read_bytes() for path in Path("here").iterdir()} == before
    measured("full disk over an earlier result", f"exit code {ended.returncode}, " + ("unchanged" if same else "changed"), "3, unchanged")
    assert ended.returncode == 3 and same


def test_a_cache_on_a_full_disk_keeps_nothing(tmp_path, measured):
    """An entry that does not fit: a warning, no file, and the process goes on. What a run does without its cache is told by
    tests/studies/test_run_study.py."""
    program = (
        "import logging, numpy\n"
        "from pathlib import Path\n"
        "from fenics_gears.elasticity.cache import Cache\n"
        "logging.basicConfig()\n"
        "Cache(Path('cache')).store('key', {'values': numpy.zeros(100_000)})\n"
        "print('went on')\n"
    )
    call = [sys.executable, "-c", program]
    ended = subprocess.run(call, cwd=tmp_path, env=environment(), capture_output=True, text=True, timeout=60, preexec_fn=within(10_000))
    names, unfinished = left_over(tmp_path / "cache")
    measured("cache full", f"exit code {ended.returncode}, {len(names) + len(unfinished)} files left", "0, none, a warning")
    assert ended.returncode == 0 and ended.stdout == "went on\n" and "nothing is kept" in ended.stderr and names == unfinished == []


@pytest.mark.parametrize("code", [errno.ENOSPC, errno.EDQUOT, errno.EACCES])
def test_the_cache_warns_of_a_full_disk(tmp_path, code, monkeypatch, caplog, measured):
    """A full disk may show only when the file is flushed."""

    def fail(descriptor):
        raise OSError(code, os.strerror(code))

    monkeypatch.setattr(os, "fsync", fail)
    Cache(tmp_path).store(KEY, ARRAYS)
    measured(f"cache: {os.strerror(code)}", f"{len(list(tmp_path.iterdir()))} files left", "none, a warning")
    assert list(tmp_path.iterdir()) == [] and os.strerror(code) in caplog.text


def test_a_study_on_a_full_disk_goes_on_when_there_is_room(folder, undrawn, measured):
    """No half case, no half dataset; exit code 3; run again it finishes, and is the undisturbed study."""
    study = write_study(folder, TWO)
    assert main(["study", str(study), "--quiet", "--output", "usual"]) == 0
    ended = limited(folder, 8192, "study", study, "--output", "here", "--quiet")
    names, unfinished = left_over("here")
    halves = [name for name in names if name.endswith(".nc")]
    measured("study on a full disk", f"exit code {ended.returncode}, {len(halves)} results, {len(unfinished)} unfinished", "3, none, none")
    assert ended.returncode == 3 and "File too large" in ended.stderr and "Traceback" not in ended.stderr
    assert halves == [] and unfinished == []
    assert main(["study", str(study), "--quiet", "--output", "here"]) == 0
    assert load("here").drop_vars("wall_time").equals(load("usual").drop_vars("wall_time"))
