"""Row 27: a full disk."""

import errno
import json
import os
import resource
import subprocess
import sys
from pathlib import Path

import pytest
from tests.hard_cases.kept_files import ARRAYS, KEY, left_over
from tests.programs import environment
from tests.studies.conftest import folder, undrawn, write_study  # noqa: F401
from tests.studies.test_run_study import TWO, load

from fenics_gears import results
from fenics_gears.commands.cli import main
from fenics_gears.elasticity.cache import Cache


def within(size):
    """A process's files may have so many bytes and no more, as on a full disk."""
    return lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))


IN_ONE_PROCESS = (
    "import json, sys; from fenics_gears.commands.cli import main; print(json.dumps([main(call) for call in"
    " json.loads(sys.argv[1])]))"
)


def limited(folder, size, *calls):
    """Calls of `gears` one after another in a process with a limit on its files: exit codes, and what was said."""
    call = [sys.executable, "-c", IN_ONE_PROCESS, json.dumps(calls)]
    ended = subprocess.run(
        call, cwd=folder, env=environment(), capture_output=True, text=True, timeout=120, preexec_fn=within(size)
    )
    return json.loads(ended.stdout), ended.stderr


def run_into(directory):
    """The call of a run without pictures."""
    return ["run", "pair.toml", "--output", directory, "--quiet", "--no-pictures"]


@pytest.mark.nightly
@pytest.mark.parametrize("size", [100, 8192])
def test_a_full_disk_leaves_no_half_result(folder, undrawn, measured, size):
    """Exit code 3, nothing half under a final name, an earlier result bit for bit as it was; with room again the
    undisturbed results. The gears are in the cache: what MPI does without room is not this program's."""
    study = write_study(folder, TWO)
    in_study = ["study", str(study), "--quiet", "--output", "study"]
    assert main(run_into("earlier")) == main([*in_study[:-1], "usual"]) == 0
    before = {path.name: path.read_bytes() for path in Path("earlier").iterdir()}
    codes, said = limited(folder, size, run_into("here"), run_into("earlier"), in_study)
    names, unfinished = left_over("here")
    same = {path.name: path.read_bytes() for path in Path("earlier").iterdir()} == before
    of_study, unfinished_of_study = left_over("study")
    halves = [name for name in of_study if name.endswith(".nc")]
    measured(
        f"disk full after {size} bytes of a file",
        f"exit code {codes[0]}, {len(names) + len(unfinished)} files",
        "3, none",
    )
    measured(
        "full disk over an earlier result",
        f"exit code {codes[1]}, " + ("unchanged" if same else "changed"),
        "3, unchanged",
    )
    measured(
        "study on a full disk",
        f"exit code {codes[2]}, {len(halves)} results, {len(unfinished_of_study)} unfinished",
        "3, none, none",
    )
    assert codes == [3, 3, 3] and said.count("could not be written: File too large") >= 3 and "Traceback" not in said
    assert names == unfinished == halves == unfinished_of_study == [] and same
    assert main(run_into("here")) == main(in_study) == 0
    assert results.load("here/run.nc").attrs["complete"] == 1
    assert load("study").drop_vars("wall_time").equals(load("usual").drop_vars("wall_time"))


@pytest.mark.parametrize("code", [errno.ENOSPC, errno.EDQUOT, errno.EACCES])
def test_the_cache_warns_of_a_full_disk(tmp_path, code, monkeypatch, caplog, measured):
    """A full disk may show only when the file is flushed."""

    def fail(descriptor):
        raise OSError(code, os.strerror(code))

    monkeypatch.setattr(os, "fsync", fail)
    Cache(tmp_path).store(KEY, ARRAYS)
    measured(f"cache: {os.strerror(code)}", f"{len(list(tmp_path.iterdir()))} files left", "none, a warning")
    assert list(tmp_path.iterdir()) == [] and os.strerror(code) in caplog.text
