"""This program beside gear packages of PyPI on the same input, into docs/evidence/other_programs.md: both values, both
times of a processor. PYTHON is that of an environment that has them.

    pip install python-gearbox py-gearworks
    python -m tests.benchmarks.against_field PYTHON
"""

import json
import subprocess
import sys
import time
from math import radians
from pathlib import Path

import numpy as np
from tests.benchmarks.marked_section import markers, write_section
from tests.benchmarks.third_dimension.pairs import in_plane, scene_of, standard_pair

from fenics_gears import gear_pair, mesh_factor, simulate, single_stiffness
from fenics_gears.scene.data import Accuracy

PAGE = Path(__file__).parents[3] / "docs" / "evidence" / "other_programs.md"
WIDTH, HELICES, TIP_RADIUS = 20.0, (0.0, 20.0), 0.25
# Quantity, program, its value, this program's, its seconds, this program's.
Row = tuple[str, str, float, float, float, float]


def timed(function, *given):
    """What a function gives, and the processor's seconds."""
    begun = time.process_time()
    return function(*given), time.process_time() - begun


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


def table(rows: list[Row]) -> str:
    """In Markdown."""
    lines = ["| quantity | program | its value | here | difference | its time, s | time here, s |"]
    lines.append("|---|---|---|---|---|---|---|")
    for quantity, program, value, own, its, mine in rows:
        off = own / value - 1.0
        difference = f"{100.0 * off:+.2g} %" if abs(off) > 1e-9 else f"{off:.0e}"
        lines.append(f"| {quantity} | {program} | {value:.7g} | {own:.7g} | {difference} | {its:.2g} | {mine:.2g} |")
    return "\n".join(lines)


def main(python: str) -> None:
    """Measure, print, write."""
    # What is compiled or imported at the first call is no part of the times.
    simulate(in_plane(scene_of(standard_pair(WIDTH), Accuracy(steps_per_mesh_cycle=20))))
    rows = packages(python)
    print(table(rows))
    write_section(PAGE, *markers("field"), table(rows))


if __name__ == "__main__":
    main(sys.argv[1])
