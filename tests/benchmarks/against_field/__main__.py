"""This program beside gear packages, a rotor program, a multi-body program and finite elements on the same input: one
table of quantities, both values, both times of a processor.

    pip install python-gearbox py-gearworks exudyn ross-rotordynamics 'plotly<6'  # into an environment of its own
    python -m tests.benchmarks.against_field PYTHON [--calculix]          # PYTHON: that environment's

Writes the table into docs/evidence/other_programs.md. Programs that PYTHON lacks are left out, and said. CalculiX
(Debian's calculix-ccx) takes three minutes.
"""

import argparse
import json
import subprocess
import sys
import time
from math import radians
from pathlib import Path

import numpy as np
from tests.benchmarks import against_calculix
from tests.benchmarks.against_exudyn import pair as exudyn
from tests.benchmarks.against_ross import __main__ as ross
from tests.benchmarks.marked_section import markers, write_section
from tests.benchmarks.third_dimension.pairs import in_plane, scene_of, standard_pair

from fenics_gears import gear_pair, mesh_factor, simulate, single_stiffness
from fenics_gears.dynamics.elastic_shaft import ElasticShaft
from fenics_gears.scene.data import Accuracy

PAGE = Path(__file__).parents[3] / "docs" / "evidence" / "other_programs.md"
WIDTH, HELICES, TIP_RADIUS = 20.0, (0.0, 20.0), 0.25
# Quantity, program, its value, this program's, its seconds, this program's.
Row = tuple[str, str, float, float, float, float]


def timed(function, *given):
    """What a function gives, and the processor's seconds, those of its processes too."""
    begun = against_calculix.seconds_of_processor()
    found = function(*given)
    return found, against_calculix.seconds_of_processor() - begun


def by_packages(python: str, helix: float, radii: list[float]) -> dict:
    """Of both packages, with their seconds without imports."""
    given = {"module": 3.0, "helix": helix, "width": WIDTH, "teeth": [20, 30], "tip_radius": TIP_RADIUS, "radii": radii}
    script = Path(__file__).with_name("gear_packages.py")
    done = subprocess.run(
        [python, "-W", "ignore", script], input=json.dumps(given), capture_output=True, text=True, check=True
    )
    return json.loads(done.stdout.splitlines()[-1])


def packages(python: str) -> list[Row]:
    """Geometry and stiffness of a spur and of a helical pair."""
    rows = []
    for helix in HELICES:
        data, words = standard_pair(WIDTH, radians(helix)), f"{helix:g} deg"
        pair, own = timed(gear_pair, data)
        pinion = pair.pinion
        radii = np.linspace(pinion.form_radius, pinion.tip_radius, 9)[1:-1]
        found = by_packages(python, helix, radii.tolist())
        one, other = found["python-gearbox"], found["py-gearworks"]
        for name, there in found.items():
            its = there["transverse contact ratio"]
            rows.append((f"transverse contact ratio, {words}", name, its, pair.contact_ratio, there["seconds"], own))
        if helix:
            overlap = one["overlap ratio"]
            rows.append((f"overlap ratio, {words}", "python-gearbox", overlap, pair.overlap_ratio, one["seconds"], own))
        mine = pinion.tooth_thickness(radii)
        worst = int(np.abs(np.array(other["thickness"]) - mine).argmax())
        rows.append((f"tooth thickness where it differs most, {words}, mm", "py-gearworks",
                     other["thickness"][worst], float(mine[worst]), other["seconds"], own))  # fmt: skip
        single, of_formula = timed(single_stiffness, data)
        rows.append((f"c' by ISO 6336-1, {words}, N/(mm µm)", "python-gearbox",
                     one["single"], single[1], one["seconds"], of_formula))  # fmt: skip
        rows.append((f"c_γα by ISO 6336-1, {words}, N/(mm µm)", "python-gearbox",
                     one["mesh"], single[1] * mesh_factor(pair.contact_ratio), one["seconds"], of_formula))  # fmt: skip
        scene = scene_of(data, Accuracy())
        result, by_contact = timed(simulate, scene if helix else in_plane(scene))
        elastic = result.attrs["mean_mesh_stiffness"]
        rows.append((f"mesh stiffness of elastic contact beside c_γα, {words}, N/(mm µm)", "python-gearbox",
                     one["mesh"], elastic, one["seconds"], by_contact))  # fmt: skip
    return rows


def rotor(python: str) -> list[Row]:
    """Deflection of shafts at the gear."""
    rows = []
    for name, (sections, gear_at, pieces) in ross.SHAFTS.items():
        shaft = ElasticShaft("pinion", sections, (206e3, 0.3), gear_at, 0.0, 0.0, ross.BEARINGS)
        mine, own = timed(lambda shaft=shaft: np.linalg.inv(shaft.stiffness))
        there, its = timed(ross.by_ross, python, shaft, pieces)
        rows.append((f"deflection: {name}, µm/kN", "ROSS", 1e6 * there[0, 0], 1e6 * mine[0, 0], its, own))
    return rows


def bodies(python: str) -> list[Row]:
    """The natural frequency that differs most, and the times of it with a response of 5000 steps."""
    (frequencies, _, given), own = timed(exudyn.by_this_program)
    found, its = timed(exudyn.asked, python, "exudyn_pair.py", given)
    theirs = np.array(found["frequencies"])
    worst = int(np.abs(frequencies / theirs - 1.0).argmax())
    words = "natural frequency on a constant mesh stiffness that differs most of 7, and 5000 steps, Hz"
    return [(words, "Exudyn", theirs[worst], frequencies[worst], its, own)]


def elements(_: str) -> list[Row]:
    """Transmission error of a helical pair at two positions."""
    gears = standard_pair(against_calculix.FACE_WIDTH, against_calculix.HELIX_ANGLE)
    scene = scene_of(gears, Accuracy(steps_per_mesh_cycle=against_calculix.STEPS), against_calculix.LINE_LOAD)
    (own, _), seconds = timed(against_calculix.by_this_program, scene)
    rows = []
    for phase, mine in zip(against_calculix.PHASES, own):
        there, _, its = against_calculix.by_calculix(scene, gear_pair(gears), phase, mine, 1.0)
        rows.append((f"transmission error, 20 deg, phase {phase:g}, µrad (20 positions here, one there)", "CalculiX",
                     1e6 * there, 1e6 * mine, its, seconds))  # fmt: skip
    return rows


def table(rows: list[Row]) -> str:
    """In Markdown."""
    lines = ["| quantity | program | its value | here | difference | its time, s | time here, s |"]
    lines.append("|---|---|---|---|---|---|---|")
    for quantity, program, value, own, its, mine in rows:
        off = own / value - 1.0
        difference = f"{100.0 * off:+.2g} %" if abs(off) > 1e-9 else f"{off:.0e}"
        lines.append(f"| {quantity} | {program} | {value:.7g} | {own:.7g} | {difference} | {its:.2g} | {mine:.2g} |")
    return "\n".join(lines)


def main() -> int:
    """Measure, print, write."""
    parser = argparse.ArgumentParser(prog="python -m tests.benchmarks.against_field")
    parser.add_argument("python", help="a Python that has the other programs")
    parser.add_argument("--calculix", action="store_true", help="CalculiX too, three minutes")
    given, rows, missing = parser.parse_args(), [], 0
    # What is compiled or imported at the first call is no part of the times.
    simulate(in_plane(scene_of(standard_pair(WIDTH), Accuracy(steps_per_mesh_cycle=20))))
    for part in (packages, rotor, bodies, *([elements] if given.calculix else [])):
        begun = time.monotonic()
        try:
            rows += part(given.python)
        except (OSError, subprocess.CalledProcessError) as error:
            missing = 1
            print(f"{part.__name__} left out: {getattr(error, 'stderr', '') or error}"[-300:], file=sys.stderr)
        print(f"{part.__name__}: {time.monotonic() - begun:.0f} s", flush=True)
    print(table(rows))
    write_section(PAGE, *markers("field"), table(rows))
    return missing


if __name__ == "__main__":
    sys.exit(main())
