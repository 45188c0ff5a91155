"""One point of an axis, in a process of its own: `python -m tests.benchmarks.growth.point "flank nodes" 100` prints its
numbers as JSON.

A stage that theory says something about is run until it has been run five times, or has taken long enough; medians
count. Seconds are the processor's, which on one thread are those of an idle machine, whatever else this one does.
"""

from __future__ import annotations

import gc
import json
import statistics
import sys
import time
from collections.abc import Callable
from dataclasses import replace

from tests.benchmarks.growth.axes import axis_named, paper
from tests.benchmarks.growth.memory import array_bytes, forget_peak, peak, resident

from fenics_gears.dynamics.march import Marcher
from fenics_gears.elasticity import condensation, gear_compliance, ring
from fenics_gears.elasticity.element_sizes import element_sizes
from fenics_gears.elasticity.elements import element_named
from fenics_gears.elasticity.sector_mesh import sector_mesh
from fenics_gears.model.model import Model, model_of
from fenics_gears.simulation.elastic_route import gear_compliances, mesh_cycle
from fenics_gears.simulation.warm_up import compile_kernels
from fenics_gears.system.progress import SilentProgress

ROUNDS, MOST_SECONDS = 5, 4.0
# With more dofs on a cut than this the Fourier transform over the sectors takes minutes.
MOST_CUT_DOFS = 700
GEARS = ("pinion", "wheel")


class Point:
    """The stages of one scene, measured; `repeated`: those that are timed more than once; `compares_rings`: by both
    routes."""

    def __init__(self, model: Model, repeated: set[str], compares_rings: bool = False):
        self.model, self.repeated, self.compares_rings = model, repeated, compares_rings
        gc.collect()
        self.found = {"idle_bytes": resident()}

    def measured(self) -> dict[str, float]:
        """Of every stage its seconds, the process's peak, that above its idle, arrays' bytes; and what was counted."""
        self._stage("mesh", self._mesh, array_bytes)
        compliances = self._condense()
        if self.compares_rings:
            self._transformed(compliances)
        cycle = self._stage("operators", lambda: self._operators(compliances), _bytes_of_cycle)
        march = self._stage(
            "solving",
            lambda: self._march(cycle),
            lambda march: array_bytes([(each.state, each.solution) for each in march.records]),
        )
        grid, teeth = self.model.resolution.contact_grid, self.model.pair.wheel.teeth
        return self.found | {
            "flank_nodes": compliances[0].nodes, "contact_nodes": grid.nodes, "teeth": teeth, "steps": cycle.steps,
            "cycles": march.steps / cycle.steps, "unknowns": sum(gear.timings["unknowns"] for gear in compliances),
            "condensed_unknowns": max(gear.timings["condensed_unknowns"] for gear in compliances),
            "most_contact_rows": max(len(cycle.position(step).operator.compliance) for step in range(cycle.steps)),
            "newton_iterations": march.newton_iterations / march.steps,
            "closed_nodes": max(int((record.solution.status != 0).sum()) for record in march.records),
        }  # fmt: skip

    def _stage(self, name: str, run: Callable, held: Callable):
        """What the first round gives, which alone is looked at for memory; then more rounds for the time."""
        gc.collect()
        forget_peak()
        seconds, rounds = [], ROUNDS if name in self.repeated else 1
        while not seconds or (len(seconds) < rounds and sum(seconds) + seconds[-1] < MOST_SECONDS):
            begun = time.process_time()
            found = run()
            seconds.append(time.process_time() - begun)
            if len(seconds) == 1:
                first = found
                self._memory(name, held(first))
            del found
        self.found |= {f"{name}_s": statistics.median(seconds), f"{name}_rounds": len(seconds)}
        return first

    def _memory(self, name: str, held: int) -> None:
        most = peak()
        self.found |= {
            f"{name}_peak_bytes": most,
            f"{name}_above_idle_bytes": max(most - self.found["idle_bytes"], 0),
            f"{name}_array_bytes": held,
        }

    def _mesh(self):
        scene, resolution = self.model.scene, self.model.resolution
        element = element_named(resolution.element)
        meshes = []
        for gear in (getattr(self.model.pair, name) for name in GEARS):
            sizes = element_sizes(gear, element, resolution.flank_element_size, resolution.body_element_size)
            meshes.append(
                sector_mesh(
                    gear.of_module_one, replace(sizes, both_flanks=scene.coast_flanks is not None).in_modules_of(gear)
                )
            )
        return meshes

    def _condense(self):
        """Both gears; seconds of assembling, Schur complement and ring are the program's own."""

        def held(gears) -> int:
            dense = [8 * gear.timings["condensed_unknowns"] ** 2 for gear in gears]
            return array_bytes([gear.blocks for gear in gears]) + max(dense)

        parts = {"assemble": [], "schur": [], "ring": []}

        def run():
            gears = gear_compliances(self.model, SilentProgress(), None)
            for part, found in parts.items():
                found.append(sum(_seconds(gear, part) for gear in gears))
            return gears

        gears = self._stage("condense", run, held)
        # The stage meshes too, which is no part of condensing.
        self.found |= {f"{part}_s": statistics.median(found) for part, found in parts.items()}
        self.found["condense_s"] = sum(self.found[f"{part}_s"] for part in parts)
        return gears

    def _transformed(self, gears) -> None:
        """The ring of sectors once more by its Fourier transform, which the program leaves to gears of few teeth."""
        cut_dofs = max(0.5 * (gear.timings["condensed_unknowns"] - 2 * gear.nodes) for gear in gears)
        if cut_dofs > MOST_CUT_DOFS:
            return
        chosen, ring.chain_is_quicker = ring.chain_is_quicker, lambda teeth, reach: False
        try:
            self.found["fourier_s"] = sum(
                _seconds(gear, "ring") for gear in gear_compliances(self.model, SilentProgress(), None)
            )
        finally:
            ring.chain_is_quicker = chosen

    def _operators(self, compliances):
        cycle = mesh_cycle(self.model, compliances)
        for step in range(cycle.steps):
            cycle.position(step)
        return cycle

    def _march(self, cycle):
        model = self.model
        marcher = Marcher(cycle, model.equations_of_motion)
        return marcher.run(model.steps, model.contact_steps)


def _bytes_of_cycle(cycle) -> int:
    """Of all that a mesh cycle keeps: positions, tooth pairs, and the flanks' compliances as it goes through them."""
    return array_bytes(cycle._built, cycle._pairs, cycle.mesh.response.__self__._blocks)


def warmed_up() -> None:
    """Every library loaded and every kernel and form compiled, so that neither counts."""
    compile_kernels(tangential=True)
    small = paper()
    small = replace(
        small, accuracy=replace(small.accuracy, flank_element_size=0.5, contact_nodes=9, steps_per_mesh_cycle=4)
    )
    Point(model_of(small), set()).measured()


def main() -> None:
    """Measure the point that the command line names."""
    name, value = sys.argv[1], float(sys.argv[2])
    for module in (condensation, gear_compliance):
        module.perf_counter = time.process_time
    warmed_up()
    axis = axis_named(name)
    print(json.dumps(Point(model_of(axis.scene(value)), axis.stages, "fourier" in axis.theory).measured()))


if __name__ == "__main__":
    main()


def _seconds(gear, part: str) -> float:
    """Of assembling, of the Schur complement, or of the ring: what condensing takes besides these two."""
    times = {name: gear.timings[f"time_{name}"] for name in ("condense", "assemble", "schur")}
    return times["condense"] - times["assemble"] - times["schur"] if part == "ring" else times[part]
