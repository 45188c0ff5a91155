"""Planetary stages of REXS files as scenes: members, torque and speed by Willis, places, and what is lacking. 17, 22
and 61 teeth of module 4 mm, planets 78 mm from the centre."""

import re

import pytest
from tests.conftest import DEMOS
from tests.extensions.rexs.planetary_model import Box

from fenics_gears import SceneError, load_train, scene_from_text
from fenics_gears.commands.cli import main
from fenics_gears.extensions.rexs.gearbox import imported_train
from fenics_gears.extensions.rexs.imported import imported_scene

SUN, RING, CARRIER = 901, 902, 903
SHAFTS = {"sun": SUN, "ring": RING, "carrier": CARRIER}


def set_box(held="ring", driven="sun", torque=1591.5, **more):
    """A set with a member coupled to the casing, one that is driven at 1500 rpm, and one with a load not known."""
    box = Box().planetary(**more).couple(990, SHAFTS[held], 1)
    (free,) = {*SHAFTS} - {held, driven}
    speed = next(each for each in box.components if each["id"] == SHAFTS[driven])
    speed["attributes"].append({"id": "rotational_speed", "unit": "1 / min", "value": 1500.0})
    return box.load(991, SHAFTS[driven], torque).load(992, SHAFTS[free])


def train_of(tmp_path, box, **options):
    file = tmp_path / "box.rexsj"
    file.write_text(str(box))
    found = imported_train(file, **options)
    (tmp_path / "box.toml").write_text(found.text)
    return load_train(tmp_path / "box.toml"), found


@pytest.mark.parametrize(
    ("held", "driven", "ratio"),
    [
        ("ring", "sun", 1 + 61 / 17),
        ("ring", "carrier", 1 / (1 + 61 / 17)),
        ("sun", "ring", 1 + 17 / 61),
        ("carrier", "sun", 61 / 17),
        ("carrier", "ring", 17 / 61),
    ],
)
def test_torque_goes_through_a_set_by_willis(tmp_path, held, driven, ratio):
    """z_s (n_s - n_c) = -z_r (n_r - n_c), and power in is power out: torques as turns of the input in one of the
    output."""
    train, found = train_of(tmp_path, set_box(held, driven))
    own = train.shafts.carrier.set
    assert (own.fixed, own.input) == (held, driven)
    assert train.input_torque == pytest.approx(1591.5e3)
    assert train.output_torque == pytest.approx(1591.5e3 * ratio)
    assert train.input_speed == pytest.approx(25.0)
    assert own.teeth == (17, 22, 61)


def test_the_set_of_fva_is_the_one_of_the_demonstration(tmp_path):
    """The same teeth, torques, speeds and phases as those of the scene that was written by hand after FVA's file."""
    train, _ = train_of(tmp_path, set_box())
    expected = load_train(DEMOS / "planetary_sets" / "fva.toml")
    assert train.shafts.carrier.set == expected.shafts.carrier.set
    for mesh, other in zip(train.meshes, expected.meshes):
        assert mesh.ahead == other.ahead
        assert mesh.direction == other.direction
        assert mesh.scene.load.wheel_torque == pytest.approx(other.scene.load.wheel_torque, rel=1e-12)
        assert mesh.scene.motion.mesh_frequency == pytest.approx(other.scene.motion.mesh_frequency, rel=1e-12)
        assert mesh.pair.contact_ratio == pytest.approx(other.pair.contact_ratio, rel=1e-12)


def test_a_set_stands_between_other_stages(tmp_path):
    """100 N m, twice as much behind 20/40 teeth, 1 + 61/17 times behind the set, and twice again."""
    box = Box().shaft(2, 1000).shaft(3).load(4, 2, 100).planetary().couple(990, RING, 1)
    box.pair(100, (2, SUN), (20, 40), ((0, 200), (0, 80))).pair(200, (903, 3), (20, 40), ((0, 0), (120, 0)))
    train, found = train_of(tmp_path, box)
    assert re.findall(r"^\[stages\.(\w+)\]", found.text, re.M) == ["stage_100", "stage_900", "stage_200"]
    assert train.output_torque == pytest.approx(100e3 * 2 * (1 + 61 / 17) * 2)
    assert [part.input_torque for part in train.joined] == pytest.approx([100e3, 200e3, 200e3 * (1 + 61 / 17)])
    assert train.input_speed == pytest.approx(1000 / 60)


def test_power_drives_as_torque_does(tmp_path):
    """100 kW at 1500 rpm are 636.62 N m."""
    box = set_box(torque=None)
    box.components[-2]["attributes"].append({"id": "power", "unit": "kW", "value": 100.0})
    assert train_of(tmp_path, box)[0].input_torque == pytest.approx(100e6 / (25 * 2 * 3.141592653589793))


def test_planets_that_are_not_equally_spaced(tmp_path):
    """Directions in steps of 360 deg/(17 + 61), opposite ones as those of the positions."""
    train, found = train_of(tmp_path, set_box(angles=(0, 360 * 27 / 78, 360 * 51 / 78)))
    assert "planet_angles = " in found.text
    assert sorted(train.shafts.carrier.set.places) == [0, 27, 51]


def test_pins_and_a_sun_that_nothing_holds(tmp_path):
    """Springs of both bearings of a planet act beside each other; a bearing holds the carrier, none the sun."""
    box = set_box()
    box.couple(960, CARRIER, 1, "concept_bearing")
    for planet in (920, 930, 940):
        box.shaft(planet + 5)
        for bearing in (6, 7):
            stiffness = {"radial_stiffness": (3e8, "N / m")}
            box.couple(planet + bearing, planet + 5, planet, "concept_bearing", **stiffness)
    train, found = train_of(tmp_path, box)
    assert train.shafts.carrier.pin_stiffness == pytest.approx(6e5)
    assert train.shafts.carrier.floating == ("sun",)
    assert any("no bearing holds the shaft of component 911" in each for each in found.assumed)


def test_the_member_that_nothing_is_joined_to_is_held(tmp_path):
    """Of three members one has to be; the file's ring has neither a load nor a coupling."""
    box = set_box()
    box.relations = [each for each in box.relations if {"role": "assembly", "id": 990} not in each["refs"]]
    assert train_of(tmp_path, box)[0].shafts.carrier.set.fixed == "ring"


def stepped():
    """The ring meshes with other gears on the shafts of the planets."""
    box = set_box()
    for planet in (920, 930, 940):
        box.gear(planet + 6, 22, planet)
        mesh = next(each for each in box.relations if {"role": "stage", "id": planet + 3} in each["refs"])
        mesh["refs"][1]["id"] = planet + 6
    return box


def without(box, number):
    """The box without the relations of a component."""
    box.relations = [each for each in box.relations if all(ref["id"] != number for ref in each["refs"])]
    return box


@pytest.mark.parametrize(
    ("box", "said"),
    [
        (lambda: set_box().couple(993, SUN, 1), r"sun and ring are joined to the casing"),
        (lambda: without(set_box().load(994, RING, 5), 990), "none is joined to the casing"),
        (stepped, "not each of its planets|meshes between planets"),
        (lambda: without(without(set_box(), 904), 903), "no planet_carrier"),
        (lambda: without(set_box(), 912), "has 0 internal gears"),
        (lambda: set_box(face_width=[(50.0, "mm"), (50.0, "mm"), (40.0, "mm")]), "differ .* in .*face_width"),
        (lambda: set_box(torque=None), "no torque.*--wheel-torque"),
        (
            lambda: set_box().shaft(5).pair(300, (SUN, 5), (20, 40), ((0, 0), (120, 0))),
            "power on several paths, or loads between stages, beside",
        ),
    ],
)
def test_what_a_set_lacks_is_said(tmp_path, box, said):
    """In words, and nothing is written."""
    with pytest.raises(SceneError, match=f"(?s){said}.*Nothing was written"):
        train_of(tmp_path, box())


def test_an_internal_pair_is_imported(tmp_path):
    """The planet drives the ring, whose teeth a file counts with either sign; diameters are positive in a scene."""
    for teeth in (61, -61):
        box = Box().shaft(2, 1000).shaft(3).load(4, 2, 100).gear(11, 22, 2)
        box.gear(12, teeth, 3, (0, 78), "ring_gear", outer_diameter=(280.0, "mm")).stage(10, 11, 12, 78.0)
        (tmp_path / "pair.rexsj").write_text(str(box))
        scene = scene_from_text(imported_scene(tmp_path / "pair.rexsj").text)
        assert scene.gears.wheel.teeth == -61
        assert scene.load.wheel_torque == pytest.approx(100e3 * 61 / 22)
        assert scene.gears.wheel.root_diameter == pytest.approx(-254.0)
    out = tmp_path / "pair.toml"
    assert main(["import", str(tmp_path / "pair.rexsj"), "-q", "-o", str(out)]) == 0
