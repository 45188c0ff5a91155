"""What a march writes down as it goes."""

import errno
import os
from types import SimpleNamespace

import numpy as np
import pytest
from tests.coarse import coarse_scene
from tests.programs import DEMO

import fenics_gears
from fenics_gears import ComputationError, load_scene, simulate
from fenics_gears.model.storage import ArraysInMemory
from fenics_gears.results import journal
from fenics_gears.results.journal import COUNTS, Journal, JournalPlace, read

LAST, STEPS, BLOCK = 300, 1000, 77
STORED = {"time": (("time",), np.dtype(float)), "field": (("contact_time", "slot"), np.dtype(float))}


@pytest.fixture
def at_once(monkeypatch):
    monkeypatch.setattr(journal, "SECONDS_WITHOUT", 0.0)
    monkeypatch.setattr(journal, "APART", 0.0)


def march_of(steps):
    return SimpleNamespace(
        **dict.fromkeys(COUNTS, steps),
        separations=[(each, each / 2.0) for each in range(0, steps, 50)],
        locked=list(range(0, steps, 70)),
    )


def block(first, end):
    steps = np.arange(first, end, dtype=float)
    return {"time": steps, "field": np.stack([steps, -steps], axis=1), "watched: any": steps % 2 == 0}


def written(file, until):
    own, room = Journal(JournalPlace(file), load_scene(DEMO)), ArraysInMemory(STORED, STEPS, LAST)
    for first in range(0, until, BLOCK):
        end = min(first + BLOCK, until)
        room.put(first, block(first, end))
        own.write(room, end, march_of(end))
    return file


@pytest.mark.parametrize("until", [20, 299, 1000])
def test_it_holds_what_was_put(tmp_path, at_once, until):
    """Identity."""
    found = read(written(tmp_path / "run.nc.part", until))
    expected = block(0, until) | {"field": block(max(until - LAST, 0), until)["field"]}
    for name, values in expected.items():
        np.testing.assert_array_equal(found.values[name], values)
        assert found.values[name].dtype == values.dtype
    known = march_of(until)
    assert found.march == vars(known) and found.steps == STEPS - 1 and found.scene == load_scene(DEMO)


def test_writing_takes_a_twentieth_of_the_time(tmp_path, monkeypatch):
    """Operations counted, with a clock that is set: a write of a second is the last one for twenty."""
    monkeypatch.setattr(journal, "SECONDS_WITHOUT", 0.0)
    now, written_at = [0.0], []
    monkeypatch.setattr(journal.time, "monotonic", lambda: now[0])

    def slow(*arguments, **options):
        written_at.append(now[0])
        now[0] += 1.0

    monkeypatch.setattr(journal.np, "savez", slow)
    own, room = Journal(JournalPlace(tmp_path / "run.nc.part"), load_scene(DEMO)), ArraysInMemory(STORED, STEPS, LAST)
    for _ in range(50):
        own.write(room, 0, march_of(0))
        now[0] += 1.0
    assert written_at == [0.0, 21.0, 42.0]


def test_a_full_disk_does_not_end_the_march(tmp_path, paper_scene, at_once, monkeypatch, caplog):
    """Row 27: the result of a run with room, and one warning."""
    scene, calls = coarse_scene(paper_scene, cycles=60), []

    def full(*arguments, **options):
        calls.append(arguments)
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(journal.np, "savez", full)
    found, whole = simulate(scene, journal=JournalPlace(tmp_path / "run.nc.part")), simulate(scene)
    assert "No space left on device. The run goes on" in caplog.text and list(tmp_path.iterdir()) == []
    assert len(calls) == 1 and found.equals(whole)


def test_another_version_is_refused(tmp_path, at_once, monkeypatch):
    """Row 27."""
    file = written(tmp_path / "run.nc.part", 100)
    monkeypatch.setattr(fenics_gears, "__version__", "0.0")
    with pytest.raises(ComputationError, match="cannot be read as the journal of a run: only version"):
        read(file)


def test_a_damaged_file_is_refused(tmp_path, at_once):
    """Row 27: one bit flipped at random, or a page of zeros."""
    file = written(tmp_path / "run.nc.part", 400)
    content, random = file.read_bytes(), np.random.default_rng(4)
    for place in random.integers(len(content), size=20):
        file.write_bytes(
            content[:place] + bytes([content[place] ^ 1 << int(random.integers(8))]) + content[place + 1 :]
        )
        with pytest.raises(ComputationError, match="cannot be read as the journal of a run"):
            read(file)
    file.write_bytes(content[:-4096] + bytes(4096))
    with pytest.raises(ComputationError):
        read(file)
