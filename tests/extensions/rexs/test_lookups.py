"""Where a file does not give a value itself: what it follows from, what is assumed, which part is meant."""

import base64
from math import cos, radians, sqrt

import numpy as np
import pytest
from tests.extensions.rexs import paper_model as rexs
from tests.extensions.rexs.test_paper_pair import imported

from fenics_gears import SceneError, gear_pair
from fenics_gears.model.modification import removals
from fenics_gears.scene.data import Motion

GEARS = (rexs.PINION, rexs.WHEEL)


def scene_of(tmp_path, model, **choice):
    return imported(tmp_path, rexs.as_xml(model), **choice)


def assumed_fields(found):
    """The fields that were assumed, but for how long the run takes."""
    return {each.split(" = ")[0] for each in found.assumed} - {"motion.mesh_cycles"}


def changed(*changes):
    return rexs.with_values(rexs.paper_model(), *changes)


def refused(tmp_path, model, **choice):
    with pytest.raises(SceneError) as raised:
        scene_of(tmp_path, model, **choice)
    return str(raised.value)


def test_root_diameter_follows_from_the_tool(tmp_path):
    """d_f = m (z + 2 x - 2 h_aP0*), with the generating shift where the file has one (ISO 21771)."""
    model = changed(
        (rexs.PINION, "root_diameter", None), (rexs.PINION_TOOL, "addendum_coefficient_reference_profile", 1.4)
    )
    scene, found = scene_of(tmp_path, model)
    assert scene.gears.pinion.root_diameter == pytest.approx(4.5 * (16 + 2 * 0.196 - 2 * 1.4), rel=1e-12)
    assert not assumed_fields(found)
    scene, _ = scene_of(
        tmp_path, rexs.with_value(model, rexs.SETTINGS, "generated_addendum_modification_coefficient", 0.15)
    )
    assert scene.gears.pinion.root_diameter == pytest.approx(4.5 * (16 + 2 * 0.15 - 2 * 1.4), rel=1e-12)
    assert scene.gears.pinion.profile_shift == 0.196


def test_centre_distance_follows_from_the_profile_shifts(tmp_path):
    """At the one that is left out, the flanks touch on both sides: as of geometry.pair from the teeth's thicknesses.
    With a profile shift missing too, both are asked for."""
    model = changed((rexs.STAGE, "center_distance", None))
    scene, found = scene_of(tmp_path, model)
    pair = gear_pair(scene.gears)
    assert pair.centre_distance == pytest.approx(pair.centre_distance_without_backlash, rel=1e-11)
    assert assumed_fields(found) == {"gears.centre_distance"}
    missing = rexs.with_values(model, *((flank, "addendum_modification_coefficient", None) for flank in (9, 10)))
    words = "center_distance is missing (and addendum_modification_coefficient of component 6)"
    assert words in refused(tmp_path, missing)


def test_tooth_depth_gives_the_root(tmp_path):
    """Root diameter = tip diameter - 2 h."""
    scene, _ = scene_of(tmp_path, changed((rexs.WHEEL, "root_diameter", None), (rexs.WHEEL, "tooth_depth", 10.0, "mm")))
    assert scene.gears.wheel.root_diameter == pytest.approx(98.64, rel=1e-12)


def test_what_no_part_says_is_of_the_standard_and_told(tmp_path):
    """ISO 53, basic rack A; steel of ISO 6336-1; each is told as assumed."""
    model = rexs.paper_model()
    names = ("tip_diameter", "root_diameter", "inner_diameter", "helix_angle_reference_diameter")
    model = rexs.with_values(
        model, *((gear, name, None) for gear in GEARS for name in names), (rexs.SHAFT, "rotational_speed", None)
    )
    kept = [each for each in model["model"]["relations"] if each["type"] not in ("reference", "manufacturing_step")]
    model["model"]["relations"] = kept
    scene, found = scene_of(tmp_path, model)
    pinion = scene.gears.pinion
    assert pinion.tip_diameter == pytest.approx(4.5 * (16 + 2 * 0.196 + 2), rel=1e-12)
    assert pinion.root_diameter == pytest.approx(4.5 * (16 + 2 * 0.196 - 2.5), rel=1e-12)
    assert pinion.rack_tip_radius == 0.38
    assert (scene.gears.material.youngs_modulus, scene.gears.material.poissons_ratio) == (206e3, 0.3)
    fields = {
        f"gears.{gear}.{name}"
        for gear in ("pinion", "wheel")
        for name in ("tip_diameter", "root_diameter", "bore_diameter", "rack.profile")
    }
    assert assumed_fields(found) == fields | {"gears.material.name", "motion.pinion_speed"}
    assert found.text.count("# assumed: ") == len(found.assumed)


def test_each_gear_has_its_own_material_and_width(tmp_path):
    """Where they do not differ, it is the pair's."""
    model = rexs.with_component(
        changed((rexs.PINION, "face_width", 17.0, "mm")),
        21,
        "material",
        ("elastic_modulus", 70.0, "GPa"),
        ("poisson_ratio", 0.33),
    )
    reference = next(
        each
        for each in model["model"]["relations"]
        if each["type"] == "reference" and each["refs"][0]["id"] == rexs.WHEEL
    )
    reference["refs"][1]["id"] = 21
    gears = scene_of(tmp_path, model)[0].gears
    assert [(each.youngs_modulus, each.poissons_ratio) for each in gears.materials] == [(206e3, 0.3), (70e3, 0.33)]
    assert gears.face_widths == (17.0, 15.0) and gears.face_width == 15.0


@pytest.mark.parametrize("version", ["1.0", "1.1", "1.2"])
def test_older_versions_name_parts_otherwise(paper_scene, tmp_path, version):
    """REXS up to 1.2: flank_geometry, tools of gears, is_driving_gear."""
    model = rexs.paper_model()
    model["model"]["version"] = version
    for each in model["model"]["components"]:
        each["type"] = {
            "cylindrical_gear_flank": "flank_geometry",
            "cylindrical_stage_gear_data": "stage_gear_data",
        }.get(each["type"], each["type"])
    kept = [each for each in model["model"]["relations"] if each["type"] != "manufacturing_step"]
    tools = [
        rexs.relation(90 + tool, "ordered_reference", 1, origin=gear, referenced=tool)
        for gear, tool in ((rexs.PINION, rexs.PINION_TOOL), (rexs.WHEEL, rexs.WHEEL_TOOL))
    ]
    model["model"]["relations"] = kept + tools
    model = rexs.with_value(model, rexs.PINION_TOOL, "tip_radius_factor", 0.3)
    scene, _ = scene_of(tmp_path, model)
    assert scene.gears.pinion.rack_tip_radius == 0.3 and scene.gears.wheel == paper_scene.gears.wheel
    scene, _ = scene_of(
        tmp_path,
        rexs.with_values(
            model, (rexs.PINION_DATA, "is_driving_gear", False), (rexs.WHEEL_DATA, "is_driving_gear", True)
        ),
    )
    assert (scene.gears.pinion.teeth, scene.gears.wheel.teeth) == (24, 16)


def two_stages():
    """A further pair, whose pinion is on the paper's output shaft."""
    model = rexs.with_component(
        rexs.paper_model(),
        31,
        "cylindrical_gear",
        ("number_of_teeth", 20),
        assembly={"assembly": rexs.OUTPUT_SHAFT, "part": 31},
    )
    model = rexs.with_component(model, 32, "cylindrical_gear", ("number_of_teeth", 30))
    return rexs.with_component(model, 33, "cylindrical_stage", stage={"stage": 33, "gear_1": 31, "gear_2": 32})


def test_several_stages_are_listed_and_one_is_chosen(paper_scene, tmp_path):
    """The message has what to type."""
    words = refused(tmp_path, two_stages())
    assert (
        "--stage 4    test stage: cylindrical_gear 5 (16 teeth) and cylindrical_gear 6 (24 teeth)" in words
        and "--stage 33    " in words
    )
    assert "no stage of cylindrical gears with the number 5" in refused(tmp_path, two_stages(), stage=5)
    # The output shaft bears two gears: its torque is not the mesh's.
    assert "--wheel-torque" in refused(tmp_path, two_stages(), stage=4)
    assert scene_of(tmp_path, two_stages(), stage=4, wheel_torque="437 N m")[0].gears == paper_scene.gears


def test_torque_of_the_pinion_s_shaft_is_multiplied_and_of_the_stage_comes_first(tmp_path):
    """M2 = M1 z2/z1; the sign is that of the shaft's axis; stage data say it of the mesh itself."""
    model = rexs.with_component(
        changed((rexs.LOAD, "torque_around_u_axis", None), (rexs.LOAD, "transmits_torque", False)),
        35,
        "external_load",
        ("torque_around_u_axis", 200.0, "N m"),
        assembly={"assembly": rexs.SHAFT, "part": 35},
    )
    assert scene_of(tmp_path, model)[0].load.wheel_torque == pytest.approx(300e3, rel=1e-12)
    model = rexs.with_value(model, rexs.PINION_DATA, "torque", -150.0, "N m")
    assert scene_of(tmp_path, model)[0].load.wheel_torque == pytest.approx(225e3, rel=1e-12)


def with_load_cases(*torques):
    model = changed((rexs.LOAD, "torque_around_u_axis", None), (rexs.SHAFT, "rotational_speed", None))
    cases = [
        {"id": number, "components": [
            {"id": rexs.LOAD, "attributes": [rexs.attribute("torque_around_u_axis", torque, "N m")]},
            {"id": rexs.SHAFT, "attributes": [rexs.attribute("rotational_speed", 100.0 * number, "1 / min")]},
        ]}
        for number, torque in enumerate(torques, start=1)
    ]  # fmt: skip
    model["model"]["load_spectrum"] = {"id": 1, "load_cases": cases}
    return model


@pytest.mark.parametrize("form", [rexs.as_xml, rexs.as_json])
def test_load_cases(tmp_path, form):
    """The only case is taken; of several one is chosen; a call that says torque and speed needs none."""
    scene, _ = imported(tmp_path, form(with_load_cases(300.0)))
    assert (scene.load.wheel_torque, scene.motion) == (300e3, Motion(pytest.approx(100 / 60 * 16), 1, 1))
    with pytest.raises(SceneError, match="2 load cases; a scene has one. Choose it with --load-case: 1, 2"):
        imported(tmp_path, form(with_load_cases(300.0, 200.0)))
    with pytest.raises(SceneError, match='no load case "3". It has: 1, 2'):
        imported(tmp_path, form(with_load_cases(300.0, 200.0)), load_case="3")
    scene, _ = imported(tmp_path, form(with_load_cases(300.0, 200.0)), load_case="2")
    assert (scene.load.wheel_torque, scene.motion.mesh_frequency) == (200e3, pytest.approx(200 / 60 * 16))
    scene, _ = imported(tmp_path, form(with_load_cases(300.0, 200.0)), wheel_torque="1 kN m", pinion_speed="10 rev/s")
    assert (scene.load.wheel_torque, scene.motion.mesh_frequency) == (1e6, pytest.approx(160.0))


def with_relief(kind="tip_relief", sides=(0, 1), gear_flanks=rexs.PINION_FLANKS, **values):
    attributes = {"depth": (31.0, "mum"), "datum_diameter": (79.0, "mm"), **values}
    given = [
        (name if name.startswith(("shape", "specify")) else f"{kind}_{name}", *value)
        for name, value in attributes.items()
    ]
    model = rexs.with_component(rexs.paper_model(), 40, kind, *given)
    return rexs.on_flanks(model, 40, [gear_flanks[side] for side in sides])


def test_reliefs(tmp_path):
    """Depth, start and shape are those of the file."""
    scene, found = scene_of(tmp_path, with_relief())
    assert (scene.tip_relief.pinion.depth, scene.tip_relief.pinion.start_diameter, scene.tip_relief.pinion.shape) == (
        pytest.approx(0.031),
        79.0,
        "linear",
    )
    assert (
        scene.tip_relief.wheel is None
        and scene.root_relief is None
        and "tip_relief.pinion.shape" in assumed_fields(found)
    )
    values = {"depth": (12.0, "mum"), "datum_diameter": (107.0, "mm"), "shape_of_relief": ("parabolic",)}
    scene, found = scene_of(tmp_path, with_relief("root_relief", gear_flanks=rexs.WHEEL_FLANKS, **values))
    relief = scene.root_relief.wheel
    assert (relief.depth, relief.start_diameter, relief.shape) == (
        pytest.approx(0.012),
        107.0,
        "parabolic",
    ) and scene.tip_relief is None
    assert not assumed_fields(found)
    assert scene_of(tmp_path, with_relief(depth=(0.0, "mm")))[0].tip_relief is None


@pytest.mark.parametrize("kind, flanks", [("tip_relief", rexs.PINION_FLANKS), ("root_relief", rexs.WHEEL_FLANKS)])
def test_a_circular_relief_is_a_parabola(tmp_path, kind, flanks):
    """An arc of depth h over a length l, tangent at its start, is h (x/l)^2 but for less than h (h/l)^2: 4e-5 of its
    depth at 31 um over 5 mm. The scene has the parabola, and the summary tells it."""
    start = {"tip_relief": 79.0, "root_relief": 107.0}[kind]
    values = {"datum_diameter": (start, "mm"), "shape_of_relief": ("circular",)}
    scene, found = scene_of(tmp_path, with_relief(kind, gear_flanks=flanks, **values))
    gear = "pinion" if kind == "tip_relief" else "wheel"
    assert getattr(getattr(scene, kind), gear).shape == "parabolic"
    assert f"{kind}.{gear}.shape = parabolic: shape_of_relief of component 40 is circular" in "".join(found.assumed)
    depth, length = 0.031, 5.0
    radius = 0.5 * (length**2 + depth**2) / depth
    x = np.linspace(0.0, length, 101)
    arc = radius - np.sqrt(radius**2 - x**2)
    assert np.abs(arc - depth * (x / length) ** 2).max() < depth * (depth / length) ** 2


@pytest.mark.parametrize("shape, power", [("linear", 1), ("parabolic", 2)])
def test_relief_given_below_the_tip_is_extended_to_it(tmp_path, shape, power):
    """The scene's law, depth ((v - v0)/(v1 - v0))^power, v = sqrt(d^2/db^2 - 1), has the file's depth where it says."""
    scene, _ = scene_of(tmp_path, with_relief(evaluation_reference=(81.0, "mm"), shape_of_relief=(shape,)))
    base = 72.0 * cos(radians(20.0))
    start, there, tip = (sqrt((diameter / base) ** 2 - 1.0) for diameter in (79.0, 81.0, 82.64))
    assert scene.tip_relief.pinion.depth * ((there - start) / (tip - start)) ** power == pytest.approx(0.031, rel=1e-10)


def test_reliefs_by_their_length_of_roll(tmp_path):
    """L_C of ISO 21771; where the relief starts, geometry computes its own way."""
    base = 36.0 * cos(radians(20.0))
    length = sqrt(41.32**2 - base**2) - sqrt(39.5**2 - base**2)
    scene, _ = scene_of(tmp_path, with_relief(datum_length=(length, "mm")))
    assert scene.tip_relief.pinion.start_diameter == 79.0 and scene.tip_relief.pinion.length_on_path is None
    values = {"datum_length": (length * 1e3, "mum"), "evaluation_reference": (81.0, "mm")}
    scene, _ = scene_of(tmp_path, rexs.with_value(with_relief(**values), 40, "tip_relief_datum_diameter", None))
    assert scene.tip_relief.pinion.length_on_path == pytest.approx(length)
    start, there, tip = (sqrt((0.5 * diameter / base) ** 2 - 1.0) for diameter in (79.0, 81.0, 82.64))
    assert scene.tip_relief.pinion.depth * (there - start) / (tip - start) == pytest.approx(0.031, rel=1e-9)
    curve = removals(scene, gear_pair(scene.gears))[0]
    assert curve(start * (1 - 1e-9)) == 0.0 and 0.0 < curve(start * (1 + 1e-4)) < 1e-3
    scene, _ = scene_of(
        tmp_path,
        rexs.with_value(with_relief("root_relief", datum_length=(1.5, "mm")), 40, "root_relief_datum_diameter", None),
    )
    assert scene.root_relief.pinion.length_on_path == 1.5


@pytest.mark.parametrize("form", [rexs.as_xml, rexs.as_json])
@pytest.mark.parametrize("dtype, code", [("<f4", "float32"), ("<f8", "float64")])
def test_arrays(paper_scene, tmp_path, form, dtype, code):
    """numpy's bytes; a longer array that no scene has a place for is told with its range."""
    amounts = np.array([-2.5, 0.25, 12.0], dtype)
    coded = {"code": code, "value": base64.b64encode(amounts.tobytes()).decode().rstrip("=")}
    one = {"code": code, "value": base64.b64encode(np.array([4.5], dtype).tobytes()).decode()}
    model = changed((rexs.WHEEL, "normal_module", [4.5], "mm"))
    module = next(each for each in rexs.component(model, rexs.PINION)["attributes"] if each["id"] == "normal_module")
    del module["floating_point"]
    module["floating_point_array_coded"] = one
    flank = rexs.component(model, rexs.PINION_FLANKS[0])
    flank["attributes"].append(
        {"id": "topographical_deviation_amounts", "unit": "mum", "floating_point_array_coded": coded}
    )
    scene, found = imported(tmp_path, form(model))
    assert scene.gears == paper_scene.gears
    assert found.left_out == (
        "component 7 (cylindrical_gear_flank): topographical_deviation_amounts = 3 values from -2.5 to 12 um",
    )


def test_tolerance_class(tmp_path):
    """The coarser class of both gears, under its names of 1.3 and of 2.0; one that ISO 1328-1:2013 lacks is left
    out."""
    first, later = "tolerance_class_according_to_iso_1328_2013", "global_tolerance_class_iso_1328_2013"
    scene, _ = scene_of(tmp_path, changed((rexs.PINION, first, "6"), (rexs.WHEEL, first, "6")))
    assert scene.flank_errors.tolerance_class == 6 and scene.motion.mesh_cycles == 48
    scene, found = scene_of(tmp_path, changed((rexs.PINION, later, "6"), (rexs.WHEEL, later, "7")))
    assert scene.flank_errors.tolerance_class == 7 and "the coarser of the two gears" in found.text
    scene, found = scene_of(tmp_path, changed((rexs.PINION, first, "12"), (rexs.WHEEL, first, "0")))
    assert scene.flank_errors is None and len(found.left_out) == 2


def test_narrower_gear_and_common_width(tmp_path):
    """Only the common width is in contact. Where it is that of the narrower gear, each gear keeps its own; a smaller
    one has the gears stand out at ends that the file does not say."""
    model = changed((rexs.PINION, "face_width", 17.0, "mm"))
    assert scene_of(tmp_path, model)[0].gears.face_width == 15.0
    whole = rexs.with_value(model, rexs.STAGE, "common_face_width", 14.999999999999996, "mm")
    assert scene_of(tmp_path, whole)[0].gears.face_widths == (17.0, 15.0)
    assert (
        scene_of(tmp_path, rexs.with_value(model, rexs.STAGE, "common_face_width", 14.0, "mm"))[0].gears.face_width
        == 14.0
    )


def test_loaded_flank_decides_where_flanks_differ(tmp_path):
    """A relief of the left flank only."""
    model = with_relief(sides=(0,))
    assert "does not say which one is loaded" in refused(tmp_path, model)
    assert (
        scene_of(tmp_path, rexs.with_value(model, rexs.PINION_DATA, "loaded_tooth_flank", "left"))[0].tip_relief
        is not None
    )
    assert (
        scene_of(tmp_path, rexs.with_value(model, rexs.PINION_DATA, "loaded_tooth_flank", "right"))[0].tip_relief
        is None
    )
