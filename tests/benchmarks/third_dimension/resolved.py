"""Approach and line loads over the face, free ends among them, against the resolved model of tests/face_reference."""

from itertools import groupby

import numpy as np
from tests.benchmarks.third_dimension.table import Row, read_rows, table, write_rows
from tests.face_reference.by_slices import answer
from tests.face_reference.reference import FORCE, OPENINGS, over_slices, reference

from fenics_gears.elasticity.cache import user_cache

NAME, SLICES, LAYERS = "resolved", 16, 8


def measure() -> list[Row]:
    rows: list[Row] = []
    for (helix, phase, opening), found in groupby(
        reference(), key=lambda row: (row.helix_angle, row.phase, row.opening)
    ):
        resolved = list(found)
        own = answer(helix, phase, opening, FORCE, user_cache(), layers=LAYERS, slices=SLICES)
        load, exact = sum(own.line_loads.values()), over_slices(resolved, own.positions)
        rows += [
            {
                "helix_angle": helix, "phase": phase, "opening": list(OPENINGS).index(opening), "slice": k,
                "line_load": load[k], "reference": exact[k],
                "approach": own.approach, "reference_approach": resolved[0].approach,
            }
            for k in range(SLICES)
        ]  # fmt: skip
    write_rows(NAME, rows)
    return rows


def section() -> str:
    lines = []
    for (helix, phase, opening), found in groupby(
        read_rows(NAME), key=lambda row: (row["helix_angle"], row["phase"], row["opening"])
    ):
        own = list(found)
        load, exact = (np.array([row[name] for row in own]) for name in ("line_load", "reference"))
        approach, resolved = own[0]["approach"], own[0]["reference_approach"]
        away = slice(SLICES // 8, -SLICES // 8)
        lines.append([
            f"{helix:g}", f"{phase:g}", list(OPENINGS)[int(opening)], f"{1e3 * approach:.3f}", f"{1e3 * resolved:.3f}",
            f"{100 * (approach / resolved - 1):+.2f}",
            f"{load.max():.0f}", f"{exact.max():.0f}", f"{100 * np.abs(load - exact)[away].max() / exact.max():.1f}",
            f"{100 * np.abs(load - exact).max() / exact.max():.1f}",
        ])  # fmt: skip
    headings = [
        "β, deg", "phase", "flanks", "approach, µm", "resolved", "off, %", "largest line load, N/mm", "resolved",
        "off at most, % of the largest", "at the ends",
    ]  # fmt: skip
    return "\n".join(table(headings, lines))
