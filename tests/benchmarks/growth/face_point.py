"""One point of an axis over the face, in a process of its own or in one for each rank: `python -m
tests.benchmarks.growth.face_point "layers" 8`.

As `point`; the processor's seconds of a rank count while it waits for another. Numbers are those of rank 0, which alone
holds the finished body.
"""

from __future__ import annotations

import json
import statistics
import sys
import time

from tests.benchmarks.growth.analysis import expected_by_mumps
from tests.benchmarks.growth.axes import axis_named
from tests.benchmarks.growth.face_axes import helical
from tests.benchmarks.growth.memory import array_bytes
from tests.benchmarks.growth.point import Point

from fenics_gears.elasticity.cache import Cache, user_cache
from fenics_gears.elasticity.face import compliance, condensed
from fenics_gears.elasticity.face.cost import expected_size
from fenics_gears.model.face_resolution import face_discretisation
from fenics_gears.model.model import model_of
from fenics_gears.simulation.elastic_route import gear_compliances
from fenics_gears.simulation.face_route import face_cycle, gear_bodies, gear_body
from fenics_gears.simulation.warm_up import compile_kernels
from fenics_gears.system.job import Job, led
from fenics_gears.system.progress import SilentProgress

# Dofs of flank and cuts that take some 6 GB and five minutes.
MOST_CONDENSED = 11900
PARTS = ("mesh", "assemble", "schur", "ring")


class FacePoint(Point):
    """The stages of the wheel's body, or of contact on bodies from the cache."""

    def body(self, job: Job | None = None) -> dict[str, float]:
        """Seconds of every part of condensing, which is the program's own account, and by the clock; memory; what was
        counted.

        Of a body that is too large to be condensed here, and of any on one rank, what MUMPS expects.
        """
        face, gear = face_discretisation(self.model, 1), self.model.pair.wheel
        if expected_size(gear, face)[1] <= MOST_CONDENSED:
            self._condense_body(job)
        if job is None:
            self.found |= expected_by_mumps(self.model)
        return self.found | {
            "teeth": gear.teeth, "layers": face.layers,
            "section_nodes": self.found["unknowns"] / (3 * (2 * face.layers + 1)),
            "ranks": 1 if job is None else job.size,
        }  # fmt: skip

    def _condense_body(self, job) -> None:
        found: dict[str, list[float]] = {part: [] for part in (*PARTS, "clock")}

        def run():
            begun = time.perf_counter()
            body = gear_body(self.model, "wheel", self.model.touching.reach, None, job)
            found["clock"].append(time.perf_counter() - begun)
            for part in PARTS:
                found[part].append(body.timings[f"time_{part}"])
            return body

        body = self._stage(
            "condense", run, lambda body: array_bytes(body.blocks) + 8 * body.timings["condensed_unknowns"] ** 2
        )
        self.found |= {f"{part}_s": statistics.median(seconds) for part, seconds in found.items()}
        self.found |= {name: body.timings[name] for name in ("unknowns", "condensed_unknowns")}

    def contact(self, cache: Cache) -> dict[str, float]:
        """Seconds and memory of the operators of a mesh cycle, and of the march through it; what was counted."""
        sections = gear_compliances(self.model, SilentProgress(), cache)
        bodies = gear_bodies(self.model, SilentProgress(), cache)

        def operators():
            cycle = face_cycle(self.model, sections, bodies)
            for step in range(cycle.steps):
                cycle.position(step)
            return cycle

        cycle = self._stage(
            "operators",
            operators,
            lambda cycle: array_bytes(cycle._built, cycle._pairs, cycle.mesh.response.__self__._bodies),
        )
        march = self._stage(
            "solving",
            lambda: self._march(cycle),
            lambda march: array_bytes([(each.state, each.solution) for each in march.records]),
        )
        return self.found | {
            "slices": self.model.face.slices, "steps": cycle.steps,
            "contact_nodes": self.model.resolution.contact_grid.nodes,
            "most_contact_rows": max(len(cycle.position(step).operator.compliance) for step in range(cycle.steps)),
            "newton_iterations": march.newton_iterations / march.steps,
            "closed_nodes": max(int((record.solution.status != 0).sum()) for record in march.records),
        }  # fmt: skip


def main(job: Job | None) -> int:
    """Measure the point that the command line names."""
    axis, value = axis_named(sys.argv[1]), float(sys.argv[2])
    small, cache = model_of(helical(layers=1)), user_cache()
    if axis.measured == "body":
        # Loads every library and compiles every form.
        FacePoint(small, set()).body(job)
        compliance.perf_counter = condensed.perf_counter = time.process_time
        found = FacePoint(model_of(axis.scene(value)), axis.stages if axis.counted != "ranks" else set()).body(job)
    else:
        compile_kernels(tangential=False)
        FacePoint(small, set()).contact(cache)
        found = FacePoint(model_of(axis.scene(value)), axis.stages).contact(cache)
    print(json.dumps(found))
    return 0


if __name__ == "__main__":
    sys.exit(led(main))
