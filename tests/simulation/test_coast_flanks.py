"""Contact on the coast flanks."""

from dataclasses import replace
from math import radians

import numpy as np
import pytest
from tests.coarse import COARSE, quasi_static

from fenics_gears import simulate
from fenics_gears.contact.eccentricity import Eccentricity, Offset
from fenics_gears.effects.coast_flanks import CoastFlanks
from fenics_gears.effects.friction import Friction
from fenics_gears.results.summary import summary_rows
from fenics_gears.scene.data import Motion


@pytest.fixture(scope="module")
def both_flanks(paper_scene):
    return replace(paper_scene, friction=None, coast_flanks=CoastFlanks(), accuracy=COARSE, motion=Motion(200.0, 1, 1))


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
