"""What the paper's scene costs, stage by stage: with friction at 200 Hz, 30 cycles of 100 steps.

    ./gears test tests/benchmarks/bench_paper_scene.py

Medians of the rounds are what counts; the numbers of one machine are not those of another. Peak memory of the whole
process:

    /usr/bin/time -v .venv/bin/python -m fenics_gears run demos/lundvall2004.toml
"""

from pathlib import Path

import pytest

from fenics_gears import load_scene, model_of
from fenics_gears.dynamics.march import Marcher
from fenics_gears.simulation.bodies import gear_bodies
from fenics_gears.simulation.elastic_route import mesh_cycle
from fenics_gears.simulation.warm_up import compile_kernels
from fenics_gears.system.progress import SilentProgress


@pytest.fixture(scope="module")
def model():
    compile_kernels(tangential=True)
    return model_of(load_scene(Path(__file__).parents[2] / "demos" / "lundvall2004.toml"))


@pytest.fixture(scope="module")
def bodies(model):
    return gear_bodies(model, SilentProgress(), None)


def marched(model, bodies):
    """All 3000 steps, the contact operators of the mesh cycle included."""
    cycle = mesh_cycle(model, bodies)
    return Marcher(cycle, model.equations_of_motion).run(model.steps, model.contact_steps)


def test_mesh_and_condense_both_gears(benchmark, model):
    benchmark.pedantic(gear_bodies, args=(model, SilentProgress(), None), rounds=7, warmup_rounds=1)


def test_contact_operators_of_a_mesh_cycle(benchmark, model, bodies):
    def build():
        cycle = mesh_cycle(model, bodies)
        for step in range(cycle.steps):
            cycle.position(step)

    benchmark.pedantic(build, rounds=7, warmup_rounds=1)


def test_march(benchmark, model, bodies):
    march = benchmark.pedantic(marched, args=(model, bodies), rounds=7, warmup_rounds=1)
    benchmark.extra_info["steps a second"] = round(march.steps / benchmark.stats["median"])
    benchmark.extra_info["newton iterations a step"] = march.newton_iterations / march.steps
    print(f"\n{benchmark.extra_info}")
