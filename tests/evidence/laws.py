"""Statics, energy, symmetry: what holds whatever the teeth are."""

import numpy as np
from tests.benchmarks.third_dimension.pairs import MODULE, scene_of, standard_pair
from tests.corner_contact_reference.reference import paper_pair
from tests.evidence.claim import LAWS, Claim, Numbers, Part, within
from tests.face.test_whole_run import COARSE, HELIX_ANGLE
from tests.hard_cases.test_row_04_energy import RUNS, account_defect, run_of_two_cycles

from fenics_gears import gear_pair, simulate

ENERGY = ("all effects", "inertia, damping", "rising speed, rigid shafts")


def _name(words: str) -> str:
    return words if words in RUNS else f"without {words}"


def energy(_: str) -> Numbers:
    scene, _pair = paper_pair()
    found = {}
    for words in ENERGY:
        result = run_of_two_cycles(scene, _name(words))
        found[words] = 0.0, float(np.abs(account_defect(result)).max() / result.work_input[-1])
    return found


def statics(_: str) -> Numbers:
    scene = scene_of(standard_pair(3.0 * MODULE, HELIX_ANGLE, bore=0.8), COARSE)
    result, pair = simulate(scene), gear_pair(scene.gears)
    pinion, wheel = np.abs(result.reaction_couple.values.T)
    ratio = scene.gears.pinion.teeth / scene.gears.wheel.teeth
    of_slices = (result.line_load * result.face_slice_width).sum(("slot", "face_position")).values
    normal = result.normal_force.sel(time=result.contact_time.values, method="nearest").values
    axial = np.abs(result.reaction_z.sel(gear="wheel").values)
    tangential = scene.load.wheel_torque / pair.wheel.base_radius
    return {
        "couples": (ratio, _furthest(pinion / wheel, ratio)),
        "wheel": (1e-3 * scene.load.wheel_torque, 1e-3 * _furthest(wheel, scene.load.wheel_torque)),
        "axial": (tangential * abs(pair.slope), _furthest(axial, tangential * abs(pair.slope))),
        "line loads": (float(normal[0]), float(normal[0]) * _furthest(of_slices / normal, 1.0)),
    }


def _furthest(found: np.ndarray, exact: float) -> float:
    return float(found[np.abs(found - exact).argmax()])


BALANCE, ROUND = "energy gained is work done less losses", "round-off"
PARTS = [
    Part(
        "energy", LAWS, "../hard_cases.md",
        {words: Claim(f"energy that is missing over two mesh cycles, {_name(words)}", BALANCE, "of the work",
                      (0.0, 1e-9), ROUND) for words in ENERGY},
        energy,
    ),
    Part(
        "statics", LAWS, "third_dimension.md#statics",
        {
            "couples": Claim("couple of the pinion over that of the wheel, helical", "numbers of teeth", "",
                             within(1e-12), ROUND),
            "wheel": Claim("couple on the wheel, at the worst step", "the load", "N m", within(1e-9), ROUND),
            "axial": Claim("axial force, at the worst step", "F tan β_b, along the line of action", "N", within(1e-9),
                           ROUND),
            "line loads": Claim("line loads of all slices added up, at the worst step", "normal force", "N",
                                within(1e-12), ROUND),
        },
        statics,
    ),
]  # fmt: skip
