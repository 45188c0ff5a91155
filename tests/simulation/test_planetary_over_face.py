"""Planetary sets over the face: laws that hold to round-off, and the plane's set as the limit of a uniform load."""

import numpy as np
import pytest
from tests.planets import COARSE, planetary, written_out

from fenics_gears import simulate_train
from fenics_gears.errors import SceneError

FACE = f"{COARSE}\nslices = 6\nlayers = 3"
COARSEST = 'steps_per_mesh_cycle = 3\nflank_element_size = "0.6 mm"\nslices = 4\nlayers = 2'
HELICAL = 'helix_angle = "12 deg"'
UNEVEN = 'carrier = { pin_stiffness = "3e5 N/mm", pin_errors = ["15 um", "0 um", "-5 um"] }'


def test_helical_planets_in_phase_share_evenly():
    """z_s/N and z_r/N whole: all planets are in the same state at every instant."""
    found = simulate_train(planetary(teeth=(18, 18, 54), planets="planets = 3", more=HELICAL, accuracy=COARSEST))
    forces = found["normal_force"].values
    for kind in range(2):
        assert np.ptp(forces[:, kind::2], axis=1).max() < 1e-9 * forces.max()
    torques = found["member_torque"].values
    np.testing.assert_allclose(torques, np.tile(600e3 * np.array([1.0, 3.0, -4.0]), (len(torques), 1)), rtol=1e-9)


def test_planets_begin_with_what_touched_there_before():
    """Equal planets pass the same places one after the other under the same load: as soon as all places have been
    passed, Newton's first iteration finds the closed nodes as they are."""
    finer = COARSEST.replace("steps_per_mesh_cycle = 3", "steps_per_mesh_cycle = 6")
    set_of_three = planetary(teeth=(17, 19, 55), planets="planets = 3", more=HELICAL, accuracy=finer)
    iterations = simulate_train(set_of_three)["newton_iterations"].values
    assert iterations[0].min() > 1
    assert (iterations[2:] == 1).all()


@pytest.mark.nightly
def test_the_mirror_image_of_a_helical_set_shares_as_the_set():
    """With the other hand the same planets carry the same: the set seen in a mirror across its axis."""
    more = f'{HELICAL}\nfloating = ["sun"]\n{UNEVEN}'
    right, left = (
        simulate_train(
            planetary(teeth=(17, 19, 55), planets="planets = 3", more=f'{more}\nsun_hand = "{hand}"', accuracy=FACE)
        )
        for hand in ("right", "left")
    )
    np.testing.assert_allclose(left["normal_force"], right["normal_force"], rtol=1e-8)
    np.testing.assert_allclose(left["overall_transmission_error"], right["overall_transmission_error"], rtol=1e-8)
    loads = right["line_load"].values
    assert np.nanmax(np.abs(loads - loads[..., ::-1])) > 1.0
    np.testing.assert_allclose(left["line_load"], loads[..., ::-1], rtol=1e-6, atol=1e-6)


@pytest.mark.nightly
def test_a_helical_set_with_its_carrier_at_rest_is_a_train_of_pairs():
    """The same planets written out, under the same torque on the ring and in the same windows."""
    same = f'{FACE}\ncontact_length = "4 mm"\ncontact_nodes = 20'
    own = planetary(parts=("carrier", "sun", "ring"), load='output_torque = "2 kN m"', accuracy=same, more=HELICAL)
    of_set = simulate_train(own)
    of_pairs = simulate_train(written_out((17, 18, 53), [0.0, 180.0], same, "12 deg"))
    np.testing.assert_allclose(of_set["normal_force"], of_pairs["normal_force"], rtol=1e-8)
    np.testing.assert_allclose(of_set["overall_transmission_error"], of_pairs["overall_transmission_error"], rtol=1e-8)


@pytest.mark.parametrize(
    ("more", "said"),
    [
        ('pinion_hand = "left"', "sun_hand"),
        ('sun_hand = "left"', "helix_angle"),
        (f'{HELICAL}\nsun_hand = "up"', '"right"'),
    ],
)
def test_wrong_hands_are_told(more, said):
    """What is wrong, and what is allowed."""
    with pytest.raises(SceneError, match=said):
        planetary(more=more)
