"""Natural frequencies of the shafts of tests.benchmarks.against_ross with a disc, by this program and by Exudyn's
shear deformable beam elements: `python -m tests.evidence exudyn --python PYTHON`."""

from itertools import pairwise
from math import ceil

import numpy as np
from tests.benchmarks.against_exudyn.pair import asked
from tests.benchmarks.against_ross.shafts import BEARINGS, DENSITY, DISC, SHAFTS, elastic, free_frequencies

from fenics_gears.dynamics.beam import properties
from fenics_gears.dynamics.elastic_shaft import ElasticShaft, SeatedGear

# Longest element of Exudyn, mm: elements of twice the length differ by 2e-4.
ELEMENT = 1.0


def given_for(shaft: ElasticShaft) -> dict:
    """What Exudyn is to be given: each element has the section of its middle."""
    ends = np.cumsum([0.0, *(each.length for each in shaft.sections)])
    stops = np.unique([*ends, shaft.seats[0].at, *(each.at for each in shaft.bearings)])
    places = [np.linspace(a, b, ceil((b - a) / ELEMENT) + 1)[:-1] for a, b in pairwise(stops)]
    places = np.append(np.concatenate(places), stops[-1])
    along, (modulus, ratio) = properties(shaft.sections, shaft.material, places, 1), shaft.material
    shear_modulus = modulus / (2.0 * (1.0 + ratio))
    of_section = 1.0 / (shear_modulus * along.shear), 1.0 / (modulus * along.axial), 1.0 / (modulus * along.bending)

    def node(at: float) -> int:
        return int(np.abs(places - at).argmin())

    return {
        "material": shaft.material,
        "density": DENSITY,
        "places": places.tolist(),
        "elements": np.column_stack([np.diff(places), *of_section]).tolist(),
        "bearings": [[node(each.at), each.radial_stiffness, each.axial_stiffness] for each in shaft.bearings],
        "node": node(shaft.seats[0].at),
        "disc": DISC,
    }


def compared(python: str) -> dict[str, tuple[np.ndarray, np.ndarray]]:
    """Natural frequencies, Hz, by this program and by Exudyn, for each shaft."""
    found = {}
    for name, (sections, gear_at, _) in SHAFTS.items():
        shaft = ElasticShaft("pinion", sections, (206e3, 0.3), (SeatedGear("pinion", gear_at),), 0.0, BEARINGS)
        there = asked(python, "exudyn_shaft.py", given_for(shaft))["frequencies"]
        found[name] = free_frequencies(shaft), elastic(np.array(there))
    return found
