"""The closed form that the benchmark of misaligned axes compares with."""

import numpy as np
import pytest
from tests.benchmarks.third_dimension.misaligned import face_load_factor, foundation, tilting_stiffness

WIDTH, STIFFNESS, MEAN = 24.0, 13e3, 200.0


@pytest.mark.parametrize("misalignment", (5e-3, 0.03, 0.08))
def test_the_foundation_carries_the_load_and_follows_the_misalignment(misalignment):
    """Exact: the springs' loads add up to the force, differ by c f dz/b where they touch, and are the closed form's at
    most."""
    z = (np.arange(200_000) + 0.5) / 200_000 * WIDTH - 0.5 * WIDTH
    load = foundation(z, WIDTH, STIFFNESS, misalignment, MEAN)
    assert load.mean() == pytest.approx(MEAN, rel=1e-4)
    assert load.max() / MEAN == pytest.approx(face_load_factor(0.5 * STIFFNESS * misalignment / MEAN), rel=1e-4)
    assert np.gradient(load, z)[10] == pytest.approx(-STIFFNESS * misalignment / WIDTH, rel=1e-6)


def test_the_tilting_stiffness_of_a_foundation_is_its_stiffness():
    """Exact: the moment c f b^2/12 of a linear line load."""
    z = (np.arange(1000) + 0.5) / 1000 * WIDTH - 0.5 * WIDTH
    assert tilting_stiffness(z, foundation(z, WIDTH, STIFFNESS, 5e-3, MEAN), WIDTH, 5e-3) == pytest.approx(
        STIFFNESS, rel=1e-5
    )
