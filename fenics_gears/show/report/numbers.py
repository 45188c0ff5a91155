"""The numbers of the run in tables: those that no tile and no spectrum has, and the points of the path of contact."""

from __future__ import annotations

import math

from fenics_gears.show.report.page import Beside, Facts, Section, Table, Words
from fenics_gears.show.run import Run
from fenics_gears.show.units import digits

NUMBERS = {
    "rms_transmission_error": ("transmission error without its mean, r.m.s.", "µm"),
    "rms_normal_force": ("mesh force without its mean, r.m.s.", "N"),
    "mean_mesh_stiffness_tangent": ("mesh stiffness for small vibrations (tangent), mean", "N/(mm µm)"),
    "single_pair_stiffness": ("stiffness of a single tooth pair c', largest", "N/(mm µm)"),
    "largest_pair_force": ("largest force of a tooth pair", "N"),
    "quasi_static_pair_normal_force": ("largest force of a tooth pair without inertia", "N"),
    "peak_edge_pressure": ("largest pressure at a tip edge, which does not converge with the mesh", "MPa"),
    "quasi_static_root_stress": ("largest root stress without inertia", "MPa"),
    "transverse_load_factor": (
        "transverse load factor: largest share of a tooth pair in the mesh force over that of an even line load",
        "",
    ),
}


def numbers(run: Run) -> Section:
    """Two tables side by side; the second is there where the result has the path of contact."""
    attributes = run.dataset.attrs
    rows = [
        (words, digits(attributes[name]), unit)
        for name, (words, unit) in NUMBERS.items()
        if name in attributes and not _round_off(name, attributes)
    ]
    rows += (
        [("dynamic factor", attributes["dynamic_factor_unknown"], "")] if "dynamic_factor_unknown" in attributes else []
    )
    blocks = [Facts(rows, "Of the settled mesh cycles")] if rows else []
    if "specific_sliding" in run.dataset:
        blocks.append(_contact_points(run))
    return Section("numbers", "Numbers", [Beside(blocks)] if blocks else [Words("The run has none.")])


def _round_off(name: str, attributes) -> bool:
    """Whether a force that varies by nothing is all that a number says."""
    return name == "rms_normal_force" and attributes[name] < 1e-9 * attributes.get("largest_pair_force", 0.0)


def _contact_points(run: Run) -> Table:
    dataset, timed = run.dataset, "sliding_speed" in run.dataset
    headings = (
        "Point",
        "Pinion (mm)",
        "Wheel (mm)",
        *(("Sliding speed (m/s)",) if timed else ()),
        "Specific sliding, pinion",
        "Specific sliding, wheel",
        "Share in the mesh force",
    )
    words = dict(zip("ABCDE", ("start of contact", "LPSTC", "pitch point", "HPSTC", "end of contact")))
    rows = []
    for point in dataset["path_point"].values.tolist():
        at = dataset.sel(path_point=point)
        values = [
            *(f"{each:.2f}" for each in at["path_point_diameter"].values),
            *((f"{round(1e-3 * float(at['sliding_speed']), 9) + 0.0:.3f}",) if timed else ()),
            *(f"{round(each, 9) + 0.0:.3f}" for each in at["specific_sliding"].values),
            "" if math.isnan(share := float(at["load_share"])) else f"{share:.3f}",
        ]
        rows.append((f"{point}, {words[point]}", *values))
    return Table(headings, rows, "Points of the path of contact (LPSTC and HPSTC of the pinion)")
