"""Quasi-static transmission error of the paper's pair, without friction, by this program and by GetFEM's own contact,
side by side.

    apt-get install python3-getfem                       # GetFEM 5.4.2 of Debian 12; PyPI has none
    python -m tests.benchmarks.against_getfem [PYTHON]   # PYTHON: one that has GetFEM, /usr/bin/python3 unless given

GetFEM (Y. Renard and K. Poulios, "GetFEM: automated FE modeling of multiphysics problems based on a generic weak form
language", ACM TOMS 47(1), 2020) is given whole gears in six-node triangles, which have nothing of this program but the
outline of the teeth, and finds contact itself (`getfem_pair.py`). Only positions away from tip edges are compared:
there contact is on the line of action, as this program takes it by default.
"""

import argparse
import json
import subprocess
import sys
import tempfile
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
from tests.corner_contact_reference.calculix import placed, wheel_centre
from tests.corner_contact_reference.gear_mesh import MeshSizes, gear_mesh

from fenics_gears import gear_pair, load_scene, simulate
from fenics_gears.effects import without
from fenics_gears.elasticity.cache import Cache

SCENE = Path(__file__).parents[3] / "demos" / "lundvall2004.toml"
PHASES = (0.2, 0.3, 0.6, 0.7)
SIZES = MeshSizes(flank=0.12, tip=0.12, fillet=0.4, coarse=2.0, body=4.0)
# mm: how far ray tracing looks for the other surface; a few elements, less than a tooth.
RELEASE = 0.5
GUESS = 6e-4


def by_this_program() -> tuple[np.ndarray, float, float, int]:
    """Rotations of the wheel (phases,), rad; seconds of all, gears condensed anew, and of the march; steps."""
    scene = without(load_scene(SCENE), "friction", "inertia", "damping", "shafts", "bearings")
    scene = replace(scene, motion=replace(scene.motion, mesh_cycles=1, recorded_cycles=1))
    for _ in range(2):  # the first run loads what is compiled
        with tempfile.TemporaryDirectory() as empty:
            begun = time.perf_counter()
            run = simulate(scene, cache=Cache(Path(empty)))
            seconds = time.perf_counter() - begun
    places = [int(np.argmin(np.abs(run.mesh_phase.values - phase))) for phase in PHASES]
    return run.transmission_error.values[places], seconds, run.attrs["time_march"], run.attrs["steps"]


def for_getfem() -> dict:
    """What GetFEM is given; arrays as lists."""
    scene = load_scene(SCENE)
    pair = gear_pair(scene.gears)
    gears = ((pair.pinion, 1), (pair.wheel, -1))
    meshes = tuple(gear_mesh(gear, SIZES, 0.0, tuple(sense * k for k in (0, 1))) for gear, sense in gears)
    material = scene.gears.material
    return {
        "youngs_modulus": material.youngs_modulus,
        "poissons_ratio": material.poissons_ratio,
        "release": RELEASE,
        "torque": scene.load.wheel_torque / pair.face_width,
        "centres": [[0.0, 0.0], list(wheel_centre(pair))],
        "meshes": [
            {"cells": mesh.cells.tolist(), "contact": mesh.contact.tolist(), "hub": mesh.hub.tolist()}
            for mesh in meshes
        ],
        "positions": [
            {"points": [each.tolist() for each in placed(pair, meshes, phase)], "guess": GUESS} for phase in PHASES
        ],
    }


def by_getfem(python: str) -> list[dict]:
    """What a Python that has GetFEM finds at each phase."""
    done = subprocess.run(
        [python, __file__.replace("__main__", "getfem_pair")],
        input=json.dumps(for_getfem()),
        capture_output=True,
        text=True,
    )
    if done.returncode:
        sys.exit(f"GetFEM failed:\n{done.stdout[-2000:]}{done.stderr[-4000:]}")
    return json.loads(done.stdout[done.stdout.index('{"answers"') :])["answers"]


def main() -> None:
    """Print both side by side."""
    parser = argparse.ArgumentParser(
        prog="python -m tests.benchmarks.against_getfem", description=__doc__.splitlines()[0]
    )
    parser.add_argument(
        "python", nargs="?", default="/usr/bin/python3", help="a Python that has GetFEM (default: %(default)s)"
    )
    own, seconds, march, steps = by_this_program()
    found = by_getfem(parser.parse_args().python)
    print(
        "mesh phase   this program, urad   GetFEM, urad   difference   GetFEM: torque ratio, unknowns, solutions, s"
        " building, s solving"
    )
    for phase, mine, other in zip(PHASES, own, found):
        print(
            f"{phase:<12} {mine * 1e6:<20.2f} {other['rotation'] * 1e6:<14.2f} {mine / other['rotation'] - 1.0:<+12.2%}"
            f" {other['torque_ratio']:.4f}, {other['unknowns']}, {other['solutions']}, {other['building']:.1f},"
            f" {other['solving']:.1f}"
        )
    a_position = np.mean([other["solving"] for other in found])
    print(
        f"this program: {seconds:.2f} s for {steps} positions from nothing, {march / steps * 1e3:.2f} ms of marching a"
        f" position; GetFEM: {a_position:.1f} s of solving a position"
    )
    print(f"ratio of times for as many positions: {a_position * steps / seconds:.0f}")


if __name__ == "__main__":
    main()
