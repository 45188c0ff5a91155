"""What the stages of a plane run cost, in processor time: of this checkout, or of two in turn.

    python -m tests.benchmarks.stages [OTHER_CHECKOUT] [--turns 7] [--scene demos/lundvall2004.toml] [--root-stress]

Prints the median and the least of the turns in ms and, of two checkouts, the median ratio of this one to the other: on
a machine that others use, the ratio alone is safe. Each checkout has a process of its own, with its kernels compiled
and its gears in the cache of the user.
"""

import argparse
import json
import statistics
import sys
import time
from pathlib import Path

HERE = Path(__file__).resolve().parents[2]


def stages(model, condense: bool) -> dict[str, float]:
    """Seconds of each stage of a run."""
    from fenics_gears.dynamics.march import Marcher
    from fenics_gears.elasticity.cache import user_cache
    from fenics_gears.results.recorder import Recorder
    from fenics_gears.simulation.routes import prepared
    from fenics_gears.simulation.simulate import result_of, root_stress_of
    from fenics_gears.system.progress import SilentProgress

    took, progress, cache, begun = {}, SilentProgress(), user_cache(), time.process_time()

    def done(stage: str) -> None:
        nonlocal begun
        now = time.process_time()
        took[stage], begun = now - begun, time.process_time()

    if condense:
        prepared(model, progress, None)
        done("meshing and condensing both gears")
    gears, cycle = prepared(model, progress, cache)
    done("gears from the cache")
    # An earlier checkout, which may be measured, makes them one by one.
    if hasattr(cycle, "build"):
        cycle.build(range(cycle.steps))
    for step in range(cycle.steps):
        cycle.position(step)
    done("contact operators of a mesh cycle")
    Marcher(cycle, model.equations_of_motion).run(model.steps, 1)
    done("march")
    stress = root_stress_of(model, cycle, progress, cache)
    recorder = Recorder(model, cycle, stress=stress)
    begun = time.process_time()
    march = Marcher(cycle, model.equations_of_motion).run(model.steps, 1, None, recorder.take)
    recorder.finish()
    done("march with recording")
    result_of(recorder, march, gears, 0.0, "").dataset
    done("dataset")
    return took


def serve(scene: Path, root_stress: bool, condense: bool) -> None:
    """In the process of a checkout: times of a run for each line that comes in."""
    from dataclasses import replace

    from fenics_gears.model.model import model_of
    from fenics_gears.scene.read import load_scene
    from fenics_gears.simulation.warm_up import compile_kernels

    read = load_scene(scene)
    model = model_of(replace(read, output=replace(read.output, root_stress=read.output.root_stress or root_stress)))
    compile_kernels(tangential=read.friction is not None)
    stages(model, condense=False)
    for _ in sys.stdin:
        print(json.dumps(stages(model, condense)), flush=True)


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("other", nargs="?", type=Path)
    parser.add_argument("--turns", type=int, default=7)
    parser.add_argument("--scene", type=Path, default=HERE / "demos" / "lundvall2004.toml")
    parser.add_argument("--root-stress", action="store_true")
    parser.add_argument("--condense", action="store_true", help="both gears without the cache too")
    parser.add_argument("--serve", action="store_true", help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.serve:
        return serve(options.scene, options.root_stress, options.condense)
    # Imported here: another checkout, which `serve` measures, may not have it.
    from tests.benchmarks.in_turns import answers_in_turns

    checkouts = [options.other.resolve(), HERE] if options.other else [HERE]
    arguments = ["--scene", str(options.scene.resolve()), *(["--root-stress"] * options.root_stress)]
    arguments += ["--condense"] * options.condense
    by_checkout = answers_in_turns(__file__, checkouts, arguments, options.turns)
    for stage in by_checkout[0][0]:
        taken = [[turn[stage] for turn in turns] for turns in by_checkout]
        words = "".join(f"  {1e3 * statistics.median(each):8.1f} (least {1e3 * min(each):7.1f})" for each in taken)
        ratio = statistics.median([new / old for old, new in zip(taken[0], taken[-1])])
        print(f"{stage:34}{words} ms" + (f"  ratio {ratio:.2f}" if options.other else ""))


if __name__ == "__main__":
    main()
