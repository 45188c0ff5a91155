"""Torque, speed and direction along a gear train: M2 = M1 z2/z1 and n2 = n1 z1/z2 without losses, equilibrium of what
turns as one, and the power that comes in where torque and speed have one sign."""

import pytest
from tests.extensions.rexs import paper_model as rexs
from tests.extensions.rexs import planetary_model
from tests.extensions.rexs.planetary_model import Box
from tests.extensions.rexs.test_lookups import refused, scene_of

from fenics_gears import load_train
from fenics_gears.commands.cli import main
from fenics_gears.extensions.rexs.loads import pinion_speed, wheel_torque
from fenics_gears.extensions.rexs.model import checked_model
from fenics_gears.extensions.rexs.order import units_in_order
from fenics_gears.extensions.rexs.stage import chosen_stage
from fenics_gears.extensions.rexs.values import ValueProblem

TEETH = "number_of_teeth"
FIRST, SECOND = 100, 200


class Gearbox(Box):
    """A model of shafts 1, 2, ..., stages between them and loads on them."""

    def __init__(self):
        self.components, self.relations = [], []

    def between(self, number, shafts, teeth, kind="cylindrical", second="cylindrical_gear", **own):
        """A stage, with its two gears ``number`` + 1 and + 2 on two shafts; ``own``: words of both gears."""
        self.part(number, f"{kind}_stage")
        for which, (shaft, count) in enumerate(zip(shafts, teeth)):
            words = {name: (values[which], "none") for name, values in own.items()}
            self.gear(number + 1 + which, count, shaft, kind=second if which else f"{kind}_gear", **words)
        return self.relate("stage", stage=number, gear_1=number + 1, gear_2=number + 2)

    def checked(self):
        return checked_model({"version": "1.4", "components": self.components, "relations": self.relations})

    def of_stage(self, number):
        """Torque on the driven gear in N m, speed of the driving one in rpm, the number of the driving gear's
        component and the side of the driven gear's teeth that is loaded."""
        model = self.checked()
        stage = chosen_stage(model, number)
        counts = [float(part.gear.attributes[TEETH].value) for part in (stage.pinion, stage.wheel)]
        ratio = counts[1] / counts[0]
        torque = wheel_torque(model, stage, ratio).number / 1e3
        speed = pinion_speed(model, stage, ratio).number / 0.10471975511965977
        return torque, pytest.approx(speed), stage.pinion.gear.id, stage.wheel.by_torque


def three_shafts(torque=100, speed=1000):
    """Torque (N m) and speed (rpm) are on shaft 1."""
    return Gearbox().shaft(1, speed).shaft(2).shaft(3).load(10, 1, torque)


def two_stages():
    """20/40 teeth from shaft 1 to shaft 2, again from shaft 2 to shaft 3; 100 N m and 1000 rpm on shaft 1."""
    return three_shafts().between(FIRST, (1, 2), (20, 40)).between(SECOND, (2, 3), (20, 40))


def test_torque_and_speed_go_through_the_stages_before():
    """Twice the torque at half the speed in each stage of 20/40 teeth: 200 and 400 N m, 1000 and 500 rpm."""
    assert two_stages().of_stage(FIRST)[:3] == (pytest.approx(200.0), 1000.0, FIRST + 1)
    assert two_stages().of_stage(SECOND)[:3] == (pytest.approx(400.0), 500.0, SECOND + 1)
    from_the_end = Gearbox().shaft(1).shaft(2).shaft(3, 250).load(10, 3, -400)
    from_the_end.between(FIRST, (1, 2), (20, 40)).between(SECOND, (2, 3), (20, 40))
    assert from_the_end.of_stage(FIRST)[:2] == (pytest.approx(200.0), 1000.0)


@pytest.mark.parametrize(
    ("kind", "relation", "words", "joined"),
    [
        ("coupling", "side", {}, True),
        ("fixed_coupling", "coupling", {}, True),
        ("feather_key_connection", "side", {}, True),
        ("cylindrical_interference_fit", "side", {}, True),
        ("switchable_coupling", "side", {"is_engaged": "true"}, True),
        ("switchable_coupling", "side", {"is_engaged": "false"}, False),
        ("switchable_coupling", "side", {}, False),
        ("rolling_bearing_with_catalog_geometry", "side", {}, False),
    ],
)
def test_couplings_and_seats_pass_torque_on_and_bearings_do_not(kind, relation, words, joined):
    """REXS: couplings join by the relation "side", up to version 1.0 by "coupling"; an open one carries nothing."""
    box = three_shafts().between(FIRST, (2, 3), (20, 40))
    box.part(11, kind, **{name: (word, "none") for name, word in words.items()})
    box.relate(relation, assembly=11, inner_part=1, outer_part=2)
    if joined:
        assert box.of_stage(FIRST)[:3] == (pytest.approx(200.0), 1000.0, FIRST + 1)
    else:
        with pytest.raises(ValueProblem, match="no torque"):
            box.of_stage(FIRST)


def test_a_shaft_held_by_the_casing_takes_what_is_not_said():
    """A coupling to the casing is a brake: what comes beyond it does not follow."""
    box = two_stages().part(12, "gear_casing")
    with pytest.raises(ValueProblem, match="no torque"):
        box.couple(11, 2, 12).of_stage(SECOND)


def test_what_a_branch_takes_is_not_in_the_mesh():
    """Equilibrium of shaft 1: of 100 N m, 30 N m on shaft 3 with 40 teeth are 15 N m on 20 teeth; 85 N m are left."""
    box = three_shafts().load(11, 3, 30)
    box.between(FIRST, (1, 2), (20, 40)).between(SECOND, (1, 3), (20, 40))
    assert box.of_stage(FIRST)[0] == pytest.approx(170.0)
    unknown = three_shafts().load(11, 3)
    unknown.between(FIRST, (1, 2), (20, 40)).between(SECOND, (1, 3), (20, 40))
    with pytest.raises(ValueProblem, match="no torque"):
        unknown.of_stage(FIRST)


def test_an_internal_gear_turns_the_sign():
    """The gears of an internal pair turn in one sense: what resists on shaft 3 is negative, and is taken off too."""
    box = three_shafts().load(11, 3, -60)
    box.between(FIRST, (1, 2), (20, 40)).between(SECOND, (1, 3), (20, 80), second="ring_gear")
    assert box.of_stage(FIRST)[0] == pytest.approx(170.0)


def test_paths_that_part_and_meet_again_are_not_shared_out():
    """Which of two parallel stages carries how much, no ratio of teeth says."""
    box = Gearbox().shaft(1, 1000).shaft(2).load(10, 1, 100)
    box.between(FIRST, (1, 2), (20, 40)).between(SECOND, (1, 2), (20, 40))
    with pytest.raises(ValueProblem, match="reach it by one path"):
        box.of_stage(FIRST)


@pytest.mark.parametrize(("torque", "driving"), [(100, FIRST + 1), (-100, FIRST + 2)])
def test_power_says_which_gear_drives(torque, driving):
    """Torque and speed of one sign drive, of two signs brake, however many teeth there are: here 40 to 20."""
    box = Gearbox().shaft(1, 500).shaft(2).load(10, 1, torque).between(FIRST, (1, 2), (40, 20))
    assert box.of_stage(FIRST)[2] == driving


@pytest.mark.parametrize(
    ("torque", "orientation", "side"),
    [(100, "negative", "right"), (-100, "negative", "left"), (100, "positive", "left")],
)
def test_torque_says_which_flank_is_loaded(torque, orientation, side):
    """The driving gear turns by its leading flank; turning about +u, it turns clockwise as seen from its end in -u, and
    the leading flank of the tooth at the top is the right one. Seen from the same end, the mate has the same side."""
    box = three_shafts(torque, 10 * torque)
    box.between(FIRST, (1, 2), (20, 40), datum_face_orientation=[orientation] * 2)
    box.between(SECOND, (2, 3), (20, 40), datum_face_orientation=[orientation] * 2)
    other = {"left": "right", "right": "left"}[side]
    assert [box.of_stage(number)[3] for number in (FIRST, SECOND)] == [side, other]


@pytest.mark.parametrize(("tips", "side"), [(("positive",) * 2, "left"), (("positive", "negative"), "right")])
def test_torque_goes_through_a_bevel_stage(tips, side):
    """Bevel gears whose axes both point to where they cross turn as external gears: the shaft behind turns the other
    way; with one axis turned round it does not."""
    box = three_shafts()
    box.between(FIRST, (1, 2), (20, 40), kind="bevel", second="bevel_gear", bevel_cone_orientation=tips)
    box.between(SECOND, (2, 3), (20, 40), datum_face_orientation=["negative"] * 2)
    assert box.of_stage(SECOND) == (pytest.approx(400.0), 500.0, SECOND + 1, side)


def test_the_scene_says_where_the_torque_is_from(tmp_path):
    """Every value names its origin; a loaded flank that was not said is told as assumed where flanks are modified."""
    model = rexs.with_component(
        rexs.with_value(rexs.paper_model(), rexs.LOAD, "torque_around_u_axis", None),
        35,
        "external_load",
        ("torque_around_u_axis", 200.0, "N m"),
        assembly={"assembly": rexs.SHAFT, "part": 35},
    )
    model = rexs.with_values(
        rexs.with_value(model, rexs.LOAD, "transmits_torque", False),
        *((gear, "datum_face_orientation", "negative") for gear in (rexs.PINION, rexs.WHEEL)),
    )
    relief = ("tip_relief_depth", 31.0, "mum"), ("tip_relief_datum_diameter", 79.0, "mm")
    model = rexs.on_flanks(rexs.with_component(model, 40, "tip_relief", *relief), 40, rexs.PINION_FLANKS[1:])
    scene, found = scene_of(tmp_path, model)
    assert scene.tip_relief.pinion.depth == pytest.approx(0.031)
    assert "loaded flank of component 5: right, by the sign of its torque" in found.text
    assert "torque_around_u_axis of component 35 by the ratio of teeth" in found.text
    braked = rexs.with_value(model, 35, "torque_around_u_axis", None)
    assert "does not say which one is loaded" in refused(tmp_path, braked, wheel_torque="437 N m")


@pytest.mark.parametrize("order", [(FIRST, SECOND), (SECOND, FIRST)])
def test_stages_of_a_train_follow_each_other_by_their_shafts(order):
    """From the shaft that is driven on, whatever their numbers are."""
    box = Gearbox().shaft(1, 1000).shaft(2).shaft(3).load(10, 1, 100)
    box.between(order[0], (1, 2), (20, 40)).between(order[1], (2, 3), (20, 40))
    assert [each.stage.id for each in units_in_order(box.checked())] == list(order)


def test_stages_that_are_no_train_are_refused():
    """Two pairs that have nothing in common."""
    apart = Gearbox().shaft(1, 1000).shaft(2).shaft(3).shaft(4).load(10, 1, 100)
    apart.between(FIRST, (1, 2), (20, 40)).between(SECOND, (3, 4), (20, 40))
    with pytest.raises(ValueProblem, match="has 2 shafts that drive and that no stage drives"):
        units_in_order(apart.checked())


def test_a_gearbox_is_imported_as_a_train(tmp_path, capsys):
    """100 N m on the first shaft make 200 N m on the second and 400 N m on the last one."""
    file = tmp_path / "two_stages.rexs"
    file.write_text(planetary_model.two_stages())
    assert main(["import", str(file), "--train", "-o", str(tmp_path / "box.toml")]) == 0
    assert "Next: gears check" in capsys.readouterr().out
    train = load_train(tmp_path / "box.toml")
    assert [mesh.scene.load.wheel_torque for mesh in train.meshes] == pytest.approx([200e3, 400e3])
    assert train.meshes[0].scene.motion.mesh_frequency == pytest.approx(1000.0 / 60.0 * 20)
    assert main(["import", str(file), "--train", "--stage", "4", "-o", str(tmp_path / "other.toml")]) == 2
    assert "--stage is of one pair" in capsys.readouterr().err
