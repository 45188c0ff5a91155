"""Memory that a run may take."""

import re
from dataclasses import replace

import numpy as np
import pytest
from tests.coarse import coarse_scene, frictionless
from tests.paper_text import COARSE, coarse_text
from tests.programs import DEMO

from fenics_gears import ComputationError, SceneError, expected_cost, model_of, simulate
from fenics_gears.commands.cli import main
from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.elasticity.cache import user_cache
from fenics_gears.model.cost_parts import ON_FLANKS, contact_of
from fenics_gears.results import load, save
from fenics_gears.results.root_stress_variables import RootStress
from fenics_gears.results.side_by_side import KnownLayouts
from fenics_gears.scene.data import Output
from fenics_gears.simulation.routes import prepared
from fenics_gears.system.memory import MEMORY_VARIABLE, allowed_memory, size_in_bytes


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
        (DEMO.parent / "misaligned_spur" / "misaligned.toml").read_text().replace("slices = 12", "slices = 450"),
        encoding="utf-8",
    )
    monkeypatch.setenv(MEMORY_VARIABLE, "8 GB")
    assert main(["check", str(wide)]) == 3
    told = capsys.readouterr()
    assert "Effects" in told.out
    found = re.search(
        r"CANNOT FIT: The run would take [\d.]+ GB .* 8 GB are allowed.* computed. It fits with (body_element_size = "
        r".*, layers = .*, slices = \d+) in \[accuracy\]\..*target = .*--memory",
        told.err,
    )
    assert main(["check", str(wide), "--memory", "1 TB"]) == 0
    assert "CANNOT" not in capsys.readouterr().err
    # With what is named, in place of what the scene has, it fits.
    kept = re.sub(r"^(body_element_size|layers|slices) = .*\n", "", wide.read_text(encoding="utf-8"), flags=re.M)
    named = found[1].replace(", ", "\n")
    wide.write_text(kept.replace("[accuracy]\n", f"[accuracy]\n{named}\n"), encoding="utf-8")
    assert main(["check", str(wide)]) == 0


def test_operators_are_given_up_where_memory_ends(paper_scene):
    """Identity with the run that has enough: none of it is computed twice into the result."""
    scene, ends = coarse_scene(paper_scene, cycles=3), iter((0, 0, 1, 0, 0, 1))
    whole = simulate(scene)

    def preparation(model, progress, cache):
        gears, cycle = prepared(model, progress, cache)
        build = cycle.build

        def building(steps):
            build(steps)
            if next(ends, 0):
                raise MemoryError

        cycle.build = building
        return gears, cycle

    again = simulate(scene, preparation=preparation, cache=user_cache())
    assert next(ends, None) is None and again.attrs["complete"]
    for name in ("transmission_error", "pair_normal_force", "newton_iterations"):
        np.testing.assert_allclose(again[name].values, whole[name].values, rtol=1e-12)


def test_what_is_done_is_kept_where_memory_ends(tmp_path, monkeypatch, capsys):
    """Exit code 3; the result has the steps before, and says why there are no more."""
    scene, build = tmp_path / "scene.toml", Cycle.build
    scene.write_text(coarse_text(cycles=3, accuracy=COARSE), encoding="utf-8")

    def building(cycle, steps):
        if max(steps) > 60:
            raise MemoryError
        build(cycle, steps)

    monkeypatch.setattr(Cycle, "build", building)
    assert main(["run", str(scene), "-o", str(tmp_path / "out"), "--no-pictures", "-q"]) == 3
    assert re.search(r"Memory ended at step \d+ of 120.*\n.*is kept, marked incomplete", capsys.readouterr().err)
    result = load(tmp_path / "out" / "run.nc")
    assert 0 < result.sizes["time"] <= 61 and not result.attrs["complete"] and result.attrs["stopped"] == "failed"


def test_memory_that_ends_before_the_march_has_words(paper_scene, monkeypatch, capsys):
    """Exit code 3, in a run and in any command."""

    def ended(*arguments):
        raise MemoryError

    with pytest.raises(ComputationError, match="Memory ended before the run was over"):
        simulate(coarse_scene(paper_scene), preparation=ended)
    monkeypatch.setattr("fenics_gears.commands.cli._carried_out", ended)
    assert main(["check", str(DEMO)]) == 3
    assert "Memory ended before the command was done" in capsys.readouterr().err


def cycle_of_a_run(scene):
    """What the march of a run went through."""
    found = []

    def preparation(model, progress, cache):
        gears, cycle = prepared(model, progress, cache)
        found.append(cycle)
        return gears, cycle

    simulate(scene, preparation=preparation, cache=user_cache())
    return found[0]


@pytest.mark.parametrize("friction", [False, True])
def test_contact_operators_take_what_is_expected(paper_scene, friction):
    """The arrays themselves, on the average over the mesh cycle: flanks end within their windows."""
    scene = coarse_scene(paper_scene, cycles=1)
    if not friction:
        scene = frictionless(scene)
    cycle = cycle_of_a_run(scene)
    operators = [cycle.position(step).operator for step in range(scene.accuracy.steps_per_mesh_cycle)]
    matrices = [each for own in operators for each in (own.compliance, own.previous_compliance) if each is not None]
    assert expected_cost(model_of(scene)).operators == pytest.approx(sum(each.nbytes for each in matrices), rel=0.1)


def test_layouts_of_a_long_mesh_cycle_are_held_once(paper_scene, monkeypatch):
    """Count: each position's nodes once, in however many blocks the march goes through the cycle."""
    scene = coarse_scene(paper_scene, cycles=1)
    monkeypatch.setattr("fenics_gears.dynamics.march.LONGEST_BLOCK", 5)
    cycle = cycle_of_a_run(scene)
    layouts = cycle.shared(KnownLayouts)
    assert len(layouts._joined) >= scene.accuracy.steps_per_mesh_cycle / 5
    held = {id(known): known for joined in layouts._joined.values() for known in joined._known}
    nodes = sum(end - first for _, first, end, _ in layouts._parts.values())
    assert sum(len(known["node"]) for known in held.values()) == nodes


def test_root_stress_holds_of_the_positions_what_is_expected(paper_scene, monkeypatch):
    """The arrays themselves: what a contact node loads, where blocks of all nodes of a pair took ten times as much and
    ended runs that `check` had told to fit."""
    made, scene = [], replace(coarse_scene(paper_scene, cycles=1), output=Output(root_stress=True))
    of_gear = RootStress._of_gear

    def kept(*arguments):
        made.append(of_gear(*arguments))
        return made[-1]

    monkeypatch.setattr(RootStress, "_of_gear", kept)
    simulate(scene, cache=user_cache())
    contact = contact_of(model_of(scene))
    expected = ON_FLANKS * 2 * contact.nodes * contact.positions
    found = sum(each.nbytes for _, rows in made for each in (rows.data, rows.indices, rows.indptr))
    assert expected / 4.0 < found < 1.5 * expected


def test_a_file_takes_at_least_what_the_disk_is_asked_for(paper_scene, tmp_path):
    """The file itself."""
    scene = coarse_scene(paper_scene, cycles=3)
    save(simulate(scene, cache=user_cache()), tmp_path / "run.nc")
    model = model_of(scene)
    assert 0.05 * model.stored_bytes < model.least_file_bytes < (tmp_path / "run.nc").stat().st_size


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
