"""The numbers of the run in tables, and the points of the path of contact."""

import math

from fenics_gears.many_runs import result_rows
from fenics_gears.pages import Beside, Facts, PageSection, Table, Words
from fenics_gears.shown import ShownRun, contact_by_fewest, digits

# What the summary that `gears run` prints leaves out.
MORE = {
    "rms_transmission_error": ("transmission error without its mean, r.m.s.", "µm"),
    "rms_normal_force": ("mesh force without its mean, r.m.s.", "N"),
    "quasi_static_pair_normal_force": ("largest force of a tooth pair without inertia", "N"),
    "peak_edge_pressure": ("largest pressure at a tip edge, which does not converge with the mesh", "MPa"),
    "quasi_static_root_stress": ("largest root stress without inertia", "MPa"),
}


def numbers(run: ShownRun) -> PageSection:
    """The summary that `gears run` prints, and more; next to it the path of contact where the result has it."""
    attributes = run.dataset.attrs
    rows = result_rows(run.dataset) if run.steps else []
    rows += [
        (words, digits(attributes[name]), unit)
        for name, (words, unit) in MORE.items()
        if name in attributes and not _round_off(name, attributes)
    ]
    blocks = [Facts(rows, "Of the settled mesh cycles")] if rows else []
    if "specific_sliding" in run.dataset:
        blocks.append(_contact_points(run))
    return PageSection("numbers", "Numbers", [Beside(blocks)] if blocks else [Words("The run has none.")])


def _round_off(name: str, attributes) -> bool:
    return name == "rms_normal_force" and attributes[name] < 1e-9 * attributes.get("largest_pair_force", 0.0)


def _contact_points(run: ShownRun) -> Table:
    dataset = run.dataset
    timed = "sliding_speed" in run.dataset
    speed = ("Sliding speed (m/s)",) if timed else ()
    sliding = "Specific sliding, pinion", "Specific sliding, wheel"
    headings = ("Point", "Pinion (mm)", "Wheel (mm)", *speed, *sliding, "Share in the mesh force")
    contact, letters = ("single tooth contact", "STC") if run.pair is None else contact_by_fewest(run.pair)
    lowest = f"LP{letters}"
    highest = f"HP{letters}"
    words = dict(zip("ABCDE", ("start of contact", lowest, "pitch point", highest, "end of contact")))
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
    which = f"{lowest} and {highest}: lowest and highest point of {contact}, of the pinion"
    return Table(headings, rows, f"Points of the path of contact ({which})")
