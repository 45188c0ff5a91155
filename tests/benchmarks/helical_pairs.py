"""Ordinary helical pairs of cars and lorries from nothing and from the cache: processor seconds, seconds by the clock
and memory of `gears run` with the program's own defaults, its pictures and all.

``python -m tests.benchmarks.helical_pairs`` prints the table of docs/evidence/third_dimension.md, a pair after the
other, on an idle machine in four minutes; with `--widths` the fourth pair with faces of 20 to 160 mm, and with
`--expected` what the program expects of either. Bores are 0.4 of the pitch circle; the second run has 5 % more torque.
"""

import os
import subprocess
import sys
import tempfile
import time
from math import cos, radians
from pathlib import Path

ROOT = Path(__file__).parents[2]
# Module and face width in mm, helix angle in degrees, numbers of teeth.
PAIRS = (
    (1.6, 32, 28, 23, 67), (1.6, 22, 28, 23, 67), (1.6, 40, 32, 25, 71), (2.0, 40, 25, 24, 73), (1.25, 25, 30, 29, 83),
    (1.5, 30, 33, 31, 93), (3, 60, 15, 21, 65), (5, 100, 12, 23, 89), (8, 180, 21.7, 20, 39), (2.5, 28, 20, 20, 60),
)  # fmt: skip
# Of the fourth pair, mm.
WIDTHS = (20, 40, 80, 160)
# Torque on the wheel, N m, over module, face width and pitch diameter of the wheel in mm.
LOAD = 0.11


def scene(pair: tuple, times: float) -> str:
    """The text of a pair under so many times its torque."""
    module, width, helix, *teeth = pair
    pitch = [module * each / cos(radians(helix)) for each in teeth]
    pinion, wheel = (
        f'{{ teeth = {each}, profile_shift = 0, bore_diameter = "{0.4 * diameter:.3f} mm" }}'
        for each, diameter in zip(teeth, pitch)
    )
    return f"""
        [gears]
        module = "{module} mm"
        pressure_angle = "20 deg"
        helix_angle = "{helix} deg"
        face_width = "{width} mm"
        pinion = {pinion}
        wheel = {wheel}
        material = "steel"
        [load]
        wheel_torque = "{times * LOAD * module * width * pitch[1]:.2f} N m"
        """


def measured(folder: Path, pair: tuple, times: float) -> str:
    """Processor seconds, seconds by the clock and GB of one run, in words."""
    file = folder / "pair.toml"
    file.write_text(scene(pair, times), encoding="utf-8")
    begun = time.perf_counter()
    call = [ROOT / "gears", "run", file, "-q", "-o", folder / "result"]
    run = subprocess.Popen(call, env={**os.environ, "FENICS_GEARS_CACHE": str(folder / "cache")})
    _, status, usage = os.wait4(run.pid, 0)
    if status:
        sys.exit(f"{pair}: the run failed")
    seconds = usage.ru_utime + usage.ru_stime
    return f"{seconds:.0f} s, {time.perf_counter() - begun:.0f} s, {1e-6 * usage.ru_maxrss:.1f} GB"


def expected(pair: tuple) -> str:
    """What `gears check` expects of a run from nothing: processor seconds and GB, in words."""
    from fenics_gears import model_of, scene_from_text
    from fenics_gears.model.cost import expected_cost

    cost = expected_cost(model_of(scene_from_text(scene(pair, 1.0))))
    return f"{(cost.condensing or 0.0) + cost.marching:.0f} s, {1e-9 * cost.memory:.1f} GB"


def main(words: list[str]) -> None:
    """Print the table."""
    of_widths = [(PAIRS[3][0], width, *PAIRS[3][2:]) for width in WIDTHS]
    pairs = of_widths if "--widths" in words else PAIRS
    if "--expected" in words:
        for pair in pairs:
            print(pair, expected(pair), flush=True)
        return
    print("| m_n, face, helix, teeth | from nothing: processor, wall, memory | from the cache |\n|---|---|---|")
    for pair in pairs:
        with tempfile.TemporaryDirectory() as folder:
            first, later = (measured(Path(folder), pair, times) for times in (1.0, 1.05))
        module, width, helix, *teeth = pair
        print(f"| {module:g}, {width}, {helix:g}, {teeth[0]}/{teeth[1]} | {first} | {later} |", flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
