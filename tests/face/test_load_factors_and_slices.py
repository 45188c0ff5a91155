"""Load factors of pairs on finite element bodies."""

import pytest

from fenics_gears import scene_from_text, simulate

# A gearbox pair whose wheel is narrower than the pinion, so that its ends press on the pinion's flank.
GEARBOX = """
[gears]
module = "2.25 mm"
pressure_angle = "18 deg"
helix_angle = "29 deg"
pinion_hand = "left"
centre_distance = "91.0 mm"
backlash = "0.12 mm"
material = "steel"
[gears.rack]
addendum = 1.2
dedendum = 1.5
tip_radius = 0.3
[gears.pinion]
teeth = 29
profile_shift = 0.25
bore_diameter = "38 mm"
face_width = "13 mm"
tip_chamfer = "0.2 mm"
[gears.wheel]
teeth = 41
profile_shift = 0.195
bore_diameter = "50 mm"
face_width = "11 mm"
tip_chamfer = "0.2 mm"
[load]
pinion_torque = "90 N m"
[motion]
mesh_cycles = 1
[accuracy]
steps_per_mesh_cycle = 40
body_element_size = "1.4 mm"
"""


@pytest.mark.nightly
@pytest.mark.parametrize("misalignment", ["0 um", "10 um"])
def test_twice_as_many_slices_and_layers_give_the_same_factors(misalignment):
    """Factors away from edges and between tooth pairs move by less than 2 %."""
    found = []
    for divided in ("slices = 14\nlayers = 8\n", "slices = 28\nlayers = 16\n"):
        found.append(
            simulate(scene_from_text(f'{GEARBOX}{divided}[misalignment]\nin_plane = "{misalignment}"\n')).attrs
        )
    for name in ("face_load_factor", "largest_line_load_factor", "transverse_load_factor"):
        assert found[1][name] == pytest.approx(found[0][name], rel=0.02), name
    # What is left out is there.
    assert found[0]["edge_line_load_factor"] > 1.2 * found[0]["largest_line_load_factor"]
