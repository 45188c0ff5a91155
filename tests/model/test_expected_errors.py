"""Errors over the face that `gears check` expects."""

import re
from dataclasses import replace

import pytest
from tests.benchmarks.third_dimension.defaults import PAIRS, Finer, finer_model, pair
from tests.helical import helical_scene

from fenics_gears import model_of, simulate
from fenics_gears.model.description import describe
from fenics_gears.model.expected_errors import FACE_LOAD, LINE_LOAD, MEAN, PRESSURE, SPAN, all_together
from fenics_gears.scene.data import Accuracy, Scene

# Neither was among those that the rule was fitted to.
UNSEEN = {"18 deg, overlap 0.98": (4.0, 40.0, 18.0, 19, 47, 1500.0), "29 deg": (2.25, 22.0, 29.0, 29, 41, 180.0)}
NUMBERS = {
    MEAN: "mean_transmission_error",
    SPAN: "peak_to_peak_transmission_error",
    FACE_LOAD: "face_load_factor",
    LINE_LOAD: "largest_line_load_factor",
    PRESSURE: "peak_contact_pressure",
}


def numbers(scene: Scene, finer: Finer) -> dict[str, float]:
    result = simulate(finer_model(scene, finer))
    return {name: result.attrs[attribute] for name, attribute in NUMBERS.items()}


@pytest.mark.nightly
@pytest.mark.parametrize("name", UNSEEN)
def test_errors_are_below_those_that_check_expects(name):
    """The program itself with slices three times and flank elements twice as fine, which errs by a ninth and a
    quarter of the expected errors."""
    scene = pair(*UNSEEN[name])
    told = all_together(model_of(scene))
    own = numbers(scene, Finer())
    finest = numbers(scene, Finer(slices=3, flank=2))
    scales = {**finest, SPAN: finest[MEAN]}
    found = {number: abs(own[number] - known) / scales[number] for number, known in finest.items()}
    assert all(found[number] <= told[number] for number in told), (found, told)
    # What is told is no blanket: measured pairs err by a half of it and more, and these runs leave a third.
    assert found[MEAN] >= told[MEAN] / 4.0


def said(scene: Scene) -> str:
    rows = {label: f"{value} {words}" for _, section in describe(scene) for label, value, words in section}
    return rows["expected errors"]


def test_check_tells_errors_by_the_scenes_own_sizes():
    """Wording; coarser sizes of each kind have larger errors in all five."""
    scene = pair(*PAIRS[9])
    number = r"\d\.\d %"
    words = rf"mean transmission error {number}, peak to peak \d+ nm, K_Hbeta {number}, line load away from edges"
    assert re.match(rf"{words} {number}, peak pressure {number} $", said(scene))
    own = all_together(model_of(scene))
    for coarser in (Accuracy(slices=8), Accuracy(layers=3), Accuracy(flank_element_size=0.13)):
        errors = all_together(model_of(replace(scene, accuracy=coarser)))
        assert all(errors[name] > own[name] for name in own)


def test_errors_that_were_not_measured_are_not_told():
    """The rule is of helical pairs whose whole face carries."""
    assert "of helical pairs alone" in said(helical_scene('[misalignment]\nin_plane = "0 um"\n', helix=0.0))
    crowned = '[lead_modifications.pinion]\ncrowning = "50 um"\n'
    assert "where the whole face carries" in said(helical_scene(crowned, torque=20e3))
