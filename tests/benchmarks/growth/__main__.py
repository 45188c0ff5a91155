"""How time and memory grow, into docs/growth.md: `python -m tests.benchmarks.growth [axis ...]`.

Runs the points of all axes (`axes.py`), each in a process of its own on one thread; writes tables and exponents between the page's two
markers, the picture and all numbers to docs/pictures/growth.png and growth.csv. Axes named on the command line alone are run anew, what
the CSV has of the others is kept.
"""

from __future__ import annotations

import argparse
import csv
import json
import os
import subprocess
import sys
from pathlib import Path

from tests.benchmarks.growth.axes import AXES, Axis
from tests.benchmarks.growth.picture import growth_picture
from tests.benchmarks.growth.report import section, write_csv
from tests.benchmarks.marked_section import write_section

from fenics_gears.show.plots import save_figure
from fenics_gears.studies.machine import machine

ROOT = Path(__file__).parents[3]
PAGE, NUMBERS, PICTURE = (ROOT / "docs" / name for name in ("growth.md", "pictures/growth.csv", "pictures/growth.png"))
COUNTED = (
    "flank_nodes", "contact_nodes", "teeth", "steps", "cycles", "unknowns", "condensed_unknowns", "most_contact_rows", "newton_iterations", "closed_nodes",
)  # fmt: skip
ONE_THREAD = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")


def points_of(axis: Axis) -> list[dict[str, float]]:
    """All points of an axis, each measured in a process of its own."""
    found = []
    for value in axis.values:
        call = [sys.executable, "-m", "tests.benchmarks.growth.point", axis.name, str(value)]
        run = subprocess.run(call, cwd=ROOT, env={**os.environ, **ONE_THREAD}, stdout=subprocess.PIPE, text=True, check=True)
        found.append(json.loads(run.stdout.splitlines()[-1]))
        print(f"{axis.name} {value:g}: " + ", ".join(f"{name} {found[-1][name + '_s']:.3g} s" for name in sorted(axis.stages)), flush=True)
    return found


def saved() -> tuple[dict[str, list[dict[str, float]]], dict[str, str]]:
    """Points that the CSV has, by axis, and what they were measured on."""
    found: dict[str, list[dict[str, float]]] = {}
    with open(NUMBERS, encoding="utf-8", newline="") as file:
        lines = [line for line in csv.DictReader(file) if line["kind"] == "point"]
    for line in lines:
        known = {name: float(value) for name, value in line.items() if name.endswith(("_s", "_bytes", "_rounds")) and value}
        found.setdefault(line["axis"], []).append(known | {name: float(line[name]) for name in COUNTED})
    return found, {name: lines[0][name] for name in machine()}


def main() -> None:
    """Measure, write numbers, picture and the page's section."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("names", nargs="*", help=f"of axes, all unless given: {', '.join(axis.name for axis in AXES)}")
    parser.add_argument("--write-again", action="store_true", help="picture and page from the saved numbers, without measuring")
    options = parser.parse_args()
    wanted = [] if options.write_again else [axis for axis in AXES if not options.names or axis.name in options.names]
    found, before = saved() if options.names or options.write_again else ({}, machine())
    for axis in wanted:
        found[axis.name] = points_of(axis)
        write_csv(found, before, NUMBERS)
    save_figure(growth_picture(found, before), PICTURE)
    write_section(PAGE, "<!-- growth: begin -->", "<!-- growth: end -->", section(found, before))


if __name__ == "__main__":
    main()
