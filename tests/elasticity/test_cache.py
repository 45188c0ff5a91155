"""The cache gives back what it was given. Damage, full disks and kills are hard case 27."""

import os
import time
from threading import Event

import numpy as np
import pytest

from fenics_gears import SceneError
from fenics_gears.commands.cli import main
from fenics_gears.elasticity.cache import (
    DIRECTORY_VARIABLE,
    SIZE_VARIABLE,
    Cache,
    content_key,
    user_cache,
    writing_meanwhile,
)
from fenics_gears.system.output import LONGEST_WRITING, UNFINISHED

KEY = content_key({"gear": {"teeth": 16}, "size": 0.06})
ARRAYS = {"blocks": np.arange(24.0).reshape(2, 3, 4) / 7.0, "unknowns": np.array(17)}


@pytest.fixture
def cache(tmp_path):
    return Cache(tmp_path / "cache")


def test_what_is_stored_comes_back_bit_for_bit(cache):
    """Exact identity."""
    cache.store(KEY, ARRAYS)
    loaded = cache.load(KEY)
    assert loaded.keys() == ARRAYS.keys()
    for name, values in ARRAYS.items():
        np.testing.assert_array_equal(loaded[name], values)
        assert loaded[name].dtype == values.dtype
    assert [path.name for path in cache.directory.iterdir()] == [f"{KEY}.h5"]


def test_a_block_goes_on_while_what_it_stores_is_written(cache, monkeypatch):
    """Order of events: what is stored is what stood there then, is read when it is written, and is there at the end."""
    went_on, write = Event(), Cache._write

    def slowly(*given):
        assert went_on.wait(timeout=60)
        write(*given)

    monkeypatch.setattr(Cache, "_write", slowly)
    values = ARRAYS["blocks"].copy()
    with writing_meanwhile(cache) as kept:
        kept.store(KEY, {"blocks": values})
        values *= 2.0
        assert cache.load(KEY) is None
        went_on.set()
        np.testing.assert_array_equal(kept.load(KEY)["blocks"], ARRAYS["blocks"])
        kept.store("another", ARRAYS)
    assert cache.load("another").keys() == ARRAYS.keys() and kept.directory == cache.directory


def test_directory_that_cannot_be_made_is_a_warning(tmp_path, caplog):
    """A file where the directory should be, as on a read-only home."""
    (tmp_path / "taken").write_text("")
    cache = Cache(tmp_path / "taken" / "cache")
    cache.store(KEY, ARRAYS)
    assert cache.load(KEY) is None
    assert "nothing is kept" in caplog.text


def test_environment_names_the_directory(tmp_path, monkeypatch):
    """docs/commands.md; 2 GB unless a size is given."""
    monkeypatch.setenv(DIRECTORY_VARIABLE, str(tmp_path))
    assert user_cache() == Cache(tmp_path, 2e9)
    monkeypatch.delenv(DIRECTORY_VARIABLE)
    assert user_cache().directory.name == "fenics_gears"


def used(cache, key, seconds_ago):
    moment = time.time() - seconds_ago
    os.utime(cache.path(key), (moment, moment))


def size_of_entry(directory):
    cache = Cache(directory)
    cache.store("any", ARRAYS)
    return cache.path("any").stat().st_size


@pytest.mark.parametrize("room, left", [(3.5, {"b", "a", "new"}), (2.5, {"a", "new"}), (1.5, {"new"}), (0.5, {"new"})])
def test_beyond_the_limit_the_longest_unused_go_first(tmp_path, room, left):
    """Definition: reading is use; the entry stored last stays whatever the limit."""
    filled = Cache(tmp_path / "cache")
    for ago, key in ((300.0, "a"), (200.0, "c"), (100.0, "b")):
        filled.store(key, ARRAYS)
        used(filled, key, ago)
    assert filled.load("a") is not None
    limited = Cache(filled.directory, room * size_of_entry(tmp_path / "other"))
    limited.store("new", ARRAYS)
    assert {path.stem for path in filled.directory.iterdir()} == left
    assert limited.load("new").keys() == ARRAYS.keys()


def test_files_that_are_being_written_stay(tmp_path):
    """Definition; those of a run killed a day before are no longer being written."""
    now = f"{UNFINISHED}elsewhere-now"
    for name, ago in ((now, 0.0), (f"{UNFINISHED}elsewhere-lost", LONGEST_WRITING + 60.0)):
        (tmp_path / name).write_text("half")
        moment = time.time() - ago
        os.utime(tmp_path / name, (moment, moment))
    Cache(tmp_path, 1.0).store("new", ARRAYS)
    assert {path.name for path in tmp_path.iterdir()} == {now, "new.h5"}
    assert len(Cache(tmp_path).clear()) == 1
    assert {path.name for path in tmp_path.iterdir()} == {now}


def test_an_entry_that_another_run_removes_is_no_failure(tmp_path, monkeypatch, caplog):
    """Two runs at once: each finds files gone that it has just seen."""
    for key in "abc":
        Cache(tmp_path).store(key, ARRAYS)
    entries = Cache.entries

    def seen_then_removed(cache):
        found = entries(cache)
        for entry in found[:2]:
            entry.path.unlink()
        return found

    monkeypatch.setattr(Cache, "entries", seen_then_removed)
    Cache(tmp_path, 1.0).store("new", ARRAYS)
    assert [path.name for path in tmp_path.iterdir()] == ["new.h5"] and not caplog.records


@pytest.mark.parametrize("text, size", [("500 MB", 5e8), ("1.5GB", 1.5e9), ("0 MB", 0.0), ("", 2e9)])
def test_environment_limits_the_size(monkeypatch, text, size):
    """Definition of MB and GB."""
    monkeypatch.setenv(SIZE_VARIABLE, text)
    assert user_cache().limit == size


@pytest.mark.parametrize("text", ["2", "-1 GB", "2 GiB", "much", "nan GB"])
def test_a_size_that_is_none_is_refused(monkeypatch, text):
    """Place, value and what is allowed."""
    monkeypatch.setenv(SIZE_VARIABLE, text)
    with pytest.raises(SceneError, match=f"{SIZE_VARIABLE} = '{text}'.*Allowed"):
        user_cache()


def test_the_command_shows_and_empties_it(tmp_path, monkeypatch, capsys):
    """What the files themselves say."""
    monkeypatch.setenv(DIRECTORY_VARIABLE, str(tmp_path))
    for key in "ab":
        Cache(tmp_path).store(key, ARRAYS)
    assert main(["cache"]) == 0
    shown = capsys.readouterr().out
    assert str(tmp_path) in shown and "2000 MB" in shown
    assert main(["cache", "--clear"]) == 0
    assert "2 entries" in capsys.readouterr().out and not list(tmp_path.iterdir())
    assert main(["cache"]) == 0
    assert "last used" not in capsys.readouterr().out
