"""What a march writes down as it goes."""

import errno
import json
import os
from types import SimpleNamespace

import numpy as np
import pytest
from tests.coarse import coarse_scene
from tests.programs import DEMO

import fenics_gears
from fenics_gears import ComputationError, load_scene, simulate
from fenics_gears.dynamics.march import LONGEST_BLOCK
from fenics_gears.results import journal
from fenics_gears.results.journal import COUNTS, HEADER, SPARE, Journal, JournalPlace, read
from fenics_gears.system.output import seal

LAST, STEPS = 300, 4 * SPARE
STORED = {"time": (("time",), np.dtype(float)), "field": (("contact_time", "slot"), np.dtype(float))}


@pytest.fixture
def at_once(monkeypatch):
    monkeypatch.setattr(journal, "SECONDS_WITHOUT", 0.0)


def march_of(steps):
    return SimpleNamespace(
        **dict.fromkeys(COUNTS, steps),
        separations=[(each, each / 2.0) for each in range(0, steps, 50)],
        locked=list(range(0, steps, 70)),
    )


def block(first, end):
    steps = np.arange(first, end, dtype=float)
    return {"time": steps, "field": np.stack([steps, -steps], axis=1), "watched: any": steps % 2 == 0}


def written(tmp_path, until, length):
    own = Journal(JournalPlace(tmp_path / "run.nc.part"), load_scene(DEMO), STORED, STEPS, LAST)
    for first in range(0, until, length):
        own.put(first, block(first, min(first + length, until)), march_of(min(first + length, until)))
    return own


@pytest.mark.parametrize(
    ("until", "length"), [(100, 100), (299, 30), (2 * SPARE + 17, LONGEST_BLOCK), (SPARE + LAST + 1, 77)]
)
def test_it_holds_what_was_put(tmp_path, at_once, until, length):
    """Identity, also where a block was begun and not ended."""
    own = written(tmp_path, until, length)
    # A block that the kill came into the middle of: values without the word that they are whole.
    own._write(until, LONGEST_BLOCK, block(until, until + LONGEST_BLOCK))
    found, expected = (
        read(tmp_path / "run.nc.part"),
        block(0, until) | {"field": block(max(until - LAST, 0), until)["field"]},
    )
    for name, values in expected.items():
        np.testing.assert_array_equal(found.values[name], values)
        np.testing.assert_array_equal(own.get(name, until), values)
        assert found.values[name].dtype == values.dtype
    known = march_of(until)
    assert found.march == vars(known) and found.steps == STEPS - 1 and found.scene == load_scene(DEMO)


@pytest.mark.parametrize("failing", [0, 3, 200])
def test_a_full_disk_does_not_end_the_march(tmp_path, paper_scene, at_once, monkeypatch, caplog, failing):
    """Row 27: in memory, and on a disk that is full from some write on."""
    scene, calls, pwrite = coarse_scene(paper_scene, cycles=60), [], os.pwrite

    def full(*arguments):
        calls.append(arguments)
        if len(calls) > failing:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        return pwrite(*arguments)

    monkeypatch.setattr(os, "pwrite", full)
    found, whole = simulate(scene, journal=JournalPlace(tmp_path / "run.nc.part")), simulate(scene)
    assert "No space left on device. The run goes on" in caplog.text and list(tmp_path.iterdir()) == []
    assert len(calls) == failing + 1 and found.equals(whole)


@pytest.mark.parametrize(
    "change", [{"version": "0.0"}, {"kinds": {"time": ["0", "|O", [], 0]}}, {"kinds": {"time": ["0", "<f8", [900], 0]}}]
)
def test_another_journal_is_refused(tmp_path, at_once, change):
    """Row 27: another version, values that would be addresses of objects, one that is too short."""
    written(tmp_path, 100, 100)
    path = tmp_path / "run.nc.part" / HEADER
    changed = json.dumps(journal._text(path) | change).encode()
    path.write_bytes(changed + seal(changed))
    with pytest.raises(ComputationError, match="cannot be read as the journal of a run"):
        read(path.parent)
    assert fenics_gears.__version__ != "0.0"


def test_every_damaged_file_is_noticed(tmp_path, at_once):
    """Row 27: one bit flipped at random, or a page of zeros."""
    until, random = SPARE + LAST + LAST // 2, np.random.default_rng(4)
    own = written(tmp_path, until, 90)
    fields = [str(own._files[name].name) for name in ("field", "check: fields")]
    for path in sorted((tmp_path / "run.nc.part").iterdir()):
        content = path.read_bytes()
        places = random.integers(len(content), size=20)
        damaged = [
            content[:place] + bytes([content[place] ^ 1 << int(random.integers(8))]) + content[place + 1 :]
            for place in places
        ]
        refused = 0
        for other in [*damaged, content[:-4096] + bytes(min(len(content), 4096))]:
            path.write_bytes(other)
            try:
                found = read(path.parent)
            except ComputationError:
                refused += 1
                continue
            np.testing.assert_array_equal(found.values["time"], block(0, until)["time"])
            np.testing.assert_array_equal(found.values["field"], block(until - LAST, until)["field"])
        path.write_bytes(content)
        # Files of contact fields and of their sums have places of steps before the last ones, which nobody reads.
        assert refused == 21 or str(path) in fields
    assert len(read(tmp_path / "run.nc.part").values["time"]) == until
