"""Approach and line loads over the face, free ends among them, against the resolved model of tests/face_reference: in
many slices, and by the program's default sizes."""

from itertools import groupby
from math import radians

import numpy as np
from tests.benchmarks.third_dimension.pairs import scene_of, standard_pair
from tests.benchmarks.third_dimension.table import Row, read_rows, table, write_rows
from tests.face_reference.by_slices import answer
from tests.face_reference.cases import FACE_WIDTH, TEETH
from tests.face_reference.reference import FORCE, OPENINGS, over_slices, reference

from fenics_gears import model_of
from fenics_gears.elasticity.cache import user_cache
from fenics_gears.model.face_resolution import FEWEST_WITH_FINER_ENDS
from fenics_gears.scene.accuracy import SECTION_SIZE
from fenics_gears.scene.data import Accuracy

NAME, SLICES, LAYERS = "resolved", 16, 8
# Of the file: whether a row is by default sizes.
BY_DEFAULTS = "by_defaults"


def default_sizes(helix_angle: float) -> dict:
    """Those of `answer` which a scene of the pair has."""
    gears = standard_pair(FACE_WIDTH, radians(helix_angle), teeth=TEETH)
    model = model_of(scene_of(gears, Accuracy(), FORCE / FACE_WIDTH))
    slices, layers = model.slices_and_layers
    return {
        "section_size": SECTION_SIZE * gears.module, "layers": layers, "slices": slices,
        "cut_ends": bool(helix_angle) and slices >= FEWEST_WITH_FINER_ENDS,
        "flank": model.resolution.flank_element_size, "spacing": model.resolution.contact_grid.spacing,
    }  # fmt: skip


def measure() -> list[Row]:
    rows: list[Row] = []
    for (helix, phase, opening), found in groupby(
        reference(), key=lambda row: (row.helix_angle, row.phase, row.opening)
    ):
        resolved = list(found)
        for sizes in ({"layers": LAYERS, "slices": SLICES}, default_sizes(helix)):
            own = answer(helix, phase, opening, FORCE, user_cache(), **sizes)
            load, exact = sum(own.line_loads.values()), over_slices(resolved, own.positions, own.widths)
            rows += [
                {
                    "helix_angle": helix, "phase": phase, "opening": list(OPENINGS).index(opening),
                    BY_DEFAULTS: len(sizes) > 2, "slice": k, "position": position,
                    "line_load": load[k], "reference": exact[k],
                    "approach": own.approach, "reference_approach": resolved[0].approach,
                }
                for k, position in enumerate(own.positions)
            ]  # fmt: skip
    write_rows(NAME, rows)
    return rows


def fine_rows() -> list[Row]:
    """Those in many slices."""
    return [row for row in read_rows(NAME) if not row[BY_DEFAULTS]]


def _off(slices: list[Row]) -> list[str]:
    """Approach off, and line loads off at most, away from the outer eighths of the face and everywhere, in per cent."""
    load, exact, position = (np.array([row[name] for row in slices]) for name in ("line_load", "reference", "position"))
    off = 100.0 * np.abs(load - exact) / exact.max()
    away = np.abs(position) < 0.375 * FACE_WIDTH
    approach = 100.0 * (slices[0]["approach"] / slices[0]["reference_approach"] - 1.0)
    return [f"{approach:+.2f}", f"{off[away].max():.1f}", f"{off.max():.1f}"]


def section() -> str:
    lines = []
    for (helix, phase, opening), found in groupby(
        read_rows(NAME), key=lambda row: (row["helix_angle"], row["phase"], row["opening"])
    ):
        both = list(found)
        fine, own = ([row for row in both if row[BY_DEFAULTS] == which] for which in (0, 1))
        lines.append([
            f"{helix:g}", f"{phase:g}", list(OPENINGS)[int(opening)], f"{1e3 * fine[0]['approach']:.3f}",
            f"{1e3 * fine[0]['reference_approach']:.3f}",
            f"{max(row['line_load'] for row in fine):.0f}", f"{max(row['reference'] for row in fine):.0f}",
            *_off(fine), *_off(own),
        ])  # fmt: skip
    headings = [
        "β, deg", "phase", "flanks", "approach, µm", "resolved", "largest line load, N/mm", "resolved",
        "approach off, %", "line load off at most, % of the largest", "at the ends too",
        "by defaults: approach off, %", "line load off at most, %", "at the ends too",
    ]  # fmt: skip
    return "\n".join(table(headings, lines))
