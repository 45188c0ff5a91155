"""Gears as drawings give them."""

import tomllib
from dataclasses import replace
from math import atan, cos, degrees, pi, radians, tan
from pathlib import Path

import pytest
from tests.drawn_pairs import PAIRS, figures, table

from fenics_gears import RACKS, GeometryError, SceneError, build_scene, gear_pair, load_scene, model_of, scene_from_text
from fenics_gears.geometry.characteristics import characteristics
from fenics_gears.geometry.gear_data import MATERIALS
from fenics_gears.scene.data import Material

ROOT = Path(__file__).parents[2]
BORE = {"bore_diameter": "15 mm"}
PINION, WHEEL = {"teeth": 19, "profile_shift": 0.3, **BORE}, {"teeth": 31, "profile_shift": 0.1, **BORE}


def scene_of(gears=None, pinion=None, wheel=None, **sections):
    """A scene of a short drawing with changes; None leaves out."""
    pair = {"module": "3 mm", "pressure_angle": "20 deg", "face_width": "20 mm", "material": "steel", **(gears or {})}
    load = {"load": {"wheel_torque": "50 N m"}}
    return build_scene(
        {"gears": pair | {"pinion": PINION | (pinion or {}), "wheel": WHEEL | (wheel or {})}} | load | sections
    )


def pair_of(*changes, **sections):
    return gear_pair(scene_of(*changes, **sections).gears)


def derived(scene) -> dict:
    return {each.name: each.value for each in scene.derived}


@pytest.mark.parametrize(
    ("title", "figure"), [(title, figure) for title, pair in PAIRS.items() for figure in pair.printed]
)
def test_every_figure_of_a_published_pair_follows_from_its_drawing(title, figure):
    """The source that tests/drawn_pairs.py names, to half a unit of the last digit."""
    printed = PAIRS[title].printed[figure]
    assert figures(PAIRS[title])[figure] == pytest.approx(
        float(printed), abs=0.51 * 10.0 ** -len(printed.partition(".")[2])
    )


@pytest.mark.parametrize("title", PAIRS)
def test_the_page_shows_these_figures(title):
    """Identity with ``python -m tests.drawn_pairs``."""
    page = (ROOT / "docs" / "evidence" / "geometry.md").read_text()
    assert "\n".join(table(PAIRS[title])) in page


def test_the_page_s_scene_is_the_demo():
    """Identity; 15 kW at 1500 rpm of the pinion are 95.49 N m."""
    demo = load_scene(ROOT / "demos" / "from_a_drawing.toml")
    page = (ROOT / "docs" / "drawing.md").read_text().partition("```toml\n")[2].partition("```")[0]
    of_page = build_scene(tomllib.loads(page))
    assert (of_page.gears, of_page.load, of_page.derived) == (demo.gears, demo.load, demo.derived)
    assert demo.load.wheel_torque == pytest.approx(2.0 * 95.493e3, rel=1e-5)


IN_ROTATION = degrees(atan(tan(radians(20.0)) / cos(radians(30.0))))


@pytest.mark.parametrize(
    ("helix_angle", "own"),
    [
        (None, {"diametral_pitch": "8 1/in"}),
        (None, {"transverse_module": "3.175 mm"}),
        ("30 deg", {"transverse_module": f"{3.175 / cos(radians(30.0))!r} mm"}),
        ("30 deg", {"diametral_pitch": f"{8.0 * cos(radians(30.0))!r} 1/in"}),
        ("30 deg", {"normal_diametral_pitch": "8 1/in"}),
        ("30 deg", {"transverse_pressure_angle": f"{IN_ROTATION!r} deg", "module": "3.175 mm"}),
    ],
)
def test_inches_and_the_plane_of_rotation_give_the_same_teeth(helix_angle, own):
    """Identity: P = 25.4 mm/m (ANSI/AGMA 1012), m_n = m_t cos(beta), tan(alpha_n) = tan(alpha_t) cos(beta) (ISO 21771);
    what is derived is told."""
    modules = {"module": None, "helix_angle": helix_angle}
    angle = {"pressure_angle": None} if "transverse_pressure_angle" in own else {}
    scene, usual = scene_of(modules | angle | own), scene_of({"module": "3.175 mm", "helix_angle": helix_angle})
    assert (scene.gears.module, scene.gears.pressure_angle) == (
        pytest.approx(3.175, rel=1e-14),
        pytest.approx(pi / 9.0, rel=1e-14),
    )
    assert gear_pair(scene.gears).contact_ratio == pytest.approx(gear_pair(usual.gears).contact_ratio, rel=1e-12)
    told = derived(scene)
    assert told.get("module", 3.175) == pytest.approx(3.175) and told.get("pressure angle", 20.0) == pytest.approx(20.0)
    assert {"module", "pressure angle"} & told.keys()


def test_diametral_pitch_counts_teeth_per_inch():
    """By definition: 17 teeth of pitch 10 are on a reference diameter of 1.7 in. Rules that compare with the module, as
    those of errors, know it too; a changed scene is written with its module."""
    gears = {"module": None, "diametral_pitch": "10 1/in"}
    scene = scene_of(gears, {"teeth": 17})
    assert 2.0 * gear_pair(scene.gears).pinion.reference_radius == pytest.approx(1.7 * 25.4, rel=1e-14)
    with pytest.raises(
        SceneError, match="too large an error of manufacture or modification for a module of 2.54 mm[.]"
    ):
        scene_of(gears, {"teeth": 17}, eccentricity={"pinion": {"distance": "12 mil"}})
    loaded = replace(scene, load=replace(scene.load, wheel_torque=60e3))
    assert scene_from_text(loaded.text).gears == scene.gears


@pytest.mark.parametrize("shifts", [(0.3, 0.1), (0.6, 0.5), (0.2, -0.5)])
@pytest.mark.parametrize("helix_angle", [None, "20 deg"])
@pytest.mark.parametrize("profile", RACKS)
def test_without_a_word_gears_have_no_backlash_and_the_rack_s_clearance(shifts, helix_angle, profile):
    """ISO 21771, working pressure angle and k: no backlash, tip clearances of the rack's dedendum less its addendum."""
    pair = pair_of(
        {"helix_angle": helix_angle, "rack": {"profile": profile}},
        {"profile_shift": shifts[0]},
        {"profile_shift": shifts[1]},
    )
    assert pair.backlash == pytest.approx(0.0, abs=1e-12)
    assert pair.tip_clearances == pytest.approx([3.0 * (RACKS[profile][1] - RACKS[profile][0])] * 2, abs=1e-9)


@pytest.mark.parametrize("helix_angle", [None, "20 deg"])
def test_backlash_thins_both_gears_alike(helix_angle):
    """Geometry: j_wt cos(alpha_wt) along the line of action, half of it by each gear."""
    scene, plain = (scene_of({"helix_angle": helix_angle, "backlash": backlash}) for backlash in ("0.12 mm", None))
    rows = {name: value for name, value, _ in characteristics(gear_pair(scene.gears))}
    assert rows["circumferential backlash at the pitch circles (j_wt)"] == pytest.approx(0.12, abs=1e-12)
    thinner = [
        before.profile_shift - after.profile_shift
        for before, after in zip((plain.gears.pinion, plain.gears.wheel), (scene.gears.pinion, scene.gears.wheel))
    ]
    assert thinner[0] == pytest.approx(thinner[1], rel=1e-9) and thinner[0] > 0.0
    assert (scene.gears.centre_distance, scene.gears.pinion.tip_diameter) == (
        plain.gears.centre_distance,
        plain.gears.pinion.tip_diameter,
    )
    # One rack cuts flanks and root: its dedendum is that of ISO 53 A.
    assert gear_pair(scene.gears).pinion.dedendum == pytest.approx(1.25 * 3.0, rel=1e-12)


def test_what_a_caliper_reads_is_told_for_the_span_that_is_asked_for():
    """KHK Gear Technical Reference, m 3, z 24, x 0.4: 32.8266 mm over 4 teeth; neighbour spans differ by the base
    pitch."""
    spans = [
        derived(scene_of(wheel={"teeth": 24, "profile_shift": 0.4, "spanned_teeth": k}))[
            f"wheel base tangent length over {k} teeth"
        ]
        for k in (3, 4)
    ]
    assert spans[1] == pytest.approx(32.8266, abs=6e-5)
    assert spans[1] - spans[0] == pytest.approx(3.0 * pi * 0.9396926207859084, rel=1e-12)


def test_power_and_pinion_torque_are_a_torque_on_the_wheel():
    """P = T omega and T2 = T1 z2/z1."""
    power = scene_of(load={"power": "20 kW"}, motion={"pinion_speed": "1500 rpm"})
    assert power.load.wheel_torque == pytest.approx(20e6 / (2.0 * pi * 25.0) * 31 / 19, rel=1e-12)
    assert scene_of(load={"pinion_torque": "19 N m"}).load.wheel_torque == pytest.approx(31e3, rel=1e-14)


@pytest.mark.parametrize(
    ("name", "factor"),
    [
        ("steel", 189.8),
        ("cast steel", 188.9),
        ("ductile cast iron", 181.4),
        ("grey cast iron", 162.0),
        ("tin bronze", 159.8),
        ("cast tin bronze", 155.0),
    ],
)
def test_materials_have_the_standard_s_elasticity_factor_with_steel(name, factor):
    """ISO 6336-2: Z_E = 1/sqrt(pi ((1 - nu1^2)/E1 + (1 - nu2^2)/E2)) for a steel mate."""
    compliances = [
        (1.0 - each.poissons_ratio**2) / each.youngs_modulus for each in (MATERIALS[name][0], MATERIALS["steel"][0])
    ]
    assert (pi * sum(compliances)) ** -0.5 == pytest.approx(factor, abs=0.05)


def test_materials_go_by_name():
    """Identity; a number goes before the name's, a gear's own name before what both share."""
    scene = scene_of(wheel={"material": {"name": "POM", "poissons_ratio": 0.4}})
    assert scene.gears.materials == (Material(206e3, 0.3), Material(2.9e3, 0.4))
    assert scene_of({"material": {"youngs_modulus": "206 GPa", "poissons_ratio": 0.3}}).gears == scene_of().gears


MEASURED = {"tooth_thickness": "5.3 mm"}
WRONG = {
    "two measures": ({}, {**MEASURED, "base_tangent_length": "32 mm", "spanned_teeth": 3}, {},
        'base_tangent_length = "32 mm"\n    is given together with tooth_thickness'),
    "no span": ({}, {"base_tangent_length": "23 mm"}, {}, "gears.pinion.spanned_teeth\n    is missing"),
    "no ball": ({}, {}, {"dimension_over_balls": "101 mm"}, "gears.wheel.ball_diameter\n    is missing"),
    "another span": ({}, {"profile_shift": None, "base_tangent_length": "23.6 mm", "spanned_teeth": 4}, {},
        "profile shift of -3.994; allowed are 2 modules"),
    "another gear": ({}, {"tooth_thickness": "8 mm"}, {},
        "allowed are 0.5 modules more or less than profile_shift = 0.3"),
    "a span off the involute": ({}, {"base_tangent_length": "59.2 mm", "spanned_teeth": 7}, {},
        "off the involute, which goes from"),
    "balls within the base circle": ({}, {"dimension_over_balls": "57 mm", "ball_diameter": "5 mm"}, {},
        "the centres of the balls would lie within the base circle"),
    "balls that do not stand out": ({}, {"dimension_over_balls": "61.2 mm", "ball_diameter": "4 mm"}, {},
        "the balls lie within the tip circle"),
    "backlash beside one measured gear": ({"backlash": "0.1 mm"}, MEASURED, {},
        'gears.backlash = "0.1 mm"\n    is given together with gears.pinion.tooth_thickness'),
    "backlash beside all that gives it": ({"backlash": "0.1 mm", "centre_distance": "77 mm"}, MEASURED, MEASURED,
        "and gears.centre_distance"),
    "less backlash than there is": ({"backlash": "0.1 mm", "centre_distance": "78 mm"}, {}, {}, "already have"),
    "tip shortening beside tip diameters": ({"tip_shortening": 0.1}, {"tip_diameter": "64 mm"},
        {"tip_diameter": "99 mm"}, "say the same"),
    "a negative tip shortening": ({"tip_shortening": -0.1}, {}, {}, "It is -k"),
    "a dedendum twice": ({}, {"root_diameter": "51 mm", "rack": {"dedendum": 1.25}}, {},
        "is given together with gears.pinion.root_diameter"),
    "a rack of another standard": ({"rack": {"profile": "ISO 53 E"}}, {}, {},
        'is not known. Did you mean "ISO 53 D"?'),
    "an unknown material": ({"material": "stel"}, {}, {}, 'Did you mean "steel"?'),
    "half a material": ({"material": {"youngs_modulus": "206 GPa"}}, {}, {},
        "gears.material.poissons_ratio\n    is missing"),
    "a pointed tip": ({}, {"teeth": 12, "profile_shift": 1.1}, {"profile_shift": -1.1}, "pointed tip"),
}  # fmt: skip


@pytest.mark.parametrize("kind", WRONG)
def test_a_drawing_that_cannot_be_is_refused(kind):
    """The rule that the message names."""
    *changes, message = WRONG[kind]
    with pytest.raises(SceneError) as caught:
        pair_of(*changes)
    assert message in str(caught.value)


@pytest.mark.parametrize(
    ("sections", "message"),
    [
        ({"load": {}}, "load.wheel_torque\n    is missing"),
        ({"load": {"wheel_torque": "1 N m", "pinion_torque": "1 N m"}}, "is given together with wheel_torque"),
        ({"load": {"power": "1 kW"}}, "needs a speed"),
        (
            {"load": {"power": "-1 kW"}, "motion": {"pinion_speed": "100 rpm"}},
            'load.power = "-1 kW"\n    is negative: it drives the pair from the wheel',
        ),
    ],
)
def test_a_load_is_given_once_and_a_power_at_a_speed(sections, message):
    """As above."""
    with pytest.raises(SceneError) as caught:
        scene_of(**sections)
    assert message in str(caught.value)


def remarks(*changes) -> list[str]:
    return [each.unusual for each in scene_of(*changes).derived if each.unusual]


def test_a_centre_distance_that_is_off_is_remarked():
    """ISO/TR 10064-2, annex A: at least 0.125 mm at 76 mm and 3 mm; half a millimetre takes 2 tan(alpha_wt) times as
    much, and the tips' clearance."""
    fitting = scene_of({"backlash": "0.12 mm"}).gears.centre_distance

    def nearer(by: float) -> list[str]:
        return remarks({"backlash": "0.12 mm", "centre_distance": f"{fitting - by:.4f} mm"})

    assert remarks({"backlash": "0.12 mm"}) == nearer(0.1) == []
    found = nearer(0.5)
    assert len(found) == 1
    for words in (
        "0.5 mm less than",
        "overlap by 0.398",
        "gears.backlash = 0.12 mm",
        "less than 0.13 mm",
        "check gears.",
    ):
        assert words in found[0]
    found = nearer(0.7)
    assert len(found) == 2 and "tips were shortened by 0.2" in found[1]


def test_measures_that_stand_for_unusual_shifts_are_remarked():
    """DIN 3960, pi m/2 + 2 x m tan(alpha): 8.2 mm at 3 mm are x = 1.6; beside x = 0.3, 6 mm are 0.632 mm too much."""
    assert remarks(None, {"profile_shift": None, "tooth_thickness": "5.1 mm"}) == []
    (alone,) = remarks({"centre_distance": "80 mm"}, {"profile_shift": None, "tooth_thickness": "7.4 mm"})[:1]
    assert "1.23 modules; usual are -0.5 to 1" in alone
    (beside,) = remarks({"centre_distance": "77.5 mm"}, {"tooth_thickness": "6 mm"})[:1]
    assert "0.632 mm more than that of profile_shift" in beside


def test_a_centre_distance_that_leaves_no_teeth_is_named():
    """ISO 21771: 3 (19 + 31)/(2 cos 44 deg) = 104.262 mm; no tip diameter would help."""
    with pytest.raises(GeometryError, match=r"pair: centre distance 76 mm, .* have 104.262 mm: .* gears.centre_dist"):
        scene_of({"helix_angle": "44 deg", "pinion_hand": "right", "centre_distance": "76 mm"})


def test_profile_shifts_that_fit_at_no_centre_distance_are_named():
    """inv(alpha_wt) = 0 is at a sum of -(z1 + z2) inv(20 deg)/(2 tan 20 deg) = -1.024 for 50 teeth."""
    below = {"profile_shift": -0.6}
    with pytest.raises(
        GeometryError, match=r"shifts of -0.6 and -0.6 .* sum must be above -1.024 .* gears.pinion.prof"
    ):
        scene_of(None, below, below)


def rows_of(scene):
    return {name: value for name, value, _ in characteristics(gear_pair(scene.gears), scene.measured_over)}


def test_measures_are_over_the_ball_and_the_teeth_of_the_drawing():
    """KHK's worked example, helical 20/15 deg, x = 0.4 over balls of 2 mm: 24.5696; one measure of a gear, not two."""
    gears = {"module": "1 mm", "helix_angle": "15 deg", "face_width": "10 mm"}
    given = {"profile_shift": 0.4, "ball_diameter": "2 mm", "spanned_teeth": 3, "bore_diameter": "5 mm"}
    scene = scene_of(gears, {"teeth": 20, **given}, {"teeth": 21, **given})
    rows = rows_of(scene)
    assert rows["pinion dimension over balls of 2 mm (M_d)"] == pytest.approx(24.5696, abs=5e-5)
    for name, value in derived(scene).items():
        if "over balls" in name or "tangent length" in name:
            ending = "(M_d)" if "balls" in name else "(W_k)"
            assert rows[f"{name} {ending}"] == pytest.approx(value, rel=1e-12)
    assert sum("over balls" in name for name in rows) == 2


def test_backlash_that_is_round_off_is_none_whatever_it_is_along():
    """A centre distance rounded to 0.001 um: along the line of action, circles and normal 0 mm, never below."""
    gears = {"module": "3 mm", "helix_angle": "30 deg", "centre_distance": "125 mm"}
    scene = scene_of(
        gears, {"teeth": 12, "profile_shift": 0.09809, "bore_diameter": "15 mm"}, {"teeth": 60, "profile_shift": 0}
    )
    rows = rows_of(scene)
    assert gear_pair(scene.gears).circumferential_backlash < -1e-6
    for name in ("backlash along the line of action", "normal backlash (j_bn)"):
        assert rows[name] == 0.0
    assert rows["circumferential backlash at the pitch circles (j_wt)"] == 0.0


LONG_TEETH = {"rack": {"addendum": 1.53, "dedendum": 1.7, "tip_radius": 0.2}}
ALIKE = {"teeth": 28, "profile_shift": 0}


@pytest.mark.parametrize("gears, letters", [({}, "STC"), (LONG_TEETH, "DTC")])
def test_points_of_contact_by_the_fewest_pairs_have_its_name(gears, letters):
    """Counting pairs of rigid gears on the path of contact: as few as the name says between the points, one more just
    outside; where no pair is ever alone a relief from HPSTC is remarked on."""
    relief = {"tip_relief": {"depth": "10 um", "start": "HPSTC"}}
    scene = scene_of(gears, ALIKE, ALIKE, **relief)
    pair, rows = gear_pair(scene.gears), rows_of(scene)
    fewest = {"STC": 1, "DTC": 2}[letters]

    def pairs_at(roll):
        """In contact while one of them is there."""
        position = roll * pair.pinion.base_radius
        places = [position + k * pair.base_pitch for k in range(-4, 5)]
        return sum(pair.path_start <= place <= pair.path_end for place in places)

    low, high = (rows[f"pinion roll angle, {end}{letters}"] * pi / 180.0 for end in ("LP", "HP"))
    assert pairs_at(low + 1e-6) == pairs_at(high - 1e-6) == fewest
    assert pairs_at(low - 1e-6) == pairs_at(high + 1e-6) == fewest + 1
    said = [each for each in model_of(scene).warnings if "no tooth pair is ever alone" in each]
    assert len(said) == (letters == "DTC") and all(
        "highest point of double tooth contact (HPDTC)" in one for one in said
    )
