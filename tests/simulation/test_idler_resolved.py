"""An idler with both of its meshes loaded against plain finite elements on three whole gears (tests/benchmarks)."""

import pytest
from tests.benchmarks import idler_resolved as resolved

from fenics_gears import load_train
from fenics_gears.scene.train_mesh import layout_of

# Of the first mesh: two tooth pairs and one in both meshes. No tip edge touches; where one does, contact leaves the
# line of action (1 % at 0.75).
PHASES = (0.1, 0.71)
IDLER = 1


@pytest.fixture(scope="module")
def train():
    return load_train(resolved.SCENE)


def test_the_second_mesh_of_an_idler_stands_where_its_outline_says(train):
    """Exact geometry: how far the idler's teeth are turned follows from its contact in the first mesh, and its phase in
    the second from there and the direction of the last gear."""
    layout = layout_of(train.meshes)
    at = resolved.position(train, 0.0)
    assert at.second == (layout.shared(IDLER, 0, 1).tooth, pytest.approx(layout.phases[1], abs=1e-12))


@pytest.mark.nightly
@pytest.mark.parametrize("phase", PHASES)
def test_lags_are_those_of_a_resolved_model(train, phase):
    """Whole gears in six-node triangles, contact found on the moving surfaces: within 0.5 % (measured: 0.16 %)."""
    at = resolved.position(train, phase)
    (own,) = resolved.by_this_program(train, [at])
    found = resolved.by_finite_elements(train, at, own, resolved.SIZES)
    assert own == pytest.approx(found, rel=0.005)
