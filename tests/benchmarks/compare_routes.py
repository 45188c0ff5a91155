"""The fast route against the reference route on the paper's pair: how far apart, and what each costs, in one run.

    .venv/bin/python -m tests.benchmarks.compare_routes --elements P2 P1 Q1 --sizes 0.16 0.08 0.04 --steps 100

A line for each element, size and case: distance of the two transmission errors over the last cycle (root mean square
    and
largest, of the mean), of their means and of their peak-to-peak values; then seconds of meshing, condensing and marching
by either route, first case of a size without any cache. With --arms the reference route once more with the base radii
as lever arms of normal forces.
"""

from __future__ import annotations

import argparse
import tempfile
from dataclasses import replace
from pathlib import Path

import numpy as np
from tests.simulation.reference.involute_lever_arms import with_involute_arms

from fenics_gears.elasticity.cache import Cache
from fenics_gears.model.resolution import EVERY_STEP, ONCE
from fenics_gears.scene.data import Accuracy, Motion
from fenics_gears.scene.read import load_scene
from fenics_gears.simulation.simulate import simulate
from fenics_gears.simulation.warm_up import compile_kernels

SCENE = Path(__file__).parents[2] / "demos" / "lundvall2004.toml"
LENGTH = 1.5
HEADING = (
    "element size/mm case             rms/mean   max/mean  mean      T_EPP(ref)/urad  T_EPP    fast/s  ref/s  ratio "
    " steps by method"
)


def cases(scene, cycles: int) -> dict:
    """The paper's scene quasi-static and at 200 Hz, with and without friction."""
    static = replace(scene, inertia=None, damping=None, motion=Motion(200.0, 1, 1))
    dynamic = replace(scene, motion=Motion(200.0, cycles, 1))
    return {
        "200 Hz, mu 0.1": dynamic,
        "200 Hz, mu 0": replace(dynamic, friction=None),
        "static, mu 0.1": static,
        "static, mu 0": replace(static, friction=None),
    }


def seconds(result) -> float:
    """Meshing, condensing and marching, without compilation."""
    return sum(result.attrs[f"time_{stage}"] for stage in ("mesh", "condense", "march"))


def distance(fast, reference) -> tuple[float, float, float, float]:
    """Root mean square and largest difference of T_E, and those of its mean, by its mean; relative difference of
    T_EPP."""
    difference = fast.transmission_error.values - reference.transmission_error.values
    mean = reference.transmission_error.values.mean()
    peaks = [np.ptp(result.transmission_error.values) for result in (fast, reference)]
    return (
        np.sqrt(np.mean(difference**2)) / mean,
        np.abs(difference).max() / mean,
        difference.mean() / mean,
        peaks[0] / peaks[1] - 1.0,
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--elements", nargs="+", default=["P2"])
    parser.add_argument(
        "--sizes", nargs="+", type=float, default=[0.16, 0.08, 0.04], help="flank elements and contact nodes, mm"
    )
    parser.add_argument("--steps", type=int, default=100, help="steps per mesh cycle")
    parser.add_argument("--cycles", type=int, default=30, help="mesh cycles at 200 Hz")
    parser.add_argument("--arms", action="store_true")
    options = parser.parse_args()
    compile_kernels(tangential=True)
    compile_kernels(tangential=False)
    print(HEADING)
    for element in options.elements:
        for size in options.sizes:
            with tempfile.TemporaryDirectory() as directory:
                compare(element, size, options, Cache(Path(directory)))


def compare(element: str, size: float, options, cache: Cache) -> None:
    """All cases at one resolution, a line each."""
    nodes = round(LENGTH / size) + 1
    for name, scene in cases(load_scene(SCENE), options.cycles).items():
        accuracy = Accuracy(
            element=element,
            flank_element_size=size,
            contact_length=LENGTH,
            contact_nodes=nodes,
            steps_per_mesh_cycle=options.steps,
        )
        fast = simulate(replace(scene, accuracy=replace(accuracy, condensation=ONCE)), cache=cache)
        slow_scene = replace(scene, accuracy=replace(accuracy, condensation=EVERY_STEP))
        reference = simulate(slow_scene, cache=cache)
        report(element, size, name, fast, reference)
        if options.arms:
            report(
                element, size, f"{name}, rb", fast, simulate(slow_scene, cache=cache, preparation=with_involute_arms)
            )


def report(element: str, size: float, name: str, fast, reference) -> None:
    rms, largest, mean, peaks = distance(fast, reference)
    peak = reference.attrs["peak_to_peak_transmission_error"] * 1e6
    costs = seconds(fast), seconds(reference)
    rungs = {
        key.split(": ")[1]: int(count) for key, count in reference.attrs.items() if key.startswith("steps_by_rung")
    }
    print(
        f"{element:7} {size:<7g} {name:16} {rms:.2e}   {largest:.2e}  {mean:+.2e} {peak:14.2f}   {peaks:+.2e}"
        f" {costs[0]:7.2f} {costs[1]:6.1f} {costs[1] / costs[0]:6.1f}  {rungs}",
        flush=True,
    )


if __name__ == "__main__":
    main()
