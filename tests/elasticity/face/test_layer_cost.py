"""What condensing a body over its face is expected to take."""

import numpy as np
import pytest
from tests.elasticity.face.swept import TWISTED, mesh

from fenics_gears.elasticity.face import runs_of_layers
from fenics_gears.elasticity.face.layer_cost import LayerCost, LayeredSize, eliminating
from fenics_gears.elasticity.face.layers import Sweep
from fenics_gears.elasticity.face.swept_stiffness import SectionForms


def test_what_joining_layers_takes_is_counted(monkeypatch):
    """The route itself: the same eliminations, one after the other, and as many dofs on the lines."""
    section, sweep = SectionForms(mesh(), 0.3), Sweep(np.linspace(-3.0, 3.0, 8), TWISTED.twist)
    nodes, made, real = len(section.nodes.points), [], runs_of_layers.eliminated
    lines, held = np.arange(0, nodes, 3), np.array([1, 2])

    def eliminated(free, coupling, kept):
        made.append((len(free), len(kept)))
        return real(free, coupling, kept)

    monkeypatch.setattr(runs_of_layers, "eliminated", eliminated)
    axes = np.tile(np.eye(3), (nodes, 1, 1))
    stiffness = runs_of_layers.condensed_onto_lines(section, sweep, lines, held, axes)
    part = LayeredSize({True: 3.0 * (nodes - len(lines) - len(held))}, {True: 3.0 * len(lines)})
    counted = LayerCost.of(part, sweep.kinds)
    assert counted.size == len(stiffness)
    assert counted.operations == pytest.approx(sum(eliminating(*each) for each in made), rel=1e-12)
    assert counted.numbers >= max(free**2 + free * kept + kept**2 for free, kept in made)
