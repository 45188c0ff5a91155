"""Memory of a process that simulates different pairs one after the other: `python -m tests.benchmarks.long_life plane
100` (or `face 20`).

Prints what the process holds after each tenth pair, MB, and the processor's seconds so far.
"""

import ctypes
import sys
import tempfile
import time
from pathlib import Path

from fenics_gears import build_scene, simulate
from fenics_gears.elasticity.cache import Cache

STEEL = {"youngs_modulus": "206 GPa", "poissons_ratio": 0.3}
OVER_FACE = {"misalignment": {"in_plane": "10 um"}}


def pair(number: int, over_face: bool):
    """The scene of one of many pairs, none like another."""
    gears = {
        "module": f"{2.0 + 0.5 * (number % 5)} mm", "pressure_angle": f"{20 + number % 4} deg", "face_width": "16 mm",
        "material": STEEL,
        "pinion": _gear(18 + number % 23), "wheel": _gear(31 + number % 37),
    }  # fmt: skip
    torque = {"wheel_torque": f"{100 + number} N m"}
    return build_scene({"gears": gears, "load": torque, **(OVER_FACE if over_face else {})}, f"pair {number}")


def _gear(teeth: int) -> dict:
    return {"teeth": teeth, "profile_shift": 0.0, "bore_diameter": f"{0.8 * teeth} mm"}


def resident() -> int:
    """Bytes that the process holds (Linux), less what its allocator has ready for the next run."""
    ctypes.CDLL(None).malloc_trim(0)
    lines = Path("/proc/self/status").read_text().splitlines()
    return 1024 * int(next(line for line in lines if line.startswith("VmRSS")).split()[1])


def main() -> None:
    over_face, count = sys.argv[1] == "face", int(sys.argv[2])
    print(f"{'pairs':>6} {'MB':>8} {'s':>8}")
    with tempfile.TemporaryDirectory() as directory:
        begun = time.process_time()
        for number in range(count):
            simulate(pair(number, over_face), cache=Cache(Path(directory), 2e9))
            if number in (0, 1, 2, 4) or (number + 1) % 10 == 0:
                print(f"{number + 1:6d} {resident() / 1e6:8.0f} {time.process_time() - begun:8.1f}", flush=True)


if __name__ == "__main__":
    main()
