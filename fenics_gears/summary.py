"""The few numbers of a run that are printed when it ends."""

from __future__ import annotations

import math
from collections.abc import Sequence

from fenics_gears.contact.ladder import LADDER, PUBLISHED
from fenics_gears.progress import seconds_in_words
from fenics_gears.resolution import EVERY_STEP
from fenics_gears.results.attributes import ESTIMATED, RUNG
from fenics_gears.results.settled import of_settled
from fenics_gears.validity import FEWER_THAN_THE_PERIOD, NO_MEANING

MICROMETRES = 1e3

# The stages of a run whose wall time the result carries, and what they are called.
STAGES = {
    "time_choose": "choosing settings",
    "time_mesh": "meshing",
    "time_compile": "compiling",
    "time_condense": "condensing",
    "time_march": "marching through time",
}


def summary_rows(dataset, stages: Sequence[tuple[str, float]] = ()) -> list[tuple[str, str, str]]:
    """Rows of label, value, unit: what came out, how the steps were solved, times, warnings; first of all those without which no number is right.

    stages: names and seconds as the progress has said them; those of the result where there are none.
    """
    said = dataset.attrs.get("warnings", "").splitlines()
    first = [warning for warning in said if NO_MEANING in warning or FEWER_THAN_THE_PERIOD in warning]
    rows = [*result_rows(dataset), *solver_rows(dataset), *(_said(stages) or stage_rows(dataset))]
    return [*(("WARNING", warning, "") for warning in first), *rows, *(("WARNING", warning, "") for warning in said if warning not in first)]


def _said(stages: Sequence[tuple[str, float]]) -> list[tuple[str, str, str]]:
    """Wall time of the stages in the words of the progress."""
    return [(name, seconds_in_words(seconds), "") for name, seconds in stages]


def result_rows(dataset) -> list[tuple[str, str, str]]:
    """What came out: transmission error as angle and length at the wheel's base circle, friction's share, root stress."""
    rows = []
    for name, label in (("mean_transmission_error", "transmission error, mean"), ("peak_to_peak_transmission_error", "transmission error, peak to peak")):
        angle = dataset.attrs.get(name, math.nan)
        if math.isfinite(angle):
            rows.append((label, f"{angle:.5g} rad = {angle * dataset.attrs['base_radius_wheel'] * MICROMETRES:.4g} um", ""))
        else:
            rows.append((label, "not determined", ""))
    if "friction_loss" in dataset.attrs:
        rows.append(("friction takes", f"{dataset.attrs['friction_loss']:.3%} of the work of the drive", ""))
    return rows + _root_stress(dataset) + _estimated_error(dataset.attrs)


def solver_rows(dataset) -> list[tuple[str, str, str]]:
    """How the steps were solved."""
    rows = []
    if dataset.sizes["time"]:
        iterations = dataset["newton_iterations"]
        rows.append(("Newton iterations a step", f"{float(iterations.mean()):.2f} on average, {int(iterations.max())} at most", ""))
    return rows + _rungs(dataset.attrs)


def stage_rows(dataset) -> list[tuple[str, str, str]]:
    """Wall time of each stage that the result carries."""
    return [(label, f"{dataset.attrs[name]:.2f}", "s") for name, label in STAGES.items() if name in dataset.attrs]


def _root_stress(dataset) -> list[tuple[str, str, str]]:
    """Largest root stress of either gear and the dynamic factors, where the scene asks for them."""
    if "root_stress_maximum" not in dataset or not dataset.sizes["time"]:
        return []
    largest = of_settled(dataset)["root_stress_maximum"].max(["time", "slot"]).values
    rows = [("largest root stress", f"{largest[0]:.4g} pinion, {largest[1]:.4g} wheel", "MPa")]
    if "dynamic_factor_by_stress" in dataset.attrs:
        factors = [dataset.attrs[f"dynamic_factor_by_{kind}"] for kind in ("force", "stress")]
        rows.append(("dynamic factor", f"{factors[0]:.3f} by force, {factors[1]:.3f} by root stress", ""))
    if "dynamic_factor_unknown" in dataset.attrs:
        rows.append(("dynamic factor", dataset.attrs["dynamic_factor_unknown"], ""))
    return rows


def _estimated_error(attributes) -> list[tuple[str, str, str]]:
    """What a target asked for and what is estimated, with the settings and which of them limits it; nothing without a target."""
    if "target" not in attributes:
        return []
    parts = {name.removeprefix(ESTIMATED): error for name, error in attributes.items() if name.startswith(ESTIMATED)}
    worst = max(parts, key=parts.__getitem__)
    settings = (
        f"{attributes['element']}, flank elements {attributes['flank_element_size']:.3g} mm, {attributes['contact_nodes']} contact nodes over "
        f"{attributes['contact_length']:.3g} mm, {attributes['steps_per_mesh_cycle']} steps per mesh cycle"
    )
    return [
        ("estimated error of T_E and T_EPP", f"{attributes['estimated_error']:.2%}, target {attributes['target']:.3%}", ""),
        ("what limits it", f"{worst}: {parts[worst]:.2%}", ""),
        ("settings chosen", settings, f"by {attributes['target_runs']} runs"),
        *(("remark", remark, "") for remark in attributes["target_remarks"].splitlines()),
    ]


def _rungs(attributes) -> list[tuple[str, str, str]]:
    """How often a step needed a rung of the fallback ladder beyond its route's own method; nothing where none did."""
    own = PUBLISHED if attributes.get("condensation") == EVERY_STEP else LADDER[0]
    used = {name.removeprefix(RUNG): int(count) for name, count in attributes.items() if name.startswith(RUNG)}
    used.pop(own, None)
    if not used:
        return []
    return [("steps solved by the fallback ladder", ", ".join(f"{count} by {rung}" for rung, count in used.items()), "")]
