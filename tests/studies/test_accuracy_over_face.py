"""`gears accuracy` and `[accuracy] target` over the face, without running it."""

from dataclasses import replace

import numpy as np
import pytest
from tests.helical import wide_pair

from fenics_gears import model_of
from fenics_gears.model.face_resolution import face_discretisation
from fenics_gears.runs.settings.measures import (
    CURVE,
    DEFECT,
    FACE_LOAD,
    LARGEST_LOAD,
    LINE_LOAD,
    SPAN,
    distances,
    judged,
)
from fenics_gears.runs.settings.setting import own_setting
from fenics_gears.studies.accuracy import report as reports
from fenics_gears.studies.accuracy.over_face import LAYERS, PLANE, SLICES, in_the_plane
from fenics_gears.studies.accuracy.refinement import BODY, FAMILY, LENGTH, STEPS, fine, refinements

LEAD = '[lead_modifications.pinion]\ncrowning = "6 um"\n'
TILTING = '[bearings]\nstiffness = "1e6 N/mm"\naxial_stiffness = "1e5 N/mm"\nplaces = { wheel = ["-40 mm", "40 mm"] }\n'


@pytest.fixture(scope="module")
def scene():
    return wide_pair(LEAD + TILTING)


def test_a_setting_gives_the_face_that_it_says(scene):
    """Identity."""
    own, model = own_setting(scene), model_of(scene)
    assert (own.slices, own.layers, own.body) == (model.face.evenly, face_discretisation(model, 0).layers, 1.0)
    again = model_of(own.of(scene))
    assert again.face.evenly == own.slices and face_discretisation(again, 1) == face_discretisation(model, 1)
    other = model_of(replace(own, slices=9, layers=3, body=2.0).of(scene))
    assert other.face.evenly == 9 and face_discretisation(other, 0).layers == 3
    assert face_discretisation(other, 0).section_size == pytest.approx(2.0 * face_discretisation(model, 0).section_size)


@pytest.mark.parametrize("quick", [True, False])
def test_slices_layers_and_body_elements_are_refined_one_at_a_time(scene, quick):
    """Definition: from coarse to fine; choices of the plane are left out."""
    found = {each.name: each for each in refinements(scene, quick)}
    assert set(found) == {SLICES, LAYERS, BODY, FAMILY, STEPS, LENGTH}
    for name, field in ((SLICES, "slices"), (LAYERS, "layers"), (BODY, "body")):
        each = found[name]
        assert each.base == fine(scene, quick) and each.fields == (field,)
        assert all(replace(level.setting, **{field: getattr(each.base, field)}) == each.base for level in each.levels)
        sizes = [level.size for level in each.levels]
        assert sizes == sorted(sizes, reverse=True) and len(set(sizes)) == len(sizes) >= 2
    assert own_setting(scene).slices in [level.setting.slices for level in found[SLICES].levels]


def test_the_plane_rung_is_the_transverse_section_in_plane_strain(scene):
    """ISO 21771: base circles and transverse contact ratio; nothing over the face is left."""
    plane = in_the_plane(scene)
    assert not plane.three_dimensional and model_of(plane).face.slices == 1
    assert reports.scene_of(scene, PLANE, None) == plane
    section, whole = model_of(plane).pair, model_of(scene).pair
    assert section.pinion.base_radius == pytest.approx(whole.pinion.base_radius, rel=1e-12)
    assert section.wheel.base_radius == pytest.approx(whole.wheel.base_radius, rel=1e-12)
    assert section.contact_ratio == pytest.approx(whole.contact_ratio, rel=1e-9)
    assert (
        plane.bearings.places is None
        and plane.bearings.axial("wheel") is None
        and plane.bearings.stiffness == scene.bearings.stiffness
    )


def test_errors_over_the_face_are_judged_and_the_plane_is_not_charged_for_them():
    """Definition: the worst of all counts; a run in the plane has no line load along the face."""
    one = {
        CURVE: np.ones(4),
        SPAN: np.ones(1),
        DEFECT: np.zeros(1),
        LINE_LOAD: np.full(3, 100.0),
        FACE_LOAD: np.array([1.2]),
        LARGEST_LOAD: np.array([1.5]),
    }
    other = one | {
        LINE_LOAD: np.array([100.0, 100.0, 103.0]),
        FACE_LOAD: np.array([1.206]),
        LARGEST_LOAD: np.array([1.53]),
    }
    errors = distances(other, one)
    assert (
        errors[FACE_LOAD] == pytest.approx(0.005)
        and errors[LINE_LOAD] == pytest.approx(0.03 / np.sqrt(3.0))
        and judged(errors) == pytest.approx(0.02)
    )
    assert judged(distances({CURVE: one[CURVE], SPAN: np.array([1.001]), DEFECT: np.zeros(1)}, one)) == pytest.approx(
        0.001
    )
