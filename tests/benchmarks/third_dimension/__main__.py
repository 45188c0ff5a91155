"""Measure and write the sections of docs/evidence/third_dimension.md: all, or those that are named; `--draw`: from the
numbers kept."""

import sys
from importlib import import_module
from pathlib import Path

from tests.benchmarks.marked_section import write_section

PAGE = Path(__file__).parents[3] / "docs" / "evidence" / "third_dimension.md"
NAMES = (
    "plane_limits",
    "face_widths",
    "overlap",
    "misaligned",
    "crowned",
    "tooth_stiffness",
    "stiffness_function",
    "root_stress",
    "cited",
    "resolved",
    "defaults",
    "convergence",
)


def main(words: list[str]) -> None:
    for name in [word for word in words if word != "--draw"] or NAMES:
        benchmark = import_module(f"tests.benchmarks.third_dimension.{name}")
        if "--draw" not in words:
            benchmark.measure()
        write_section(PAGE, f"<!-- {name}: begin -->", f"<!-- {name}: end -->", benchmark.section())


if __name__ == "__main__":
    main(sys.argv[1:])
