"""Memory that a run may take."""

import re

import numpy as np
import pytest
from tests.coarse import coarse_scene
from tests.programs import DEMO

from fenics_gears import ComputationError, SceneError, expected_cost, model_of, simulate
from fenics_gears.commands.cli import main
from fenics_gears.elasticity.cache import user_cache
from fenics_gears.simulation import simulate as simulation
from fenics_gears.simulation.routes import prepared
from fenics_gears.system.memory import MEMORY_VARIABLE, allowed_memory, size_in_bytes


@pytest.mark.parametrize("share", [pytest.param(0.0, marks=pytest.mark.nightly), 0.4])
def test_operators_that_are_not_kept_change_no_number(paper_scene, monkeypatch, share):
    """Operators made again in every mesh cycle, and operators kept."""
    scene = coarse_scene(paper_scene, cycles=3)
    whole, made = simulate(scene), []

    def preparation(model, progress, cache):
        gears, cycle = prepared(model, progress, cache)
        build = cycle._build
        monkeypatch.setattr(cycle, "_build", lambda ends: made.extend(ends) or build(ends))
        return gears, cycle

    operators = expected_cost(model_of(scene)).operators
    monkeypatch.setattr(simulation, "memory_for_operators", lambda model: share * operators)
    again = simulate(scene, preparation=preparation, cache=user_cache())
    steps = scene.accuracy.steps_per_mesh_cycle
    assert len(made) > (3 if share == 0.0 else 1.5) * steps
    for name, variable in whole.data_vars.items():
        # Works are summed block by block, and blocks are shorter where memory is.
        np.testing.assert_allclose(
            again.variables[name].values,
            variable.values,
            rtol=1e-12,
            atol=1e-9 if name == "energy_defect" else 0.0,
            err_msg=name,
        )


def test_a_run_that_does_not_fit_is_refused(paper_scene, monkeypatch):
    """Row 26: with the size, what is allowed, and what to change."""
    monkeypatch.setenv(MEMORY_VARIABLE, "20 MB")
    with pytest.raises(
        ComputationError,
        match=r"0\.3\d* GB of memory, contact operators apart, and 0\.02 GB are allowed. Nothing was computed",
    ):
        simulate(coarse_scene(paper_scene), preparation=lambda *arguments: pytest.fail("computed"))


def test_check_says_that_a_scene_cannot_fit(tmp_path, monkeypatch, capsys):
    """Row 26: as a run, after the description; exit code 3. With another machine's memory it fits."""
    wide = tmp_path / "wide.toml"
    wide.write_text(
        (DEMO.parent / "misaligned_spur" / "misaligned.toml").read_text().replace("slices = 12", "slices = 300"),
        encoding="utf-8",
    )
    monkeypatch.setenv(MEMORY_VARIABLE, "8 GB")
    assert main(["check", str(wide)]) == 3
    told = capsys.readouterr()
    assert "Effects" in told.out and re.search(
        r"CANNOT FIT: The run would take [\d.]+ GB .* 8 GB are allowed.*slices.*here 300.*--memory", told.err
    )
    assert main(["check", str(wide), "--memory", "1 TB"]) == 0
    assert "CANNOT" not in capsys.readouterr().err


def test_sizes_of_memory(monkeypatch):
    """Definition: decimal units; without one, a share of what is free."""
    assert size_in_bytes("1.5 GB", "x", "") == 1.5e9
    monkeypatch.setenv(MEMORY_VARIABLE, "much")
    with pytest.raises(SceneError, match="FENICS_GEARS_MEMORY = 'much' is no size"):
        allowed_memory()
    monkeypatch.delenv(MEMORY_VARIABLE)
    monkeypatch.delenv("OMPI_COMM_WORLD_LOCAL_SIZE", raising=False)
    alone = allowed_memory()
    monkeypatch.setenv("OMPI_COMM_WORLD_LOCAL_SIZE", "4")
    assert 1e7 < alone < 1e14 and allowed_memory() == pytest.approx(alone / 4, rel=0.2)
