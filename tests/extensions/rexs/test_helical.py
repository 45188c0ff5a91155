"""Helical pairs and lead modifications: the schema of REXS 1.6, ISO 21771 for the helix angle's sign and for left
and right flanks, and files of other programs for coordinates (from mid-width, datum face negative)."""

from math import cos, radians

import pytest
from tests.extensions.rexs import paper_model as rexs
from tests.extensions.rexs.test_lookups import assumed_fields, refused, scene_of

from fenics_gears import gear_pair
from fenics_gears.geometry.lead_modification import EndRelief, LeadModification

STRETCH = 1.0 / cos(radians(20.0))


def helical(pinion=20.0, wheel=-20.0):
    angles = [
        (gear, "helix_angle_reference_diameter", angle, "deg")
        for gear, angle in ((rexs.PINION, pinion), (rexs.WHEEL, wheel))
        if angle is not None
    ]
    gone = [(gear, name, None) for gear in (rexs.PINION, rexs.WHEEL) for name in ("tip_diameter", "root_diameter")]
    gone += [
        (gear, "helix_angle_reference_diameter", None)
        for gear, angle in ((rexs.PINION, pinion), (rexs.WHEEL, wheel))
        if angle is None
    ]
    return rexs.with_values(rexs.paper_model(), *gone, *angles, (rexs.STAGE, "center_distance", 97.25, "mm"))


@pytest.mark.parametrize(
    ("angles", "hand"),
    [((20.0, -20.0), "right"), ((-20.0, 20.0), "left"), ((20.0, None), "right"), ((None, 20.0), "left")],
)
def test_helix_angle_and_hand(tmp_path, angles, hand):
    """ISO 21771: a positive angle is a right-hand helix; a mate without one has the other hand."""
    scene, found = scene_of(tmp_path, helical(*angles))
    assert (scene.gears.helix_angle, scene.gears.pinion_hand) == (pytest.approx(radians(20.0), rel=1e-15), hand)
    assert scene.three_dimensional and not assumed_fields(found) & {"gears.helix_angle", "gears.pinion_hand"}


def test_circles_and_shifts_count_in_normal_modules(tmp_path):
    """d_a = m_n (z/cos(beta) + 2 (x + 1)), d_f = m_n (z/cos(beta) + 2 (x - 1.25))."""
    model = rexs.with_values(helical(), (rexs.PINION, "reference_circle_diameter", 72.0 * STRETCH, "mm"))
    scene, _ = scene_of(tmp_path, model)
    pinion = scene.gears.pinion
    assert pinion.tip_diameter == pytest.approx(4.5 * (16 * STRETCH + 2 * 1.196), rel=1e-11)
    assert pinion.root_diameter == pytest.approx(4.5 * (16 * STRETCH + 2 * (0.196 - 1.25)), rel=1e-11)
    assert gear_pair(scene.gears).pinion.dedendum == pytest.approx(1.25 * 4.5, rel=1e-10)
    assert "which give 76.6208 mm" in refused(
        tmp_path, rexs.with_value(model, rexs.PINION, "reference_circle_diameter", 72.0, "mm")
    )


def test_missing_shift_of_a_helical_gear_follows_from_the_centre_distance(tmp_path):
    """At the centre distance without backlash, which geometry.pair computes, the other gear's shift comes out."""
    touching = gear_pair(scene_of(tmp_path, helical())[0].gears).centre_distance_without_backlash
    model = rexs.with_values(
        helical(),
        *((flank, "addendum_modification_coefficient", None) for flank in rexs.WHEEL_FLANKS),
        (rexs.STAGE, "center_distance", touching, "mm"),
    )
    scene, found = scene_of(tmp_path, model)
    assert scene.gears.wheel.profile_shift == pytest.approx(0.125, abs=1e-8)
    assert "gears.wheel.profile_shift" in assumed_fields(found)


@pytest.mark.parametrize("angles", [(20.0, 20.0), (20.0, -19.0), (20.0, 0.0)])
def test_helices_that_do_not_mesh_are_refused(tmp_path, angles):
    """Gears on parallel axes have one helix angle and opposite hands."""
    said = refused(tmp_path, helical(*angles))
    assert "helix_angle_reference_diameter of component 5 is 20.0 deg" in said and "opposite signs" in said


def with_modification(kind, *attributes):
    model = rexs.with_component(rexs.paper_model(), 40, kind, *attributes)
    return rexs.on_flanks(model, 40, rexs.PINION_FLANKS)


def crowning(datum=6.0, other=6.0, at=None):
    """Attributes of a crowning in um; `at`: coordinates, mm."""
    places = (
        []
        if at is None
        else [
            (f"coordinate_where_helix_crowning_is_specified_{face}", place, "mm")
            for face, place in zip(("datum_face", "non_datum_face"), at)
        ]
    )
    return [
        ("helix_crowning_amount_datum_face", datum, "mum"),
        ("helix_crowning_amount_non_datum_face", other, "mum"),
        *places,
    ]


def end_relief(face, depth=10.0, length=4.0, shape="linear"):
    return [
        (f"end_relief_depth_{face}", depth, "mum"),
        (f"end_relief_length_{face}", length, "mm"),
        ("shape_of_relief", shape),
    ]


def loaded(model, side):
    return rexs.with_value(model, rexs.PINION_DATA, "loaded_tooth_flank", side)


def lead_of(tmp_path, model):
    scene, found = scene_of(tmp_path, model)
    assert scene.lead_modifications.wheel is None and not found.left_out
    return scene.lead_modifications.pinion


def test_a_wider_gear_has_its_lead_modifications_over_its_own_face(tmp_path):
    """As a scene takes them; the file's common width is that of the narrower mate. A circular end relief is parabolic
    as a tip relief is."""
    model = rexs.with_values(
        with_modification("helix_crowning", *crowning(at=(-9.0, 9.0))),
        (rexs.PINION, "face_width", 18.0, "mm"),
        (rexs.STAGE, "common_face_width", 15.0, "mm"),
    )
    scene, _ = scene_of(tmp_path, model)
    assert scene.gears.face_widths == (18.0, 15.0)
    assert scene.lead_modifications.pinion == LeadModification(crowning=pytest.approx(0.006))
    model = loaded(with_modification("end_relief_datum_face", *end_relief("datum_face", shape="circular")), "left")
    assert lead_of(tmp_path, model).end_relief.shape == "parabolic"


def test_crowning(tmp_path):
    """Height at the ends of the face (15 mm): given at 5 mm from mid-width it is (7.5/5)^2 as high."""
    assert lead_of(tmp_path, with_modification("helix_crowning", *crowning())) == LeadModification(crowning=0.006)
    assert lead_of(tmp_path, with_modification("helix_crowning", *crowning(at=(-7.5, 7.5)))) == LeadModification(
        crowning=0.006
    )
    inner = lead_of(tmp_path, with_modification("helix_crowning", *crowning(at=(-5.0, 5.0))))
    assert inner.crowning == pytest.approx(0.006 * 2.25, rel=1e-11)


@pytest.mark.parametrize(
    ("side", "ends"),
    [
        ("left", {"datum_face": "right", "non_datum_face": "left"}),
        ("right", {"datum_face": "left", "non_datum_face": "right"}),
    ],
)
def test_end_relief_is_at_the_end_that_the_loaded_flank_says(tmp_path, side, ends):
    """A pinion whose left flank drives, seen from its datum face, turns counter-clockwise: that face is the right
    end."""
    for face, end in ends.items():
        model = loaded(with_modification(f"end_relief_{face}", *end_relief(face, shape="parabolic")), side)
        assert lead_of(tmp_path, model) == LeadModification(end_relief=EndRelief(0.01, 4.0, end, "parabolic"))


def test_helix_slope_has_the_sign_of_the_end(tmp_path):
    """Removed towards the face opposite the datum face; over a shorter evaluation it is steeper over the face."""
    slope = with_modification("helix_slope", ("helix_slope", 8.0, "mum"))
    assert lead_of(tmp_path, loaded(slope, "right")).helix_slope == pytest.approx(0.008, rel=1e-11)
    assert lead_of(tmp_path, loaded(slope, "left")).helix_slope == pytest.approx(-0.008, rel=1e-11)
    shorter = with_modification(
        "helix_slope",
        ("helix_slope", 8.0, "mum"),
        ("helix_evaluation_start", -6.0, "mm"),
        ("helix_evaluation_end", 6.0, "mm"),
    )
    scene, found = scene_of(tmp_path, loaded(shorter, "right"))
    assert scene.lead_modifications.pinion.helix_slope == pytest.approx(0.010, rel=1e-11)
    assert "lead_modifications.pinion.helix_slope" in assumed_fields(found)


REFUSED = [
    (
        with_modification("helix_crowning", *crowning(6.0, 5.0)),
        ["helix_crowning_amount_datum_face = 6.0 um at 7.5 mm, 5.0 um at 7.5 mm", "the same amount at both"],
    ),
    (with_modification("helix_crowning", *crowning(at=(-7.5, 5.0))), ["at 7.5 mm", "at 5 mm"]),
    (
        with_modification("helix_crowning", *crowning(), ("helix_highest_point", 2.0, "mm")),
        ["helix_highest_point = 2.0", "0 or false"],
    ),
    (with_modification("helix_crowning"), ["helix_crowning_amount_datum_face is missing"]),
    (
        loaded(with_modification("end_relief_datum_face", *end_relief("datum_face", shape="logarithmic")), "left"),
        ["shape_of_relief = logarithmic", "linear, parabolic or circular"],
    ),
    (
        loaded(with_modification("end_relief_datum_face", *end_relief("datum_face", depth=-1.0)), "left"),
        ["end_relief_depth_datum_face = -1.0 um is negative"],
    ),
    (
        loaded(with_modification("end_relief_datum_face", *end_relief("datum_face", length=0.0)), "left"),
        ["end_relief_length_datum_face = 0.0 mm is not positive"],
    ),
    (
        rexs.with_value(with_modification("helix_crowning", *crowning()), rexs.STAGE, "common_face_width", 14.0, "mm"),
        ["common_face_width is 14.0 mm", "lead modifications"],
    ),
]


@pytest.mark.parametrize(("model", "words"), REFUSED, ids=[words[0] for _, words in REFUSED])
def test_modifications_that_a_scene_has_no_like_of_are_refused(tmp_path, model, words):
    """Component, attribute, value and what is allowed."""
    said = refused(tmp_path, model)
    assert all(each in said for each in words), said
