"""Shafts of a REXS file as those of a train that bend: every place is a distance from the left end."""

import tomllib

import pytest
from tests.extensions.rexs.test_gearbox import BOX, at, related, train_of, with_component, written

from fenics_gears import load_train
from fenics_gears.commands.cli import main
from fenics_gears.extensions.rexs.gearbox import imported_train

# Shaft 3 begins at u = 10 mm and carries gears 6 and 51, 30 and 100 mm from there.
PLACES = {2: (0, 0, 0), 5: (40, 0, 0), 3: (10, 120, 0), 6: (40, 120, 0), 51: (110, 120, 0), 52: (110, 120, 120)}
SECTIONS = ((0, 50, 30, 30), (50, 70, 40, 35), (120, 20, 35, 35))


def box(stiffness=2e8, outer=80, torque="100.0"):
    """The gearbox with shaft 3 described: three sections, a bearing of a stiffness (N/m) 5 mm from either end."""
    text = BOX.replace(">100.0<", f">{torque}<").replace(">1000.0<", f">{10 * float(torque)}<")
    for number, place in PLACES.items():
        text = at(text, number, *place)
    text = with_component(text, outer, "gear_casing", None)
    for number, (start, length, first, last) in enumerate(SECTIONS, start=90):
        sizes = {"u_coordinate_on_shaft": start, "length": length, "outer_diameter_begin": first}
        sizes["outer_diameter_end"] = last
        text = with_component(text, number, "shaft_section", 3, *((name, "mm", size) for name, size in sizes.items()))
    for number, place in ((81, 5), (82, 135)):
        stated = (("radial_stiffness", "N / m", stiffness),) if stiffness else ()
        absorbs = ("axial_force_absorption", "", "both_directions" if number == 81 else "no_direction")
        where = ("u_coordinate_on_shaft_inner_side", "mm", place)
        text = with_component(text, number, "concept_bearing", None, where, absorbs, *stated)
        text = related(text, "side", assembly=number, inner_part=3, outer_part=outer)
    return text


def shafts_of(tmp_path, text):
    found = imported_train(written(tmp_path, text), bent=True)
    return tomllib.loads(found.text).get("shafts", {}), found


def test_a_shaft_has_its_sections_gears_and_bearings(tmp_path):
    """As they stand in the file; 2e8 N/m are 0.2e6 N/mm; the other two shafts say what they lack."""
    shafts, found = shafts_of(tmp_path, box())
    own = shafts["shaft_3"]
    assert list(shafts) == ["shaft_3"]
    assert own["carries"] == ["stage_4.wheel", "stage_50.pinion"]
    assert own["gears_at"] == ["30 mm", "100 mm"]
    assert [each["length"] for each in own["sections"]] == ["50 mm", "70 mm", "20 mm"]
    assert own["sections"][1] == {"length": "70 mm", "diameter": "40 mm", "end_diameter": "35 mm"}
    assert [each["at"] for each in own["bearings"]] == ["5 mm", "135 mm"]
    assert own["bearings"][1] == {"at": "135 mm", "radial_stiffness": "200000000.0 N / m"}
    assert own["bearings"][0]["axial_stiffness"] == "1000000000 N/mm"
    assert sum("which is rigid here: it has no sections" in each for each in found.left_out) == 2


def test_a_shaft_is_turned_round_where_its_axis_points_to_the_left(tmp_path):
    """The first gear then turns about -u, and its right end is the beginning of the file's shafts, 140 mm long."""
    own = shafts_of(tmp_path, box(torque="-100.0"))[0]["shaft_3"]
    assert own["gears_at"] == ["110 mm", "40 mm"]
    assert [each["at"] for each in own["bearings"]] == ["135 mm", "5 mm"]
    assert own["sections"][1] == {"length": "70 mm", "diameter": "35 mm", "end_diameter": "40 mm"}
    assert [each["length"] for each in own["sections"]] == ["20 mm", "70 mm", "50 mm"]


def test_the_material_is_that_of_the_shaft(tmp_path):
    """By the reference of REXS 1.4."""
    text = with_component(
        box(), 95, "material", None, ("elastic_modulus", "N / mm^2", 210000), ("density", "kg / dm^3", 7.8)
    )
    own = shafts_of(tmp_path, related(text, "reference", origin=3, referenced=95))[0]["shaft_3"]
    assert own["material"] == {"youngs_modulus": "210000 N / mm^2", "density": "7.8 kg / dm^3"}


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda: box(stiffness=None), "component 81 (concept_bearing) has no radial_stiffness"),
        (lambda: box().replace('type="gear_casing"', 'type="shaft"'), "holds it in component 80"),
        (lambda: box().replace(">70</attribute>", ">60</attribute>"), "do not follow each other"),
        (
            lambda: box().replace(">135</attribute>", ">141</attribute>"),
            "is at 141 mm, not within its sections of 140 mm",
        ),
    ],
)
def test_what_is_not_complete_stays_rigid_and_is_told(tmp_path, change, said):
    """Half a shaft would bend wrongly."""
    shafts, found = shafts_of(tmp_path, change())
    assert not shafts
    assert any("component 3 (shaft), which is rigid here" in each and said in each for each in found.left_out)


def test_a_bearing_that_does_not_give_way(tmp_path):
    """Files write 1e22 N/m; no computer adds that to the stiffness of steel."""
    own = shafts_of(tmp_path, box(stiffness=1e22))[0]["shaft_3"]
    assert own["bearings"][1]["radial_stiffness"] == "1000000000 N/mm"


def test_shafts_stay_rigid_unless_they_are_asked_for(tmp_path):
    """With shafts that bend all stages move together, which takes longer; what is not taken over is told."""
    found = train_of(tmp_path, box())[1]
    assert "[shafts" not in found.text.split("title", 1)[1]
    assert "shaft sections: components 90, 91, 92" in found.left_out


def test_the_command_writes_a_train_on_shafts_that_bend(tmp_path):
    """``--shafts`` beside ``--train``: the text is a train that the program reads, its intermediate shaft bends."""
    file = written(tmp_path, box())
    assert main(["import", str(file), "--train", "--shafts", "-o", str(tmp_path / "train.toml"), "-q"]) == 0
    (bent,) = load_train(tmp_path / "train.toml").shafts.bent
    assert bent.own.carries == ("stage_4.wheel", "stage_50.pinion")
    assert main(["import", str(file), "--stage", "4", "--shafts", "-o", str(tmp_path / "pair.toml"), "-q"]) == 2
