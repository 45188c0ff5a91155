"""What lead modifications and misalignment open along the face."""

from math import cos, radians, sin

import numpy as np
import pytest
from scipy.optimize import fsolve
from scipy.spatial.transform import Rotation

from fenics_gears import face_opening, gear_pair
from fenics_gears.geometry.lead_modification import EndRelief, LeadModification, LeadModifications
from fenics_gears.geometry.misalignment import Misalignment
from fenics_gears.scene.data import GearData, GearPairData


def data_of(helix_angle=15.0, hand="right", widths=(30.0, 30.0), offsets=(0.0, 0.0)):
    stretch, common = 1.0 / cos(radians(helix_angle)), min(*widths, 0.5 * sum(widths) - abs(offsets[0] - offsets[1]))
    gears = [
        GearData(z, 0.0, 3.0 * (z * stretch + 2.0), 3.0 * (z * stretch - 2.5), 20.0, 0.38, b)
        for z, b in zip((20, 33), widths)
    ]
    return GearPairData(
        3.0, radians(20.0), 1.5 * 53 * stretch, common, *gears, None, radians(helix_angle), hand, offsets
    )


def contact_gap(pair, misalignment, position, z):
    """Gap (mm) along the contact normal of two helicoids, the wheel's axis tilted about the pitch point: involutes
    of a string shorter by tau z at z."""
    tau, rb1, rb2, span = pair.slope, pair.pinion.base_radius, pair.wheel.base_radius, pair.line_of_action_length
    centre, pivot = np.array([span, -rb1 - rb2, 0.0]), np.array([pair.pitch_point, -rb1, 0.0])
    tilt = Rotation.from_rotvec(
        [-misalignment.out_of_plane / pair.face_width, misalignment.in_plane / pair.face_width, 0.0]
    )
    normal = np.array([1.0, 0.0, -tau]) / np.sqrt(1.0 + tau**2)
    touched = np.array([position, -rb1, z])

    def wheel_flank(angle, height):
        string = span - (position + tau * (height - z)) + rb2 * angle
        section = [rb2 * np.sin(angle) - string * np.cos(angle), rb2 * np.cos(angle) + string * np.sin(angle), height]
        return pivot + tilt.apply(centre + section - pivot)

    def missed(unknowns):
        angle, height, gap = unknowns
        return wheel_flank(angle, height) - touched - gap * normal

    found, _, fine, _ = fsolve(missed, [0.0, z, 0.0], xtol=1e-14, full_output=True)
    assert np.abs(missed(found)).max() < 1e-11
    return found[2]


@pytest.mark.parametrize("hand", ["right", "left"])
@pytest.mark.parametrize("helix_angle", [0.0, 15.0, 30.0])
@pytest.mark.parametrize(
    "misalignment", [Misalignment(in_plane=0.01), Misalignment(out_of_plane=0.01), Misalignment(-0.006, 0.009)]
)
def test_misalignment_opens_what_tilted_helicoids_do(helix_angle, hand, misalignment):
    """Brute force on the helicoids; first order in angles of 3e-4."""
    pair = gear_pair(data_of(helix_angle, hand))
    for position in (pair.path_start, pair.pitch_point, pair.path_end):
        for z in (-15.0, -4.0, 15.0):
            opening = pair.cosine * face_opening(pair, None, misalignment, z, position)
            assert opening == pytest.approx(contact_gap(pair, misalignment, position, z), abs=5e-6)


AMOUNTS = {
    # At -15, -7.5, 0, 7.5 and 15 mm of a face of 30 mm.
    "crowning": (LeadModification(crowning=6.0), [6.0, 1.5, 0.0, 1.5, 6.0]),
    "helix slope": (LeadModification(helix_slope=8.0), [0.0, 2.0, 4.0, 6.0, 8.0]),
    "negative helix slope": (LeadModification(helix_slope=-8.0), [8.0, 6.0, 4.0, 2.0, 0.0]),
    "end relief": (LeadModification(end_relief=EndRelief(10.0, 10.0)), [10.0, 2.5, 0.0, 2.5, 10.0]),
    "parabolic, left": (
        LeadModification(end_relief=EndRelief(10.0, 15.0, "left", "parabolic")),
        [10.0, 2.5, 0.0, 0.0, 0.0],
    ),
    "right, over the whole face": (
        LeadModification(end_relief=EndRelief(12.0, 30.0, "right")),
        [0.0, 3.0, 6.0, 9.0, 12.0],
    ),
    "all": (LeadModification(6.0, 8.0, EndRelief(10.0, 10.0, "right")), [6.0, 3.5, 4.0, 10.0, 24.0]),
}


@pytest.mark.parametrize("name", AMOUNTS)
def test_lead_modifications_remove_what_is_drawn(name):
    """ISO 21771: lines and parabolas by hand, for either gear and hand."""
    own, expected = AMOUNTS[name]
    z = np.array([-15.0, -7.5, 0.0, 7.5, 15.0])
    for hand in ("right", "left"):
        pair = gear_pair(data_of(hand=hand))
        for modifications in (LeadModifications(pinion=own), LeadModifications(wheel=own)):
            assert face_opening(pair, modifications, None, z) == pytest.approx(expected, abs=1e-14)
        both = face_opening(pair, LeadModifications(own, own), None, z)
        assert both == pytest.approx(2.0 * np.array(expected), abs=1e-14)


def test_each_gear_s_modification_is_about_its_own_mid_width():
    """Identity."""
    pair = gear_pair(data_of(widths=(30.0, 40.0), offsets=(2.0, -4.0)))
    crowned = LeadModification(crowning=0.01)
    middle = pair.gear_middles
    assert face_opening(pair, LeadModifications(crowned), None, middle[0]) == pytest.approx(0.0, abs=1e-18)
    assert face_opening(pair, LeadModifications(None, crowned), None, middle[1] + 20.0) == pytest.approx(0.01)


@pytest.mark.parametrize(("widths", "offsets", "width", "middles"), [
    ((30.0, 30.0), (0.0, 0.0), 30.0, (0.0, 0.0)),
    ((30.0, 20.0), (0.0, 0.0), 20.0, (0.0, 0.0)),
    ((30.0, 30.0), (5.0, 2.0), 27.0, (1.5, -1.5)),
    # From 1 to 21 within -15 to 15: the common face is 1 to 15.
    ((30.0, 20.0), (0.0, 11.0), 14.0, (-8.0, 3.0)),
])  # fmt: skip
def test_the_common_face_is_where_both_gears_are(widths, offsets, width, middles):
    """By hand."""
    pair = gear_pair(data_of(widths=widths, offsets=offsets))
    assert pair.face_width == width and pair.common_face == (-0.5 * width, 0.5 * width)
    assert pair.gear_middles == pytest.approx(middles, abs=1e-14)
    assert pair.overlap_ratio == pytest.approx(width * sin(radians(15.0)) / (np.pi * 3.0), rel=1e-14)
    assert pair.total_contact_ratio == pair.contact_ratio + pair.overlap_ratio
