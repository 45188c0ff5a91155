"""How time and memory over the face grow with layers, slices and contact nodes, of a standard pair of 20 and 30 teeth.

``python -m tests.benchmarks.growth_over_face`` writes docs/pictures/growth_face.csv, from which `python -m
tests.docs.write` makes the tables of docs/evidence/growth.md. Processor seconds on one thread and memory in bytes, each
point in a process of its own: of the wheel's body; of the positions of a mesh cycle, which is what a first run takes
more than later ones with other misalignment; and of a later run. Exponents are fitted over the last three points.
"""

import csv
import json
import resource
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from statistics import median

import numpy as np
from tests.helical import CROWNED, FRICTION, helical_scene
from threadpoolctl import threadpool_limits

from fenics_gears.model.model import Model, model_of
from fenics_gears.runs.gear_store import GearStore
from fenics_gears.runs.one_run import completed
from fenics_gears.simulation.bodies import gear_body
from fenics_gears.system.progress import SilentProgress

KEPT = Path(__file__).parents[2] / "docs" / "pictures" / "growth_face.csv"
LATER_RUNS, FITTED = 5, 3
LAYERS, SLICES, NODES = "layers", "slices", "contact nodes of a tooth pair in a slice, with flank elements"
AXES = {LAYERS: (4, 6, 8, 12, 16, 24, 32), SLICES: (6, 12, 24, 48, 96), NODES: (9, 17, 33, 65)}
OF_CLOSED = "the bodies between sections of all slices, and rows of closed nodes, which all others see: n^2"
OF_CONTACT = {
    "operators": (2.0, OF_CLOSED),
    "operators arrays": (2.0, OF_CLOSED),
    "solving": (2.0, "products with these rows, n^2; for large n factors between closed nodes, n^3"),
    "friction": (2.0, "the same with twice the forces"),
}
# Of each axis what grows, the exponent by theory, and why.
THEORY = {
    LAYERS: {
        "condense": (3.0, "dense algebra of flank and cuts, whose nodes are proportional to the layers"),
        "condense peak": (2.0, "dense matrices of flank and cuts"),
    },
    SLICES: OF_CONTACT,
    NODES: OF_CONTACT,
}


def models(axis: str, value: int, friction: bool) -> list[Model]:
    """A first run and later ones."""
    sizes = {LAYERS: 8, SLICES: 12, NODES: 13} | {axis: value}
    accuracy = (
        f"layers = {sizes[LAYERS]}\nslices = {sizes[SLICES]}\ncontact_nodes = {sizes[NODES]}\nsteps_per_mesh_cycle = 8"
        # Flank elements of two spacings of contact nodes, which more nodes would not be independent in.
        f'\ncontact_length = "1.2 mm"\nflank_element_size = "{2.4 / (sizes[NODES] - 1)} mm"'
    )
    more = CROWNED + (FRICTION if friction else "")
    leaning = (f'{more}\n[misalignment]\nin_plane = "{lean} um"\n' for lean in range(5, 6 + LATER_RUNS))
    return [model_of(helical_scene(each, teeth=(20, 30), accuracy=accuracy)) for each in leaning]


def seconds(work: Callable[[], object]) -> float:
    begun = time.process_time()
    work()
    return time.process_time() - begun


def resident() -> int:
    """Bytes of memory that this process has."""
    return int(Path("/proc/self/statm").read_text(encoding="ascii").split()[1]) * resource.getpagesize()


def point(axis: str, value: int) -> dict[str, float]:
    """What is measured of a point, in this process."""
    with threadpool_limits(1):
        return _body(value) if axis == LAYERS else _contact(axis, value)


def _body(layers: int) -> dict[str, float]:
    # Loads every library and compiles every form.
    gear_body(models(LAYERS, 2, False)[0], "wheel", None)
    before, model = resident(), models(LAYERS, layers, False)[0]
    taken = seconds(lambda: gear_body(model, "wheel", None))
    return {"condense": taken, "condense peak": 1024 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before}


def _contact(axis: str, value: int) -> dict[str, float]:
    found: dict[str, float] = {}
    for friction, solving in ((False, "solving"), (True, "friction")):
        store = GearStore()
        # Loads all that is compiled.
        completed(models(axis, AXES[axis][0], friction)[0], GearStore().prepared)
        first, *later = models(axis, value, friction)
        store.bodies(first, SilentProgress(), None)
        before = resident()
        taken = seconds(lambda: completed(first, store.prepared))
        if not friction:
            found["operators arrays"] = resident() - before
        found[solving] = median(seconds(lambda each=each: completed(each, store.prepared)) for each in later)
        found.setdefault("operators", taken - found[solving])
    return found


def main() -> None:
    """Measure all points, or the one that the command line names."""
    if sys.argv[1:]:
        print(json.dumps(point(sys.argv[1], int(sys.argv[2]))))
        return
    rows = []
    for axis, values in AXES.items():
        found = []
        for value in values:
            called = [sys.executable, "-m", "tests.benchmarks.growth_over_face", axis, str(value)]
            found.append(json.loads(subprocess.run(called, check=True, capture_output=True, text=True).stdout))
            print(axis, value, found[-1], flush=True)
        for quantity, (theory, why) in THEORY[axis].items():
            taken = [each[quantity] for each in found]
            slope = np.polyfit(np.log(values[-FITTED:]), np.log(taken[-FITTED:]), 1)[0]
            kept = {f"{place}": f"{value}: {number:.3g}" for place, (value, number) in enumerate(zip(values, taken))}
            rows.append({"axis": axis, "quantity": quantity, "exponent": slope, "theory": theory, "why": why, **kept})
    with open(KEPT, "w", encoding="utf-8", newline="") as opened:
        writer = csv.DictWriter(opened, list(max(rows, key=len)), lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


if __name__ == "__main__":
    main()
