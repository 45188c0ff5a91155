"""Run the hard cases and write what they measured into the documentation: `python -m tests.hard_cases.table`.

Writes docs/hard_cases.md, with what the nightly cases measure. Further arguments go to pytest; tables of which nothing
was measured then stay as they are, so that `-k over_the_face` renews those of the face alone.
"""

import platform
import re
import sys
from collections import defaultdict
from pathlib import Path

import pytest

HERE = Path(__file__).parent
PAGE = HERE.parents[1] / "docs" / "hard_cases.md"
OVER_THE_FACE = "Over the face:"


class Collector:
    """A pytest plugin that gathers measurements by row."""

    def __init__(self):
        self.measured, self.over_the_face = (defaultdict(lambda: defaultdict(list)) for _ in range(2))

    def pytest_runtest_logreport(self, report):
        if report.when != "call":
            return
        measured = self.over_the_face if "over_the_face" in Path(report.fspath).name else self.measured
        for kind, line in report.user_properties:
            if kind == "hard_case":
                row, what, value, limit = line.split("|")
                measured[int(row)][what].append((value, limit))


def page(collector: Collector, text: str) -> str:
    """The documentation's page `text` with the tables of its cases made anew."""
    head, *cases = re.split(r"^(?=## \d+\. )", text, flags=re.MULTILINE)
    found = [re.sub(r"^Python .*$", f"Python {platform.python_version()} on {platform.machine()}.", head, flags=re.M)]
    for case in cases:
        row, (plane, _, face) = int(re.match(r"## (\d+)", case)[1]), case.partition(OVER_THE_FACE)
        said, _, before = plane.partition("\n| ")
        lines = [said, *(table(collector.measured[row]) or ["| " + before] * bool(before))]
        over_the_face = table(collector.over_the_face[row]) or [face.strip()] * bool(face)
        if over_the_face:
            lines += ["", OVER_THE_FACE, "", *over_the_face]
        found.append("\n".join(line.rstrip("\n") for line in lines) + "\n")
    return "\n".join(each.rstrip("\n") + "\n" for each in found)


def table(measured: dict) -> list[str]:
    if not measured:
        return []
    lines = ["| quantity | measured | limit |", "|---|---|---|"]
    return lines + [
        f"| {what} | {spread([each for each, _ in values])} | {values[-1][1]} |" for what, values in measured.items()
    ]


def spread(values: list[str]) -> str:
    """One measurement as it is; of several the smallest and the largest, or all that differ where they are words."""
    different = list(dict.fromkeys(values))
    if len(different) == 1:
        return different[0]
    try:
        ordered = sorted(different, key=lambda value: float(value.split()[0]))
    except ValueError:
        return "; ".join(different)
    if any("," in value for value in different):
        return "; ".join(different)
    return f"{ordered[0]} ... {ordered[-1]}"


def main(options: list[str]) -> int:
    collector = Collector()
    outcome = pytest.main(["-q", "-m", "", str(HERE), *options], plugins=[collector])
    PAGE.write_text(page(collector, PAGE.read_text(encoding="utf-8")), encoding="utf-8")
    return int(outcome)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
