"""The demonstration of tip relief, on coarse teeth."""

from dataclasses import replace

import numpy as np
import pytest
from demos.tip_relief import findings
from demos.tip_relief.design import Bench, Design, conditions, paper_scene
from demos.tip_relief.optimum import ALLOWED, optimum
from tests.coarse import COARSE

from fenics_gears.runs.gear_store import GearStore


@pytest.fixture(scope="module")
def benches():
    """One for every condition, and one of teeth alone without friction."""
    store = GearStore()
    made = {name: Bench(scene, store) for name, scene in conditions(paper_scene(COARSE)).items()}
    return made | {"teeth alone": Bench(replace(made[findings.STIFF].scene, friction=None), store)}


@pytest.fixture(scope="module")
def best(benches):
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr("demos.tip_relief.optimum.SEARCHED", 60)
        return optimum(benches["μ = 0"])


@pytest.mark.nightly
def test_the_chosen_relief_is_the_best(benches, best):
    """Definition of a minimum: nothing of a coarse map or beside it is better; a micrometre more is left at both
    ends."""
    bench, design, least = benches["μ = 0"], best.design, best.peak_to_peak
    around = findings.relief_map(bench, np.array([0.0, 15.0, 30.0, 45.0]), np.array([0.5, 0.8, 1.0, 1.3]))
    assert least < around.left.min()
    for depth, length in ((1.5, 0.0), (-1.5, 0.0), (0.0, 0.06), (0.0, -0.06), (1.5, -0.05), (-1.5, 0.05)):
        assert bench.peak_to_peak(Design(design.depth + depth, design.length + length)) > least
    for depth in best.depths:
        assert bench.peak_to_peak(replace(design, depth=depth)) == pytest.approx(least + ALLOWED, abs=0.35)
    # The README's numbers, on coarser teeth.
    assert 25.0 < design.depth < 36.0 and 0.8 < design.length < 1.15
    assert least < 0.25 * bench.peak_to_peak(None)
