"""Steps at rest over a face, solved in two halves by two threads."""

import numpy as np
import pytest
from tests.helical import wide_pair
from tests.over_face import MORE

from fenics_gears import simulate
from fenics_gears.dynamics import block
from fenics_gears.dynamics.batch import Batch
from fenics_gears.dynamics.block import Block


@pytest.mark.parametrize("plain", [False, True], ids=["compiled", "step by step"])
@pytest.mark.parametrize("friction", [0.0, 0.08])
def test_results_are_those_of_one_thread(monkeypatch, friction, plain):
    """Without friction a step at rest has one solution, whatever the sets to begin with; with friction the second
    thread solves positions without it first, and the march is the same."""
    made, solve_on, later = Batch.__init__, Block.solve_on, []

    def plainly(self, *given):
        made(self, *given)
        self.plain = plain or self.plain

    def told(self, number, first, end, ended):
        solved = solve_on(self, number, first, end, ended)
        later.append(solved == end > first)
        return solved

    monkeypatch.setattr(Batch, "__init__", plainly)
    monkeypatch.setattr(Block, "solve_on", told)
    scene = wide_pair((f"[friction]\ncoefficient = {friction}\n" if friction else "") + MORE)
    results = []
    for threads in (1, 2):
        monkeypatch.setattr(block, "threads", lambda threads=threads: threads)
        results.append(simulate(scene))
        # By itself a step with friction follows from the one before it.
        assert any(later) == (threads == 2 and not (plain and friction))
    assert all(later)
    for name in ("transmission_error", "line_load", "normal_force"):
        one, two = (result[name].values for result in results)
        np.testing.assert_allclose(two, one, rtol=0.0, atol=1e-11 * np.abs(one).max())
