"""Where results are written. Authority: hard cases 26 and 27: refused before any computation; no half result, and nothing of somebody else's removed."""

import os
import subprocess
import sys

import pytest

from fenics_gears.errors import SceneError
from fenics_gears.system import output


def dead_process():
    """The number of a process that has ended."""
    process = subprocess.Popen([sys.executable, "-I", "-S", "-c", ""])
    process.wait()
    return process.pid


def test_what_a_killed_process_left_is_removed_and_nothing_else(tmp_path):
    """Of this machine and of a process that has ended: by the next that writes there. Not of a live process, of another machine, or of a folder within."""
    left = f"{output.UNFINISHED}{output._machine()}-{dead_process()}-abc"
    others = {tmp_path / f"{output.UNFINISHED}{output._machine()}-{os.getppid()}-abc", tmp_path / f"{output.UNFINISHED}elsewhere-4026531836-{dead_process()}-abc"}
    others |= {tmp_path / "neighbour" / left, tmp_path / f"{output.UNFINISHED}abc"}
    for each in (tmp_path / left, *others):
        each.mkdir(parents=True)
        (each / "run.nc").touch()
    output.write_whole(tmp_path / "run.nc", lambda path: path.write_text("whole"))
    assert {each.parent for each in tmp_path.rglob("*/run.nc") if each.parent != tmp_path} == others
    assert (tmp_path / "run.nc").read_text() == "whole"


def test_a_killed_writer_is_recognised(tmp_path):
    """A process that kills itself while it writes leaves a folder that the next writer removes."""
    program = "import os, signal, sys; from pathlib import Path; from fenics_gears.system.output import write_whole\n"
    program += "write_whole(Path(sys.argv[1], 'a'), lambda path: os.kill(os.getpid(), signal.SIGKILL))"
    subprocess.run([sys.executable, "-P", "-c", program, tmp_path], env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}, timeout=60)
    assert [each.name.startswith(output.UNFINISHED) for each in tmp_path.iterdir()] == [True]
    output.write_whole(tmp_path / "b", lambda path: path.touch())
    assert [each.name for each in tmp_path.iterdir()] == ["b"]


def places(folder):
    """Directories that take no result, by why."""
    (folder / "file").touch()
    (folder / "dangling").symlink_to("/nowhere/at/all")
    (folder / "own" / "run.nc").mkdir(parents=True)
    (folder / "loop").symlink_to("loop")
    return {"is a file": folder / "file" / "out", "is a link to /nowhere/at/all": folder / "dangling" / "out", "is no file": folder / "own",
            "levels of symbolic links": folder / "loop", "name too long": folder / ("x" * 300)}  # fmt: skip


@pytest.mark.parametrize("why", ["is a file", "is a link to /nowhere/at/all", "is no file", "levels of symbolic links", "name too long"])
def test_places_that_take_no_result_are_refused(tmp_path, why):
    """Each with what it is and the remedy."""
    with pytest.raises(SceneError, match=rf"(?i){why}.*--output"):
        output.check_writable(places(tmp_path)[why], "run.nc")


def test_places_that_take_a_result_are_left_as_they_are(tmp_path):
    """There or not; also where a file of the name is replaced."""
    (tmp_path / "run.nc").touch()
    for directory in (tmp_path, tmp_path / "new" / "one"):
        output.check_writable(directory, "run.nc", "a.png")
    assert [each.name for each in tmp_path.iterdir()] == ["run.nc"]
