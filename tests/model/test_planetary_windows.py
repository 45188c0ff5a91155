"""Steps, elements and windows of planetary sets."""

import pytest
from tests.planets import planetary

from fenics_gears.model.planetary_windows import ELEMENTS_PER_HALF_WIDTH, STEPS
from fenics_gears.model.train import train_model_of


def test_defaults_of_a_set_resolve_its_contact():
    """Elements as the smallest half-width of a set takes them, in all of its meshes; steps that hold all phases; where
    a scene says so, what it says."""
    row = train_model_of(planetary(accuracy="")).rows[0]
    sun, ring = (model.resolution for model in row.models[:2])
    smallest = min(sun.half_width, ring.half_width)
    assert sun.flank_element_size == ring.flank_element_size == pytest.approx(smallest / ELEMENTS_PER_HALF_WIDTH)
    assert sun.steps_per_mesh_cycle == STEPS
    assert not row.warnings
    asked = train_model_of(planetary()).rows[0].models[0].resolution
    assert (asked.steps_per_mesh_cycle, asked.flank_element_size) == (12, 0.3)


def test_windows_are_narrow_away_from_edges():
    """Nodes that are left out are far from where flanks touch: more than four half-widths to either side stay."""
    for model in train_model_of(planetary(accuracy="")).rows[0].models[:2]:
        grid = model.resolution.contact_grid
        assert 8.0 * model.resolution.half_width < grid.inner_length < grid.length
