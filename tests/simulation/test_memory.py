"""Memory that a run may take: what does not fit is made again, with the same numbers, or refused before anything is computed."""


import numpy as np
import pytest
from tests.coarse import coarse_scene

from fenics_gears.elasticity.cache import user_cache
from fenics_gears.errors import ComputationError, SceneError
from fenics_gears.model.cost import expected_cost
from fenics_gears.model.model import model_of
from fenics_gears.simulation import simulate as simulation
from fenics_gears.simulation.routes import prepared
from fenics_gears.simulation.simulate import simulate
from fenics_gears.system.memory import MEMORY_VARIABLE, allowed_memory, size_in_bytes


@pytest.mark.parametrize("share", [0.0, 0.4])
def test_operators_that_are_not_kept_change_no_number(paper_scene, monkeypatch, share):
    """Two routes to the same number: operators made again in every mesh cycle, and operators kept."""
    scene = coarse_scene(paper_scene, cycles=3)
    whole, made = simulate(scene), []

    def preparation(model, progress, cache):
        gears, cycle = prepared(model, progress, cache)
        build = cycle._build
        monkeypatch.setattr(cycle, "_build", lambda *ends: made.append(ends) or build(*ends))
        return gears, cycle

    operators = expected_cost(model_of(scene)).operators
    monkeypatch.setattr(simulation, "memory_for_operators", lambda model, ranks: share * operators)
    again = simulate(scene, preparation=preparation, cache=user_cache())
    steps = scene.accuracy.steps_per_mesh_cycle
    assert len(made) > (3 if share == 0.0 else 1.5) * steps
    for name, variable in whole.data_vars.items():
        # Works are summed block by block, and blocks are shorter where memory is.
        np.testing.assert_allclose(again.variables[name].values, variable.values, rtol=1e-12, atol=1e-9 if name == "energy_defect" else 0.0, err_msg=name)


def test_a_run_that_does_not_fit_is_refused(paper_scene, monkeypatch):
    """Row 26: before anything is computed, with the size, what is allowed, and what to change."""
    monkeypatch.setenv(MEMORY_VARIABLE, "20 MB")
    with pytest.raises(ComputationError, match=r"0\.3\d* GB of memory, contact operators apart, and 0\.02 GB are allowed. Nothing was computed"):
        simulate(coarse_scene(paper_scene), preparation=lambda *arguments: pytest.fail("computed"))


def test_sizes_of_memory(monkeypatch):
    """Definition: decimal units; a wrong size is named with its variable; without one, a share of what is free."""
    assert size_in_bytes("1.5 GB", "x", "") == 1.5e9
    monkeypatch.setenv(MEMORY_VARIABLE, "much")
    with pytest.raises(SceneError, match="FENICS_GEARS_MEMORY = 'much' is no size"):
        allowed_memory()
    monkeypatch.delenv(MEMORY_VARIABLE)
    monkeypatch.delenv("OMPI_COMM_WORLD_LOCAL_SIZE", raising=False)
    alone = allowed_memory()
    monkeypatch.setenv("OMPI_COMM_WORLD_LOCAL_SIZE", "4")
    assert 1e7 < alone < 1e14 and allowed_memory() == pytest.approx(alone / 4, rel=0.2)
