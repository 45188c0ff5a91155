"""What the computing process of the page answers."""

import numpy as np
import pytest

from fenics_gears import as_toml, model_of, scene_from_text, simulate, simulate_train, train_from_text
from fenics_gears.extensions.live.computing import REPORT, RESULT, RUN, STRESS, Computing, Work
from fenics_gears.extensions.live.controls import controls_of, reach
from fenics_gears.extensions.live.settled import settled
from fenics_gears.scene_text import Models, fields
from fenics_gears.simulation.train import row_cycle

COARSE = {"steps_per_mesh_cycle": 10}


@pytest.fixture
def computing(spoken, tmp_path):
    return Computing(spoken, "pair", str(tmp_path))


def answered(computing, spoken, *works):
    spoken.waiting += works
    computing.answer_all()
    return spoken.sent[-1]


def error_of(answer):
    """The transmission error that is drawn (steps,), µm."""
    return np.array(answer["charts"][0]["figure"]["data"][0]["y"])


def test_the_page_shows_what_gears_run_gives(computing, spoken, tree, tmp_path):
    """The other route: the scene that the page saves, run by itself."""
    scene = settled(tree, model_of(scene_from_text(as_toml(tree))), Models("pair", tmp_path))
    first = Work(RUN, 1, scene, reach=tuple(reach(scene, controls_of(scene, False))))
    changed = fields.changed(scene, ("load", "wheel_torque"), "320 N m")
    answer = answered(computing, spoken, first, Work(RUN, 2, changed))
    alone = simulate(scene_from_text(as_toml(changed)))
    expected = 1e3 * alone["transmission_error"].values * alone.attrs["base_radius_wheel"]
    assert answer["number"] == 2 and answer["kind"] == "result"
    assert np.abs(error_of(answer) - expected).max() < 1e-6 * np.abs(expected).max()
    assert answer["drawing"]["gears"][0]["turn"] * answer["drawing"]["gears"][1]["turn"] < 0.0


def test_a_train_is_shown_as_it_is_run(computing, spoken, train, tmp_path):
    """The other route: the scene that the page saves, run by itself. Gears that mesh turn against each other, each by
    one of its teeth in a mesh cycle. A load has the very contact windows of the start."""
    models = Models("train", tmp_path)
    scene = settled(train, models.of(train), models)
    changed = fields.changed(scene, ("load", "output_torque"), "320 N m")
    answered(computing, spoken, Work(RUN, 1, scene), Work(REPORT, 1))
    answer = answered(computing, spoken, Work(RUN, 2, changed))
    alone = simulate_train(train_from_text(as_toml(changed)))
    expected = 1e6 * alone["overall_transmission_error"].values
    assert np.abs(error_of(answer) - expected).max() < 1e-6 * np.abs(expected).max()
    turns = sorted(
        gear["turn"] * teeth / (2.0 * np.pi) for gear, teeth in zip(answer["drawing"]["gears"], (31, 25, 20))
    )
    assert np.allclose(turns, [-1.0, 1.0, 1.0], atol=1e-12)
    assert b"<html" in spoken.of("file")[0]["content"]
    windows = [[each.resolution.contact_grid for each in models.of(tree).models] for tree in (scene, changed)]
    assert windows[0] == windows[1]


def test_reliefs_of_a_train_share_its_contact_operators(computing, spoken, train, tmp_path, monkeypatch):
    """The other route: each scene run by itself. Gears are condensed for the first one alone, and a train that is
    changed back is the one before."""
    models = Models("train", tmp_path)
    scene = settled(train, models.of(train), models)
    relief = {"depth": "15 um", "start": "HPSTC"}
    relieved = fields.changed(scene, ("stages", "idler", "tip_relief"), {"wheel": relief})
    both = fields.changed(relieved, ("stages", "idler", "root_relief"), {"pinion": {**relief, "start": "LPSTC"}})
    before = error_of(answered(computing, spoken, Work(RUN, 1, scene)))
    monkeypatch.setattr("fenics_gears.simulation.train.row_cycle", None)
    for number, tree in enumerate((relieved, both), 2):
        found = error_of(answered(computing, spoken, Work(RUN, number, tree)))
        expected = 1e6 * simulate_of(tree, monkeypatch)["overall_transmission_error"].values
        assert np.abs(found - expected).max() < 1e-6 * np.abs(expected).max()
        assert np.abs(found - before).max() > 0.01 * np.abs(before).max()
    assert np.abs(error_of(answered(computing, spoken, Work(RUN, 4, scene))) - before).max() < 1e-9


def simulate_of(tree, monkeypatch):
    """The run of a train by itself, which makes operators of its own."""
    with monkeypatch.context() as own:
        own.setattr("fenics_gears.simulation.train.row_cycle", row_cycle)
        return simulate_train(train_from_text(as_toml(tree)))


def test_a_first_look_at_a_train_has_few_steps(computing, spoken, train, tmp_path):
    """The other route: the scene with that many steps, run by itself; all steps then follow."""
    answer = answered(computing, spoken, Work(RUN, 1, train, steps=10))
    alone = simulate_train(train_from_text(as_toml({**train, "accuracy": train["accuracy"] | COARSE})))
    expected = 1e6 * alone["overall_transmission_error"].values
    assert answer["first_look"] and np.abs(error_of(answer) - expected).max() < 1e-6 * np.abs(expected).max()
    assert not answered(computing, spoken, Work(RUN, 1, train))["first_look"]


@pytest.mark.nightly
def test_the_stress_of_bodies_is_a_picture(computing, spoken, tree):
    """By the signature of the format; `gears picture` has tests of what it shows."""
    answered(computing, spoken, Work(RUN, 1, tree), Work(STRESS, 1))
    assert spoken.of("file")[0]["content"][:8] == b"\x89PNG\r\n\x1a\n"


def test_only_the_newest_scene_is_run(computing, spoken, tree):
    """Of scenes that come while another is computed the last one is answered, and files asked for meanwhile."""
    works = [Work(RUN, 1, tree), Work(RUN, 2, tree), Work(RESULT, 2), Work(RUN, 3, tree)]
    answered(computing, spoken, *works)
    assert [each["number"] for each in spoken.of("result")] == [3]
    assert spoken.of("file")[0]["content"][1:4] == b"HDF"


def test_a_run_is_given_up_for_a_newer_scene(computing, spoken, tree):
    """The newer scene waits no longer than until the next report of progress."""
    finer = fields.changed(tree, ("accuracy", "steps_per_mesh_cycle"), 40)
    told = spoken.send

    def send(message):
        told(message)
        if message == {"kind": "progress", "number": 1, "stage": "march", "done": 0, "total": 0}:
            spoken.waiting.append(Work(RUN, 2, finer))

    spoken.send = send
    answered(computing, spoken, Work(RUN, 1, tree))
    assert [each["number"] for each in spoken.of("left")] == [1]
    assert [each["number"] for each in spoken.of("result")] == [2]


def test_mistakes_and_failures_are_answers(computing, spoken, tree):
    """The process goes on after each of them."""
    negative = fields.changed(tree, ("gears", "face_width"), "-3 mm")
    apart = fields.changed(tree, ("gears", "centre_distance"), "200 mm")
    answered(computing, spoken, Work(RUN, 1, negative))
    answered(computing, spoken, Work(RUN, 2, apart))
    answered(computing, spoken, Work(RUN, 3, tree))
    (first, second) = spoken.of("mistakes")
    assert first["problems"][0]["path"] == "gears.face_width" and second["problems"]
    assert spoken.sent[-1]["kind"] == "result"
