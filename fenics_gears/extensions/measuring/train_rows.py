"""Runs of a train whose meshes are computed together, one below the other: numbers of each, and how much they differ
from those of another one."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from fenics_gears.charts import DARK, PALETTE, styled

from .machine import in_words, write_lines

# Numbers by name: words and unit; of each mesh the largest counts.
NUMBERS = {
    "mean_overall_transmission_error": ("T_E, mean", "rad"),
    "peak_to_peak_overall_transmission_error": ("T_E, peak to peak", "rad"),
    "largest_pair_force": ("largest pair force", "N"),
    "peak_contact_pressure": ("peak pressure", "MPa"),
    "face_load_factor": ("K_Hbeta", ""),
    "load_sharing_factor": ("K_gamma", ""),
    "largest_bearing_force": ("largest bearing force", "N"),
}


@dataclass(frozen=True)
class Row:
    """A run: its name, seconds and numbers; `compared`: the name of the run that its numbers are compared with, of
    itself none."""

    name: str
    seconds: float
    numbers: Mapping[str, float]
    compared: str = ""


@dataclass(frozen=True)
class TrainReport:
    """The rows of a train; `timed`: what their seconds are of. `what`: is measured; `left`: what did not run, and
    why."""

    title: str
    what: str
    timed: str
    rows: tuple[Row, ...]
    left: tuple[tuple[str, str], ...]
    machine: Mapping[str, str]

    @property
    def names(self) -> list[str]:
        """Of the numbers that any row has, in their order."""
        return [name for name in NUMBERS if any(name in row.numbers for row in self.rows)]

    def changes(self, row: Row) -> dict[str, float]:
        """By how much a row's numbers are larger than those of the row that it is compared with, in parts of these;
        round-off is none."""
        before = next((other.numbers for other in self.rows if other.name == row.compared), {})
        both = {name: value for name, value in before.items() if value and name in row.numbers}
        return {name: round(row.numbers[name] / value - 1.0, 9) for name, value in both.items()}


def numbers_of(found: xr.Dataset) -> dict[str, float]:
    """The numbers that a result has."""
    numbers = {}
    for name in NUMBERS:
        if name in found.attrs:
            numbers[name] = float(found.attrs[name])
        elif name in found:
            values = found[name].values
            if np.isfinite(values).any():
                numbers[name] = float(np.nanmax(values))
    return numbers


def headings(report: TrainReport) -> tuple[tuple[str, ...], tuple[str, ...]]:
    names = [NUMBERS[name] for name in report.names]
    return ("", report.timed, *(words for words, _ in names)), ("", "s", *(unit for _, unit in names))


def table_rows(report: TrainReport) -> list[tuple[str, ...]]:
    """The numbers of all rows, and their changes."""
    rows = []
    for row in report.rows:
        changes = report.changes(row)
        cells = (_cell(row.numbers.get(name), changes.get(name)) for name in report.names)
        rows.append((row.name, f"{row.seconds:.2f}", *cells))
    return rows


def _cell(value: float | None, change: float | None) -> str:
    if value is None:
        return "none"
    return f"{value:.5g}" + ("" if change is None else f" ({100.0 * change + 0.0:+.3f} %)")


def write_csv(report: TrainReport, file: Path) -> None:
    """A line for each row, with its numbers, and for each that did not run."""
    lines = [
        {report.what: row.name, "seconds": row.seconds, **row.numbers, "compared_with": row.compared}
        for row in report.rows
    ]
    write_lines(file, [*lines, *({report.what: name, "remarks": why} for name, why in report.left)], report.machine)


@styled
def picture(report: TrainReport) -> Figure:
    """Changes of each number in per cent, a panel each, and the seconds of each run."""
    names = report.names
    height = 2.2 + 0.42 * len(report.rows)
    figure = Figure(figsize=(3.2 * (1 + len(names)), height), layout="constrained")
    figure.get_layout_engine().set(rect=(0, 0.5 / height, 1, 1 - 0.5 / height))
    seconds, *panels = figure.subplots(1, 1 + len(names), sharey=True)
    places = np.arange(len(report.rows))
    seconds.barh(places, [row.seconds for row in report.rows], color=DARK, height=0.6)
    seconds.set_title(f"{report.timed[0].upper()}{report.timed[1:]}\n(s)")
    seconds.set_yticks(places, [row.name for row in report.rows])
    seconds.set_ylim(places[-1] + 0.6, -0.6)
    compared = list(dict.fromkeys(row.compared for row in report.rows if row.compared))
    colours = dict(zip(compared, PALETTE))
    for panel, name in zip(panels, names):
        values = [100.0 * report.changes(row).get(name, 0.0) for row in report.rows]
        if not any(values):
            panel.set_xlim(-1.0, 1.0)
        panel.barh(places, values, color=[colours.get(row.compared, DARK) for row in report.rows], height=0.6)
        panel.axvline(0.0, color=DARK, linewidth=0.8)
        panel.set_title(f"{NUMBERS[name][0][0].upper()}{NUMBERS[name][0][1:]}\n(change, %)")
    for panel in (seconds, *panels):
        panel.grid(axis="y", visible=False)
        panel.tick_params(axis="y", length=0)
        panel.locator_params(axis="x", nbins=4)
    words = dict(zip(compared, ("blue", "orange")))
    against = "; ".join(f"{words[each]}: against {each}" for each in compared)
    figure.suptitle(f"{report.title}: {report.what} ({against})" if against else f"{report.title}: {report.what}")
    figure.text(0.5, 0.06 / height, f"Measured on {in_words(report.machine)}", ha="center", fontsize=9)
    return figure
