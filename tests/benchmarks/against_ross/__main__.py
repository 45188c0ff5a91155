"""Static displacements of shafts at their gear under a force and a moment, by this program and by the rotor program
ROSS, side by side.

    python -m tests.benchmarks.against_ross PYTHON   # PYTHON: one that has ROSS, `pip install ross-rotordynamics`

The gear's seat has no width here, since ROSS has no rigid part of a shaft. A cone is divided into as many elements of
ROSS as the second number of its row says.
"""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import numpy as np

from fenics_gears.dynamics.elastic_shaft import ElasticShaft
from fenics_gears.effects.bearings import Bearing
from fenics_gears.effects.shafts import ShaftSection

BEARINGS = (Bearing(12.0, 3e5, 1e5), Bearing(85.0, 4e5))
HOLLOW, THICK = ShaftSection(40.0, 28.0, bore=8.0), ShaftSection(90.0, 35.0)
SHAFTS = {
    "cylinder, gear between the bearings": ((ShaftSection(100.0, 30.0),), 50.0, 1),
    "hollow and stepped, overhung gear": ((HOLLOW, THICK), 114.0, 1),
    "with a cone, overhung gear": ((HOLLOW, ShaftSection(30.0, 28.0, 40.0), THICK), 130.0, 40),
}


def by_ross(python: str, shaft: ElasticShaft, pieces: int) -> np.ndarray:
    """Displacements (5, 5) of the gear's middle per load."""
    ends = np.cumsum([0.0, *(each.length for each in shaft.sections)])
    within = [np.linspace(a, b, pieces + 1) for each, a, b in zip(shaft.sections, ends, ends[1:]) if each.tapered]
    places = np.unique(np.concatenate([ends, [shaft.gear_at], [each.at for each in shaft.bearings], *within]))
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
        "node": node(shaft.gear_at),
    }
    script = Path(__file__).with_name("ross_shaft.py")
    done = subprocess.run([python, script], input=json.dumps(given), capture_output=True, text=True, check=True)
    return np.array(json.loads(done.stdout.splitlines()[-1]))


def compared(python: str) -> dict[str, tuple[np.ndarray, np.ndarray]]:
    """Displacements (5, 5) per load by this program and by ROSS, for each shaft."""
    found = {}
    for name, (sections, gear_at, pieces) in SHAFTS.items():
        shaft = ElasticShaft("pinion", sections, (206e3, 0.3), gear_at, 0.0, 0.0, BEARINGS)
        found[name] = np.linalg.inv(shaft.stiffness), by_ross(python, shaft, pieces)
    return found


def main(python: str) -> None:
    """Print displacements and largest differences."""
    print("shaft; um along x under 1 kN: this program, ROSS; largest difference, part of each entry's own size")
    for name, (own, other) in compared(python).items():
        size = np.sqrt(np.outer(np.diag(own), np.diag(own)))
        print(f"{name}; {1e6 * own[0, 0]:.6f}, {1e6 * other[0, 0]:.6f}; {np.abs((own - other) / size).max():.1e}")


if __name__ == "__main__":
    main(sys.argv[1])
