"""Displacements of shafts at their gear and natural frequencies with a disc there, by this program and by the rotor
program ROSS: `python -m tests.evidence ross --python PYTHON`, of a Python that has `ross-rotordynamics`.

The gear's seat has no width here, since ROSS has no rigid part of a shaft. Each section is divided into as many
elements of ROSS as the second number of its row says.
"""

import json
import subprocess
from dataclasses import replace
from pathlib import Path

import numpy as np
from scipy.linalg import block_diag, eigh

from fenics_gears.dynamics.bearings import Bearing
from fenics_gears.dynamics.elastic_shaft import FIVE, ElasticShaft, SeatedGear
from fenics_gears.dynamics.shaft_system import ShaftSystem
from fenics_gears.dynamics.shafts import ShaftSection

BEARINGS = (Bearing(12.0, 3e5, 1e5), Bearing(85.0, 4e5))
HOLLOW, THICK = ShaftSection(40.0, 28.0, bore=8.0), ShaftSection(90.0, 35.0)
SHAFTS = {
    "cylinder, gear between the bearings": ((ShaftSection(100.0, 30.0),), 50.0, 60),
    "hollow and stepped, overhung gear": ((HOLLOW, THICK), 114.0, 60),
    "with a cone, overhung gear": ((HOLLOW, ShaftSection(30.0, 28.0, 40.0), THICK), 130.0, 40),
}
# Of steel, N s^2/mm^4; of the disc: mass, N s^2/mm, and moments of inertia about a diameter and the axis, N mm s^2.
DENSITY, DISC = 7.85e-9, (2e-3, 1.1, 2.0)
# Frequencies up to the first of these, Hz, are compared; modes of the program's shafts are up to the other.
COMPARED, UP_TO = 12e3, 1e6


def by_ross(python: str, shaft: ElasticShaft, pieces: int) -> tuple[np.ndarray, np.ndarray]:
    """Displacements (5, 5) of the gear's middle per load, and natural frequencies, Hz."""
    ends = np.cumsum([0.0, *(each.length for each in shaft.sections)])
    within = [np.linspace(a, b, pieces + 1) for a, b in zip(ends, ends[1:])]
    places = np.unique(np.concatenate([ends, [shaft.seats[0].at], [each.at for each in shaft.bearings], *within]))
    elements = []
    for left, right in zip(places, places[1:]):
        number = int(np.searchsorted(ends, 0.5 * (left + right))) - 1
        section = shaft.sections[number]
        sizes = np.interp((left, right), ends[number : number + 2], (section.diameter, section.right_diameter))
        elements.append([right - left, *sizes, section.bore])

    def node(at: float) -> int:
        return int(np.abs(places - at).argmin())

    given = {
        "material": shaft.material,
        "elements": elements,
        "bearings": [[node(each.at), each.radial_stiffness, each.axial_stiffness] for each in shaft.bearings],
        "node": node(shaft.seats[0].at),
        "density": DENSITY,
        "disc": DISC,
    }
    script = Path(__file__).with_name("ross_shaft.py")
    done = subprocess.run([python, script], input=json.dumps(given), capture_output=True, text=True, check=True)
    moved, frequencies = json.loads(done.stdout.splitlines()[-1])
    return np.array(moved), elastic(np.array(frequencies))


def elastic(frequencies: np.ndarray) -> np.ndarray:
    """Natural frequencies, Hz, ascending, without that of the shaft that turns freely and those too high to compare."""
    return frequencies[(frequencies > 1.0) & (frequencies < COMPARED)]


def free_frequencies(shaft: ElasticShaft) -> np.ndarray:
    """Natural frequencies, Hz, with the disc, free to turn."""
    mass, across, about = DISC
    system = ShaftSystem((replace(shaft, density=DENSITY, up_to=UP_TO),))
    of_disc = np.zeros(len(system.mass))
    of_disc[:6] = mass, mass, mass, across, across, about
    torsion = system.torsional_stiffness(system.shafts[0]) * np.array([[1.0, -1.0], [-1.0, 1.0]])
    stiffness = block_diag(system.gear_stiffness, torsion, system.stiffness[FIVE:, FIVE:])
    squares = eigh(stiffness, system.mass + np.diag(of_disc), eigvals_only=True)
    return elastic(np.sqrt(np.maximum(squares, 0.0)) / (2.0 * np.pi))


def compared(python: str) -> dict[str, tuple[tuple[np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]]]:
    """Displacements (5, 5) per load and natural frequencies, by this program and by ROSS, for each shaft."""
    found = {}
    for name, (sections, gear_at, pieces) in SHAFTS.items():
        shaft = ElasticShaft("pinion", sections, (206e3, 0.3), (SeatedGear("pinion", gear_at),), 0.0, BEARINGS)
        own = np.linalg.inv(ShaftSystem((shaft,)).stiffness), free_frequencies(shaft)
        found[name] = own, by_ross(python, shaft, pieces)
    return found
