"""Contact on the coast flanks."""

from dataclasses import replace
from math import radians

import numpy as np
import pytest
from tests.coarse import COARSE, quasi_static

from fenics_gears import simulate
from fenics_gears.contact.eccentricity import Eccentricity, Offset
from fenics_gears.contact.tooth_pair import apart, coast_place, drive_place
from fenics_gears.effects.coast_flanks import CoastFlanks
from fenics_gears.effects.friction import Friction
from fenics_gears.elasticity.ring import rotation
from fenics_gears.geometry.involute import canonical_point
from fenics_gears.geometry.outline import tooth_outline
from fenics_gears.results.summary import summary_rows
from fenics_gears.scene.data import Motion


@pytest.fixture(scope="module")
def both_flanks(paper_scene):
    return replace(paper_scene, friction=None, coast_flanks=CoastFlanks(), accuracy=COARSE, motion=Motion(200.0, 1, 1))


@pytest.mark.parametrize("part", [0.1, 0.5, 0.9])
def test_coast_flanks_stand_where_the_tooth_outlines_have_them(paper_pair, part):
    """Exact: the outlines' coast points meet on the mirrored line of action once the wheel has turned by the
    backlash."""
    closed = paper_pair.backlash / paper_pair.wheel.base_radius
    xi = paper_pair.path_start + part * (paper_pair.path_end - paper_pair.path_start)
    place, drive = coast_place(paper_pair, 0, xi), drive_place(paper_pair, 0, xi)
    behind = drive_place(paper_pair, -1, xi - paper_pair.base_pitch)
    normal, across = np.array(place.axes)
    tangent_points, points = [], []
    for gear, roll, turned in (
        (paper_pair.pinion, place.contact_rolls[0], drive.contact_rolls[0]),
        (paper_pair.wheel, place.contact_rolls[1], behind.contact_rolls[1] + np.pi - closed),
    ):
        flank = tooth_outline(gear).coast(canonical_point(gear.base_radius, roll)[None])[0]
        points.append(rotation(turned) @ flank)
    wheel_centre = np.array(
        [paper_pair.line_of_action_length, -paper_pair.pinion.base_radius - paper_pair.wheel.base_radius]
    )
    tangent_points = (-across * paper_pair.pinion.base_radius, wheel_centre + across * paper_pair.wheel.base_radius)
    pinion, wheel = points[0], wheel_centre + points[1]
    assert pinion == pytest.approx(
        tangent_points[0] + normal * paper_pair.pinion.base_radius * place.contact_rolls[0], abs=1e-9
    )
    assert wheel == pytest.approx(
        tangent_points[1] - normal * paper_pair.wheel.base_radius * place.contact_rolls[1], abs=1e-9
    )
    assert wheel == pytest.approx(pinion, abs=1e-9)
    assert apart(paper_pair, [place, drive]) == pytest.approx([paper_pair.backlash, 0.0], abs=1e-12)


def test_a_pair_that_stays_in_contact_does_not_feel_its_coast_flanks(both_flanks):
    """The same transmission error but for the finer mesh; no coast force."""
    with_coast = simulate(quasi_static(both_flanks))
    without = simulate(quasi_static(both_flanks, coast_flanks=None))
    assert np.all(with_coast.coast_normal_force.values == 0.0)
    assert with_coast.transmission_error.values == pytest.approx(without.transmission_error.values, rel=1e-3)
    assert not any("coast" in str(name) for name in without)


def test_run_out_beyond_the_backlash_wedges_the_teeth_and_is_named(both_flanks, paper_pair):
    """Geometry: run-out of the backlash presses both flanks."""
    towards = Eccentricity(
        Offset(2.0 * paper_pair.backlash, radians(-90.0) + paper_pair.operating_pressure_angle), None
    )
    wedged = simulate(
        quasi_static(both_flanks, shafts=None, bearings=None, eccentricity=towards, friction=Friction(0.05))
    )
    assert wedged.coast_normal_force.max() > 0.0
    (said,) = [line for line in wedged.attrs["warnings"].splitlines() if "wedged" in line]
    assert f"by up to {float(wedged.coast_normal_force.max()):.4g} N" in said
    # What wedges is not the load: its friction is no loss of the load's power.
    printed = {label: value for label, value, _ in summary_rows(wedged)}
    assert "mesh_efficiency" not in wedged.attrs and "efficiency of the mesh" not in printed["friction loss"]
    assert "wedged" not in simulate(quasi_static(both_flanks)).attrs["warnings"]
