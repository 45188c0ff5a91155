"""`gears accuracy` and `[accuracy] target` over the face, without running it."""

from dataclasses import replace

import pytest
from tests.helical import wide_pair

from fenics_gears import model_of
from fenics_gears.extensions.measuring.accuracy import report as reports
from fenics_gears.extensions.measuring.accuracy.over_face import LAYERS, PLANE, SLICES, in_the_plane
from fenics_gears.extensions.measuring.accuracy.refinement import BODY, FAMILY, LENGTH, STEPS, fine, refinements
from fenics_gears.runs.settings.setting import own_setting

LEAD = '[lead_modifications.pinion]\ncrowning = "6 um"\n'
TILTING = '[bearings]\nstiffness = "1e6 N/mm"\naxial_stiffness = "1e5 N/mm"\nplaces = { wheel = ["-40 mm", "40 mm"] }\n'


@pytest.fixture(scope="module")
def scene():
    return wide_pair(LEAD + TILTING)


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
