"""Deflection at hand-over against full contact analyses by CalculiX 2.20: reference.csv.

Plane strain, teeth alone, no friction, contact found on the true outlines (flank elements 0.08 mm, at tips 0.03 mm,
penalty 1e8 MPa/mm), the wheel turned until it carries its couple. Elements 0.7 times as large and a penalty of 1e7
moved the transmission error by less than 0.2 %.
"""

import csv
from pathlib import Path

import pytest
from tests.corner_contact_reference.approach import elastic_cycle, teeth_alone, transmission_error

from fenics_gears.contact.corner import corner_contact
from fenics_gears.geometry.pair import gear_pair

STEPS = 100
with Path(__file__).with_name("reference.csv").open() as lines:
    ROWS = [{name: float(value) for name, value in row.items()} for row in csv.DictReader(lines)]


@pytest.fixture(scope="module")
def cycles(paper_scene, suite_cache):
    """Contact operators at the default accuracy with sharp and with rounded tip edges, and without corner contact."""
    scene, pair = teeth_alone(paper_scene), gear_pair(paper_scene.gears)
    corners = {radius: corner_contact(pair, radius) for radius in sorted({row["edge_radius"] for row in ROWS})}
    return {
        radius: elastic_cycle(scene, corner, STEPS, suite_cache) for radius, corner in (*corners.items(), (None, None))
    }


@pytest.mark.parametrize("row", ROWS, ids=lambda row: "phase {phase:g}, edge {edge_radius:g} mm".format(**row))
def test_deflection_is_that_of_a_full_contact_analysis(row, cycles, paper_scene, paper_pair, record_property):
    """CalculiX 2.20: the transmission error agrees within 1 % at every phase (measured: 0.5 %)."""
    couple, cycle = paper_scene.load.wheel_torque, cycles[row["edge_radius"]]
    error, couples = transmission_error(cycle, paper_pair, couple, row["phase"])
    record_property("relative_difference", error / row["transmission_error"] - 1.0)
    assert error == pytest.approx(row["transmission_error"], rel=0.01)
    # Off the line of action the couples are no longer as the tooth numbers: the arms are those of the true normal.
    assert couples == pytest.approx(row["couple_ratio"], rel=0.005)


def test_without_corner_contact_the_wheels_tip_comes_in_wrongly(cycles, paper_scene, paper_pair):
    """CalculiX: along the line of action alone the entering tip is off by more than 1 %, so that the test above can
    fail."""
    (row,) = [row for row in ROWS if (row["phase"], row["edge_radius"]) == (0.95, 0.0)]
    error, _ = transmission_error(cycles[None], paper_pair, paper_scene.load.wheel_torque, row["phase"])
    assert abs(error / row["transmission_error"] - 1.0) > 0.01
