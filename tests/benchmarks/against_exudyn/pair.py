"""Natural frequencies and a time response of an unequal pair on a constant mesh stiffness, by this program and by
the multi-body program Exudyn (https://github.com/jgerstm/EXUDYN): `python -m tests.evidence exudyn --python PYTHON`."""

import json
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np

from fenics_gears import gear_pair, load_scene, lumped_gears
from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.contact.spring_mesh import PairSprings, spring_mesh
from fenics_gears.contact.tooth_pair import DRIVE
from fenics_gears.dynamics.bearings import Bearings, Support
from fenics_gears.dynamics.frequencies import natural_frequencies
from fenics_gears.dynamics.march import Marcher
from fenics_gears.dynamics.shafts import Shaft, Shafts
from fenics_gears.dynamics.stepping import EquationsOfMotion
from fenics_gears.model.drivetrain import drivetrain

HERE = Path(__file__).parent
SCENE = HERE / "pair_19_48.toml"
# N/mm; the couples are small (N mm): the program is of small displacements, Exudyn is not.
MESH, COUPLE, COUPLE_AFTER = 2.2e5, 1000.0, 500.0
STEP, STEPS = 2e-6, 5000
BEARINGS = {"pinion": (6.56e4, 5.0e4), "wheel": (8.0e4, 7.0e4)}
SHAFTS = {"input": 4.4e7, "output": 2.5e7}


def scene():
    """The pair without damping, bearings and shafts all unlike."""
    supports = {gear: Support(stiffness_x=x, stiffness_y=y) for gear, (x, y) in BEARINGS.items()}
    shafts = Shafts(**{name: Shaft(stiffness) for name, stiffness in SHAFTS.items()})
    read = load_scene(SCENE)
    return replace(
        read, damping=None, bearings=Bearings(**supports), shafts=shafts, load=replace(read.load, wheel_torque=COUPLE)
    )


def by_this_program() -> tuple[np.ndarray, np.ndarray, dict]:
    """Frequencies (7,), Hz; rotations of pinion and wheel (2, steps + 1), rad; and what Exudyn is to be given."""
    of = scene()
    pair = gear_pair(of.gears)
    shafts, lumped = drivetrain(of, pair), lumped_gears(of, pair)

    def springs(phase):
        # One pair all the time: it hands over to itself.
        return [PairSprings(0, DRIVE, np.zeros(1), np.zeros(1), np.array([MESH]))]

    cycle = Cycle(spring_mesh(pair, springs, 1, coast_flanks=False), STEPS, shafts.indices, tangential=False)
    added = COUPLE_AFTER * shafts.ends[0]
    marcher = Marcher(cycle, EquationsOfMotion(shafts, STEP, loads=(lambda step: added * (step > 0),)))
    start = marcher.start()[0]
    # At rest where the first couple holds it, accelerated by what is added, as Exudyn starts.
    still = replace(
        start, state=start.state._replace(velocity=0.0 * added, acceleration=np.linalg.solve(shafts.mass, added))
    )
    marcher.start = lambda: {0: still}
    records = marcher.run(STEPS - 1, STEPS).records
    states = np.array([record.state.position for record in records])
    rotations = np.array([shafts.value(states, name) for name in ("rotation_1", "rotation_2")])
    given = {
        "base_radii": [pair.pinion.base_radius, pair.wheel.base_radius], "line_length": pair.line_of_action_length,
        "mesh": MESH,
        "mass": [each.mass for each in lumped.values()],
        "inertia": [each.moment_of_inertia for each in lumped.values()],
        "load": of.inertia.shaft_end, "bearing": list(BEARINGS.values()), "shaft": list(SHAFTS.values()),
        "couple": COUPLE, "couple_after": COUPLE_AFTER, "step": STEP, "steps": STEPS - 1,
    }  # fmt: skip
    return natural_frequencies(shafts, MESH), rotations, given


def asked(python: str, script: str, given: dict) -> dict:
    done = subprocess.run([python, HERE / script], input=json.dumps(given), capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"Exudyn failed:\n{done.stdout[-2000:]}{done.stderr[-4000:]}")
    return json.loads(done.stdout[done.stdout.index('{"version"') :])
