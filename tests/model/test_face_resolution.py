"""Slices and layers over the face that follow from the scene."""

from dataclasses import replace

import numpy as np
import pytest
from tests.helical import BEARINGS, helical_scene, on_stand_in_bodies

from fenics_gears import SceneError, model_of, simulate
from fenics_gears.model.description import describe
from fenics_gears.model.face_resolution import face_discretisation, lines_in_step, loaded_part
from fenics_gears.results.validity import WINDOW_REACHED
from fenics_gears.scene.data import Accuracy
from fenics_gears.simulation.elastic_route import mesh_cycle

CROWNED = '[lead_modifications.pinion]\ncrowning = "5 um"\n'


def model_with(more="", **values):
    return model_of(helical_scene(more, **{"accuracy": "", **values}))


def boundaries(model, gear):
    """z (mm) of a gear's layers, from the middle of the common face."""
    return face_discretisation(model, gear).sweep.boundaries + model.pair.gear_middles[gear]


@pytest.mark.parametrize(("helix", "width"), [(1.0, 40.0), (20.0, 3.0), (20.0, 33.0), (40.0, 17.0)])
def test_defaults_are_as_fine_as_they_say(helix, width):
    """docs/scene.md's numbers: parts of the module, and of the base pitch by the line of contact."""
    model = model_with(helix=helix, width=width)
    thickness = np.diff(boundaries(model, 0)).max()
    assert thickness <= 2.5 * model.scene.gears.module * (1.0 + 1e-9)
    slice_width = model.face.widths.max()
    assert slice_width <= 0.7 * model.scene.gears.module * (1.0 + 1e-9)
    assert slice_width * abs(model.pair.slope) <= 0.08 * model.pair.base_pitch * (1.0 + 1e-9)
    assert face_discretisation(model, 0).layers >= 4 and model.face.slices >= 8


def test_outermost_slices_of_helical_pairs_are_cut_in_two():
    """Definition: of helical pairs alone, without gaps."""
    for helix, accuracy, cut in ((8.0, "", 1), (0.0, "", 0), (8.0, "slices = 7", 0), (8.0, "slices = 8", 1)):
        face = model_with(CROWNED, helix=helix, accuracy=accuracy).face
        size = 24.0 / face.evenly
        assert face.slices == face.evenly + 2 * cut
        assert face.widths[[0, 1, -2, -1]] == pytest.approx(size / (1 + cut)) and face.widths[2:-2] == pytest.approx(
            size
        )
        assert np.diff(face.positions) == pytest.approx(0.5 * (face.widths[1:] + face.widths[:-1]))
        assert face.widths.sum() == pytest.approx(24.0)


def test_steeper_helices_have_more_slices():
    """Geometry: 24 mm of 3 mm and tau = 0.7086 move the line by 1.566 base pitches, which 0.08 divides into 20 slices,
    12.77 to a base pitch; of two lines cos(0.77 pi) come to the next slice together, of 21 slices cos(0.41 pi)."""
    assert model_with(helix=8.0).face.evenly == model_with(CROWNED, helix=0.0).face.slices == 13
    model = model_with(helix=38.0)
    assert model.face.evenly == 21
    overlap = model.pair.overlap_ratio
    assert lines_in_step(overlap, 20 / overlap) == pytest.approx(abs(np.cos(np.pi * 20 / overlap)))
    assert lines_in_step(overlap, 21 / overlap) < 0.5 < lines_in_step(overlap, 20 / overlap)


@pytest.mark.parametrize(
    ("asked", "slices", "layers"),
    [(Accuracy(slices=40, layers=12), 40, 12), (Accuracy(slices=40), 40, 4), (Accuracy(layers=8), 13, 8)],
)
def test_what_the_scene_asks_for_is_taken(asked, slices, layers):
    """Of one alone the other is what it is by default."""
    model = model_of(replace(helical_scene(accuracy="", helix=8.0), accuracy=asked))
    assert model.face.evenly == slices
    assert [face_discretisation(model, gear).layers for gear in range(2)] == [layers, layers]


@pytest.mark.parametrize("offset", [0.0, 1.3])
def test_layers_are_alike_towards_both_ends_of_a_gear(offset):
    """docs/third_dimension.md: boundaries are each other's opposites."""
    scene = helical_scene(accuracy="", offset=offset)
    wider = replace(scene, gears=replace(scene.gears, wheel=replace(scene.gears.wheel, face_width=29.0)))
    for gear in range(2):
        found = face_discretisation(model_of(wider), gear).sweep.boundaries
        assert np.array_equal(found, -found[::-1]) and np.diff(found).min() > 0.0


def test_layers_that_turn_too_far_are_refused_before_anything_is_computed():
    """Hard case 26: 45 mm at 35 degrees turn by 0.906 rad, 45 tan(beta_b)/r_b; half a radian is the limit."""
    coarse = replace(
        helical_scene(accuracy="", helix=35.0, width=45.0, teeth=(19, 25)), accuracy=Accuracy(slices=4, layers=1)
    )
    with pytest.raises(
        SceneError,
        match=r"accuracy.layers = 1: a layer would turn by 0.9\d* rad, at most 0.5 is accurate; take 2 or more",
    ):
        model_of(coarse)
    assert model_of(replace(coarse, accuracy=Accuracy(slices=4, layers=2))).face.slices == 4


def misaligned(amount, torque=200e3, **accuracy):
    scene = helical_scene(f'[misalignment]\nin_plane = "{amount} um"\n', helix=0.0, accuracy="", torque=torque)
    return model_of(replace(scene, accuracy=Accuracy(**accuracy)))


def test_part_of_a_face_that_carries():
    """Exact: F on a slope s touches over sqrt(2 F/(c s))."""
    model = misaligned(300.0, torque=20e3)
    force, slope = 20e3 / model.pair.wheel.base_radius, 0.3 / 24.0
    assert loaded_part(model) == pytest.approx(np.sqrt(2.0 * force / (0.1 * 206e3 * slope)) / 24.0, rel=0.02)
    assert loaded_part(misaligned(1.0)) == 1.0


def test_few_slices_under_the_load_are_warned_of():
    """60 um over 6 mm at light load; slices that the sentence asks for end it."""
    (sentence,) = (each for each in misaligned(300.0, torque=20e3).warnings if "accuracy.slices" in each)
    asked = int(sentence.rsplit("= ", 1)[1])
    for amount, slices in ((300.0, asked), (20.0, None)):
        assert not any(
            "accuracy.slices" in each
            for each in misaligned(amount, torque=20e3 if slices else 200e3, slices=slices).warnings
        )


def test_check_prints_slices_layers_and_motions():
    """docs/third_dimension.md."""
    scene = helical_scene(BEARINGS, accuracy="slices = 12\nlayers = 6")
    wider = replace(scene, gears=replace(scene.gears, pinion=replace(scene.gears.pinion, face_width=32.0)))
    rows = {label: " ".join((str(value), words)) for label, value, words in dict(describe(wider))["Model"]}
    assert rows["slices of the face"].startswith("12, the outermost cut in two;")
    assert rows["layers of the bodies"] == "pinion 8, wheel 6, 6 of them on the common face"
    motions = rows["motions of the gears that are unknown"]
    assert motions.startswith("11:") and "_" not in motions and "pinion tilt about x" in motions


RELIEVED = "[tip_relief]\ndepth = {depth}\nlength_on_flank = {length}\n"


def test_windows_reach_as_far_as_reliefs_move_the_contact():
    """A gap y^2/(2 R) + m y is least at y = -R m: the largest radius in the middle of T1 T2, and relief on both flanks.
    Under a light load the contact is narrow, and beyond a window that reckons with its half-width alone."""
    depth, length = 0.03, 2.0
    relief = RELIEVED.format(depth=f'"{depth} mm"', length=f'"{length} mm"')
    light = dict(torque=3e3, helix=20.0)
    plain = model_with(**light)
    model = model_with(relief, **light)
    radius = 0.25 * plain.pair.line_of_action_length
    window = model.resolution.contact_grid.inner_length
    # Windows are one of a row, each longer by a fourth root of two.
    wanted = 2.0 * radius * 2.0 * depth / length
    assert plain.resolution.contact_grid.inner_length < wanted < window < 1.5 * wanted
    run = simulate(replace(model.scene, accuracy=Accuracy(steps_per_mesh_cycle=8)), preparation=on_bodies)
    assert not [each for each in run.warnings if WINDOW_REACHED in each]


def on_bodies(model, progress, cache):
    return (), mesh_cycle(model, on_stand_in_bodies(model))
