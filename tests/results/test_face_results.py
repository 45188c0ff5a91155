"""Results over the face: kept on disk, read again, combined by a study."""

import numpy as np
import pytest
import xarray as xr
from tests.hard_cases.invariants import finished_helical_run
from tests.helical import wide_pair
from tests.over_face import MORE, helical_run

from fenics_gears import model_of, scene_from_text, simulate
from fenics_gears.results import journal
from fenics_gears.results.attributes import RESULT_ATTRIBUTES
from fenics_gears.results.mesh_curves import read_off
from fenics_gears.results.pairs import in_middle_slice
from fenics_gears.results.summary import summary_rows
from fenics_gears.runs.record import record_of
from fenics_gears.runs.settings.measures import MEAN, OVER_FACE, answer

OF_FACE = {
    "overlap_ratio",
    "total_contact_ratio",
    "face_load_factor",
    "largest_line_load_factor",
    "edge_line_load_factor",
    "transverse_load_factor",
}


@pytest.mark.nightly
def test_journal_keeps_fields_over_the_face(tmp_path, monkeypatch):
    """Identity, bit for bit."""
    monkeypatch.setattr(journal, "SECONDS_WITHOUT", 0.0)
    written = simulate(wide_pair(MORE), journal=journal.JournalPlace(tmp_path / "run.nc.part"))
    assert (tmp_path / "run.nc.part").is_file()
    xr.testing.assert_equal(written, helical_run())


def test_studies_take_the_load_factors(monkeypatch):
    """Every attribute of the face is listed and in a case's record."""
    result = helical_run()
    assert set(result.attrs) >= OF_FACE and {each.name for each in RESULT_ATTRIBUTES} >= OF_FACE
    record = record_of(result.assign_attrs(wall_time=1.0))
    assert {name: record.numbers[name] for name in OF_FACE} == {name: result.attrs[name] for name in OF_FACE}


def test_a_peak_pressure_beside_the_end_of_a_line_of_contact_is_told():
    """Definition: within half a module of the face from an end of the line of contact; the summary has it."""
    result = helical_run()
    pair = model_of(scene_from_text(result.attrs["scene"])).pair
    radius, base = 0.5 * result.attrs["peak_contact_pressure_diameter"], pair.pinion.base_radius
    place, near = np.sqrt(radius**2 - base**2), min(0.5 * pair.pinion.normal_module, 0.1 * pair.face_width) * pair.slope
    said = "start" if place < pair.path_start + near else "end" if place > pair.path_end - near else None
    assert result.attrs.get("peak_contact_pressure_beside") == said
    printed = dict(row[:2] for row in summary_rows(result))
    row = next(value for label, value in printed.items() if label.startswith("peak contact pressure"))
    assert (f"near the {said} of its active profile" in row) == (said is not None)


def test_measures_of_accuracy_are_of_the_middle_slice():
    """Identity: but for line loads, what the middle slice alone gives."""
    whole, middle = (answer(each, 1.0) for each in (helical_run(), in_middle_slice(helical_run())))
    assert whole.keys() == middle.keys() | {MEAN, *OVER_FACE}
    for name, values in middle.items():
        np.testing.assert_array_equal(values, whole[name])


def test_peak_pressure_is_not_of_an_end_of_the_face():
    """Definition: of a misaligned pair the ends press most; theirs is a pressure at edges."""
    few = "slices = 12\ncontact_nodes = 9\nsteps_per_mesh_cycle = 8"
    result = finished_helical_run('[misalignment]\nin_plane = "20 um"\n', helix=0.0, width=8.0, accuracy=few).result
    order = "contact_time", "slot", "face_position", "contact_node"
    pressure = read_off(
        result["contact_pressure"].transpose(*order).values, result["contact_roll_angle"].transpose(*order).values
    ).max(axis=(1, 3))
    ends, rest = pressure[:, [0, -1]].max(axis=1), pressure[:, 1:-1].max(axis=1)
    largest, edge = (result[f"largest_{name}_pressure"].values for name in ("contact", "edge"))
    assert (ends > rest).any() and (edge >= ends).all() and (largest <= rest).all()
    # Tips press at the other steps.
    assert (largest == rest).any() and result.attrs["peak_contact_pressure"] == largest[:-1].max() < result.attrs[
        "peak_edge_pressure"
    ]
