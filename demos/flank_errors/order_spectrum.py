"""Orders of a pair with errors of manufacture: run flank_errors.toml, draw its order spectrum, print its lines. Called
by `run`."""

from __future__ import annotations

import sys
from pathlib import Path

from demos.arguments import output_directory

SCENE = Path(__file__).parent / "flank_errors.toml"
PICTURE = "order_spectrum.png"
# Lines of the table, turns of the pinion being order 1: turns of the wheel are order 2/3, mesh orders the multiples of
# its 16 teeth.
NAMED = {
    "run-out of the wheel": 2 / 3,
    "run-out of the pinion": 1.0,
    "sideband of the mesh, one turn of the pinion below": 15.0,
    "mesh": 16.0,
    "sideband of the mesh, one turn of the pinion above": 17.0,
    "twice the mesh": 32.0,
    "ghost order of 37 waves on the pinion": 37.0,
    "three times the mesh": 48.0,
}


def main(arguments: list[str] | None = None) -> int:
    """Run, draw, print; returns 0."""
    directory = output_directory(
        "flank_errors", "Orders of the transmission error of a pair with errors of manufacture.", arguments
    )
    from fenics_gears import load_scene, simulate
    from fenics_gears.show.plots import run_figures, save_figures

    result = simulate(load_scene(SCENE))
    written = save_figures({PICTURE: run_figures(result)[PICTURE]}, directory)
    for name, amplitude in named_lines(result).items():
        print(f"{name}: order {NAMED[name]:.4g}, {amplitude:.2f} um")
    print(written[0])
    return 0


def named_lines(result) -> dict[str, float]:
    """Amplitudes (um on the wheel's base circle) of the orders that one cause is known for; `result`: of whole hunting
    tooth periods."""
    from fenics_gears.show.run import scene_of
    from fenics_gears.results.spectrum import order_lines

    gears, phase = scene_of(result).gears, result["mesh_phase"].values
    error = result["transmission_error"].values * result.attrs["base_radius_wheel"] * 1e3
    lines = order_lines(error, float(phase[-1] - phase[0]), (gears.pinion.teeth, gears.wheel.teeth))
    return {name: lines.at(order) for name, order in NAMED.items()}


if __name__ == "__main__":
    sys.exit(main())
