"""The cache never gives a wrong number, and never ends a run (hard case 27)."""

import errno
import logging
import os
from concurrent.futures import ThreadPoolExecutor

import h5py
import numpy as np
import pytest

from fenics_gears.elasticity.cache import DIRECTORY_VARIABLE, Cache, content_key, user_cache

KEY = content_key({"gear": {"teeth": 16}, "size": 0.06})
ARRAYS = {"blocks": np.arange(24.0).reshape(2, 3, 4) / 7.0, "unknowns": np.array(17)}


@pytest.fixture
def cache(tmp_path):
    return Cache(tmp_path / "cache")


def test_what_is_stored_comes_back_bit_for_bit(cache):
    """Exact identity, the kind of the numbers included."""
    cache.store(KEY, ARRAYS)
    loaded = cache.load(KEY)
    assert loaded.keys() == ARRAYS.keys()
    for name, values in ARRAYS.items():
        np.testing.assert_array_equal(loaded[name], values)
        assert loaded[name].dtype == values.dtype
    assert [path.name for path in cache.directory.iterdir()] == [f"{KEY}.h5"]


def truncated(path):
    path.write_bytes(path.read_bytes()[:-500])


def empty(path):
    path.write_bytes(b"")


def foreign(path):
    path.write_bytes(b"not HDF5 at all" * 100)


def one_bit_flipped(path):
    content = bytearray(path.read_bytes())
    position = content.find(ARRAYS["blocks"].tobytes()[-16:])
    content[position] ^= 1
    path.write_bytes(bytes(content))


def array_missing(path):
    with h5py.File(path, "a") as file:
        del file["unknowns"]


def other_format(path):
    with h5py.File(path, "a") as file:
        file.attrs["format"] = "something else"


def directory_instead(path):
    path.unlink()
    path.mkdir()


@pytest.mark.parametrize(
    "damage", [truncated, empty, foreign, one_bit_flipped, array_missing, other_format, directory_instead]
)
def test_damaged_entry_is_reported_and_not_used(cache, damage, caplog):
    """Hard case 27: a damaged entry is as good as none, and says so."""
    cache.store(KEY, ARRAYS)
    damage(cache.path(KEY))
    with caplog.at_level(logging.WARNING):
        assert cache.load(KEY) is None
    assert str(cache.path(KEY)) in caplog.text


def test_entry_under_another_name_is_not_used(cache, caplog):
    """A file copied to another key holds another gear."""
    cache.store(KEY, ARRAYS)
    other = content_key({"gear": {"teeth": 17}})
    os.replace(cache.path(KEY), cache.path(other))
    assert cache.load(other) is None
    assert "computed again" in caplog.text


def test_absent_entry_is_no_warning(cache, caplog):
    """The first run is nothing to report."""
    assert cache.load(KEY) is None
    assert not caplog.records


@pytest.mark.parametrize("code", [errno.ENOSPC, errno.EDQUOT, errno.EACCES])
def test_full_disk_is_a_warning_and_leaves_nothing(cache, code, monkeypatch, caplog):
    """Hard case 27: a full disk shows when the file is flushed; the run goes on."""
    def fail(descriptor):
        raise OSError(code, os.strerror(code))

    monkeypatch.setattr(os, "fsync", fail)
    cache.store(KEY, ARRAYS)
    assert list(cache.directory.iterdir()) == []
    assert os.strerror(code) in caplog.text


def test_interrupted_write_leaves_no_file(cache, monkeypatch):
    """Hard case 27: Ctrl-C between writing aside and renaming."""
    def interrupt(source, target):
        raise KeyboardInterrupt

    monkeypatch.setattr(os, "replace", interrupt)
    with pytest.raises(KeyboardInterrupt):
        cache.store(KEY, ARRAYS)
    assert list(cache.directory.iterdir()) == []


def test_killed_write_is_never_seen(cache, tmp_path):
    """Hard case 27: what kill -9 leaves is a file aside, under no entry's name."""
    cache.store(KEY, ARRAYS)
    content = cache.path(KEY).read_bytes()
    cache.path(KEY).rename(cache.directory / f"{KEY}.x.part")
    (cache.directory / f"{KEY}.x.part").write_bytes(content[:100])
    assert cache.load(KEY) is None


def test_directory_that_cannot_be_made_is_a_warning(tmp_path, caplog):
    """A file where the directory should be, as on a read-only home."""
    (tmp_path / "taken").write_text("")
    cache = Cache(tmp_path / "taken" / "cache")
    cache.store(KEY, ARRAYS)
    assert cache.load(KEY) is None
    assert "nothing is kept" in caplog.text


def test_two_runs_at_once(cache, caplog):
    """Hard case 27: every reader sees a whole entry or none."""
    def write_and_read(number):
        cache.store(KEY, ARRAYS)
        return cache.load(KEY)

    with ThreadPoolExecutor(4) as pool:
        results = list(pool.map(write_and_read, range(40)))
    assert all(np.array_equal(result["blocks"], ARRAYS["blocks"]) for result in results)
    assert not caplog.records
    assert len(list(cache.directory.iterdir())) == 1


def test_key_depends_on_content_only():
    """Order of keys is no content; a change in the last digit is."""
    assert content_key({"a": 1.0, "b": 2}) == content_key({"b": 2, "a": 1.0})
    assert content_key({"a": 1.0}) != content_key({"a": np.nextafter(1.0, 2.0)})


def test_environment_names_the_directory(tmp_path, monkeypatch):
    """FENICS_GEARS_CACHE overrides the user's cache directory."""
    monkeypatch.setenv(DIRECTORY_VARIABLE, str(tmp_path))
    assert user_cache() == Cache(tmp_path)
    monkeypatch.delenv(DIRECTORY_VARIABLE)
    assert user_cache().directory.name == "fenics_gears"
