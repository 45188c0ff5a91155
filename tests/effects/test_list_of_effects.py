"""The one list of effects and what hangs on it."""

import dataclasses

from fenics_gears import Scene, effects
from fenics_gears.inputs.section import names_in
from fenics_gears.scene.schema import scene_text

SECTIONS, AT_THE_TOP = effects.SECTIONS, effects.AT_THE_TOP


def test_schema_data_and_list_know_the_same_sections():
    """Identity; what is not one of the four sections that are always there."""
    always = {"title", "gears", "load", "motion", "accuracy", "output"}
    assert set(names_in(scene_text())) - always == set(AT_THE_TOP)
    assert {field.name for field in dataclasses.fields(Scene)} - always - {
        "name",
        "derived",
        "written",
        "folder",
        "measured_over",
    } == set(AT_THE_TOP)


def test_names_in_the_list_are_consistent():
    """Identity: needs and excludes name sections of the list, variables of one name are the same."""
    named = [name for effect in effects.every_effect() for name in (*effect.needs, *effect.excludes)]
    assert set(named) <= set(SECTIONS)
    variables = {variable for effect in effects.every_effect() for variable in effect.variables} | set(
        effects.COMMON_VARIABLES
    )
    assert len({variable.name for variable in variables}) == len(variables)


def test_needs_and_conflicts_are_found():
    """docs/promises.md."""
    assert effects.missing_needs(["damping"]) == [(effects.effect_named("damping"), "inertia")]
    assert effects.missing_needs(["damping", "inertia"]) == []
    of_points = ("body_meshes", "coast_flanks", "lead_modifications", "misalignment")
    pairs = (
        ("body_meshes", "coast_flanks"),
        ("lead_modifications", "body_meshes"),
        ("misalignment", "body_meshes"),
        *(("wheel_points", other) for other in of_points),
    )
    assert effects.conflicts(SECTIONS) == [(effects.effect_named(effect), other) for effect, other in pairs]
    assert effects.conflicts([section for section in SECTIONS if section not in ("body_meshes", "wheel_points")]) == []
