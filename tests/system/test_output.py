"""Where results are written and files of users are read (hard cases 26 and 27)."""

import os
import resource
import shutil
import subprocess
import sys

import pytest

from fenics_gears import SceneError
from fenics_gears.system import output, user_file


def dead_process():
    process = subprocess.Popen([sys.executable, "-I", "-S", "-c", ""])
    process.wait()
    return process.pid


def test_what_a_killed_process_left_is_removed_and_nothing_else(tmp_path):
    """Of this machine and of a process that has ended; not of a live one, another machine, or a folder within."""
    here, dead = f"{output.UNFINISHED}{output._machine()}-", dead_process()
    left, alive, elsewhere = (
        f"{here}{dead}-abc",
        f"{here}{os.getppid()}-abc",
        f"{output.UNFINISHED}elsewhere-1-{dead}-abc",
    )
    others = {
        tmp_path / alive,
        tmp_path / elsewhere,
        tmp_path / "neighbour" / left,
        tmp_path / f"{output.UNFINISHED}abc",
    }
    for each in (tmp_path / left, *others):
        each.mkdir(parents=True)
        (each / "run.nc").touch()
    output.write_whole(tmp_path / "run.nc", lambda path: path.write_text("whole"))
    assert {each.parent for each in tmp_path.rglob("*/run.nc") if each.parent != tmp_path} == others
    assert (tmp_path / "run.nc").read_text() == "whole"


def test_a_killed_writer_is_recognised(tmp_path):
    """A process that kills itself while it writes."""
    program = "import os, signal, sys; from pathlib import Path; from fenics_gears.system.output import write_whole\n"
    program += "write_whole(Path(sys.argv[1], 'a'), lambda path: os.kill(os.getpid(), signal.SIGKILL))"
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    subprocess.run([sys.executable, "-P", "-c", program, tmp_path], env=environment, timeout=60)
    assert [each.name.startswith(output.UNFINISHED) for each in tmp_path.iterdir()] == [True]
    output.write_whole(tmp_path / "b", lambda path: path.touch())
    assert [each.name for each in tmp_path.iterdir()] == ["b"]


def places(folder):
    (folder / "file").touch()
    (folder / "dangling").symlink_to("/nowhere/at/all")
    (folder / "own" / "run.nc").mkdir(parents=True)
    (folder / "loop").symlink_to("loop")
    return dict(
        zip(
            WHY,
            (
                folder / "file" / "out",
                folder / "dangling" / "out",
                folder / "own",
                folder / "loop",
                folder / ("x" * 300),
            ),
        )
    )


WHY = ("is a file", "is a link to /nowhere/at/all", "is no file", "levels of symbolic links", "name too long")


@pytest.mark.parametrize("why", WHY)
def test_places_that_take_no_result_are_refused(tmp_path, why):
    """What it is, and the remedy."""
    with pytest.raises(SceneError, match=rf"(?i){why}.*--output"):
        output.check_writable(places(tmp_path)[why], "run.nc")


def test_places_that_take_a_result_are_left_as_they_are(tmp_path):
    """There or not; also where a file is replaced."""
    (tmp_path / "run.nc").touch()
    for directory in (tmp_path, tmp_path / "new" / "one"):
        output.check_writable(directory, "run.nc", "a.png")
    assert [each.name for each in tmp_path.iterdir()] == ["run.nc"]


def kinds(folder):
    made = {name: folder / name for name in WORDS if name != "a name with NUL"}
    os.mkfifo(made["a pipe"])
    made["a folder"].mkdir()
    made["a link to itself"].symlink_to("a link to itself")
    made["a link to a device"].symlink_to("/dev/zero")
    made["text with NUL"].write_bytes(b"a\r\nb\0")
    made["no UTF-8"].write_bytes(b"ab\xff")
    with open(made["large"], "wb") as file:
        file.truncate(3_000_000_000)
    return made | {"a name with NUL": f"{folder}/a\0b"}


WORDS = {
    "a pipe": "it is a device or a pipe, not a file",
    "a folder": "it is a folder",
    "a link to itself": "Too many levels of symbolic links",
    "a link to a device": "it is a device or a pipe, not a file",
    "text with NUL": "the character NUL in line 2",
    "no UTF-8": r"is not a text in UTF-8 \(byte 2\)",
    "large": "has 3000 MB; a file of more than 10 MB is not read",
    "missing": "there is no such file",
    "a name with NUL": "cannot be read: ",
}


@pytest.mark.parametrize("kind", WORDS)
def test_what_is_no_text_is_refused_in_words(tmp_path, kind):
    """A pipe would be waited for, a device would fill the memory."""
    with pytest.raises(user_file.Unreadable, match=WORDS[kind]):
        user_file.text_of(kinds(tmp_path)[kind], user_file.LARGEST_SCENE)


def test_a_file_that_grows_while_it_is_read_is_refused(tmp_path, monkeypatch):
    """Its length is read once more."""
    (tmp_path / "grows").write_bytes(b"x" * 11)
    monkeypatch.setattr(user_file, "check_file", lambda path, largest: None)
    with pytest.raises(user_file.Unreadable, match="has more than 0 MB"):
        user_file.content_of(tmp_path / "grows", 10)


def test_a_disk_without_room_is_found_by_writing(tmp_path):
    """The kernel's own refusal, here by its limit on files; nothing is left behind."""
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (output.TRIED // 2, before[1]))
    try:
        with pytest.raises(SceneError, match=r"cannot be written to: File too large\. To go on, .*--output"):
            output.check_writable(tmp_path / "new" / "out", "run.nc")
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
    output.check_writable(tmp_path / "new" / "out", "run.nc")
    assert list(tmp_path.iterdir()) == []


def test_a_disk_with_less_room_than_the_result_takes_is_found_before(tmp_path, monkeypatch):
    """Definition: what is free is less than what a file takes at least; both are said."""
    usage = shutil.disk_usage(tmp_path)
    monkeypatch.setattr(output.shutil, "disk_usage", lambda path: usage._replace(free=300_000_000))
    with pytest.raises(SceneError, match=r"takes 1,200\.0 MB at least, and 300\.0 MB are free\. To go on, .*--output"):
        output.check_writable(tmp_path / "new", "run.nc", room=1_200_000_000)
    output.check_writable(tmp_path / "new", "run.nc", room=200_000_000)
