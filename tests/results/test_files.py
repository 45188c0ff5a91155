"""The file of a result against another program's."""

import io

import numpy as np
import pytest
import xarray as xr
from tests.show.synthetic import made_up_run

from fenics_gears import ComputationError, results
from fenics_gears.results import files
from fenics_gears.results.files import read_netcdf, write_netcdf
from fenics_gears.results.stored import stored


def several_kinds(steps: int) -> xr.Dataset:
    """All kinds of values that results have."""
    values = np.linspace(0.0, 1.0, 2 * steps).reshape(steps, 2)
    values[:1] = np.nan
    return xr.Dataset(
        {
            "force": (("time", "gear"), values, {"units": "N", "long_name": "force"}),
            "count": ("time", np.arange(steps, dtype=np.int32), {"units": "1"}),
            "open": (("time", "node"), np.zeros((steps, 3), dtype=bool)),
            "why": ("gear", np.array(["", "Größe µm"], dtype=object)),
            "single": ((), 2.5),
        },
        coords={
            "time": ("time", np.arange(steps) * 0.1, {"units": "mm"}),
            "gear": ["pinion", "wheel"],
            "phase": ("time", np.arange(steps) / 2.0),
        },
        attrs={"title": "größer", "number": 3.5, "steps": steps, "empty": ""},
    )


def test_a_file_is_read_as_if_another_program_had_written_it():
    """xarray writes the same dataset by h5netcdf; of no step too."""
    for steps in (0, 5):
        ours = several_kinds(steps)
        theirs = _by_h5netcdf(ours)
        content = io.BytesIO()
        write_netcdf(ours, content)
        with (
            xr.open_dataset(content, engine="h5netcdf") as read,
            xr.open_dataset(theirs, engine="h5netcdf") as expected,
        ):
            assert read.load().identical(expected.load())
            assert read.identical(ours)


def test_files_are_read_as_another_program_reads_them():
    """What xarray reads by h5netcdf, of files that it or this program has written."""
    for steps in (0, 5):
        ours = io.BytesIO()
        write_netcdf(several_kinds(steps), ours)
        for content in (ours, _by_h5netcdf(several_kinds(steps))):
            found = read_netcdf(content)
            with xr.open_dataset(content, engine="h5netcdf") as opened:
                expected = opened.load()
            assert (
                found.identical(expected)
                and list(found.variables) == list(expected.variables)
                and list(found.attrs) == list(expected.attrs)
            )
            for name, each in found.variables.items():
                assert _kind(each.dtype) == _kind(expected[name].dtype)
                assert {key: type(value) for key, value in each.attrs.items()} == {
                    key: type(value) for key, value in expected[name].attrs.items()
                }


def test_what_is_asked_for_of_a_file_is_what_is_there_when_all_is_read():
    """Identity, of values, attributes and their types."""
    content = io.BytesIO()
    write_netcdf(several_kinds(5), content)
    whole = read_netcdf(content)
    with stored(content) as found:
        assert "why" in found and "nothing" not in found
        assert dict(found.attrs) == whole.attrs
        assert {name: type(each) for name, each in found.attrs.items()} == {
            name: type(each) for name, each in whole.attrs.items()
        }
        for name in ("force", "count", "time", "single"):
            np.testing.assert_array_equal(found[name].values, whole[name].values)
            assert np.asarray(found[name]).dtype == whole[name].dtype
            assert whole[name].attrs.items() <= found[name].attrs.items()
        with pytest.raises(KeyError):
            found.attrs["nothing"]


def _kind(type_of_values: np.dtype):
    """A type; all types of text alike."""
    return "text" if type_of_values.kind in "OU" else type_of_values


def test_a_file_made_on_disk_is_the_one_made_in_memory(monkeypatch):
    """Identity."""
    monkeypatch.setattr(files, "MOST_IN_MEMORY", 0)
    ours, content = several_kinds(5), io.BytesIO()
    write_netcdf(ours, content)
    with xr.open_dataset(content, engine="h5netcdf") as read:
        assert read.load().identical(ours)


def test_a_file_begun_as_a_copy_has_nothing_of_the_one_before():
    """Identity, of datasets that differ in values, in an attribute or only in its type."""
    first = several_kinds(5)
    other = first.map(
        lambda each: each if each.dtype.kind == "O" else each + each.dtype.type(1), keep_attrs=True
    ).assign_attrs(title="other", more=1)
    written = [first, other]
    for offset in (1, 1.0, np.int32(1)):
        written.append(first.assign(force=first["force"].assign_attrs(offset=offset)))
    for dataset in written:
        content = io.BytesIO()
        write_netcdf(dataset, content)
        with xr.open_dataset(content, engine="h5netcdf") as read:
            assert read.load().identical(dataset)
            wanted = dataset["force"].attrs.get("offset")
            assert wanted is None or read["force"].attrs["offset"].dtype == np.asarray(wanted).dtype


def _by_h5netcdf(dataset: xr.Dataset) -> io.BytesIO:
    import h5netcdf
    from xarray.backends import H5NetCDFStore

    content = io.BytesIO()
    with h5netcdf.File(content, "w") as file:
        dataset.dump_to_store(H5NetCDFStore(file))
    return io.BytesIO(content.getvalue())


DAMAGES = {
    "it has no pair_normal_force": lambda run: run.drop_vars("pair_normal_force"),
    "it has no time": lambda run: run.drop_vars("time"),
    "it has contact fields and no contact_pair_number": lambda run: run.drop_vars("contact_pair_number"),
    "transmission_error is over (gear), not over (time)": lambda run: run.assign(
        transmission_error=("gear", [1.0, 2.0])
    ),
    "contact_pressure is over": lambda run: run.assign(contact_pressure=run["contact_pressure"].transpose("slot", ...)),
    "normal_force holds": lambda run: run.assign(normal_force=run["normal_force"].astype(str).astype(object)),
    "its attribute base_radius_wheel is 'fifty'": lambda run: run.assign_attrs(base_radius_wheel="fifty"),
    "its gears are not": lambda run: run.assign_coords(gear=["wheel", "pinion"]),
    "time does not go on": lambda run: run.isel(time=slice(None, None, -1)),
    "not at its steps": lambda run: run.assign_coords(contact_time=run["contact_time"] + 1.0),
    "pair_number has no whole number": lambda run: run.assign_coords(pair_number=run["pair_number"] * 1),
    "pair_number has a tooth pair in a slot": lambda run: run.assign_coords(
        pair_number=run["pair_number"].copy(data=run["pair_number"].values[:, ::-1])
    ),
}


@pytest.mark.parametrize("words", DAMAGES)
def test_a_result_whose_layout_is_not_one_is_refused_by_its_first_mistake(tmp_path, words):
    """docs/result.md's names, dimensions and types."""
    results.save(made_up_run(), tmp_path / "run.nc")
    assert results.load(tmp_path / "run.nc").equals(made_up_run())
    written = made_up_run(fenics_gears_version="0.1.0")
    results.save(DAMAGES[words](written), tmp_path / "run.nc")
    with pytest.raises(ComputationError) as refused:
        results.load(tmp_path / "run.nc")
    assert words in str(refused.value)
