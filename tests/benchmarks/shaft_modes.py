"""What modes of elastic shafts cost a time step, in processor time: of this checkout, or of two in turn.

    python -m tests.benchmarks.shaft_modes [OTHER_CHECKOUT] [--turns 7]

For scenes on bodies without finite elements, with no, few and more modes: the median over the turns of a march's ms,
its Newton iterations, and the cost of a march, and of an iteration, over that without modes; of two checkouts also the
median ratio of this one to the other and the largest relative difference of the motions.
"""

import argparse
import json
import statistics
import sys
import time
from math import ceil
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parents[2]
FRICTION = "[friction]\ncoefficient = 0.05\n"
SCENES = {
    "coarse": ("", "slices = 5\ncontact_nodes = 9\nsteps_per_mesh_cycle = 64"),
    "coarse, friction": (FRICTION, "slices = 5\ncontact_nodes = 9\nsteps_per_mesh_cycle = 64"),
    "fine": ("", "slices = 25\ncontact_nodes = 61\nsteps_per_mesh_cycle = 64"),
    "fine, friction": (FRICTION, "slices = 25\ncontact_nodes = 61\nsteps_per_mesh_cycle = 64"),
}
# Hz up to which shafts have modes; and mesh cycles of a run, of which the first makes the contact.
UP_TO, CYCLES = (1.0, 8e3, 2e4), 6
# Seconds that a turn takes at least, by as many marches.
OF_A_TURN = 0.1


def marchers():
    """By scene and number of modes, what marches and how far."""
    from unittest.mock import patch

    from tests.elastic_shaft_scenes import VIBRATING
    from tests.hard_cases.invariants import cycle_of
    from tests.helical import helical_scene, on_stand_in_bodies

    from fenics_gears import model_of
    from fenics_gears.dynamics.march import Marcher

    for name, (more, accuracy) in SCENES.items():
        for up_to in UP_TO:
            with patch("fenics_gears.model.drivetrain.highest_of_interest", return_value=0.5 * up_to):
                scene = helical_scene(VIBRATING + more, accuracy=accuracy, frequency=400.0, cycles=CYCLES)
                model = model_of(scene)
                drivetrain = model.drivetrain
            modes = sum("_mode_" in each for each in drivetrain.coordinates)
            cycle = cycle_of(model, on_stand_in_bodies(model))
            yield (
                f"{name}, {modes} modes",
                lambda of=Marcher(cycle, model.equations_of_motion), to=model.steps: of.run(to, to + 1),
            )


def serve() -> None:
    """In the process of a checkout: ms, iterations and motions of each march for each line that comes in."""
    runs, times = dict(marchers()), {}
    for name, run in runs.items():
        run()
        begun = time.process_time()
        run()
        times[name] = ceil(OF_A_TURN / (time.process_time() - begun))
    for _ in sys.stdin:
        found = {}
        for name, run in runs.items():
            begun = time.process_time()
            for _ in range(times[name]):
                march = run()
            took = (time.process_time() - begun) / times[name]
            motion = [each.state.position.tolist() for each in march.records]
            found[name] = 1e3 * took, march.newton_iterations, motion
        print(json.dumps(found), flush=True)


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("other", nargs="?", type=Path)
    parser.add_argument("--turns", type=int, default=7)
    parser.add_argument("--serve", action="store_true", help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.serve:
        return serve()
    # Imported here: another checkout, which `serve` measures, may not have it.
    from tests.benchmarks.in_turns import answers_in_turns

    checkouts = [options.other.resolve(), HERE] if options.other else [HERE]
    found = answers_in_turns(__file__, checkouts, (), options.turns)
    for name in found[0][0]:
        print(_line(name, found))


def _line(name: str, checkouts: list[list[dict]]) -> str:
    without = name.rpartition(", ")[0] + ", 0 modes"
    words = f"{name:28}"
    for turns in checkouts:
        took, iterations = statistics.median(turn[name][0] for turn in turns), turns[0][name][1]
        march = statistics.median(turn[name][0] / turn[without][0] for turn in turns)
        one = march * turns[0][without][1] / iterations
        words += f"  {took:8.1f} ms, {iterations} iterations, march {march:.2f} and iteration {one:.2f} of none"
    if len(checkouts) > 1:
        old, new = checkouts
        moved, before = (np.array(turns[0][name][2]) for turns in (new, old))
        ratio = statistics.median(b[name][0] / a[name][0] for a, b in zip(old, new))
        words += f"  ratio {ratio:.2f}, differs {np.abs(moved - before).max() / np.abs(before).max():.0e}"
    return words


if __name__ == "__main__":
    main()
