"""Other programs on the same input."""

import numpy as np
from tests.benchmarks import against_calculix
from tests.benchmarks.against_exudyn import pair as exudyn
from tests.benchmarks.against_exudyn import shaft, tilting
from tests.benchmarks.against_getfem import pair as getfem
from tests.benchmarks.against_ross import shafts as ross
from tests.benchmarks.third_dimension.pairs import scene_of, standard_pair
from tests.corner_contact_reference import approach, reference
from tests.evidence.claim import PROGRAMS, Claim, Numbers, Part, within
from tests.evidence.gearpie import PART as GEARPIE

from fenics_gears import gear_pair
from fenics_gears.contact.corner import corner_contact
from fenics_gears.scene.data import Accuracy

CORNERS = ((0.2, 0.0), (0.7, 0.0), (0.5, 0.0), (0.95, 0.0), (0.54, 0.1), (0.98, 0.1))
EDGES = {0.2: "two tooth pairs", 0.7: "one tooth pair", 0.5: "the pinion's tip leaves", 0.95: "the wheel's tip enters",
         0.54: "a rounded tip leaves", 0.98: "a rounded tip enters"}  # fmt: skip
STEPS = 100


def corner(_: str) -> Numbers:
    """µrad, of the paper's pair on the true outlines."""
    scene, pair = reference.paper_pair()
    alone, found = approach.teeth_alone(scene), {}
    rows = {row.case: row for row in reference.read()}
    for radius in sorted({radius for _, radius in CORNERS}):
        cycle = approach.elastic_cycle(alone, corner_contact(pair, radius), STEPS)
        for phase in (phase for phase, own in CORNERS if own == radius):
            error, _ = approach.transmission_error(cycle, pair, scene.load.wheel_torque, phase)
            found[EDGES[phase]] = 1e6 * rows[reference.case(phase, radius)].transmission_error, 1e6 * error
    return found


def calculix(_: str) -> Numbers:
    """µrad, of a helical pair."""
    gears = standard_pair(against_calculix.FACE_WIDTH, against_calculix.HELIX_ANGLE)
    scene = scene_of(gears, Accuracy(steps_per_mesh_cycle=against_calculix.STEPS), against_calculix.LINE_LOAD)
    own = against_calculix.by_this_program(scene)
    return {
        f"{phase:g}": (1e6 * against_calculix.by_calculix(scene, gear_pair(gears), phase, mine), 1e6 * mine)
        for phase, mine in zip(against_calculix.PHASES, own)
    }


def by_getfem(python: str) -> Numbers:
    """µrad, of the paper's pair."""
    own, other = getfem.by_this_program(), getfem.by_getfem(python)
    return {
        f"{phase:g}": (1e6 * there["rotation"], 1e6 * mine) for phase, mine, there in zip(getfem.PHASES, own, other)
    }


def by_exudyn(python: str) -> Numbers:
    """The natural frequencies that differ most, and the swing of the pinion's rotation."""
    frequencies, rotations, given = exudyn.by_this_program()
    found = exudyn.asked(python, "exudyn_pair.py", given)
    tilted, moved, of_tilting = tilting.by_this_program()
    there = exudyn.asked(python, "exudyn_tilting_pair.py", of_tilting)
    own, other = rotations[0], np.array(found["rotations"][0])
    count = min(len(own), len(other))
    swing = 1e6 * np.ptp(other)
    off = 1e6 * np.abs(own[:count] - other[:count]).max()
    bent = np.concatenate([np.array(each) for each in shaft.compared(python).values()], axis=1)
    both = np.concatenate([found["frequencies"], there["frequencies"]]), np.concatenate([frequencies, tilted])
    return {
        "frequencies": _furthest(*both),
        "shafts": _furthest(bent[1], bent[0]),
        "response": (swing, swing + off),
        "static": _furthest(np.ravel(there["moved"]) * 1e3, moved.ravel() * 1e3),
    }


def _furthest(authority, own) -> tuple[float, float]:
    authority, own = np.asarray(authority), np.asarray(own)
    worst = int(np.abs(own / authority - 1.0).argmax())
    return float(authority[worst]), float(own[worst])


def by_ross(python: str) -> Numbers:
    """Deflection under 1 kN, µm, and the natural frequency, Hz, that differs most."""
    every = ross.compared(python)
    pairs = [pair for (_, own), (_, other) in every.values() for pair in zip(other.tolist(), own.tolist())]
    moved = {name: (1e6 * other[0, 0], 1e6 * own[0, 0]) for name, ((own, _), (other, _)) in every.items()}
    cone = moved.pop(CONE)
    return {
        "cylinders": _furthest(*zip(*moved.values())),
        CONE: cone,
        "vibrating": max(pairs, key=lambda pair: abs(pair[1] / pair[0] - 1.0)),
    }


CALCULIX, GETFEM = "CalculiX 2.20, contact on the true outlines", "GetFEM 5.4.2, large sliding, augmented Lagrangian"
EXUDYN, ROSS = "Exudyn 1.13.6, rigid bodies and springs", "ROSS 2.3.0, beam elements"
(CONE,) = (each for each in ross.SHAFTS if "cone" in each)
PAIR = "transmission error of the paper's pair"
PARTS = [
    Part(
        "corner", PROGRAMS, "other_programs.md#calculix",
        {words: Claim(f"{PAIR}, {words}", CALCULIX, "µrad", within(0.01), "default elements; CalculiX's mesh 0.2 %")
         for words in EDGES.values()},
        corner,
    ),
    Part(
        "calculix", PROGRAMS, "other_programs.md#over-the-face",
        {f"{phase:g}": Claim(f"transmission error of a helical pair, 20 deg, phase {phase:g}", CALCULIX, "µrad",
                             within(0.005), "CalculiX's elements, which are stiffer; teeth left out, which are softer")
         for phase in against_calculix.PHASES},
        calculix, minutes=6.0, needs="CalculiX (ccx)",
    ),
    Part(
        "getfem", PROGRAMS, "other_programs.md#getfem",
        {f"{phase:g}": Claim(f"{PAIR}, phase {phase:g}", GETFEM, "µrad", within(0.003), "elements of either program")
         for phase in getfem.PHASES},
        by_getfem, minutes=2.0, needs="GetFEM",
    ),
    Part(
        "exudyn", PROGRAMS, "other_programs.md#exudyn",
        {
            "frequencies": Claim("natural frequencies on a constant mesh stiffness, tilting too, the worst of 20",
                                 EXUDYN, "Hz", within(1e-13), "round-off"),
            "shafts": Claim("natural frequencies of three shafts up to 12 kHz, the worst of 29",
                            "Exudyn 1.13.6, geometrically exact beams of 1 mm", "Hz", within(1e-4),
                            "elements of either program"),
            "response": Claim("rotation after a step of the couple, largest difference in 10 ms", EXUDYN, "µrad",
                              within(1e-6), "Exudyn's large displacements"),
            "static": Claim("displacements of gears that tilt, the worst of 12", EXUDYN, "10⁻³ mm or rad",
                            within(1e-5), "Exudyn's large displacements"),
        },
        by_exudyn, needs="Exudyn",
    ),
    Part(
        "ross", PROGRAMS, "third_dimension.md#shafts-that-bend",
        {
            "cylinders": Claim("deflection at the gear, shafts of cylinders, the worst of 2", ROSS, "µm/kN",
                               within(1e-10), "round-off"),
            CONE: Claim(f"deflection at the gear: {CONE}", ROSS, "µm/kN", within(1e-3), "40 elements in a section"),
            "vibrating": Claim("natural frequencies of the three up to 12 kHz, the worst of 29", ROSS, "Hz",
                               within(1e-4), "elements of either program"),
        },
        by_ross, needs="ROSS",
    ),
    GEARPIE,
]  # fmt: skip
