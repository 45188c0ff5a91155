"""Remeshing shared out between MPI ranks."""

import numpy as np
import pytest
from tests.programs import CHECKOUT, gears

from fenics_gears import load_scene, results, simulate
from fenics_gears.elasticity.cache import Cache

pytestmark = pytest.mark.ranks


@pytest.fixture(scope="module")
def scene_file(tmp_path_factory):
    text = (CHECKOUT / "demos" / "lundvall2004.toml").read_text()
    for old, new in (
        ('condensation = "once"', 'condensation = "every step"'),
        ("steps_per_mesh_cycle = 100", "steps_per_mesh_cycle = 2"),
        ("mesh_cycles = 30", "mesh_cycles = 2"),
        ("contact_nodes = 20 ", "contact_nodes = 8 "),
        ('"0.08 mm"', '"0.3 mm"'),
    ):
        assert old in text
        text = text.replace(old, new)
    path = tmp_path_factory.mktemp("ranks") / "every_step.toml"
    path.write_text(text)
    return path


@pytest.mark.parametrize("ranks", [pytest.param(number, marks=pytest.mark.nightly) for number in (2, 3)])
def test_ranks_give_what_one_gives(scene_file, tmp_path, monkeypatch, ranks):
    """The number of threads changes round-off alone; only rank 0 writes."""
    monkeypatch.setenv("FENICS_GEARS_CACHE", str(tmp_path / "cache"))
    run = gears(tmp_path, "run", scene_file, "--output", tmp_path / "run", "--no-pictures", ranks=ranks)
    assert run.returncode == 0, run.stderr
    assert run.stdout.count("Files") == 1
    together, alone = (
        results.load(tmp_path / "run" / "run.nc"),
        simulate(load_scene(scene_file), cache=Cache(tmp_path / "other")),
    )
    for name in ("transmission_error", "contact_pressure", "friction_force"):
        scale = np.abs(alone[name].values).max()
        assert together[name].values == pytest.approx(alone[name].values, rel=1e-8, abs=1e-9 * scale, nan_ok=True)
    assert together.attrs["condensation"] == "every step"
