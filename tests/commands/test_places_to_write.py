"""A place that cannot take the result is refused before anything is computed (hard case 26)."""

import os
import shlex
import sys
from pathlib import Path

import pytest
from tests.system.test_console import GREEK

from fenics_gears.commands.cli import main

SCENE = GREEK + "[friction]\ncoefficient = 0.1\n"
STUDY = 'scene = "pair.toml"\n[sweep]\nfriction.coefficient = [0.1, 0.2]\n'
DESIGN = """
scene = "pair.toml"
set.tip_relief.start = "HPSTC"
variables.tip_relief.depth = ["5 um", "60 um"]
goals.peak_to_peak_transmission_error = 1
"""
CALLS = {
    "run pair.toml": "run.nc",
    "run pair.toml ": "load_sharing.png",
    "accuracy pair.toml": "accuracy.csv",
    "effects pair.toml": "effects.png",
    "study study.toml": "study.nc",
}


@pytest.mark.parametrize("call", CALLS)
def test_a_folder_under_the_results_name(tmp_path, monkeypatch, capsys, call):
    """Named, with the remedy; what was there is all that is there."""
    monkeypatch.chdir(tmp_path)
    Path("study.toml").write_text(STUDY)
    check_refusal(call.split(), CALLS[call], capsys)


# Of all commands that write, those of extensions too. A run is looked at after the place.
NOWHERE = (
    "run pair.toml", "study study.toml", "effects pair.toml", "accuracy pair.toml", "plot run.nc",
    "map pair.toml --loads '100 N m'", "optimize design.toml",
    "plot --spectrum -- run.nc", "picture run.nc", "report run.nc", "export run.nc", "rate run.nc", "listen run.nc",
    "import pair.rexs",
)  # fmt: skip
ENDINGS = {"picture": ".png", "report": ".html", "export": ".csv", "rate": ".csv", "listen": ".wav", "import": ".toml"}


@pytest.mark.parametrize("call", NOWHERE)
def test_a_place_that_permissions_say_nothing_of(tmp_path, monkeypatch, capsys, call):
    """The kernel makes no files in /proc, not for root either, whom permissions do not stop."""
    monkeypatch.chdir(tmp_path)
    for name, text in (("pair.toml", SCENE), ("study.toml", STUDY), ("design.toml", DESIGN), ("run.nc", "")):
        Path(name).write_text(text)
    output = f"/proc/new{ENDINGS.get(call.split()[0], '')}"
    command, *words = shlex.split(call)
    assert main([command, "--output", output, *words]) == 2
    said = capsys.readouterr().err
    assert "/proc" in said and "cannot be written to: no file can be made there" in said
    assert sorted(each.name for each in tmp_path.iterdir()) == ["design.toml", "pair.toml", "run.nc", "study.toml"]


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


def test_libraries_do_not_read_the_commands_arguments(monkeypatch, capsys):
    """DOLFINx reads sys.argv when it is imported."""
    monkeypatch.setattr(sys, "argv", ["gears", "check", os.fsdecode(b"\xff.toml")])
    assert main() == 2
    assert sys.argv == ["gears"] and "there is no such file" in capsys.readouterr().err
