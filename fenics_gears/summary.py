"""The few numbers of a run that are printed when it ends."""

from __future__ import annotations

import math

MICROMETRES = 1e3

# The stages of a run whose wall time the result carries, and what they are called.
STAGES = {
    "time_mesh": "meshing",
    "time_compile": "compiling",
    "time_condense": "condensing",
    "time_march": "marching through time",
}


def summary_rows(dataset) -> list[tuple[str, str, str]]:
    """Rows of label, value, unit: transmission error as angle and length at the wheel's base circle, times, Newton iterations."""
    rows = []
    for name, label in (("mean_transmission_error", "transmission error, mean"), ("peak_to_peak_transmission_error", "transmission error, peak to peak")):
        angle = dataset.attrs.get(name, math.nan)
        if math.isfinite(angle):
            rows.append((label, f"{angle:.5g} rad = {angle * dataset.attrs['base_radius_wheel'] * MICROMETRES:.4g} um", ""))
        else:
            rows.append((label, "not determined", ""))
    if dataset.sizes["time"]:
        iterations = dataset["newton_iterations"]
        rows.append(("Newton iterations a step", f"{float(iterations.mean()):.2f} on average, {int(iterations.max())} at most", ""))
    rows += [(label, f"{dataset.attrs[name]:.2f}", "s") for name, label in STAGES.items() if name in dataset.attrs]
    rows += [("WARNING", warning, "") for warning in dataset.attrs.get("warnings", "").splitlines()]
    return rows
