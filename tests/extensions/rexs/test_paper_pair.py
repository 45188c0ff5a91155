"""The paper's pair from REXS: every form and unit give demos/lundvall2004.toml."""

from dataclasses import astuple, replace

import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.conftest import DEMOS
from tests.extensions.rexs import paper_model as rexs

from fenics_gears import scene_from_text
from fenics_gears.extensions.rexs.imported import imported_scene


def imported(tmp_path, content, name="file.rexs", **choice):
    path = tmp_path / name
    path.write_bytes(content)
    found = imported_scene(path, **choice)
    return scene_from_text(found.text, "imported"), found


@pytest.mark.parametrize(
    "form",
    [
        "XML",
        "JSON",
        "XML in ZIP",
        "JSON in ZIP",
        "XML of the other ending in ZIP",
        "XML with namespace",
        "XML with byte-order mark",
        "JSON with byte-order mark",
    ],
)
def test_every_form_gives_the_paper_s_pair(paper_scene, tmp_path, form):
    """Gears and load to the last digit; the speed once rpm are mesh cycles a second."""
    model = rexs.paper_model()
    xml, json = rexs.as_xml(model), rexs.as_json(model)
    content = {
        "XML": (DEMOS / "lundvall2004.rexs").read_bytes(),
        "JSON": json,
        # What macOS adds to an archive, and what a model may refer to.
        "XML in ZIP": rexs.as_zip(("model.rexs", xml), ("__MACOSX/._model.rexs", b"\0"), ("gear.gde", b"")),
        "JSON in ZIP": rexs.as_zip(("model.rexsj", json)),
        "XML of the other ending in ZIP": rexs.as_zip(("model.rexs.xml", xml)),
        "XML with namespace": rexs.as_xml(model, namespace="https://www.rexs.info/schema/rexs-file"),
        "XML with byte-order mark": b"\xef\xbb\xbf" + xml,
        "JSON with byte-order mark": b"\xef\xbb\xbf" + json,
    }[form]
    scene, found = imported(tmp_path, content)
    assert scene.gears == paper_scene.gears
    assert scene.load == paper_scene.load
    assert scene.motion.mesh_frequency == pytest.approx(paper_scene.motion.mesh_frequency, rel=1e-14)
    assert [each.split(" = ")[0] for each in found.assumed] == ["motion.mesh_cycles"] and not found.left_out


# Units a REXS file may have, and how many N, mm, s, rad (kg/dm^3 for the density) each is: from their definitions.
LENGTHS = {"mm": 1.0, "m": 1000.0, "cm": 10.0, "dm": 100.0, "mum": 1e-3, "µm": 1e-3, "in": 25.4}
ANGLES = {"deg": 1.0, "°": 1.0, "rad": 57.29577951308232, "mrad": 0.05729577951308232}
SPEEDS = {"1 / min": 1.0, "1/min": 1.0, "rpm": 1.0, "1 / s": 60.0, "rad / s": 9.549296585513721, "Hz": 60.0}
TORQUES = {"N m": 1.0, "Nm": 1.0, "N mm": 1e-3, "kN m": 1e3}
STRESSES = {"N / mm^2": 1.0, "MPa": 1.0, "GPa": 1e3, "Pa": 1e-6}
RATIOS = {"none": 1.0, "": 1.0, "1": 1.0, "-": 1.0, "%": 0.01}
SIZES = ("normal_module", "tip_diameter", "root_diameter", "inner_diameter", "face_width")
SHIFT = "addendum_modification_coefficient"
QUANTITIES = [
    (
        LENGTHS,
        [(rexs.STAGE, "center_distance"), *((gear, name) for gear in (rexs.PINION, rexs.WHEEL) for name in SIZES)],
    ),
    (ANGLES, [(flank, "normal_pressure_angle") for flank in rexs.PINION_FLANKS + rexs.WHEEL_FLANKS]),
    (SPEEDS, [(rexs.SHAFT, "rotational_speed")]),
    (TORQUES, [(rexs.LOAD, "torque_around_u_axis")]),
    (STRESSES, [(rexs.MATERIAL, "elastic_modulus")]),
    (RATIOS, [(rexs.MATERIAL, "poisson_ratio"), *((flank, SHIFT) for flank in rexs.PINION_FLANKS)]),
]


@given(data=st.data())
def test_units_do_not_matter(paper_scene, tmp_path_factory, data):
    """Property: the same scene, to rounding."""
    model = rexs.paper_model()
    for units, places in QUANTITIES:
        for number, name in places:
            written = next(each for each in rexs.component(model, number)["attributes"] if each["id"] == name)
            unit = data.draw(st.sampled_from(sorted(units)))
            written["floating_point"], written["unit"] = written["floating_point"] / units[unit], unit
    content = data.draw(st.sampled_from([rexs.as_xml, rexs.as_json]))(model)
    scene, _ = imported(tmp_path_factory.mktemp("units"), content)
    assert_same_gears(scene.gears, paper_scene.gears)
    assert scene.load.wheel_torque == pytest.approx(437e3, rel=1e-13)
    assert scene.motion.mesh_frequency == pytest.approx(200.0, rel=1e-13)


@pytest.mark.parametrize("version", ["1.40", "2.0.0", "v1.4", "1,4"])
def test_versions_are_read_as_programs_write_them(paper_scene, tmp_path, version):
    """REXS says main version, point, sub-version, and its own newest is 2.0.0."""
    model = rexs.paper_model()
    model["model"]["version"] = version
    assert imported(tmp_path, rexs.as_xml(model))[0].gears == paper_scene.gears


def assert_same_gears(found, expected):
    for each, other in (
        (found.pinion, expected.pinion),
        (found.wheel, expected.wheel),
        (found.material, expected.material),
    ):
        assert astuple(each) == pytest.approx(astuple(other), rel=1e-12)
    plain = [astuple(replace(gears, pinion=None, wheel=None, material=None))[:4] for gears in (found, expected)]
    assert plain[0] == pytest.approx(plain[1], rel=1e-12)


def test_the_gear_with_fewer_teeth_is_the_pinion(paper_scene, tmp_path):
    """The scene's meaning; a stage may name its gears in any order."""
    model = rexs.paper_model()
    stage = next(each for each in model["model"]["relations"] if each["type"] == "stage")
    roles = {"gear_1": "gear_2", "gear_2": "gear_1"}
    for each in stage["refs"]:
        each["role"] = roles.get(each["role"], each["role"])
    assert imported(tmp_path, rexs.as_xml(model))[0].gears == paper_scene.gears
