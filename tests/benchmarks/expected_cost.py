"""Expected cost beside measured, of the examples: `python -m tests.benchmarks.expected_cost [NAME ...]`. Each runs in a
process of its own on one thread with an empty cache; seconds are the processor's, memory is the process's peak."""

import io
import json
import os
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).parents[2]
PAPER = ROOT / "demos" / "lundvall2004.toml"
DEMOS = (
    PAPER,
    *(
        ROOT / "demos" / name
        for name in ("flank_errors/flank_errors.toml", "cracked_tooth/cracked_tooth.toml", "speed_ramp/up.toml")
    ),
)
STAGES = ("condensing", "marching", "memory")

LARGER_PAIR = """
[gears]
module = "3 mm"
pressure_angle = "20 deg"
centre_distance = "105.15 mm"
face_width = "25 mm"
pinion = { teeth = 23, profile_shift = 0, tip_diameter = "75 mm", root_diameter = "61.5 mm", bore_diameter = "30 mm" }
wheel = { teeth = 47, profile_shift = 0, tip_diameter = "147 mm", root_diameter = "133.5 mm", bore_diameter = "50 mm" }
material = { youngs_modulus = "206 GPa", poissons_ratio = 0.3 }
[load]
wheel_torque = "200 N m"
[motion]
mesh_frequency = "200 Hz"
mesh_cycles = 4
"""
HELICAL_PAIR = """
[gears]
module = "3 mm"
pressure_angle = "20 deg"
helix_angle = "15 deg"
centre_distance = "86.9632 mm"
face_width = "20 mm"
[gears.pinion]
teeth = 24
profile_shift = 0
tip_diameter = "80.54 mm"
root_diameter = "67.04 mm"
bore_diameter = "30 mm"
[gears.wheel]
teeth = 32
profile_shift = 0
tip_diameter = "105.387 mm"
root_diameter = "91.887 mm"
bore_diameter = "40 mm"
[gears.material]
youngs_modulus = "210 GPa"
poissons_ratio = 0.3
[load]
wheel_torque = "300 N m"
[motion]
mesh_frequency = "200 Hz"
mesh_cycles = 2
"""


def cases() -> dict[str, str]:
    """Text of each example's scene by its name."""
    from tests.effects.examples import EXAMPLES
    from tests.paper_text import without

    paper = PAPER.read_text(encoding="utf-8")
    found = {path.stem: path.read_text(encoding="utf-8") for path in DEMOS}
    found |= {
        f"paper - {name}": without(paper, *names)
        for name, *names in (("friction", "friction"), ("inertia", "inertia", "damping"), ("shafts", "shafts"))
    }
    bare = without(paper, "friction", "inertia", "damping", "shafts", "bearings")
    found |= {"paper, bare": bare, "paper, rigid flanks": without(bare, "gears.material", "accuracy")}
    more = [
        name
        for name in EXAMPLES
        if f"[{name}]" not in paper and name not in ("tooth_elasticity", "body_meshes", "speed_ramp")
    ]
    found |= {f"paper + {name}": f"{paper}\n{EXAMPLES[name]}" for name in more}
    found["paper, ISO 6336"] = without(paper, "accuracy") + '\n[accuracy]\nmodel = "ISO 6336-1"\n'
    found["paper, its own condensation"] = (
        without(bare, "accuracy")
        + '\n[accuracy]\ncondensation = "every step"\ncontact_nodes = 11\nsteps_per_mesh_cycle = 10\n'
    )
    found |= {
        "helical": HELICAL_PAIR,
        "helical, 10 slices, friction": HELICAL_PAIR + "[accuracy]\nslices = 10\n[friction]\ncoefficient = 0.06\n",
    }
    found["helical, coarse body, 40 slices"] = (
        HELICAL_PAIR + '[accuracy]\nslices = 40\nlayers = 4\nbody_element_size = "1.8 mm"\nsteps_per_mesh_cycle = 40\n'
    )
    return found | {"23/47": LARGER_PAIR, "23/47 + coast_flanks": LARGER_PAIR + "[coast_flanks]\n"}


def measure(name: str) -> dict[str, float]:
    """Run an example in this process; seconds of condensing and marching, bytes, and what was expected."""
    time.perf_counter = time.process_time
    from fenics_gears.elasticity.cache import Cache
    from fenics_gears.model.cost import expected_cost
    from fenics_gears.model.model import model_of
    from fenics_gears.runs.simulate import simulate
    from fenics_gears.scene.read import scene_from_text
    from fenics_gears.system.progress import LineProgress

    beside = next((path.parent for path in DEMOS if path.stem == name), ROOT)
    scene = scene_from_text(cases()[name], name, directory=beside)
    expected = expected_cost(model_of(scene))
    progress = LineProgress(io.StringIO(), clock=time.process_time)
    with tempfile.TemporaryDirectory() as directory:
        attributes = simulate(scene, progress=progress, cache=Cache(Path(directory))).attrs
    stress = sum(seconds for name, seconds in progress.finished if name.startswith("root stress"))
    return {
        "condensing": attributes["time_mesh"] + attributes["time_condense"] + stress,
        "marching": attributes["time_march"],
        "memory": 1024.0 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss,
        **{f"expected {stage}": getattr(expected, stage) or 0.0 for stage in STAGES},
    }  # fmt: skip


def main(names: list[str]) -> None:
    """Print a row of every example: expected, measured and their ratio, of each stage."""
    print(f"{'example':30}" + "".join(f"{stage + ', expected for measured':>36}" for stage in STAGES) + "  load")
    for name in names or cases():
        call = [sys.executable, "-P", "-m", "tests.benchmarks.expected_cost", "--measure", name]
        ended = subprocess.run(
            call, env={**os.environ, "OMP_NUM_THREADS": "1"}, capture_output=True, text=True, check=False
        )
        if ended.returncode:
            print(f"{name:30} {(ended.stderr.strip().splitlines() or [f'code {ended.returncode}'])[-1]}", flush=True)
            continue
        found = json.loads(ended.stdout.splitlines()[-1])
        print(
            f"{name:30}"
            + "".join(_cell(found[f"expected {stage}"], found[stage], stage) for stage in STAGES)
            + f"  {os.getloadavg()[0]:.1f}",
            flush=True,
        )


def _cell(expected: float, measured: float, stage: str) -> str:
    scale, unit = (1e-6, "MB") if stage == "memory" else (1.0, "s")
    ratio = f"{expected / measured:.2f}" if measured and expected else "-"
    return f"{expected * scale:10.3g} for {measured * scale:8.3g} {unit:2} {ratio:>10}"


if __name__ == "__main__":
    if sys.argv[1:2] == ["--measure"]:
        print(json.dumps(measure(sys.argv[2])))
    else:
        main(sys.argv[1:])
