"""The numbers of the run in tables: key numbers, and the points of the path of contact."""

from __future__ import annotations

import math

from fenics_gears.results.key_numbers import HARMONIC_NAMES
from fenics_gears.show.report.page import Beside, Facts, Section, Table, Words
from fenics_gears.show.run import Run

# Attributes with their words, unit and what they are multiplied by.
ROWS = (
    ("mean_mesh_stiffness", "mesh stiffness c_γ, mean, force over deflection", "N/(mm µm)", 1.0),
    ("mean_mesh_stiffness_tangent", "mesh stiffness, mean, tangent", "N/(mm µm)", 1.0),
    ("single_pair_stiffness", "stiffness c' of one tooth pair, largest", "N/(mm µm)", 1.0),
    ("largest_pair_force", "largest force of a tooth pair", "N", 1.0),
    ("quasi_static_pair_normal_force", "the same without inertia", "N", 1.0),
    ("dynamic_factor_by_force", "dynamic factor by force", "", 1.0),
    ("dynamic_factor_by_stress", "dynamic factor by root stress", "", 1.0),
    ("peak_contact_pressure", "peak contact pressure, averaged over five contact nodes, off the flanks' edges", "MPa", 1.0),
    ("peak_contact_pressure_diameter", "on the pinion at the diameter", "mm", 1.0),
    ("peak_contact_pressure_mesh_phase", "at mesh cycle", "", 1.0),
    ("peak_edge_pressure", "peak at a tip's edge, which does not converge with the mesh", "MPa", 1.0),
    ("largest_root_stress_pinion", "largest root stress of the pinion", "MPa", 1.0),
    ("largest_root_stress_wheel", "largest root stress of the wheel", "MPa", 1.0),
    ("input_power", "input power, mean", "kW", 1e-3),
    ("friction_power", "lost to friction between the flanks, mean", "W", 1.0),
    ("mesh_efficiency", "efficiency of the mesh", "%", 100.0),
)


def numbers(run: Run) -> Section:
    """Two tables side by side; the second is there where the result has the path of contact."""
    attributes = run.dataset.attrs
    waves = ", ".join(f"{attributes[name]:.4g}" for name in HARMONIC_NAMES if name in attributes)
    rows = [("harmonics 1 to 5 of the mesh frequency in the transmission error, amplitudes", waves, "µm")] if waves else []
    rows += [(words, f"{attributes[name] * scale:.5g}", unit) for name, words, unit, scale in ROWS if name in attributes]
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
