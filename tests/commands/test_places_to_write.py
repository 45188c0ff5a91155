"""A place that cannot take the result is refused before anything is computed (hard case 26)."""

import os
import shlex
import shutil
import sys
from pathlib import Path

import pytest
from tests.system.test_console import GREEK

from fenics_gears.commands.cli import main

SCENE = GREEK + "[friction]\ncoefficient = 0.1\n"
STUDY = 'scene = "pair.toml"\n[sweep]\nfriction.coefficient = [0.1, 0.2]\n'
CALLS = {"run pair.toml": "run.nc", "run pair.toml ": "load_sharing.png", "study study.toml": "study.nc"}


@pytest.mark.parametrize("call", CALLS)
def test_a_folder_under_the_results_name(tmp_path, monkeypatch, capsys, call):
    """Named, with the remedy; what was there is all that is there."""
    monkeypatch.chdir(tmp_path)
    Path("study.toml").write_text(STUDY)
    check_refusal(call.split(), CALLS[call], capsys)


# A run is looked at after the place. By the name of what is asked for, where that is a file.
NOWHERE = {
    "run pair.toml": "", "study study.toml": "", "plot run.nc": "",
    "picture run.nc": ".png", "export run.nc": ".csv",
}  # fmt: skip


@pytest.mark.parametrize("call", NOWHERE)
def test_a_place_that_permissions_say_nothing_of(tmp_path, monkeypatch, capsys, call):
    """The kernel makes no files in /proc, not for root either, whom permissions do not stop."""
    monkeypatch.chdir(tmp_path)
    Path("study.toml").write_text(STUDY)
    check_nowhere(call, NOWHERE[call], capsys)


def check_nowhere(call, ending, capsys):
    Path("pair.toml").write_text(SCENE)
    Path("run.nc").touch()
    before = sorted(Path().iterdir())
    command, *words = shlex.split(call)
    assert main([command, "--output", f"/proc/new{ending}", *words]) == 2
    said = capsys.readouterr().err
    assert "/proc" in said and "cannot be written to: no file can be made there" in said
    assert sorted(Path().iterdir()) == before


def check_refusal(words, name, capsys):
    Path("pair.toml").write_text(SCENE)
    taken = Path("out", name)
    taken.mkdir(parents=True)
    assert main([*words, "--output", "out"]) == 2
    assert (
        f"{taken} is no file; the result needs this name. Remove it, or choose another directory"
        in capsys.readouterr().err
    )
    assert list(Path("out").rglob("*")) == [taken]


def test_a_disk_with_less_room_than_a_run_takes(tmp_path, monkeypatch, capsys):
    """Refused before, though a little can be written; pictures and tables alone take no such room."""
    monkeypatch.chdir(tmp_path)
    Path("pair.toml").write_text(SCENE)
    usage = shutil.disk_usage(tmp_path)
    monkeypatch.setattr(shutil, "disk_usage", lambda path: usage._replace(free=10_000))
    assert main(["run", "pair.toml", "--output", "out"]) == 2
    assert "out cannot be written to: the result takes" in capsys.readouterr().err
    assert [path.name for path in Path().iterdir()] == ["pair.toml"]


def test_libraries_do_not_read_the_commands_arguments(monkeypatch, capsys):
    """DOLFINx reads sys.argv when it is imported."""
    monkeypatch.setattr(sys, "argv", ["gears", "check", os.fsdecode(b"\xff.toml")])
    assert main() == 2
    assert sys.argv == ["gears"] and "there is no such file" in capsys.readouterr().err
