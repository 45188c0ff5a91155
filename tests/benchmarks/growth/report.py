"""Points of all axes, their exponents beside theory's, as CSV and as tables for a page."""

from __future__ import annotations

import csv
from collections.abc import Mapping, Sequence
from pathlib import Path

from tests.benchmarks.growth.axes import axis_named, those_of
from tests.benchmarks.growth.axis import Axis
from tests.benchmarks.growth.fit import Exponent, exponent, local_slopes

Points = Sequence[Mapping[str, float]]
STAGES = ("mesh", "assemble", "schur", "ring", "fourier", "clock", "condense", "operators", "solving")
WORDS = {
    "mesh": "meshing", "assemble": "condensing: assembling", "schur": "condensing: Schur complement",
    "ring": "condensing: ring of sectors",
    "fourier": "instead: ring by Fourier transform", "clock": "condensing by the clock",
    "factor": "factor, as MUMPS counts",
    "condense": "condensing", "operators": "marching: operators", "solving": "marching: solving",
}  # fmt: skip
MEBI, ROUNDS = 2.0**20, 5


def column(quantity: str) -> str:
    """The name that a quantity of the theory has in a point."""
    stage, _, what = quantity.partition(" ")
    return {
        "": f"{stage}_s",
        "arrays": f"{stage}_array_bytes",
        "peak": f"{stage}_above_idle_bytes",
        "operations": f"{stage}_operations",
    }[what]


def words(quantity: str) -> str:
    """A quantity for people."""
    stage, _, what = quantity.partition(" ")
    return (
        WORDS[stage]
        + {"": "", "arrays": ", arrays", "peak": ", peak of the process above its idle", "operations": ", operations"}[
            what
        ]
    )


def exponents(axis: Axis, points: Points) -> dict[str, Exponent | None]:
    """Of every quantity that theory says something about."""
    return {quantity: exponent(*known(axis, points, column(quantity))) for quantity in axis.theory}


def known(axis: Axis, points: Points, name: str) -> tuple[list[float], list[float]]:
    """What is counted along an axis, and what was measured, of the points that have it."""
    having = [point for point in points if name in point]
    return [point[axis.counted] for point in having], [point[name] for point in having]


def section(found: Mapping[str, Points], machine: Mapping[str, str], name: str = "growth") -> str:
    """Both tables of every axis, the picture of a name and what it was measured on."""
    parts = [f"![](../pictures/{name}.png)", "", f"All numbers: [{name}.csv](../pictures/{name}.csv)."]
    for axis in those_of(found):
        points = found[axis.name]
        parts += [
            "",
            f"## {axis.name[0].upper()}{axis.name[1:]}",
            "",
            *_exponent_table(axis, points),
            "",
            *_point_table(axis, points),
        ]
    fewest = min(
        int(point.get(f"{stage}_rounds", ROUNDS))
        for name, points in found.items()
        for point in points
        for stage in _timed(name)
    )
    parts += ["", (
        f"Times are processor seconds on one thread: medians of 5 runs, or of at least {fewest} where a stage takes "
        f"longer than a second. Each point ran in a process "
        f"of its own. {machine['processor']}, load {machine['load']}; {machine['versions']}."
    )]  # fmt: skip
    return "\n".join(parts)


def _timed(name: str) -> set[str]:
    return axis_named(name).stages


def _exponent_table(axis: Axis, points: Points) -> list[str]:
    lines = [
        "|what grows|exponent over the upper decade|between the last two points|theory|why|",
        "|---|---|---|---|---|",
    ]
    for quantity, found in exponents(axis, points).items():
        theory = axis.theory[quantity]
        last = local_slopes(*known(axis, points, column(quantity)))[-1]
        measured = "-" if found is None else f"{found.value:.2f} ± {found.error:.2f}", f"{last:.2f}"
        lines.append(f"|{words(quantity)}|{measured[0]}|{measured[1]}|{theory.exponent:.3g}|{theory.why}|")
    return lines


def _point_table(axis: Axis, points: Points) -> list[str]:
    timed = [stage for stage in STAGES if stage in axis.theory]
    heading = [
        axis.name,
        *axis.also.values(),
        *(f"{WORDS[stage]}, s" for stage in timed),
        "peak of the process, MiB",
        "arrays, MiB",
    ]
    lines = [f"|{'|'.join(heading)}|", "|---" * len(heading) + "|"]
    for point in points:
        peak = max((value for name, value in point.items() if name.endswith("_peak_bytes")), default=None)
        arrays = sum(value for name, value in point.items() if name.endswith("_array_bytes"))
        cells = [
            f"{point[axis.counted]:g}",
            *(f"{point[count]:.0f}" for count in axis.also),
            *(f"{point[stage + '_s']:.2g}" if f"{stage}_s" in point else "-" for stage in timed),
        ]
        lines.append(
            f"|{'|'.join([*cells, '-' if peak is None else str(round(peak / MEBI)), f'{arrays / MEBI:.3g}'])}|"
        )
    return lines


def write_csv(found: Mapping[str, Points], machine: Mapping[str, str], file: Path) -> None:
    """A line for each point, with all that was measured, then one for each exponent."""
    measured = dict.fromkeys(name for points in found.values() for point in points for name in point)
    columns = [
        "kind",
        "axis",
        "quantity",
        *measured,
        "exponent",
        "standard_error",
        "fitted_points",
        "last_slope",
        "theory",
        "why",
        *machine,
    ]
    with open(file, "w", encoding="utf-8", newline="") as opened:
        writer = csv.DictWriter(opened, columns, restval="")
        writer.writeheader()
        for axis in those_of(found):
            for point in found[axis.name]:
                writer.writerow({"kind": "point", "axis": axis.name, **point, **machine})
            for quantity, fit in exponents(axis, found[axis.name]).items():
                theory = axis.theory[quantity]
                told = {} if fit is None else {
                    "exponent": fit.value, "standard_error": fit.error, "fitted_points": fit.points,
                    "last_slope": fit.last,
                }  # fmt: skip
                writer.writerow({
                    "kind": "exponent", "axis": axis.name, "quantity": quantity, **told, "theory": theory.exponent,
                    "why": theory.why, **machine,
                })  # fmt: skip
