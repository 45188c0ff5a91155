"""Up and down through the resonance: run both ramps, compare with steady runs, draw. Called by `run`."""

from __future__ import annotations

import time
from pathlib import Path

from demos.arguments import output_directory

# Mesh frequencies (Hz) of the steady runs.
STEADY = (160.0, 180.0, 190.0, 200.0, 208.0, 214.0, 225.0, 240.0)


def main(arguments: list[str] | None = None) -> int:
    """Run, draw, print; returns 0."""
    directory = output_directory(
        "speed_ramp", "Jumps between branches of vibration, on the way up and down.", arguments
    )
    import numpy as np

    from demos.speed_ramp.picture import draw
    from demos.speed_ramp.sweeps import HERE, ramps, steady
    from fenics_gears import load_scene
    from fenics_gears.geometry.pair import gear_pair
    from fenics_gears.system.output import written_aside
    from fenics_gears.show.panels import DOTS_PER_INCH
    from fenics_gears.runs.gear_store import GearStore

    begun, store = time.perf_counter(), GearStore()
    passed = ramps(store)
    held = {name: np.array([steady(name, frequency, store) for frequency in STEADY]) for name in passed}
    radius = gear_pair(load_scene(HERE / "up.toml").gears).wheel.base_radius
    written: list[Path] = []
    with written_aside(directory, written) as aside:
        draw(passed, np.array(STEADY), held, radius).savefig(aside / "speed_ramp.png", dpi=DOTS_PER_INCH)
    print(
        "mesh frequency (Hz), transmission error peak to peak on the wheel's base circle (um): reached from below, from"
        " above"
    )
    for frequency, up, down in zip(STEADY, held["up"], held["down"]):
        print(f"{frequency:g}  {1e3 * radius * up:.1f}  {1e3 * radius * down:.1f}")
    print(written[0])
    print(f"{time.perf_counter() - begun:.0f} s")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
