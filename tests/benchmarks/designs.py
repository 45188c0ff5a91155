"""What a run costs among others that differ in modifications, misalignment and torque, and what it costs by itself.

``python -m tests.benchmarks.designs [--runs N] [--friction] [--plane] [--element 0.12]``: runs of the pair of
`demos/helical_gearbox` over the face (left out by `--plane`; its flank elements in mm: 0.12 gives some 870 contact
nodes, 0.06 some 1,570), and of the paper's pair in the plane, quasi-static, drawn at random about the designs of the
demonstrations; gears are condensed before. Processor seconds of a run in medians: of this process and of the kernel;
contact operators that were built, positions between steps that were asked for, Newton's iterations.
"alone": nothing but gears is shared; "shared": one after the other on the same contact operators, the second half of
them; "together": as a search computes them, a task at a time, of which T_EPP alone is asked.
"""

from __future__ import annotations

import argparse
import resource
import tomllib
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.dynamics.marched import BetweenSteps
from fenics_gears.model.model import Model
from fenics_gears.runs.common_windows import CommonWindows
from fenics_gears.runs.gear_store import GearStore
from fenics_gears.runs.one_run import completed
from fenics_gears.runs.runs import MOST_TOGETHER
from fenics_gears.simulation.together import solved_together
from fenics_gears.studies.scenes import model_of_tree

DEMOS = Path(__file__).parents[2] / "demos"
ACCURACY = {"steps_per_mesh_cycle": 20, "contact_length": "1.2 mm", "slices": 28, "layers": 14}
NO_FIELDS = {"output": {"contact_fields": False}}
FRICTION = {"friction": {"coefficient": 0.05}}


def over_the_face(friction: bool, draw: np.random.Generator, element: float) -> Iterator[Model]:
    """Designs of the helical pair: relief, crowning, helix slope, misalignment, three torques."""
    tree = tomllib.loads((DEMOS / "helical_gearbox" / "gearbox.toml").read_text(encoding="utf-8"))
    tree |= (
        NO_FIELDS | {"accuracy": ACCURACY | {"flank_element_size": f"{element} mm"}} | (FRICTION if friction else {})
    )
    while True:
        depth, crowning, slope, lean = draw.uniform((18.0, 6.0, -3.0, 15.0), (26.0, 10.0, 3.0, 30.0))
        tree["tip_relief"] = tree["tip_relief"] | {"depth": f"{depth:.4g} um"}
        tree["lead_modifications"] = {"pinion": {"crowning": f"{crowning:.4g} um", "helix_slope": f"{slope:.4g} um"}}
        tree["misalignment"] = {"in_plane": f"{lean:.4g} um"}
        for torque in (280, 300, 320):
            yield model_of_tree("design", tree | {"load": {"wheel_torque": f"{torque} N m"}}, DEMOS)


def in_the_plane(friction: bool, draw: np.random.Generator, element: float) -> Iterator[Model]:
    """Designs of the search `demos/best_relief`."""
    tree = tomllib.loads((DEMOS / "lundvall2004.toml").read_text(encoding="utf-8"))
    left_out = ("inertia", "damping", "motion", *(() if friction else ("friction",)))
    tree = {name: section for name, section in tree.items() if name not in left_out} | NO_FIELDS
    while True:
        depth, length = draw.uniform((5.0, 3.0), (50.0, 9.0))
        relief = {"depth": f"{depth:.4g} um", "length_on_path": f"{length:.4g} mm"}
        yield model_of_tree("design", tree | {"tip_relief": relief}, DEMOS)


def spent(model: Model, store: GearStore) -> list[float]:
    """User and kernel seconds of a run, operators built, positions asked for between steps, iterations."""
    counted, build, solve = [0, 0], Cycle._build, BetweenSteps._solve_each

    def counting_built(cycle, ends):
        counted[0] += len(ends)
        return build(cycle, ends)

    def counting_places(between, places):
        counted[1] += len(places)
        solve(between, places)

    Cycle._build, BetweenSteps._solve_each = counting_built, counting_places
    before = resource.getrusage(resource.RUSAGE_SELF)
    try:
        result = completed(model, store.prepared)
    finally:
        Cycle._build, BetweenSteps._solve_each = build, solve
    after = resource.getrusage(resource.RUSAGE_SELF)
    seconds = after.ru_utime - before.ru_utime, after.ru_stime - before.ru_stime
    return [*seconds, *counted, result.attrs["newton_iterations_total"]]


def together(models: Iterator[Model], store: GearStore, runs: int) -> list[float]:
    """As of `spent`, medians over tasks of runs that are computed together, the second half of so many."""
    found, windows = [], CommonWindows()
    for _ in range(max(runs // MOST_TOGETHER, 4)):
        task = windows.of([next(models) for _ in range(MOST_TOGETHER)])
        before = resource.getrusage(resource.RUSAGE_SELF)
        results = solved_together(task, store.prepared, ["peak_to_peak_transmission_error"])
        after = resource.getrusage(resource.RUSAGE_SELF)
        seconds = after.ru_utime - before.ru_utime, after.ru_stime - before.ru_stime
        iterations = sum(result.attrs["newton_iterations_total"] for result in results)
        found.append([each / MOST_TOGETHER for each in (*seconds, np.nan, np.nan, iterations)])
    return found


def main() -> None:
    """Print a row for each kind of pair and way."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--runs", type=int, default=24)
    parser.add_argument("--friction", action="store_true")
    parser.add_argument("--plane", action="store_true")
    parser.add_argument("--element", type=float, default=0.12)
    options = parser.parse_args()
    print(f"{'':26}{'user ms':>9}{'kernel ms':>11}{'built':>7}{'between':>9}{'iterations':>12}")
    for name, designs in (("over the face", over_the_face), ("in the plane", in_the_plane))[options.plane :]:
        for way in ("alone", "shared", "together"):
            models = designs(options.friction, np.random.default_rng(1), options.element)
            store = GearStore(None, way != "alone")
            runs = options.runs if way != "alone" else max(options.runs // 6, 2)
            each = (
                together(models, store, runs)
                if way == "together"
                else [spent(next(models), store) for _ in range(runs)]
            )
            user, kernel, *others = np.median(each[len(each) // 2 :], axis=0)
            figures = "".join(f"{each:>{width}.0f}" for each, width in zip(others, (7, 9, 12)))
            print(f"{f'{name}, {way}':26}{1e3 * user:9.0f}{1e3 * kernel:11.0f}{figures}", flush=True)


if __name__ == "__main__":
    main()
