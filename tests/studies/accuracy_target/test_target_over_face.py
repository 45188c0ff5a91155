"""`[accuracy] target` over the face."""

from dataclasses import replace

import pytest
from tests.helical import helical_scene

from fenics_gears import model_of, scene_from_text, simulate
from fenics_gears.model.face_resolution import face_warnings
from fenics_gears.results.summary import summary_rows
from fenics_gears.runs.settings.measures import JUDGED, OVER_FACE, distance, judged_answer

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
