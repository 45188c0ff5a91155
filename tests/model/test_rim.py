"""Rims that are thin for a rigid bore."""

from dataclasses import replace

import pytest
from tests.benchmarks import rigid_bore

from fenics_gears import model_of
from fenics_gears.effects.body_meshes import BodyMeshes
from fenics_gears.geometry.gear_data import Web
from fenics_gears.model.modification import rim_warnings, too_stiff


def with_wheel(scene, **changes):
    return replace(scene, gears=replace(scene.gears, wheel=replace(scene.gears.wheel, **changes)))


def warnings_of(scene):
    return rim_warnings(model_of(scene))


def test_a_thin_rim_is_remarked_with_its_thickness(paper_scene):
    """The rule; half a module under a root circle of 98.37 mm."""
    (found,) = warnings_of(with_wheel(paper_scene, bore_diameter=98.37 - 4.5))
    assert (
        found.startswith("wheel: thin rim: 2.25 mm = 0.5 modules")
        and "gears.wheel.bore_diameter" in found
        and "[gears.wheel.web]" in found
    )


def test_other_seats_are_not_remarked(paper_scene):
    """The rule."""
    thin = with_wheel(paper_scene, bore_diameter=94.0)
    assert warnings_of(paper_scene) == warnings_of(with_wheel(paper_scene, web=Web(20.0, 47.0, 0.5))) == []
    assert rim_warnings(replace(model_of(thin), scene=replace(thin, body_meshes=BodyMeshes(None, object())))) == []
    assert warnings_of(replace(thin, accuracy=replace(thin.accuracy, model="ISO 6336-1"))) == []


@pytest.mark.nightly
@pytest.mark.parametrize(("teeth", "rim"), [(20, 1.0), (20, 2.0), (40, 1.0), (40, 2.0), (40, 4.0)])
def test_what_is_said_is_what_is_measured(teeth, rim):
    """Finite elements of a rim on a rigid ring against a solid body."""
    assert -too_stiff(rigid_bore.gear_of(teeth, rim)) == pytest.approx(
        rigid_bore.off(teeth, rim, on_web=False), abs=4.0
    )


@pytest.mark.nightly
def test_a_rim_on_a_web_is_softer():
    """The same; where a rigid ring makes it stiffer."""
    assert rigid_bore.off(40, 1.0, on_web=True) > rigid_bore.off(40, 2.0, on_web=True) > 10.0
