"""The scene as a page changes it."""

from tests.extensions.live.conftest import SET

from fenics_gears import as_toml, scene_from_text, train_from_text
from fenics_gears.extensions.live.computing import Work
from fenics_gears.extensions.live.session import Session
from fenics_gears.scene_text import fields, parsed, value_at

DEPTH = "tip_relief.pinion.depth"


class Page:
    """A session with lists in the place of the computing process and the browsers."""

    def __init__(self, tree, slow=False):
        self.asked, self.told = [], []
        self.session = Session(tree, "pair", slow, self.asked.append, self.told.append)

    def do(self, action, **what):
        self.session.do({"do": action, **what})
        return self.session

    def field(self, name):
        return next(each for each in self.session.state["controls"] if each["name"] == name)


def test_a_slider_changes_the_scene_that_is_run(tree):
    """What the user expects: the number in the slider's unit is in the next run's scene, which is a scene."""
    page = Page(tree)
    page.do("set", name=DEPTH, value=12.5)
    work = page.asked[-1]
    assert isinstance(work, Work) and work.number == page.session.number
    relief = scene_from_text(as_toml(work.tree)).tip_relief
    assert relief.pinion.depth == 12.5e-3 and relief.wheel is None
    assert page.field(DEPTH)["number"] == 12.5 and page.field(DEPTH)["start"] == ""


def test_zero_takes_a_relief_out_of_the_scene(tree):
    """At zero the scene is that of the start, in which no relief is named."""
    page = Page(tree)
    page.do("set", name=DEPTH, value=12.5)
    page.do("set", name=DEPTH, value=0.0)
    assert page.session.tree == tree and not page.session.state["changed"]


def test_any_unit_and_any_field_by_its_name(tree):
    """Texts are those of a scene file; a name that is none is answered with the nearest."""
    page = Page(tree)
    page.do("set", name="load.wheel_torque", value="2000 lbf in")
    assert value_at(page.session.tree, "load", "wheel_torque") == "2000 lbf in"
    page.do("show", name="gears.face_width")
    assert page.field("gears.face_width")["text"] == "20 mm"
    page.do("show", name="gears.face_widht")
    assert 'Did you mean "gears.face_width"?' in page.told[-1]["message"]


def test_undo_and_redo(tree):
    """As in any editor: a new change forgets what was undone."""
    page = Page(tree)
    for depth in (5.0, 10.0):
        page.do("set", name=DEPTH, value=depth)
    page.do("undo")
    assert page.field(DEPTH)["number"] == 5.0
    page.do("undo")
    page.do("undo")
    assert page.session.tree == tree
    page.do("redo")
    page.do("set", name=DEPTH, value=7.0)
    page.do("redo")
    assert page.field(DEPTH)["number"] == 7.0
    page.do("start")
    assert page.session.tree == tree


def test_a_mistake_stands_beside_its_field(tree):
    """The words of the check, at the field they are about or at the nearest one that the page shows."""
    page = Page(tree)
    page.do("set", name=DEPTH, value="-3 um")
    problems = [{"path": DEPTH, "message": "is negative."}, {"path": "tip_relief.pinion", "message": "lacks start."}]
    page.session.answered({"kind": "mistakes", "number": page.session.number, "problems": problems})
    first, second = page.told[-1]["problems"]
    assert first == {"path": DEPTH, "message": "is negative."}
    assert second == {"path": DEPTH, "message": "tip_relief.pinion lacks start."}


def test_answers_for_older_scenes_are_not_shown(tree):
    """A slider that has moved on is not answered with where it was."""
    page = Page(tree)
    page.do("set", name=DEPTH, value=5.0)
    old = page.session.number
    page.do("set", name=DEPTH, value=6.0)
    told = len(page.told)
    page.session.answered({"kind": "result", "number": old, "first_look": False})
    assert len(page.told) == told and page.session.result is None


def test_over_the_face_a_first_look_is_followed_by_all_steps(tree):
    """The page draws something soon, and the whole run after it."""
    page = Page(tree, slow=True)
    page.do("set", name="lead_modifications.pinion.crowning", value=5.0)
    first = page.asked[-1]
    page.session.answered({"kind": "result", "number": first.number, "first_look": True})
    assert first.steps is not None and page.asked[-1] == Work("run", first.number, page.session.tree)


def test_a_browser_that_comes_later_sees_what_the_first_one_sees(tree):
    """Nothing is lost with a closed page."""
    page = Page(tree)
    page.session.run()
    page.session.answered({"kind": "result", "number": 1, "first_look": False})
    kinds = [each["kind"] for each in page.session.messages]
    assert kinds == ["names", "state", "start", "result"]


def test_fields_of_a_train_by_stage(train):
    """Paths are those of studies of trains; the changed scene is one, and a listed gear keeps its place."""
    page = Page(train)
    page.do("set", name="stages.idler.gears.2.profile_shift", value=0.1)
    page.do("set", name="stages.idler.tip_relief.wheel.depth", value=8.0)
    first, second = train_from_text(as_toml(page.asked[-1].tree)).meshes
    assert first.pair.wheel.profile_shift == second.pair.pinion.profile_shift == 0.1
    assert [mesh.scene.tip_relief.wheel.depth for mesh in (first, second)] == [8e-3, 8e-3]
    page.do("set", name="stages.idler.tip_relief.wheel.depth", value=0.0)
    assert "tip_relief" not in page.session.tree["stages"]["idler"]
    page.do("show", name="stages.idler.face_width")
    assert page.field("stages.idler.face_width")["text"] == "20 mm"


def test_a_set_without_a_second_sun_has_no_sliders_for_it():
    """They could only give mistakes; those of the sun's and the ring's meshes are there."""
    names = {
        each["name"].split(".")[2]
        for each in Page(dict(parsed(SET, "set.toml")), True).session.state["controls"]
        if each["name"].startswith("stages.set.")
    }
    assert names == {"sun", "planet", "ring", "sun_mesh", "ring_mesh"}


def test_a_relief_of_both_gears_is_one_slider(tree):
    """It stands at the depth of the scene. At zero the relief keeps where it begins and how, which it lost."""
    relief = {"depth": "12 um", "length_on_path": "3 mm", "shape": "parabolic"}
    page = Page(fields.changed(tree, ("tip_relief",), relief))
    assert page.field("tip_relief.depth")["number"] == 12.0
    page.do("set", name="tip_relief.depth", value=0.0)
    assert scene_from_text(as_toml(page.session.tree)).tip_relief.pinion.depth == 0.0
    page.do("set", name="tip_relief.depth", value=12.0)
    assert page.session.tree["tip_relief"] == relief
