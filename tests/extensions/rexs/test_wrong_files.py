"""Files that make no scene: the specification's rules, with component, attribute, value and what is allowed."""

import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.extensions.rexs import paper_model as rexs
from tests.extensions.rexs.test_lookups import changed, refused, with_relief
from tests.extensions.rexs.test_paper_pair import imported

from fenics_gears import SceneError
from fenics_gears.extensions.rexs import read

P, W, FLANK, MATERIAL = rexs.PINION, rexs.WHEEL, rexs.PINION_FLANKS[0], rexs.MATERIAL

WRONG_VALUES = [
    (
        (P, "normal_module", "abc", "mm"),
        "component 5 (cylindrical_gear 'pinion'): normal_module = abc mm does not begin with a number",
    ),
    ((P, "normal_module", "4,5", "mm"), "the decimal sign is a point"),
    ((P, "normal_module", 4.5, "furlong"), 'normal_module = 4.5 furlong has the unknown unit "furlong"'),
    ((P, "normal_module", 4.5, "none"), "normal_module = 4.5 none has no unit. Allowed: a unit of the kind of mm"),
    ((P, "normal_module", 4.5, "deg"), "normal_module = 4.5 deg is an angle, not a length"),
    ((P, "normal_module", -4.5, "mm"), "normal_module = -4.5 mm is not positive"),
    ((P, "normal_module", [4.5, 4.5], "mm"), "normal_module is an array of 2 values. Allowed: one value"),
    ((P, "normal_module", float("inf"), "mm"), "normal_module = inf mm is not a finite number"),
    (
        (W, "normal_module", 5.0, "mm"),
        "normal_module of component 5 is 4.5 mm, but normal_module of component 6 is 5.0 mm",
    ),
    ((P, "number_of_teeth", 16, "mm"), "number_of_teeth = 16 mm is not a whole number without unit"),
    ((P, "inner_diameter", -1.0, "mm"), "inner_diameter = -1.0 mm is negative"),
    (
        (FLANK, "normal_pressure_angle", 25.0, "deg"),
        "normal_pressure_angle of component 7 is 25.0 deg, but normal_pressure_angle of component 8 is 20.0 deg",
    ),
    (
        (FLANK, "addendum_modification_coefficient", 0.2),
        "component 5 (cylindrical_gear 'pinion') has contradictory profile shifts",
    ),
    ((FLANK, "addendum_modification_coefficient", 0.196, "mm"), 'has the unit "mm". Allowed: "none" or "%"'),
    (
        (rexs.STAGE, "sum_of_addendum_modification_coefficients", 0.4),
        "contradicts the profile shifts of its gears, 0.196 and 0.125",
    ),
    ((rexs.PINION_TOOL, "normal_module", 4.0, "mm"), "The tool has another module than the gear"),
    ((MATERIAL, "density", 7.85, "kg / m"), "density = 7.85 kg / m is"),
    ((rexs.LOAD, "torque_around_u_axis", None), "no torque. Its gears, 5 and 6, have none in their stage data"),
]


@pytest.mark.parametrize("change, words", WRONG_VALUES, ids=[f"{change[1]}={change[2]}" for change, _ in WRONG_VALUES])
def test_wrong_values_are_named(tmp_path, change, words):
    said = refused(tmp_path, changed(change))
    assert words in said and "Nothing was written." in said


@pytest.mark.parametrize(
    "array, words",
    [
        ({"code": "float16", "value": "AAAA"}, 'is an array with the code "float16". Allowed: float32, float64, int32'),
        ({"code": "float32", "value": "AAAA"}, "is no array of float32 in base64: buffer size must be"),
        ({"code": "float64", "value": "no base64!"}, "is no array of float64 in base64"),
        ({"code": "float32", "value": "MveeQZ6hM0I"}, "is an array of 2 values. Allowed: one value"),
    ],
)
def test_wrong_arrays_are_named(tmp_path, array, words):
    """An unknown code, bytes that are no whole numbers, no base64, more than one value (the specification's
    example)."""
    model = rexs.paper_model()
    module = next(each for each in rexs.component(model, P)["attributes"] if each["id"] == "normal_module")
    del module["floating_point"]
    module["floating_point_array_coded"] = array
    for content in (rexs.as_json(model), rexs.as_xml(model)):
        with pytest.raises(SceneError) as raised:
            imported(tmp_path, content)
        assert f"component 5 (cylindrical_gear 'pinion'): normal_module {words}" in str(raised.value)


def test_all_mistakes_are_told_at_once(tmp_path):
    """What only follows from three mistakes is not repeated."""
    said = refused(
        tmp_path, changed((P, "normal_module", None), (W, "face_width", 15.0, "kg"), (MATERIAL, "poisson_ratio", None))
    )
    assert said.count("file.rexs: ") == 3 and "3 mistakes in " in said


@pytest.mark.parametrize(
    "values, words",
    [
        (
            {"datum_diameter": (79.0, "deg")},
            "component 40 (tip_relief): tip_relief_datum_diameter = 79.0 deg is an angle, not a length",
        ),
        ({"depth": (-5.0, "mum")}, "tip_relief_depth = -5.0 um is not positive"),
        (
            {"shape_of_relief": ("exponential",)},
            "shape_of_relief = exponential. Allowed: linear, parabolic or circular",
        ),
        (
            {"datum_length": (25.0, "mm")},
            "tip_relief_datum_length = 25.0 mm is no length of roll of this flank. Allowed: above 0 and below 23.7",
        ),
        (
            {"datum_length": (3.0, "mm")},
            "tip_relief_datum_diameter = 79.0 mm contradicts tip_relief_datum_length = 3.0 mm, which starts at 7",
        ),
        (
            {"evaluation_reference": (79.0, "mm")},
            "tip_relief_evaluation_reference = 79.0 mm does not lie outside the start of the relief, 79 mm",
        ),
    ],
)
def test_wrong_reliefs_are_named(tmp_path, values, words):
    """A relief has a start, by one attribute or another."""
    assert words in refused(tmp_path, with_relief(**values))
    model = rexs.with_value(with_relief("root_relief"), 40, "root_relief_datum_diameter", None)
    assert "root_relief_datum_diameter is missing (and root_relief_datum_length of component 40)" in refused(
        tmp_path, model
    )


def test_pairs_that_are_none(tmp_path):
    """Ring gears that drive, and other stages."""
    ring = rexs.paper_model()
    ring = rexs.with_values(
        ring, (rexs.PINION_DATA, "is_driving_gear", True), (rexs.WHEEL_DATA, "is_driving_gear", False)
    )
    rexs.component(ring, P)["type"] = "ring_gear"
    assert "component 5 (ring_gear 'pinion') is an internal gear and drives" in refused(tmp_path, ring)
    worm = rexs.paper_model()
    rexs.component(worm, rexs.STAGE)["type"] = "worm_stage"
    assert "has no pair of cylindrical gears" in refused(tmp_path, worm) and "Its stages are: worm_stage" in refused(
        tmp_path, worm
    )


def test_wrong_calls_are_refused(tmp_path):
    """What the call says in the file's place is a quantity of its kind."""
    assert '--wheel-torque "437 N" is a force, not a torque' in refused(
        tmp_path, rexs.paper_model(), wheel_torque="437 N"
    )
    assert '--pinion-speed "fast" does not begin with a number' in refused(
        tmp_path, rexs.paper_model(), pinion_speed="fast"
    )


def edited(old, new):
    content = rexs.as_xml(rexs.paper_model()).decode()
    assert old in content
    return content.replace(old, new, 1).encode()


BROKEN = {
    "empty": (b" \n", "is empty"),
    "cut off": (rexs.as_xml(rexs.paper_model())[:2000], "is not valid XML"),
    "other XML": (b"<svg/>", "its root is <svg>, not <model>"),
    "unknown encoding": (edited("utf-8", "klingon"), "is not valid XML"),
    "no JSON": (b'{"model": ', "is not valid JSON"),
    "other JSON": (b"[1, 2]", 'the file has no "model"'),
    "JSON of another shape": (b'{"model": {"version": "1.7", "components": {}}}', "components is not a list"),
    "deep JSON": (b"[" * 100_000, "is not valid JSON"),
    "not text": (b'{"model": "\xff"}', "is not valid JSON"),
    "unknown version": (edited('version="1.7"', 'version="9.0"'), '"9.0"; 1.0 to 2.0 are read'),
    "no version": (edited('version="1.7"', ""), "version is missing"),
    "number of a component": (
        edited('<component id="5"', '<component id="five"'),
        'components five, id = "five" is not a whole number',
    ),
    "component twice": (edited('<component id="5"', '<component id="6"'), "two components with the number 6"),
    "relation to nothing": (edited('<ref id="14"', '<ref id="99"'), "whose part is component 99, which is not there"),
    "attribute twice": (
        edited(
            '<attribute id="number_of_teeth"',
            '<attribute id="normal_module" unit="mm">5</attribute><attribute id="number_of_teeth"',
        ),
        "components 5, attributes has normal_module twice, with different values: 4.5 mm; 5 mm",
    ),
    "two models in one archive": (rexs.as_zip(("a.rexs", b""), ("b.rexsj", b"")), "but holds: a.rexs, b.rexsj"),
    "an archive that says it begins before its beginning": (
        rexs.as_zip(("a.rexs", b"x"))[:-6] + b"\xff\xff\xff\x7f\0\0",
        "cannot be unpacked: it is damaged",
    ),
    "an archive with a name that is no text": (
        rexs.as_zip(("\u03a9.rexs", b"x")).replace("\u03a9".encode(), b"\xb6\xb6"),
        "cannot be unpacked: it is damaged",
    ),
}


@pytest.mark.parametrize("case", BROKEN)
def test_broken_files_are_named_as_what_they_are(tmp_path, case):
    content, words = BROKEN[case]
    with pytest.raises(SceneError) as raised:
        imported(tmp_path, content)
    assert words in str(raised.value) and str(tmp_path / "file.rexs") in str(raised.value)


def test_missing_files_and_directories(tmp_path):
    for path, words in ((tmp_path / "none.rexs", "there is no such file"), (tmp_path, "cannot be read")):
        with pytest.raises(SceneError, match=words):
            read.read_model(path)


def test_entities_are_not_expanded_and_files_not_read(tmp_path):
    """Ten lines could fill the memory, or copy a file into a scene."""
    (tmp_path / "secret").write_text("42")
    laughs = "".join(f'<!ENTITY e{n} "{f"&e{n - 1};" * 10}">' for n in range(1, 12))
    for declarations, reference in (
        ('<!ENTITY e0 "ha">' + laughs, "&e11;"),
        (f'<!ENTITY e SYSTEM "file://{tmp_path}/secret">', "&e;"),
    ):
        content = (
            b"<?xml version='1.0'?><!DOCTYPE model ["
            + declarations.encode()
            + b"]>"
            + edited(">16<", f">{reference}<").split(b"?>", 1)[1]
        )
        with pytest.raises(SceneError, match="document type declaration"):
            imported(tmp_path, content)


def test_large_files_are_refused(tmp_path, monkeypatch):
    """Packed as well: an archive of kilobytes can hold gigabytes."""
    monkeypatch.setattr(read, "LARGEST", 10_000)
    for content in (b"<" + b" " * 20_000, rexs.as_zip(("a.rexs", b" " * 20_000))):
        with pytest.raises(SceneError, match="is not read"):
            imported(tmp_path, content)


@given(data=st.data())
def test_damaged_files_end_in_a_scene_or_in_a_sentence(tmp_path_factory, data):
    """Property: nothing but a SceneError."""
    form = data.draw(st.sampled_from([rexs.as_xml, rexs.as_json]))
    content = form(rexs.paper_model())
    for _ in range(data.draw(st.integers(1, 4))):
        start = data.draw(st.integers(0, len(content)))
        put = data.draw(
            st.one_of(
                st.binary(max_size=4),
                st.sampled_from([b'"', b"<", b"null", b"[]", b"{}", b"-", b"e9", b"true", b"\x00", b"5"]),
            )
        )
        content = content[:start] + put + content[start + data.draw(st.integers(0, 12)) :]
    try:
        imported(tmp_path_factory.mktemp("damaged"), content, stage=4)
    except SceneError as error:
        assert str(error).strip()


def test_what_does_not_hang_together_is_told_together(tmp_path):
    """A missing module hides no other mistake; shifts that both lack are one."""
    changes = (
        (P, "normal_module", None),
        (FLANK, "addendum_modification_coefficient", 0.2),
        (P, "tip_diameter", 80.0, "kg"),
    )
    said = refused(tmp_path, changed(*changes))
    assert (
        "3 mistakes" in said and "contradictory profile shifts" in said and "tip_diameter = 80.0 kg is a mass" in said
    )
    both = [(flank, "addendum_modification_coefficient", None) for flank in rexs.PINION_FLANKS + rexs.WHEEL_FLANKS]
    said = refused(tmp_path, changed(*both))
    assert (
        "1 mistake in" in said
        and "addendum_modification_coefficient is missing, for its flanks too, and so is that of component 6" in said
    )
    near = refused(tmp_path, changed(*both[:2], (rexs.STAGE, "center_distance", 80.0, "mm")))
    assert "center_distance = 80 mm is too small for 40 teeth of module 4.5 mm" in near


def test_parts_that_a_stage_cannot_have(tmp_path):
    bevel = rexs.paper_model()
    rexs.component(bevel, W)["type"] = "bevel_gear"
    assert "component 6 (bevel_gear 'wheel') is no cylindrical gear" in refused(tmp_path, bevel)
    twice = with_relief()
    twice = rexs.with_component(twice, 42, "tip_relief", reference={"origin": FLANK, "referenced": 42})
    assert "two components tip_relief, 40 and 42; a scene has one" in refused(tmp_path, twice)
    named = rexs.paper_model()
    rexs.component(named, W)["id"] = "six"
    with pytest.raises(SceneError, match='components six, id = "six" is not a whole number'):
        imported(tmp_path, rexs.as_json(named))
    with pytest.raises(SceneError, match="normal_module = false mm does not begin with a number"):
        imported(tmp_path, rexs.as_json(changed((P, "normal_module", False, "mm"))))
    with pytest.raises(SceneError, match="poisson_ratio = nan none is not a finite number"):
        imported(tmp_path, rexs.as_xml(changed((MATERIAL, "poisson_ratio", float("nan")))))
