"""Transmission error of the paper's pair, without friction, by this program and by GetFEM's own contact:
`python -m tests.evidence getfem --python PYTHON`, of a Python that has GetFEM (Debian's python3-getfem).

GetFEM (Y. Renard and K. Poulios, ACM TOMS 47(1), 2020) is given whole gears in six-node triangles, which have nothing
of this program but the outline of the teeth, and finds contact itself (`getfem_pair.py`). Only positions away from tip
edges are compared: there contact is on the line of action, as this program takes it by default.
"""

import json
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
from tests.corner_contact_reference.calculix import placed, wheel_centre
from tests.corner_contact_reference.gear_mesh import MeshSizes, gear_mesh

from fenics_gears import gear_pair, load_scene, simulate
from fenics_gears.effects import without

SCENE = Path(__file__).parents[3] / "demos" / "lundvall2004.toml"
PHASES = (0.2, 0.3, 0.6, 0.7)
SIZES = MeshSizes(flank=0.12, tip=0.12, fillet=0.4, coarse=2.0, body=4.0)
# mm: how far ray tracing looks for the other surface; a few elements, less than a tooth.
RELEASE = 0.5
GUESS = 6e-4


def by_this_program() -> np.ndarray:
    """Rotations of the wheel (phases,), rad."""
    scene = without(load_scene(SCENE), "friction", "inertia", "damping", "shafts", "bearings")
    run = simulate(replace(scene, motion=replace(scene.motion, mesh_cycles=1, recorded_cycles=1)))
    places = [int(np.argmin(np.abs(run.mesh_phase.values - phase))) for phase in PHASES]
    return run.transmission_error.values[places]


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
        [python, Path(__file__).with_name("getfem_pair.py")],
        input=json.dumps(for_getfem()),
        capture_output=True,
        text=True,
    )
    if done.returncode:
        sys.exit(f"GetFEM failed:\n{done.stdout[-2000:]}{done.stderr[-4000:]}")
    return json.loads(done.stdout[done.stdout.index('{"answers"') :])["answers"]
