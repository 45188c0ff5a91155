"""Consecutive steps of a march as arrays."""

from types import SimpleNamespace

import numpy as np
import pytest

from fenics_gears.contact.addresses import Arrays, row_of
from fenics_gears.dynamics.steps import Steps


@pytest.mark.parametrize("kinds", [1, 2])
def test_the_largest_force_of_each_step_is_that_of_its_nodes(kinds):
    """Brute force: step by step, also where a step has no contact node, at either end too, or none that presses."""
    counts, rng = [0, 3, 1, 0, 0, 4, 2, 0], np.random.default_rng(1)
    nodes = sum(counts)
    positions = [SimpleNamespace(in_memory=row_of(count, [None] * len(Arrays._fields))) for count in counts]
    forces = rng.uniform(0.0, 9.0, kinds * nodes)
    expected, place = [], 0
    for count in counts:
        expected.append(max([*forces[place : place + count], 0.0]))
        place += kinds * count
    nothing = np.zeros((len(counts), 3, 1))
    steps = Steps(
        np.arange(8.0),
        positions,
        nothing,
        forces,
        forces,
        np.zeros(nodes, dtype=np.int8),
        np.zeros(8, dtype=np.int64),
        [""] * 8,
    )
    assert steps.largest_forces.tolist() == expected
    assert steps.between(3, 5).largest_forces.tolist() == [0.0, 0.0]
