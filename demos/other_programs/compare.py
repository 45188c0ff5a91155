"""The same pair in this program, in ROSS and in Exudyn: mesh stiffness, static and dynamic transmission error and
natural frequencies side by side.

    demos/other_programs/run PYTHON [DIR]        PYTHON: one that has the programs of requirements.txt

Exudyn gets the mesh from this program (force, tangent stiffness and displacement over the mesh cycle), ROSS has a mesh
stiffness of its own.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
from dataclasses import dataclass, replace
from pathlib import Path

from fenics_gears.system import environment

environment.prepare()
os.environ.setdefault("OMP_NUM_THREADS", "1")

import numpy as np  # noqa: E402
import xarray as xr  # noqa: E402
from matplotlib.figure import Figure  # noqa: E402

from fenics_gears import load_scene, simulate  # noqa: E402
from fenics_gears.dynamics.frequencies import natural_frequencies  # noqa: E402
from fenics_gears.model.drivetrain import lumped_gears  # noqa: E402
from fenics_gears.model.model import Model, model_of  # noqa: E402
from fenics_gears.results.settled import of_settled  # noqa: E402
from fenics_gears.scene.data import Motion  # noqa: E402
from fenics_gears.show.panels import PALETTE, legend, styled  # noqa: E402

HERE = Path(__file__).parent
SCENE = HERE / "pair.toml"
STEPS, CYCLES = 200, 30


@dataclass(frozen=True)
class Comparison:
    """What all programs say: `phase` (n,) of the mesh cycle with curves over it, T_E in um on the wheel's base circle,
    stiffness in N/um, `single` its largest value with one tooth pair; frequencies in Hz."""

    phase: np.ndarray
    static_error: np.ndarray
    stiffness: np.ndarray
    single: float
    ross_single: float
    ross_phase: np.ndarray
    ross_stiffness: np.ndarray
    ross_static_error: np.ndarray
    dynamic_error: np.ndarray
    exudyn_error: np.ndarray
    frequencies: np.ndarray
    ross_frequencies: np.ndarray
    exudyn_frequencies: np.ndarray


def compared(python: str, scene_file: Path = SCENE) -> Comparison:
    """Run the pair here, then both other programs by the Python that has them."""
    scene = load_scene(scene_file)
    scene = replace(scene, accuracy=replace(scene.accuracy, steps_per_mesh_cycle=STEPS))
    static = simulate(replace(scene, inertia=None, damping=None, motion=Motion(scene.motion.mesh_frequency, 1, 1)))
    dynamic = of_settled(simulate(scene))
    model = model_of(scene)
    given, mesh = _pair(model, static)
    ross, exudyn = (
        _asked(python, "ross_pair.py", _in_metres(model, given)),
        _asked(python, "exudyn_pair.py", given | mesh),
    )
    radius, load = model.pair.wheel.base_radius, mesh["force"].mean()
    rotations, radii = np.array(exudyn["rotations"]), np.array(given["base_radii"])
    ross_stiffness, alone = 1e-6 * np.array(ross["stiffness"]), np.array(ross["phase"]) > ross["contact_ratio"] - 1.0
    return Comparison(
        single=static.attrs["single_pair_stiffness"] * model.pair.face_width, ross_single=ross_stiffness[alone].max(),
        phase=mesh["phase"], static_error=_micrometres(static, radius)[:STEPS],
        stiffness=static["mesh_stiffness"].values[:STEPS] * 1e-3,
        ross_phase=np.array(ross["phase"]), ross_stiffness=ross_stiffness, ross_static_error=load / ross_stiffness,
        dynamic_error=_micrometres(dynamic, radius)[-STEPS - 1 :], exudyn_error=1e3 * radii @ rotations,
        frequencies=natural_frequencies(model.drivetrain, given["mesh_stiffness"]),
        ross_frequencies=np.array(ross["frequencies"]),
        exudyn_frequencies=np.array(exudyn["frequencies"]),
    )  # fmt: skip


def _micrometres(result: xr.Dataset, radius: float) -> np.ndarray:
    return 1e3 * radius * result["transmission_error"].values


def _pair(model: Model, static: xr.Dataset) -> tuple[dict, dict]:
    """The drivetrain in N, mm, t, s and rad, and the mesh over a mesh cycle: force, tangent stiffness, and displacement
    of the flanks along the line of action."""
    scene, pair, lumped = model.scene, model.pair, lumped_gears(model.scene, model.pair)
    radii = (pair.pinion.base_radius, pair.wheel.base_radius)
    cycle = static.isel(time=slice(STEPS))
    x, rotation = cycle["centre_x"].values, cycle["rotation"].values
    displacement = (x * [1.0, -1.0] + rotation * radii).sum(axis=1)
    given = {
        "base_radii": radii, "line_length": pair.line_of_action_length, "mass": [each.mass for each in lumped.values()],
        "inertia": [each.moment_of_inertia for each in lumped.values()], "load": scene.inertia.shaft_end,
        "bearing": scene.bearings.of("pinion", "x"),
        "shaft": scene.shafts.of("input"), "damping": scene.damping.stiffness_proportional,
        "torque": scene.load.wheel_torque,
        "mesh_frequency": scene.motion.mesh_frequency, "steps_of_a_cycle": STEPS, "cycles": CYCLES,
        "mesh_stiffness": float(cycle["mesh_stiffness"].mean()),
    }  # fmt: skip
    mesh = {
        "phase": cycle["mesh_phase"].values % 1.0, "displacement": displacement,
        "stiffness": cycle["mesh_stiffness_tangent"].values, "force": cycle["normal_force"].values,
    }  # fmt: skip
    return given, mesh


def _in_metres(model: Model, given: dict) -> dict:
    """The pair in N, m, kg and rad, with what ROSS needs for a tooth stiffness of its own."""
    gears, material = model.scene.gears, model.scene.gears.material
    return {
        "module": 1e-3 * gears.module, "teeth": [gears.pinion.teeth, gears.wheel.teeth],
        "pressure_angle": gears.pressure_angle, "face_width": 1e-3 * gears.face_width,
        "bores": [1e-3 * gears.pinion.bore_diameter, 1e-3 * gears.wheel.bore_diameter],
        "youngs_modulus": 1e6 * material.youngs_modulus, "poissons_ratio": material.poissons_ratio,
        "mass": [1e3 * each for each in given["mass"]], "inertia": [1e-3 * each for each in given["inertia"]],
        "load": 1e-3 * given["load"],
        "bearing": 1e3 * given["bearing"], "shaft": 1e-3 * given["shaft"],
        "mesh_stiffness": 1e3 * given["mesh_stiffness"],
    }  # fmt: skip


def _asked(python: str, script: str, given: dict) -> dict:
    """What another program answers. Raises SystemExit with its words where it fails."""
    text = json.dumps(
        {name: value.tolist() if isinstance(value, np.ndarray) else value for name, value in given.items()}
    )
    done = subprocess.run([python, HERE / script], input=text, capture_output=True, text=True)
    if done.returncode:
        sys.exit(
            f"{script} failed:\n{done.stdout[-2000:]}{done.stderr[-4000:]}\nPYTHON needs the programs of"
            f" {HERE / 'requirements.txt'}."
        )
    return json.loads(done.stdout[done.stdout.index('{"version"') :])


def table(found: Comparison) -> str:
    """The comparison as text."""
    nearest = [found.ross_frequencies[np.argmin(np.abs(found.ross_frequencies - each))] for each in found.frequencies]
    lines = [f"{'':34}{'this program':>14}{'ROSS':>12}{'Exudyn':>12}"]

    def row(name: str, own: float, ross: float | None, exudyn: float | None) -> None:
        lines.append(
            f"{name:34}{own:14.2f}"
            + "".join(f"{'' if each is None else format(each, '.2f'):>12}" for each in (ross, exudyn))
        )

    row("mean mesh stiffness, N/um", found.stiffness.mean(), found.ross_stiffness.mean(), None)
    row("largest with one pair, N/um", found.single, found.ross_single, None)
    row("static T_E, peak to peak, um", np.ptp(found.static_error), np.ptp(found.ross_static_error), None)
    row("dynamic T_E, peak to peak, um", np.ptp(found.dynamic_error), None, np.ptp(found.exudyn_error))
    for number, (own, ross, exudyn) in enumerate(zip(found.frequencies, nearest, found.exudyn_frequencies), 1):
        row(f"natural frequency {number}, Hz", own, ross, exudyn)
    return "\n".join(lines)


@styled
def draw(found: Comparison) -> Figure:
    """Above the mesh stiffness, in the middle the static and below the dynamic transmission error over a mesh cycle."""
    figure = Figure(figsize=(9.0, 9.0), layout="constrained")
    above, middle, below = figure.subplots(3, sharex=True)
    figure.suptitle("The same pair in three programs", x=0.012, ha="left", fontsize=14)
    own, ross, exudyn = PALETTE[0], PALETTE[1], PALETTE[2]
    above.plot(found.phase, found.stiffness, color=own, label="this program")
    above.plot(found.ross_phase, found.ross_stiffness, color=ross, label="ROSS")
    above.set_ylabel("Mesh stiffness (N/µm)")
    middle.plot(found.phase, found.static_error - found.static_error.mean(), color=own, label="this program")
    middle.plot(found.ross_phase, found.ross_static_error - found.ross_static_error.mean(), color=ross, label="ROSS")
    middle.set_ylabel("Static transmission error,\nless its mean (µm)")
    phase = np.linspace(0.0, 1.0, STEPS + 1)
    below.plot(phase, found.dynamic_error - found.dynamic_error.mean(), color=own, linewidth=3.0, label="this program")
    below.plot(phase, found.exudyn_error - found.exudyn_error.mean(), color=exudyn, label="Exudyn")
    below.set_ylabel("Dynamic transmission error,\nless its mean (µm)")
    below.set_xlabel("Phase of the mesh cycle")
    for axes in (above, middle, below):
        axes.set_xlim(0.0, 1.0)
        legend(axes, 2)
    return figure


def main() -> None:
    """Print the table and draw the picture."""
    parser = argparse.ArgumentParser(prog="demos/other_programs/run", description=__doc__.splitlines()[0])
    parser.add_argument("python", metavar="PYTHON", help="a Python that has the programs of requirements.txt")
    parser.add_argument(
        "directory",
        nargs="?",
        type=Path,
        metavar="DIR",
        default=Path("results/other_programs"),
        help="where to write (default: %(default)s)",
    )
    options = parser.parse_args()
    found = compared(options.python)
    print(table(found))
    options.directory.mkdir(parents=True, exist_ok=True)
    draw(found).savefig(options.directory / "other_programs.png", dpi=150)
    print(options.directory / "other_programs.png")


if __name__ == "__main__":
    main()
