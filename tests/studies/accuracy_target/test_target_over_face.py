"""`[accuracy] target` over the face."""

from dataclasses import replace

import numpy as np
import pytest
from tests.helical import helical_scene

from fenics_gears import model_of, scene_from_text, simulate
from fenics_gears.model.face_resolution import face_warnings
from fenics_gears.results.summary import summary_rows
from fenics_gears.runs.settings.measures import CURVE, JUDGED, MEAN, OVER_FACE, SPAN, distance, judged_answer

TARGET = 0.03
PAIRS = {
    "helical": ("", 15.0),
    "helical, misaligned, crowned": (
        '[misalignment]\nin_plane = "12 um"\n[lead_modifications.pinion]\ncrowning = "6 um"\n',
        25.0,
    ),
    "spur, misaligned": ('[misalignment]\nin_plane = "10 um"\n', 0.0),
}


@pytest.mark.nightly
@pytest.mark.parametrize("name", PAIRS)
def test_all_that_a_target_promises_holds(name):
    """Flank elements, contact nodes, slices and layers twice as fine, body elements by half; nothing chosen is
    warned of."""
    more, helix = PAIRS[name]
    run = simulate(
        helical_scene(
            more,
            teeth=(19, 31),
            helix=helix,
            width=10.0,
            torque=60e3,
            module=2.0,
            accuracy=f'target = "{100.0 * TARGET} %"',
        )
    )
    scene = scene_from_text(run.attrs["scene"])
    assert not face_warnings(model_of(scene)) and run.attrs["estimated_error"] <= TARGET
    own, said = scene.accuracy, "\n".join(" ".join(map(str, row)) for row in summary_rows(run))
    assert f"{own.slices} slices on {own.layers} layers" in said and "estimated error of T_E, T_EPP, line load" in said
    finer = replace(
        own, flank_element_size=0.5 * own.flank_element_size, contact_nodes=2 * own.contact_nodes - 1,
        slices=2 * own.slices, layers=2 * own.layers,
        body_element_size=own.body_element_size / 1.5,
    )  # fmt: skip
    found, truth = judged_answer(run), judged_answer(simulate(replace(scene, accuracy=finer)))
    errors = {measure: distance(found, truth, measure) for measure in (*JUDGED, *OVER_FACE)}
    assert max(errors.values()) <= TARGET, errors


def test_errors_of_what_vanishes_count_in_parts_of_the_mean():
    """Exact: where nothing is left of the curve, a sine of a tenth of the mean in height is an error of 1, and so is
    that height; of a curve that is higher, errors count in its own parts. In the plane, without a mean, all do."""
    sine = 0.5 * 0.002 * np.sin(2.0 * np.pi * np.arange(100) / 100)
    nothing = {CURVE: 0.0 * sine, SPAN: np.array([0.0]), MEAN: np.array([0.02])}
    one = {CURVE: sine, SPAN: np.array([0.002])}
    assert distance(one, nothing, CURVE) == pytest.approx(1.0) == distance(one, nothing, SPAN)
    higher = {CURVE: 4.0 * sine, SPAN: np.array([0.008]), MEAN: np.array([0.02])}
    for known in (higher, {name: higher[name] for name in (CURVE, SPAN)}):
        assert distance(one, known, CURVE) == pytest.approx(0.75) == distance(one, known, SPAN)
