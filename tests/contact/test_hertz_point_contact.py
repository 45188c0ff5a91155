"""Crowned flanks at the pitch point: Hertz's point contact, Johnson, Contact Mechanics, 1985, 4.2 (b)."""

import pytest
from tests.benchmarks.third_dimension import crowned

# Layers of 1.5 half-lengths, sections of the default elements.
THICK = crowned.Sizes(layers=2, slices=15, section=crowned.SECTION_SIZE)


def test_point_contact_on_thick_layers(suite_cache):
    """Known solution, ten to one: what thick layers leave out near a load is added. Half-axes, peak pressure, line load
    and the change of approach per load."""
    errors = crowned.CrownedFlanks(10.0, THICK, suite_cache).errors()
    assert errors == pytest.approx(dict.fromkeys(errors, 0.0), abs=0.015)
