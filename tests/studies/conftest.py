"""A coarse scene that a study can vary in a few seconds."""

from pathlib import Path

import pytest
from tests.paper_text import coarse_text


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """A folder with the coarse scene `pair.toml`, as the present directory."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "pair.toml").write_text(coarse_text())
    return tmp_path


@pytest.fixture
def undrawn(monkeypatch):
    """Studies in this process are not drawn, which takes longer than their runs."""
    monkeypatch.setattr("fenics_gears.show.study_pictures.draw_study", lambda file: [])


def write_study(folder, text, name="study.toml"):
    path = Path(folder) / name
    path.write_text('scene = "pair.toml"\n' + text)
    return path


def stamps(directory):
    """Inode and time of change of every case's file."""
    return {path.name: (path.stat().st_ino, path.stat().st_mtime_ns) for path in Path(directory, "cases").glob("*.nc")}
