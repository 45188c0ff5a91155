"""What condensing a gear's body over its face takes: `python tests/benchmarks/condensing.py SCENE pinion`, or under
`mpirun -n N`, of each rank. With PYTHONPATH at another checkout it measures that one."""

import resource
import sys
from pathlib import Path

from fenics_gears import load_scene, model_of
from fenics_gears.simulation.bodies import solid_of
from fenics_gears.system.job import led


def main(scene: str, name: str) -> None:
    """Condense without the cache; print seconds of the process, its libraries included, and its peak memory."""

    def condensed(job) -> int:
        solid_of(model_of(load_scene(Path(scene))), name, None, job)
        return 0

    led(condensed)
    used = resource.getrusage(resource.RUSAGE_SELF)
    print(f"user {used.ru_utime:6.2f} s, system {used.ru_stime:5.2f} s, {used.ru_maxrss / 1024.0:5.0f} MB", flush=True)


if __name__ == "__main__":
    main(*sys.argv[1:])
