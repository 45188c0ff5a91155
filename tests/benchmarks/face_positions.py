"""What a position over the face costs, and a step: `python -m tests.benchmarks.face_positions [OLD_CHECKOUT]`.

Each scene is marched three times in a process of its own: to build its positions (and the gears, where the cache has
none), with the positions built, and once more. A position's cost is what the first steps take more than the last ones.
With an old checkout both take turns. Medians of `TURNS`; seconds of `user` and `sys`, and by the clock.
"""

import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
from tests.benchmarks.expected_cost import HELICAL_PAIR

ROOT, TURNS, STEPS = Path(__file__).parents[2], 3, 20
GUIDE = (
    HELICAL_PAIR
    + """
[friction]
coefficient = 0.06
[inertia]
mass = "1.5 kg"
moment_of_inertia = "2e-3 kg m^2"
[bearings]
stiffness = "0.155e6 N/mm"
axial_stiffness = "0.1e6 N/mm"
places = { pinion = ["-50 mm", "50 mm"], wheel = ["-50 mm", "50 mm"] }
[accuracy]
slices = 20
steps_per_mesh_cycle = 40
"""
)
SCENES = {
    "car's gear stage": (ROOT / "demos" / "helical_gearbox" / "gearbox.toml").read_text(encoding="utf-8"),
    "pair of the guide, friction and inertia": GUIDE,
}
COLUMNS = (
    "position_user", "position_sys", "position_wall", "position_megabytes", "step_user", "step_sys", "step_wall",
    "iterations",
)  # fmt: skip
# Run in the old and in the new checkout alike.
MEASURE = """
import json, resource, sys, time
import numpy as np
from fenics_gears.dynamics.march import Marcher
from fenics_gears.elasticity.cache import user_cache
from fenics_gears.model.model import model_of
from fenics_gears.scene.read import scene_from_text
from fenics_gears.simulation.elastic_route import elastic_route
from fenics_gears.simulation.warm_up import compile_kernels
from fenics_gears.system.progress import SilentProgress

def used():
    now = resource.getrusage(resource.RUSAGE_SELF)
    lines = open("/proc/self/status").read().splitlines()
    held = next(int(line.split()[1]) for line in lines if line.startswith("VmRSS"))
    return np.array([now.ru_utime, now.ru_stime, time.perf_counter(), held / 1024.0])

steps, name = int(sys.argv[1]), sys.argv[2]
model = model_of(scene_from_text(sys.stdin.read(), name))
gears, cycle = elastic_route(model, SilentProgress(), user_cache())
compile_kernels(model.scene.friction is not None)
# One position, so that all is compiled and loaded.
cycle.position(cycle.steps // 2)
found, counted = [], 0
for turn in range(3):
    begun = used()
    march = Marcher(cycle, model.equations_of_motion).run(steps, 1)
    found.append(used() - begun)
    counted = march.newton_iterations / steps
position, step = (found[0] - found[2]) / (steps + 2), found[2] / (steps + 2)
print(json.dumps([*position[:3] * 1e3, found[0][3] / (steps + 2), *step[:3] * 1e3, counted]))
"""


def measured(checkout: Path, name: str) -> list[float]:
    """The columns of a scene, by a checkout; ms and MB."""
    environment = {**os.environ, "PYTHONPATH": str(checkout), "OMP_NUM_THREADS": "1"}
    ended = subprocess.run(
        [sys.executable, "-P", "-c", MEASURE, str(STEPS), name],
        input=SCENES[name], env=environment, capture_output=True, text=True, check=True, cwd=checkout,
    )  # fmt: skip
    return json.loads(ended.stdout.splitlines()[-1])


def main(arguments: list[str]) -> None:
    """Print a line of every scene and checkout."""
    checkouts = [*(Path(each).resolve() for each in arguments), ROOT]
    print(f"{'ms a position and a step':46}" + "".join(f"{column:>20}" for column in COLUMNS))
    for name in SCENES:
        found = np.array([[measured(checkout, name) for checkout in checkouts] for _ in range(TURNS)])
        for checkout, row in zip(("before", "now")[-len(checkouts) :], np.median(found, axis=0)):
            print(f"{name + ', ' + checkout:46}" + "".join(f"{number:20.3g}" for number in row), flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
