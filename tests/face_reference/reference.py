"""Rows of approach.csv and line_load.csv, and how they are found."""

import csv
from dataclasses import dataclass, replace
from itertools import groupby
from math import radians
from pathlib import Path

import numpy as np
from tests.face_reference.cases import FACE_WIDTH, Assembled, Sizes, assembled
from tests.face_reference.section_mesh import SectionSizes
from tests.face_reference.unilateral import pressed

APPROACH, LINE_LOAD = (Path(__file__).with_name(name) for name in ("approach.csv", "line_load.csv"))
FORCE = 1500.0
# What opens the flanks along n (mm) at heights z (mm).
OPENINGS = {
    "plain": np.zeros_like,
    "misaligned": lambda z: 0.010 * z / FACE_WIDTH,
    "crowned": lambda z: 0.010 * (2.0 * z / FACE_WIDTH) ** 2,
}
# Sizes that fit 2 GB; and with thinner layers, 4 GB.
SMALL = Sizes(SectionSizes(0.08, 0.12, 0.9, 1.6, 6.0, 0.6, 1), (0.15, 0.3, 0.5, 0.8, 1.0, 1.0), 0.05, 0.3)
THIN_LAYERS = replace(SMALL, layers=(0.15, 0.25, 0.35, 0.45, 0.5, 0.5, 0.5, 0.525, 0.525))
# Thin where a tip edge of the helical pair crosses the face: 1.4 to 3 mm from its middle at phases 0.6 and 0.85, in the
# middle at 0.97.
THIN_ASIDE = replace(SMALL, layers=(0.3, 0.45, 0.4, 0.4, 0.4, 0.4, 0.6, 0.8))
THIN_MIDDLE = replace(SMALL, layers=(0.3, 0.75, 1.0, 0.7, 0.4, 0.3, 0.3))


@dataclass(frozen=True)
class Row:
    """Line load (N/mm, along n) of a tooth pair at height `z` (mm); `approach` (mm, along the transverse line of
    action)."""

    helix_angle: float
    phase: float
    opening: str
    approach: float
    pair: int
    z: float
    line_load: float


def rows(found: Assembled, helix_angle: float, opening: str) -> list[Row]:
    areas, heights = np.concatenate([each.areas for each in found.points]), found.points[0].z
    z = np.concatenate([each.z[each.level] for each in found.points])
    gaps = np.concatenate([each.gaps for each in found.points]) + OPENINGS[opening](z) * areas
    pressure, approach = pressed(found.matrix, gaps, areas, FORCE)
    share, result, first = np.zeros(len(heights)), [], 0
    share[:-1] += 0.5 * np.diff(heights)
    share[1:] += 0.5 * np.diff(heights)
    for each in found.points:
        part = slice(first, first + len(each.chosen))
        load = np.bincount(each.level, (pressure * areas)[part], minlength=len(heights)) / share
        head = (helix_angle, found.position.phase, opening, approach / found.position.cosine, each.index)
        result += [Row(*head, float(height), float(value)) for height, value in zip(heights, load)]
        first = part.stop
    return result


def computed(helix_angle: float, phase: float, sizes: Sizes = SMALL) -> list[Row]:
    found = assembled(radians(helix_angle), phase, sizes)
    return [row for opening in OPENINGS for row in rows(found, helix_angle, opening)]


def reference() -> list[Row]:
    approach, line_load = (list(csv.DictReader(file.open())) for file in (APPROACH, LINE_LOAD))
    approaches = {(line["helix_angle"], line["phase"]): line for line in approach}
    result = []
    for key, lines in groupby(line_load, key=lambda line: (line["helix_angle"], line["phase"])):
        here = list(lines)
        for opening in OPENINGS:
            head = (*map(float, key), opening, float(approaches[key][opening]))
            result += [Row(*head, int(line["pair"]), float(line["z"]), float(line[opening])) for line in here]
    return result


def over_slices(found: list[Row], positions: np.ndarray, widths: np.ndarray) -> np.ndarray:
    """N/mm (S,) of all tooth pairs, averaged over slices of `widths` at `positions` (S,), mm."""
    z = np.array(sorted({row.z for row in found}))
    load = np.array([sum(row.line_load for row in found if row.z == each) for each in z])
    parts = (np.arange(100) + 0.5) / 100.0 - 0.5
    return np.interp(positions[:, None] + widths[:, None] * parts, z, load).mean(axis=1)


def write(found: list[Row]) -> None:
    """A column for each opening, numbers to five digits: meshes differ in the fourth."""
    of = {opening: [row for row in found if row.opening == opening] for opening in OPENINGS}
    with APPROACH.open("w", newline="") as approach, LINE_LOAD.open("w", newline="") as line_load:
        writers = [csv.writer(lines, lineterminator="\n") for lines in (approach, line_load)]
        for writer, names in zip(writers, (("helix_angle", "phase"), ("helix_angle", "phase", "pair", "z"))):
            writer.writerow([*names, *OPENINGS])
        last = None
        for rows in zip(*of.values()):
            case = (rows[0].helix_angle, rows[0].phase)
            if case != last:
                writers[0].writerow(f"{value:.5g}" for value in (*case, *(row.approach for row in rows)))
            last, values = case, (*case, rows[0].pair, round(rows[0].z, 9), *(row.line_load for row in rows))
            writers[1].writerow(f"{value:.5g}" for value in values)
