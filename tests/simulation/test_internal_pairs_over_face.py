"""Runs of a pinion in its ring over the face: the plane, the mirror, helicoids drawn by hand, statics and energy."""

from math import cos, pi, radians, sqrt, tan

import numpy as np
import pytest
from tests.geometry.test_internal_pairs import involute
from tests.internal import internal_scene, moving

from fenics_gears import gear_pair, model_of, simulate
from fenics_gears.contact.places import face_places
from fenics_gears.contact.tooth_pair import facing_points_at
from fenics_gears.scene.read import scene_from_text

HELIX = 12.0
COARSE = """
[accuracy]
slices = 5
layers = 2
body_element_size = "4 mm"
flank_element_size = "0.4 mm"
contact_length = "4 mm"
contact_nodes = 21
steps_per_mesh_cycle = 10
"""
TILTING = moving(
    2, 'axial_stiffness = "200 kN/mm"\nplaces = { pinion = ["-40 mm", "60 mm"], wheel = ["-45 mm", "50 mm"] }'
)


def scene_of(more: str = COARSE, *, hand: str = "right", helix: float = HELIX, **changes):
    leaning = f'helix_angle = "{helix} deg"\npinion_hand = "{hand}"\n' if helix else ""
    return scene_from_text(internal_scene(gears=leaning, more=more, **changes))


def test_gaps_are_those_of_two_helicoids_drawn_one_in_the_other():
    """Brute force: in the section at any height both gears are turned by the same lead, the pinion's and the ring's
    helix of one hand; strings unwound from both base circles there, 1e-9 mm."""
    model = model_of(scene_of())
    pair = model.pair
    transverse = 4.0 / cos(radians(HELIX))
    pressure = np.arctan(tan(radians(20.0)) / cos(radians(HELIX)))
    reference = 11.0 * transverse, 30.5 * transverse
    small, large = (radius * cos(pressure) for radius in reference)
    between = sqrt(pair.centre_distance**2 - (large - small) ** 2)
    centres = np.array([[0.0, 0.0], [-between, large - small]])
    numbers = np.random.default_rng(3)
    checked = 0
    for phase in numbers.uniform(size=4):
        places = face_places(pair, model.resolution.contact_grid, model.face, phase)
        on_path = [each for each in places if pair.path_start < each.contact_rolls[0] * small < pair.path_end]
        for place in numbers.choice(on_path, 5):
            offsets = np.sort(numbers.uniform(-0.15, 0.15, 4))
            found = facing_points_at(pair, (None, None), place, offsets)[2]
            # Where the pair's contact is in the middle of the face, and how far both have turned on at this height.
            xi = pair.path_start + (phase + place.index) * pair.base_pitch
            turned = place.height * tan(radians(HELIX)) / np.array(reference)
            begins = -0.5 * pi + np.array([xi / small, (xi + between) / large]) + turned
            pinion, other = (
                np.array([involute(centre, radius, begin, -1.0, y) for y in offsets - small])
                for centre, radius, begin in zip(centres, (small, large), begins)
            )
            known = np.isfinite(found)
            checked += known.sum()
            np.testing.assert_allclose(found[known], (other - pinion)[known], rtol=0.0, atol=1e-9)
    assert checked > 40


@pytest.fixture(scope="module")
def helical():
    return simulate(scene_of())


def test_line_loads_add_up_to_the_torque(helical):
    """Statics without friction: the contact normal leans by the base helix angle, so that the line load's integral is
    T/(rb cos(beta_b)); couples are as the numbers of teeth; forces along the axis are opposite."""
    pair = gear_pair(scene_of().gears)
    force = (helical.line_load.sum("slot") * helical.face_slice_width).sum("face_position")
    np.testing.assert_allclose(force, 500e3 / (pair.pinion.base_radius * pair.cosine), rtol=1e-9)
    couple = helical.reaction_couple.values
    assert -couple[:, 1] / couple[:, 0] == pytest.approx(np.full(len(couple), 61.0 / 22.0), rel=1e-9)
    assert helical.transmission_error.values.min() > 0.0


def test_other_hand_is_the_mirror(helical):
    """Exact symmetry: hands, helix slopes and tilts in the plane of action mirrored along the face are the same run."""
    other = simulate(scene_of(hand="left"))
    np.testing.assert_allclose(other.transmission_error, helical.transmission_error, rtol=1e-10)
    largest = float(helical.line_load.max())
    load = helical.line_load.values[..., ::-1]
    np.testing.assert_allclose(other.line_load, load, rtol=0.0, atol=1e-8 * largest)
    tilted = (
        f'[misalignment]\nin_plane = "{sign}20 um"\n[lead_modifications.wheel]\nhelix_slope = "{other}10 um"\n'
        for sign, other in (("", "-"), ("-", ""))
    )
    ends = [simulate(scene_of(COARSE + more, hand=hand)) for more, hand in zip(tilted, ("right", "left"))]
    np.testing.assert_allclose(ends[0].transmission_error, ends[1].transmission_error, rtol=1e-10)


def test_a_ring_that_leans_away_is_a_helix_slope(helical):
    """Geometry: to lean in the plane of action by f opens spur flanks as a helix slope of f does, but for f/2 along the
    line of action."""
    leaning, slope = (
        simulate(scene_of(COARSE + more, helix=0.0))
        for more in ('[misalignment]\nin_plane = "20 um"\n', '[lead_modifications.wheel]\nhelix_slope = "20 um"\n')
    )
    radius = leaning.attrs["base_radius_wheel"]
    apart = (slope.transmission_error - leaning.transmission_error).values * radius
    np.testing.assert_allclose(apart, 0.01, rtol=1e-6)
    right = leaning.line_load.sum("slot").mean("time" if "time" in leaning.line_load.dims else "contact_time")
    assert np.all(np.diff(right.values) < 0.0)


def test_energy_and_thrust_balance_with_friction_inertia_and_tilting():
    """Energy: what goes in, out, is damped, rubbed and stored adds up to round-off, of gears that tilt and move along
    their axes."""
    result = simulate(scene_of(COARSE + TILTING))
    carried = float(np.abs(result.work_input.values).max())
    assert float(np.abs(result.energy_defect.values).max()) < 1e-9 * carried
    assert result.work_friction.values[-1] > 0.0
    moved = result.axial_position.values
    assert moved[:, 0].min() > 0.0 > moved[:, 1].max()
