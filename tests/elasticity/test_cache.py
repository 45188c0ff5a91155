"""The cache gives back what it was given, by its content. Damage, full disks and kills are hard case 27."""

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


def test_absent_entry_is_no_warning(cache, caplog):
    """The first run is nothing to report."""
    assert cache.load(KEY) is None
    assert not caplog.records


def test_directory_that_cannot_be_made_is_a_warning(tmp_path, caplog):
    """A file where the directory should be, as on a read-only home."""
    (tmp_path / "taken").write_text("")
    cache = Cache(tmp_path / "taken" / "cache")
    cache.store(KEY, ARRAYS)
    assert cache.load(KEY) is None
    assert "nothing is kept" in caplog.text


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
