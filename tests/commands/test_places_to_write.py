"""Each command that writes refuses, before it computes, a place that cannot take its result. Authority: hard case
26."""

import argparse
import os
import sys
from pathlib import Path

import pytest
from tests.system.test_console import GREEK

from fenics_gears.commands import picture
from fenics_gears.commands.cli import main
from fenics_gears.errors import SceneError

SCENE = GREEK + "[friction]\ncoefficient = 0.1\n"
STUDY = 'scene = "pair.toml"\n[sweep]\nfriction.coefficient = [0.1, 0.2]\n'
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
    Path("study.toml").write_text(STUDY, encoding="utf-8")
    check_refusal(call.split(), CALLS[call], capsys)


def check_refusal(words, name, capsys):
    """A command does not write where a folder has the name of its result."""
    Path("pair.toml").write_text(SCENE, encoding="utf-8")
    taken = Path("out", name)
    taken.mkdir(parents=True)
    assert main([*words, "--output", "out"]) == 2
    assert (
        f"{taken} is no file; the result needs this name. Remove it, or choose another directory"
        in capsys.readouterr().err
    )
    assert list(Path("out").rglob("*")) == [taken]


def test_vtk_takes_names_in_utf_8_only(tmp_path, monkeypatch):
    """VTK's own rule; its bindings raise an error of encoding after the stresses have been recovered."""
    monkeypatch.chdir(tmp_path)
    options = argparse.Namespace(vtu=Path(os.fsdecode(b"a\xff.vtu")), pvd=None, animate=False)
    with pytest.raises(SceneError, match="VTK writes only files whose names are text in UTF-8"):
        picture._check_outputs(options, None)


def test_libraries_do_not_read_the_commands_arguments(monkeypatch, capsys):
    """DOLFINx reads sys.argv when it is imported, and raises at names that are no UTF-8."""
    monkeypatch.setattr(sys, "argv", ["gears", "check", os.fsdecode(b"\xff.toml")])
    assert main() == 2
    assert sys.argv == ["gears"] and "there is no such file" in capsys.readouterr().err
