"""How time and memory grow, into docs/evidence/growth.md: `python -m tests.benchmarks.growth [axis ...]`.

Runs the points of all axes (`axes.py`, over the face `face_axes.py`), each in a process of its own on one thread;
writes tables and exponents between the page's markers, pictures and all numbers to docs/pictures/growth.png and
growth.csv, over the face growth_face. Axes named on the command line alone are run anew, what the CSV has of the others
is kept.
"""

from __future__ import annotations

import argparse
import csv
import json
import os
import subprocess
import sys
from pathlib import Path

from tests.benchmarks.growth.axes import AXES
from tests.benchmarks.growth.axis import Axis
from tests.benchmarks.growth.face_axes import FACE_AXES
from tests.benchmarks.growth.picture import PLANE_PAIR, growth_picture
from tests.benchmarks.growth.report import section, write_csv
from tests.benchmarks.marked_section import write_section

from fenics_gears.show.plots import save_figure
from fenics_gears.studies.machine import machine

ROOT = Path(__file__).parents[3]
PAGE, PICTURES = ROOT / "docs" / "evidence" / "growth.md", ROOT / "docs" / "pictures"
# What grows, by the name of its files.
GROUPS = {
    "growth": (AXES, PLANE_PAIR),
    "growth_face": (FACE_AXES, "over the face, 20 and 30 teeth at 15 degrees, one thing at a time made larger"),
}
COUNTED = (
    "flank_nodes", "contact_nodes", "teeth", "steps", "cycles", "unknowns", "condensed_unknowns", "most_contact_rows",
    "newton_iterations", "closed_nodes",
    "section_nodes", "layers", "slices", "ranks",
)  # fmt: skip
ONE_THREAD = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")


def points_of(axis: Axis) -> list[dict[str, float]]:
    """All points of an axis, each measured in a process of its own."""
    found = []
    for value in axis.values:
        module = "point" if axis.measured == "pair" else "face_point"
        call = [sys.executable, "-m", f"tests.benchmarks.growth.{module}", axis.name, str(value)]
        if axis.counted == "ranks":
            call = ["mpirun", "--bind-to", "none", "-n", f"{value:g}", *call]
        run = subprocess.run(
            call, cwd=ROOT, env={**os.environ, **ONE_THREAD}, stdout=subprocess.PIPE, text=True, check=True
        )
        found.append(json.loads(run.stdout.splitlines()[-1]))
        print(
            f"{axis.name} {value:g}: "
            + ", ".join(f"{name} {found[-1].get(name + '_s', 0.0):.3g} s" for name in sorted(axis.stages))
            + f", peak {_peak(found[-1]):.2f} GB",
            flush=True,
        )
    return found


def _peak(point: dict[str, float]) -> float:
    return max((value for name, value in point.items() if name.endswith("_peak_bytes")), default=0.0) / 1e9


def saved(numbers: Path) -> tuple[dict[str, list[dict[str, float]]], dict[str, str]]:
    """Points that a CSV has, by axis, and what they were measured on."""
    found: dict[str, list[dict[str, float]]] = {}
    with open(numbers, encoding="utf-8", newline="") as file:
        lines = [line for line in csv.DictReader(file) if line["kind"] == "point"]
    for line in lines:
        known = {
            name: float(value)
            for name, value in line.items()
            if name.endswith(("_s", "_bytes", "_rounds", "_operations")) and value
        }
        found.setdefault(line["axis"], []).append(
            known | {name: float(line[name]) for name in COUNTED if line.get(name)}
        )
    return found, {name: lines[0][name] for name in machine()}


def main() -> None:
    """Measure, write numbers, pictures and the page's sections."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument(
        "names", nargs="*", help=f"of axes, all unless given: {', '.join(axis.name for axis in AXES + FACE_AXES)}"
    )
    parser.add_argument(
        "--write-again", action="store_true", help="pictures and page from the saved numbers, without measuring"
    )
    options = parser.parse_args()
    for group, (axes, what) in GROUPS.items():
        wanted = (
            [] if options.write_again else [axis for axis in axes if not options.names or axis.name in options.names]
        )
        if not wanted and not options.write_again:
            continue
        numbers = PICTURES / f"{group}.csv"
        found, before = (
            saved(numbers) if (options.names or options.write_again) and numbers.exists() else ({}, machine())
        )
        for axis in wanted:
            found[axis.name] = points_of(axis)
            write_csv(found, before, numbers)
        save_figure(growth_picture(found, before, what), PICTURES / f"{group}.png")
        write_section(PAGE, f"<!-- {group}: begin -->", f"<!-- {group}: end -->", section(found, before, group))


if __name__ == "__main__":
    main()
