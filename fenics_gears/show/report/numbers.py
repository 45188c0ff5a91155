"""The numbers of the run in tables: key numbers, and the points of the path of contact."""

from __future__ import annotations

import math

from fenics_gears.results.attributes import RESULT_ATTRIBUTES
from fenics_gears.results.key_numbers import STUDIED
from fenics_gears.show.report.page import Beside, Facts, Section, Table, Words
from fenics_gears.show.run import Run


def numbers(run: Run) -> Section:
    """Two tables side by side; the second is there where the result has the path of contact."""
    attributes = run.dataset.attrs
    names = {*STUDIED, "quasi_static_pair_normal_force", "quasi_static_root_stress", "dynamic_factor_unknown"} & attributes.keys()
    rows = [(each.meaning, attributes[each.name], each.units.removeprefix("1")) for each in RESULT_ATTRIBUTES if each.name in names]
    blocks = [Facts(rows, "Of the settled mesh cycles")] if rows else []
    if "specific_sliding" in run.dataset:
        blocks.append(_contact_points(run))
    return Section("numbers", "Numbers", [Beside(blocks)] if blocks else [Words("The run has none.")])


def _contact_points(run: Run) -> Table:
    dataset = run.dataset
    headings = ("Point", "Pinion, mm", "Wheel, mm", "Sliding speed, m/s", "Specific sliding, pinion", "Specific sliding, wheel", "Load share")
    words = dict(zip("ABCDE", ("start of contact", "LPSTC", "pitch point", "HPSTC", "end of contact")))
    rows = []
    for point in dataset["path_point"].values.tolist():
        at = dataset.sel(path_point=point)
        values = [
            *(f"{each:.2f}" for each in at["path_point_diameter"].values),
            f"{round(1e-3 * float(at['sliding_speed']), 9) + 0.0:.3f}" if "sliding_speed" in dataset else "",
            *(f"{round(each, 9) + 0.0:.3f}" for each in at["specific_sliding"].values),
            "" if math.isnan(share := float(at["load_share"])) else f"{share:.3f}",
        ]
        rows.append((f"{point}, {words[point]}", *values))
    return Table(headings, rows, "Points of the path of contact (LPSTC and HPSTC of the pinion)")
