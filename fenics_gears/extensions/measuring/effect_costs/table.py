"""The report of `gears effects` as a table, in words, and as CSV."""

import re
import statistics
from math import isnan, nan
from pathlib import Path

from ..machine import write_lines
from .measured import EffectReport, MeasuredRow
from .subsets import ALL, BARE

MICRO = 1e6
MILLI = 1e3
NUMBERS_OF_ONE = " (numbers of the first row that says so)"
HEADINGS = (
    "effects", "unknowns", "closed nodes", "Newton iterations per step", "time per step", "operators", "condensing",
    "T_EPP", "peak force", "",
)  # fmt: skip
UNITS = ("", "centre + contact", "mean (most)", "", "us", "s", "s", "um", "N", "remark")


# Of scenes over the face, before the remarks: heading, unit, digits.
OF_FACE = {"face_load_factor": ("K_Hbeta", "", 2), "peak_pressure": ("peak pressure", "MPa", 0)}


def headings(report: EffectReport) -> tuple[tuple[str, ...], tuple[str, ...]]:
    words, units = zip(*(OF_FACE[name][:2] for name in report.of_face)) if report.of_face else ((), ())
    return (*HEADINGS[:-1], *words, HEADINGS[-1]), (*UNITS[:-1], *units, UNITS[-1])


def table_rows(report: EffectReport) -> list[tuple[str, ...]]:
    """A row of cells for each subset; changes are against the bare scene for one effect more, against all for one
    less."""
    numbers = {_words(remark): place for place, remark in enumerate(remarks(report), 1)}
    return [_cells(report, row, numbers) for row in report.rows]


def _cells(report: EffectReport, row: MeasuredRow, numbers: dict[str, int]) -> tuple[str, ...]:
    return (
        row.subset.name,
        f"{row.coordinates} + {row.contact_rows:.1f}",
        f"{row.closed_nodes:.2f} ({row.most_closed_nodes})",
        f"{row.iterations:.2f}",
        f"{row.step_time * MICRO:.1f}",
        f"{row.operators:.2f}",
        f"{row.condense:.2f}" if row.elastic else "none",
        _with_change(row.transmission_error * MILLI, report, row, "transmission_error", 3),
        _with_change(row.peak_force, report, row, "peak_force", 0),
        *(_with_change(getattr(row, name), report, row, name, OF_FACE[name][2]) for name in report.of_face),
        " ".join(f"[{numbers[_words(remark)]}]" for remark in row.remarks),
    )


def _with_change(value: float, report: EffectReport, row: MeasuredRow, name: str, digits: int) -> str:
    if isnan(value):
        return "none"
    changed = change(report, row, name)
    return f"{value:.{digits}f}" + ("" if changed is None else f" ({in_percent(changed)})")


def change(report: EffectReport, row: MeasuredRow, name: str) -> float | None:
    """Relative change of a number of the rows, such as "transmission_error", against what the row is compared with;
    None without that."""
    reference = report.reference(row)
    before = 0.0 if reference is None else getattr(reference, name)
    changed = getattr(row, name) / before - 1.0 if before else nan
    return None if isnan(changed) else changed


def in_percent(changed: float) -> str:
    return "same" if abs(changed) < 5e-4 else f"{changed:+.1%}" if abs(changed) < 0.1 else f"{changed:+.0%}"


def remarks(report: EffectReport) -> list[str]:
    """Every remark once, in order; of those that differ in their numbers only, the first row's."""
    said: dict[str, list[str]] = {}
    for row in report.rows:
        for remark in row.remarks:
            said.setdefault(_words(remark), []).append(remark)
    return [same[0] if len(set(same)) == 1 else same[0] + NUMBERS_OF_ONE for same in said.values()]


def own_remarks(report: EffectReport, row: MeasuredRow) -> list[str]:
    full = report.row(ALL)
    said = {_words(remark) for remark in full.remarks} if full is not None else set()
    return [remark for remark in row.remarks if _words(remark) not in said]


def _words(remark: str) -> str:
    """A remark without its numbers, and without the note that they are one row's."""
    return re.sub(r"\d+(\.\d+)?(e[+-]?\d+)?", "#", remark.removesuffix(NUMBERS_OF_ONE))


def ratio_in_words(report: EffectReport) -> list[tuple[str, str, str]]:
    bare = report.row(BARE)
    full = report.row(ALL)
    if not report.ratios:
        return []
    low = min(report.ratios)
    high = max(report.ratios)
    return [
        ("unknowns", f"{bare.unknowns:.1f} and {full.unknowns:.1f}, ratio {full.unknowns / bare.unknowns:.2f}", ""),
        ("time a step", f"{bare.step_time * MICRO:.1f} and {full.step_time * MICRO:.1f}", "us"),
        (
            "ratio measured",
            f"{statistics.median(report.ratios):.2f}, {low:.2f} to {high:.2f} in {len(report.ratios)} rounds",
            "",
        ),
    ]


CSV_COLUMNS = (
    "effects", "sections", "centre_coordinates", "contact_rows", "closed_nodes_mean", "closed_nodes_max",
    "newton_iterations_per_step",
    "step_time_s", "step_time_least_s", "step_time_most_s", "operators_s", "condensing_s",
    "transmission_error_peak_to_peak_mm", "peak_force_N", "change_of_transmission_error", "change_of_peak_force",
    "compared_with",
    "remarks", "peak_contact_pressure_MPa", "face_load_factor", "processor", "load", "threads", "versions",
)  # fmt: skip


def write_csv(report: EffectReport, file: Path) -> None:
    """All numbers of a report, a line for each subset and each one that was skipped; changes are relative."""
    skipped = [{"effects": each.name, "remarks": f"skipped: {each.reason}"} for each in report.skipped]
    write_lines(file, [*(dict(zip(CSV_COLUMNS, _line(report, row))) for row in report.rows), *skipped], report.machine)


def _line(report: EffectReport, row: MeasuredRow) -> tuple:
    reference = report.reference(row)
    return (
        row.subset.name, " ".join(sorted(row.subset.sections)), row.coordinates, row.contact_rows, row.closed_nodes,
        row.most_closed_nodes,
        row.iterations, row.step_time, min(row.step_times), max(row.step_times), row.operators,
        row.condense,
        row.transmission_error, row.peak_force, change(report, row, "transmission_error"),
        change(report, row, "peak_force"),
        "" if reference is None else reference.subset.name, "; ".join(row.remarks), row.peak_pressure,
        row.face_load_factor,
    )  # fmt: skip
