"""Row 27: damaged cache entries and results are computed again, the same to the last bit; nothing read back can be
code."""

import logging
import os
import pickle
from pathlib import Path

import h5py
import numpy as np
import pytest
import xarray as xr
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.hard_cases.kept_files import ARRAYS, KEY
from tests.studies.conftest import folder, stamps, undrawn, write_study  # noqa: F401
from tests.studies.test_run_study import TWO, load

from fenics_gears import ComputationError, results
from fenics_gears.commands.cli import main
from fenics_gears.elasticity.cache import Cache


@pytest.fixture
def own_cache(tmp_path):
    made = Cache(tmp_path / "own cache")
    made.store(KEY, ARRAYS)
    return made


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    values = {
        "transmission_error": ("time", np.sin(np.arange(40.0))),
        "own_field": (("time", "node"), np.arange(120.0).reshape(40, 3)),
    }
    coordinates = {"time": np.arange(40.0), "mesh_phase": ("time", np.arange(40.0))}
    coordinates |= {"gear": ("gear", ["pinion", "wheel"], {"long_name": "gear"})}
    made = xr.Dataset(values, coordinates).assign_attrs(scene="[gears]\n", complete=1, peak=0.25, warnings="")
    made["transmission_error"].attrs["units"] = "rad"
    return made


def truncated(path):
    path.write_bytes(path.read_bytes()[:-500])


def lengthened(path):
    path.write_bytes(path.read_bytes() + b" ")


def empty(path):
    path.write_bytes(b"")


def foreign(path):
    path.write_bytes(b"not HDF5 at all" * 100)


def one_bit_flipped(path):
    content = bytearray(path.read_bytes())
    content[content.find(ARRAYS["blocks"].tobytes()[-16:])] ^= 1
    path.write_bytes(bytes(content))


def array_missing(path):
    with h5py.File(path, "a") as file:
        del file["unknowns"]


def array_added(path):
    with h5py.File(path, "a") as file:
        file["more"] = 1.0


def other_format(path):
    with h5py.File(path, "a") as file:
        file.attrs["format"] = "something else"


def directory_instead(path):
    path.unlink()
    path.mkdir()


def without_permission(path):
    if os.geteuid() == 0:
        pytest.skip("root can read files without permission")
    path.chmod(0)


DAMAGES = [
    truncated,
    lengthened,
    empty,
    foreign,
    one_bit_flipped,
    array_missing,
    array_added,
    other_format,
    directory_instead,
    without_permission,
]


@pytest.mark.parametrize("damage", DAMAGES)
def test_a_damaged_cache_entry_is_reported_and_not_used(own_cache, damage, caplog, measured):
    """As good as none; written again where the file system lets it."""
    damage(own_cache.path(KEY))
    with caplog.at_level(logging.WARNING):
        loaded = own_cache.load(KEY)
    measured(
        f"cache entry {damage.__name__.replace('_', ' ')}",
        "used" if loaded is not None else "computed again",
        "computed again",
    )
    assert loaded is None and str(own_cache.path(KEY)) in caplog.text
    own_cache.store(KEY, ARRAYS)
    again = own_cache.load(KEY)
    assert damage is directory_instead or np.array_equal(again["blocks"], ARRAYS["blocks"])


def flipped(content: bytes, place: float, bit: int) -> bytes:
    """The content with one bit turned, at a place from 0 to 1."""
    changed = bytearray(content)
    changed[min(int(place * len(content)), len(content) - 1)] ^= 1 << bit
    return bytes(changed)


def of_cache(own: Cache):
    loaded = own.load(KEY)
    return loaded and {name: array.tobytes() for name, array in loaded.items()}


def of_result(path: Path):
    """The same of a run's file, whose refusal names it."""
    try:
        return results.load(path).to_dict(encoding=True)
    except ComputationError as error:
        assert str(path) in str(error)
        return None


@pytest.mark.parametrize("kind", ["cache entry", "result"])
def test_any_one_bit_flipped(own_cache, run, tmp_path, measured, kind):
    """Wherever the bit: refused, before HDF5 sees it (which ended the process at some of these bits)."""
    path = own_cache.path(KEY) if kind == "cache entry" else tmp_path / "run.nc"
    results.save(run, tmp_path / "run.nc")
    content, refused = path.read_bytes(), []

    def read():
        return of_cache(own_cache) if kind == "cache entry" else of_result(path)

    assert read() is not None

    @settings(max_examples=300)
    @given(st.floats(0, 1), st.integers(0, 7))
    def flip(place, bit):
        path.write_bytes(flipped(content, place, bit))
        refused.append(read() is None)

    flip()
    measured(f"one bit of a {kind} flipped", f"{sum(refused)} of {len(refused)} refused", "all refused")
    assert all(refused) and len(refused) >= 300


def damage_case(damage: str, file: Path, other: Path) -> None:
    """Damage the file of a case; `other`: that of another case."""
    content = file.read_bytes()
    if damage == "cut":
        file.write_bytes(content[: len(content) // 2])
    elif damage == "swapped":
        file.write_bytes(other.read_bytes())
    elif damage == "attribute":
        with h5py.File(file, "a") as opened:
            opened.attrs["peak_to_peak_transmission_error"] = 1.0
    else:
        values = results.load(file)["transmission_error"].values.tobytes()
        assert values in content
        file.write_bytes(content.replace(values, values[8:] + values[:8]))


@pytest.mark.nightly
def test_a_damaged_case_is_computed_again(folder, undrawn, caplog, measured):
    """The undisturbed study's dataset; only Newton's iterations depend on the runs before."""
    study = write_study(folder, TWO)
    main(["study", str(study), "--quiet", "--output", "here"])
    combined = load("here")
    for damage in ("cut", "overwritten", "swapped", "attribute"):
        first, second = sorted(Path("here/cases").glob("*.nc"))
        damage_case(damage, first, second)
        before = stamps("here")
        caplog.clear()
        assert main(["study", str(study), "--quiet", "--output", "here"]) == 0
        after = stamps("here")
        repeated = [name for name in before if before[name] != after[name]]
        measured(
            f"case of a study damaged: {damage}",
            f"{len(repeated)} computed again",
            "1, with the same numbers to the bit",
        )
        assert repeated == [first.name] and "computed again" in caplog.text
        effort = ["wall_time", "newton_iterations"]
        assert load("here").drop_vars(effort).equals(combined.drop_vars(effort))


class Bomb:
    """A pickle of it creates a file where it is loaded."""

    def __init__(self, mark):
        self._mark = mark

    def __reduce__(self):
        return open, (str(self._mark), "w")


def in_hdf5(content: bytes, path: Path) -> None:
    """The bytes inside an HDF5 file, as an array, an opaque value and an attribute."""
    with h5py.File(path, "w") as file:
        file["transmission_error"] = np.frombuffer(content, dtype=np.uint8)
        file["values"] = np.void(content)
        file.attrs["scene"] = np.void(content)


@pytest.mark.parametrize("wrapped", [False, True])
def test_a_planted_pickle_is_never_loaded(tmp_path, capsys, measured, wrapped):
    """In a cache entry's and a result's place: refused, and its code has not run."""
    mark = tmp_path / "executed"
    content = pickle.dumps(Bomb(mark))
    pickle.loads(content).close()
    assert mark.exists()  # the bomb works
    mark.unlink()
    own = Cache(tmp_path)
    for path in (own.path(KEY), tmp_path / "run.nc"):
        in_hdf5(content, path) if wrapped else path.write_bytes(content)
    refused = [own.load(KEY) is None, main(["plot", str(tmp_path / "run.nc")]) == 2]
    capsys.readouterr()
    ran = "executed" if mark.exists() else "not executed"
    measured(
        "pickle " + ("within HDF5" if wrapped else "as a file"),
        f"{sum(refused)} of 2 refused, {ran}",
        "refused, not executed",
    )
    assert all(refused) and not mark.exists()
