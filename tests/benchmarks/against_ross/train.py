"""Natural frequencies of a two-stage train with constant mesh stiffness, by this program and by the rotor program ROSS:
`python -m tests.benchmarks.against_ross.train PYTHON`, of a Python that has `ross-rotordynamics` (and plotly below 6).

Rigid gears on centres that give way, shafts that twist between drive, gears and load. ROSS is given masses, inertias
and stiffnesses, and couples its rotors by its own matrix of a gear mesh."""

import argparse
import json
import subprocess
from math import cos
from pathlib import Path

import numpy as np

from fenics_gears import train_from_text
from fenics_gears.model.row_model import RowModel
from fenics_gears.model.train import train_model_of

SCENE = Path(__file__).parents[3] / "demos" / "gear_trains" / "two_stages.toml"
MORE = """
[bearings]
stiffness = "0.2e6 N/mm"
[shafts.input]
carries = ["first.pinion"]
torsional_stiffness = "0.05e9 N mm/rad"
"""
SUPPORT = 0.2e6
# N mm/rad.
TORSION = 0.05e9, 0.1e9, 0.3e9
# The drive's end turns as prescribed: N s^2/mm and N mm s^2 that hardly move.
HELD = 1e6
# Hz: what is slower is a disc that tilts alone in ROSS, or the whole train turning.
LEAST = 20.0


def row_of_train() -> RowModel:
    return train_model_of(train_from_text(SCENE.read_text() + MORE)).rows[0]


def for_ross(row: RowModel) -> dict:
    """What ROSS is given: shafts with their discs from the drive on, and meshes."""
    pairs = [mesh.pair for mesh in row.meshes]
    gears = [(pair, gear) for pair in pairs for gear in (pair.pinion, pair.wheel)]
    # The program counts rotations on base circles, those behind a shaft that twists from the gear before it.
    matrix = row.drivetrain.mass
    turning = np.diag(matrix)[:5] * np.array([gear.base_radius**2 for _, gear in (*gears, gears[-1])])
    inertia = turning[0], turning[1] - turning[2], turning[2], turning[3] - turning[4]
    # Of their centres, x and y of each.
    masses = np.diag(matrix)[5::2]

    def disc(number: int) -> dict:
        pair, gear = gears[number]
        angle = pair.operating_pressure_angle
        own = {"teeth": gear.teeth, "pitch_radius": gear.base_radius / cos(angle), "pressure_angle": angle}
        return {"mass": masses[number], "inertia": inertia[number], "bearing": SUPPORT, **own}

    drive = {"mass": HELD, "inertia": HELD, "bearing": SUPPORT}
    load = {"mass": 1.0, "inertia": turning[4], "bearing": SUPPORT}
    discs = [drive, disc(0)], [disc(1), disc(2)], [disc(3), load]
    return {
        "shafts": [{"discs": each, "torsion": [torsion]} for each, torsion in zip(discs, TORSION)],
        "stiffness": row.mesh_stiffness.tolist(),
        "direction": [mesh.direction for mesh in row.meshes],
    }


def compared(python: str) -> np.ndarray:
    """Natural frequencies (n, 2), Hz, by this program and by ROSS."""
    row = row_of_train()
    given = json.dumps(for_ross(row))
    script = Path(__file__).with_name("ross_train.py")
    done = subprocess.run([python, script], input=given, capture_output=True, text=True, check=True)
    there = np.array(json.loads(done.stdout.splitlines()[-1]))
    own = np.sort([each.frequency for each in row.vibrations])
    # What belongs to the load's own bearing and the drive's is of no gear.
    there = there[there > LEAST]
    nearest = [there[np.argmin(np.abs(there - each))] for each in own]
    return np.column_stack([own, nearest])


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("python")
    for own, other in compared(parser.parse_args().python):
        print(f"{own:10.3f} Hz  ROSS {other:10.3f} Hz  {own / other - 1.0:+.2e}")


if __name__ == "__main__":
    main()
