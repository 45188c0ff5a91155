"""Contact on the coast flanks: their place against the tooth outlines, and their forces against the drive flanks'."""

from dataclasses import replace

import numpy as np
import pytest

from fenics_gears.contact.tooth_pair import coast_place, drive_place
from fenics_gears.elasticity.ring import rotation
from fenics_gears.geometry.involute import canonical_point
from fenics_gears.geometry.outline import tooth_outline
from fenics_gears.effects.coast_flanks import CoastFlanks
from fenics_gears.scene.data import Accuracy, Motion
from fenics_gears.show.curves import load_sharing
from fenics_gears.simulation import simulate

COARSE = Accuracy(element="P1", flank_element_size=0.12, contact_length=3.0, contact_nodes=26, steps_per_mesh_cycle=40)


@pytest.fixture(scope="module")
def both_flanks(paper_scene):
    """The paper's pair with coast flanks, frictionless, at a coarse mesh."""
    return replace(paper_scene, friction=None, coast_flanks=CoastFlanks(), accuracy=COARSE, motion=Motion(200.0, 1, 1))


def quasi_static(scene, **changes):
    return replace(scene, inertia=None, damping=None, **changes)


@pytest.mark.parametrize("part", [0.1, 0.5, 0.9])
def test_coast_flanks_stand_where_the_tooth_outlines_have_them(paper_pair, part):
    """Exact: the outlines' coast points with the place's roll angles lie on the mirrored line of action, a backlash apart."""
    xi = paper_pair.path_start + part * (paper_pair.path_end - paper_pair.path_start)
    place, drive = coast_place(paper_pair, 0, xi), drive_place(paper_pair, 0, xi)
    behind = drive_place(paper_pair, -1, xi - paper_pair.base_pitch)
    normal, across = np.array(place.axes)
    tangent_points, points = [], []
    for gear, roll, turned in (
        (paper_pair.pinion, place.contact_rolls[0], drive.contact_rolls[0]),
        (paper_pair.wheel, place.contact_rolls[1], behind.contact_rolls[1] + np.pi),
    ):
        flank = tooth_outline(gear).coast(canonical_point(gear.base_radius, roll)[None])[0]
        points.append(rotation(turned) @ flank)
    wheel_centre = np.array([paper_pair.line_of_action_length, -paper_pair.pinion.base_radius - paper_pair.wheel.base_radius])
    tangent_points = (-across * paper_pair.pinion.base_radius, wheel_centre + across * paper_pair.wheel.base_radius)
    pinion, wheel = points[0], wheel_centre + points[1]
    assert pinion == pytest.approx(tangent_points[0] + normal * paper_pair.pinion.base_radius * place.contact_rolls[0], abs=1e-9)
    assert wheel == pytest.approx(tangent_points[1] - normal * paper_pair.wheel.base_radius * place.contact_rolls[1], abs=1e-9)
    assert wheel - pinion == pytest.approx(paper_pair.backlash * normal, abs=1e-9)


def test_a_pair_that_stays_in_contact_does_not_feel_its_coast_flanks(both_flanks):
    """Omitted equals not touched: the same transmission error but for the finer mesh along the coast flank; no coast force."""
    with_coast = simulate(quasi_static(both_flanks))
    without = simulate(quasi_static(both_flanks, coast_flanks=None))
    assert np.all(with_coast.coast_normal_force.values == 0.0)
    assert with_coast.transmission_error.values == pytest.approx(without.transmission_error.values, rel=1e-3)
    assert not any("coast" in str(name) for name in without)


@pytest.mark.parametrize("absent", [("shafts", "bearings"), ()])
def test_reversed_torque_is_the_mirror_image(both_flanks, paper_pair, absent):
    """Symmetry: driven backwards the pair deflects as driven forwards, mirrored, after crossing the backlash.

    Only to 0.5 %: displacements are small ones about the nominal position, from which the wheel is a backlash away: its tips pass
    0.1 mm beside where the model has them, 0.75 % of a base pitch.
    """
    fine = replace(COARSE, steps_per_mesh_cycle=200)
    scene = quasi_static(both_flanks, accuracy=fine, **dict.fromkeys(absent))
    forward = simulate(scene)
    backward = simulate(replace(scene, load=replace(scene.load, wheel_torque=-scene.load.wheel_torque)))
    assert np.all(backward.normal_force.values == 0.0)
    assert backward.coast_normal_force.values == pytest.approx(forward.normal_force.values, rel=1e-9)
    crossed = -backward.transmission_error.values - paper_pair.backlash / paper_pair.wheel.base_radius
    assert crossed.mean() == pytest.approx(forward.transmission_error.values.mean(), rel=5e-3)
    assert crossed.min() == pytest.approx(forward.transmission_error.values.min(), rel=5e-3)
    assert crossed.max() == pytest.approx(forward.transmission_error.values.max(), rel=5e-3)
    assert backward.reaction_couple.sel(gear="wheel").values == pytest.approx(scene.load.wheel_torque, rel=1e-9)
    assert backward.coast_flank_opening.values.max() <= 1e-12
    lowest = min(np.nanmin(line.get_ydata()) for line in load_sharing(backward).axes[0].lines)
    assert lowest == pytest.approx(-backward.pair_coast_normal_force.values.max())


def test_reversed_torque_with_friction_balances(both_flanks, paper_scene):
    """Equilibrium: the wheel's couple is the load; friction of the single pair is mu times its normal force."""
    scene = quasi_static(both_flanks, friction=paper_scene.friction)
    result = simulate(replace(scene, load=replace(scene.load, wheel_torque=-scene.load.wheel_torque)))
    assert result.reaction_couple.sel(gear="wheel").values == pytest.approx(scene.load.wheel_torque, rel=1e-9)
    # Across the coast flanks' own line of action: the reaction's part that the normal force does not explain.
    force = np.hypot(result.reaction_x.sel(gear="pinion").values, result.reaction_y.sel(gear="pinion").values)
    ratio = force / result.coast_normal_force.values
    assert ratio.max() == pytest.approx(np.hypot(1.0, 0.1), rel=1e-6)


def test_undamped_resonance_crosses_the_backlash_and_comes_back(both_flanks, paper_pair):
    """Row 17: teeth separate, cross the backlash, touch on the coast flanks, return. In free flight the two openings sum to the
    backlash exactly, centres being fixed; what is more is the hat average of the flanks' curvature."""
    result = simulate(replace(both_flanks, damping=None, bearings=None, motion=Motion(270.0, 100, 30)))
    driving, coasting = result.normal_force.values > 0.0, result.coast_normal_force.values > 0.0
    free = ~driving & ~coasting
    assert driving.any() and coasting.any() and free.any() and not np.any(driving & coasting)
    openings = result.drive_flank_opening.values + result.coast_flank_opening.values
    assert openings[free] == pytest.approx(paper_pair.backlash, rel=0.01)
    assert "lose contact" in result.attrs["warnings"] and "no meaning" not in result.attrs["warnings"]
