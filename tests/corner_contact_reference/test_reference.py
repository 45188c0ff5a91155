"""Deflection at hand-over against CalculiX; `python -m tests.corner_contact_reference` regenerates reference.csv."""

import shutil
from dataclasses import replace

import pytest
from tests.corner_contact_reference.approach import elastic_cycle, teeth_alone, transmission_error
from tests.corner_contact_reference.reference import LEAVING, VARIANTS, case, computed, read

from fenics_gears import gear_pair
from fenics_gears.contact.corner import corner_contact

STEPS = 100
ROWS = {row.case: row for row in read()}
USUAL = [row for row in ROWS.values() if row.case not in VARIANTS]


def name(row) -> str:
    return f"phase {row.case.phase:g}, edge {row.case.edge_radius:g} mm"


@pytest.fixture(scope="module")
def cycles(paper_scene, suite_cache):
    scene, pair = teeth_alone(paper_scene), gear_pair(paper_scene.gears)
    corners = {radius: corner_contact(pair, radius) for radius in sorted({row.case.edge_radius for row in USUAL})}
    return {
        radius: elastic_cycle(scene, corner, STEPS, suite_cache) for radius, corner in (*corners.items(), (None, None))
    }


@pytest.mark.parametrize("row", USUAL, ids=name)
def test_deflection_is_that_of_a_full_contact_analysis(row, cycles, paper_scene, paper_pair, record_property):
    """CalculiX 2.20: within 1 % at every phase (measured: 0.5 %)."""
    couple, cycle = paper_scene.load.wheel_torque, cycles[row.case.edge_radius]
    error, couples = transmission_error(cycle, paper_pair, couple, row.case.phase)
    record_property("relative_difference", error / row.transmission_error - 1.0)
    assert error == pytest.approx(row.transmission_error, rel=0.01)
    # Off the line of action the couples are no longer as the tooth numbers: the arms are those of the true normal.
    assert couples == pytest.approx(row.couple_ratio, rel=0.005)


def test_without_corner_contact_the_wheels_tip_comes_in_wrongly(cycles, paper_scene, paper_pair):
    """CalculiX: the entering tip is off by more than 1 %, so that the test above can fail."""
    row = ROWS[case(0.95, 0.0)]
    error, _ = transmission_error(cycles[None], paper_pair, paper_scene.load.wheel_torque, row.case.phase)
    assert abs(error / row.transmission_error - 1.0) > 0.01


@pytest.mark.nightly
@pytest.mark.skipif(shutil.which("ccx") is None, reason="CalculiX is not installed (Debian: calculix-ccx)")
def test_calculix_gives_the_file_again(paper_scene, paper_pair, tmp_path):
    """One position anew, with elements half as large again (measured: 1e-5); of the file's own sizes CalculiX 2.20
    calls one undistorted element of today's gmsh inverted."""
    row = ROWS[case(LEAVING[0], 0.0)]
    coarser = replace(row.case, refinement=1.5)
    again = computed(paper_scene, paper_pair, coarser, tmp_path, guess=row.transmission_error)
    assert again.transmission_error == pytest.approx(row.transmission_error, rel=2e-4)
