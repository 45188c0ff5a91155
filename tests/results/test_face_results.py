"""Results over the face: kept on disk while a run goes on, read again, and combined by a study."""

import numpy as np
import xarray as xr
from tests.helical import wide_pair
from tests.over_face import MORE, helical_run

from fenics_gears.results import journal
from fenics_gears.results.attributes import RESULT_ATTRIBUTES
from fenics_gears.results.pairs import by_pair, in_middle_slice
from fenics_gears.simulation.simulate import simulate
from fenics_gears.studies.accuracy.measures import answer
from fenics_gears.studies.combine import record_of

OF_FACE = {"overlap_ratio", "total_contact_ratio", "face_load_factor", "largest_line_load_factor", "edge_line_load_factor", "transverse_load_factor"}


def test_journal_keeps_fields_over_the_face(tmp_path, monkeypatch):
    """Identity: a run whose steps are written down as they come has the same result, bit for bit."""
    monkeypatch.setattr(journal, "SECONDS_WITHOUT", 0.0)
    written = simulate(wide_pair(MORE), journal=journal.Place(tmp_path / "run.nc.part"))
    assert any((tmp_path / "run.nc.part").iterdir())
    xr.testing.assert_equal(written, helical_run())


def test_studies_take_the_load_factors(monkeypatch):
    """Every attribute of the face is there, is listed, and is in the record of a study's case."""
    result = helical_run()
    assert set(result.attrs) >= OF_FACE and {each.name for each in RESULT_ATTRIBUTES} >= OF_FACE
    record = record_of(result.assign_attrs(wall_time=1.0))
    assert {name: record.numbers[name] for name in OF_FACE} == {name: result.attrs[name] for name in OF_FACE}


def test_measures_of_accuracy_are_of_the_middle_slice():
    """Identity: what settings are compared by is what the middle slice alone gives."""
    whole, middle = (answer(each, 1.0) for each in (helical_run(), in_middle_slice(helical_run())))
    assert whole.keys() == middle.keys()
    for name, values in whole.items():
        np.testing.assert_array_equal(values, middle[name])


def test_pairs_have_their_own_fields():
    """Identity: with pairs in place of slots line loads add up to the same forces."""
    result = helical_run()
    loads = by_pair(result["line_load"], absent=0.0)
    assert set(loads.dims) == {"contact_time", "pair", "face_position"}
    np.testing.assert_allclose(loads.sum(["pair", "face_position"]), result["line_load"].sum(["slot", "face_position"]), rtol=1e-12)
