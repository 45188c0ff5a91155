"""The summary that is printed when a run ends."""

from __future__ import annotations

import math
from collections.abc import Sequence

from fenics_gears.contact.step_solver import NEWTON, PUBLISHED
from fenics_gears.model.resolution import EVERY_STEP
from fenics_gears.results.key_numbers import HARMONIC_NAMES
from fenics_gears.results.numbers import ESTIMATED, RUNG
from fenics_gears.results.validity import FEWER_THAN_THE_PERIOD, NO_MEANING
from fenics_gears.system.progress import seconds_in_words

MICROMETRES = 1e3
KILO = 1e3
# Lengths (um) that are round-off of positions.
ROUND_OFF = 1e-6
Row = tuple[str, str, str]
# Where pressure stands apart from the peak contact pressure, as it does not converge there.
APART = {"edge": "edges", "kink": "kinks of relief"}

# The stages of a run whose wall time the result carries, and what they are called.
STAGES = {
    "time_choose": "choosing settings",
    "time_mesh": "meshing",
    "time_compile": "compiling",
    "time_condense": "condensing",
    "time_march": "marching through time",
}


def summary_rows(dataset, stages: Sequence[tuple[str, float]] = ()) -> list[Row]:
    """Rows of label, value, unit: results, solver, times, warnings; warnings that make the numbers wrong stand first.

    stages: names and seconds of the progress; those of the result where there are none.
    """
    said = dataset.attrs.get("warnings", "").splitlines()
    first = [warning for warning in said if NO_MEANING in warning or FEWER_THAN_THE_PERIOD in warning]
    rows = [*result_rows(dataset), *solver_rows(dataset), *(_said(stages) or stage_rows(dataset))]
    return [
        *(("WARNING", warning, "") for warning in first),
        *rows,
        *(("WARNING", warning, "") for warning in said if warning not in first),
    ]


def _said(stages: Sequence[tuple[str, float]]) -> list[Row]:
    """Wall time of the stages in the words of the progress."""
    return [(name, seconds_in_words(seconds), "") for name, seconds in stages]


def result_rows(dataset) -> list[Row]:
    """The results, the most important first; rows without a number in this run are left out."""
    attributes = dataset.attrs
    parts = (_transmission_error, _harmonics, _stiffness, _pair_force, _face, _shafts, _pressure, _root_stress)
    rows = [row for part in parts for row in part(attributes)]
    return rows + _power(attributes) + _sliding(dataset) + _contact_loss(dataset) + _estimated_error(attributes)


def _transmission_error(attributes) -> list[Row]:
    """As length along the line of action, which is that at the wheel's base circle, and as angle of the wheel."""
    rows = []
    for name, label in (
        ("peak_to_peak_transmission_error", "transmission error, peak to peak"),
        ("mean_transmission_error", "transmission error, mean"),
    ):
        angle = attributes.get(name, math.nan)
        length = angle * attributes["base_radius_wheel"] * MICROMETRES
        known = f"{length:.4g} um = {angle:.5g} rad" if abs(length) > ROUND_OFF else "0 um"
        rows.append((label, known if math.isfinite(angle) else "not determined", ""))
    return rows


def _harmonics(attributes) -> list[Row]:
    found = [attributes[name] for name in HARMONIC_NAMES if name in attributes]
    if max(found, default=0.0) < ROUND_OFF:
        return []
    return (
        [(f"harmonics of the mesh, 1 to {len(found)}", ", ".join(f"{each:.3g}" for each in found), "um")]
        if found
        else []
    )


def _stiffness(attributes) -> list[Row]:
    """The tangent, which small vibrations have; the secant counts gaps of relief and misalignment as deflection."""
    if "mean_mesh_stiffness_tangent" not in attributes:
        return []
    single = attributes.get("single_pair_stiffness")
    one = "" if single is None else f", at most {single:.4g} with one pair"
    secant = f"{attributes['mean_mesh_stiffness']:.4g}{one}"
    return [
        (
            "mesh stiffness, tangent",
            f"{attributes['mean_mesh_stiffness_tangent']:.4g} N/(mm um) on average; force over deflection {secant}",
            "",
        )
    ]


def _pair_force(attributes) -> list[Row]:
    if not attributes.get("largest_pair_force"):
        return []
    rows = [
        (
            "largest force of a tooth pair",
            f"{attributes['largest_pair_force']:.4g} N at mesh cycle {attributes['largest_pair_force_mesh_phase']:.4g}",
            "",
        )
    ]
    if "dynamic_factor_by_force" in attributes:
        stress = (
            f", {attributes['dynamic_factor_by_stress']:.3f} by root stress"
            if "dynamic_factor_by_stress" in attributes
            else ""
        )
        rows.append(
            (
                "dynamic factor",
                (
                    f"{attributes['dynamic_factor_by_force']:.3f} by force of a tooth pair{stress}, over that without"
                    " inertia"
                ),
                "",
            )
        )
    if "dynamic_factor_unknown" in attributes:
        rows.append(("dynamic factor", attributes["dynamic_factor_unknown"], ""))
    return rows


def _face(attributes) -> list[Row]:
    """Load factors and overlap of flanks that are resolved over the face."""
    if "overlap_ratio" not in attributes:
        return []
    rows = [
        (
            "contact ratio",
            f"{attributes['total_contact_ratio']:.4g} in all, overlap ratio {attributes['overlap_ratio']:.4g}",
            "",
        )
    ]
    if "face_load_factor" in attributes:
        rows.append(
            (
                "face load factor K_Hbeta",
                f"{attributes['face_load_factor']:.3f}, of the line load averaged over the mesh cycle",
                "",
            )
        )
    if "largest_line_load_factor" in attributes:
        edges = f", {attributes['edge_line_load_factor']:.3f} at edges" if "edge_line_load_factor" in attributes else ""
        rows.append(
            (
                "largest line load over even one",
                f"{attributes['largest_line_load_factor']:.3f} away from edges{edges}",
                "",
            )
        )
    if "transverse_load_factor" in attributes:
        rows.append(("transverse load factor K_Halpha", f"{attributes['transverse_load_factor']:.3f}", ""))
    return rows


def _shafts(attributes) -> list[Row]:
    """What shafts that bend do to the axes, and the largest force on a bearing."""
    if "largest_bearing_force" not in attributes:
        return []
    rows = [
        (
            f"{kind} of the axes, mean",
            f"{attributes[f'mean_axis_{kind}_in_plane']:.4g} um in the plane of action,"
            f" {attributes[f'mean_axis_{kind}_out_of_plane']:.4g} um out of it{over}",
            "",
        )
        for kind, over in (("inclination", ", over the common face"), ("offset", ""))
    ]
    return [*rows, ("largest force of a bearing", f"{attributes['largest_bearing_force']:.4g}", "N")]


def _pressure(attributes) -> list[Row]:
    if not attributes.get("peak_contact_pressure") or "peak_contact_pressure_diameter" not in attributes:
        return []
    place = (
        f"at mesh cycle {attributes['peak_contact_pressure_mesh_phase']:.4g}, pinion's diameter"
        f" {attributes['peak_contact_pressure_diameter']:.4g} mm"
    )
    flank = ", coast flank" if attributes["peak_contact_pressure_flank"] == "coast" else ""
    if end := attributes.get("peak_contact_pressure_beside"):
        flank += f", beside the {end} of its active profile, where lines of contact end"
    apart = [name for name in APART if f"peak_{name}_pressure" in attributes]
    label = "peak contact pressure" + (f", without {' and '.join(APART[name] for name in apart)}" if apart else "")
    rows = [(label, f"{attributes['peak_contact_pressure']:.4g} MPa {place}{flank}", "")]
    if "peak_kink_pressure" in attributes:
        rows.append(
            ("pressure at kinks of relief", f"{attributes['peak_kink_pressure']:.4g} MPa, more on a finer mesh", "")
        )
    return rows


def _power(attributes) -> list[Row]:
    rows = []
    if "input_power" in attributes:
        rows.append(("input power", f"{attributes['input_power'] / KILO:.4g} kW", ""))
    if "friction_loss" in attributes:
        watts = f"{attributes['friction_power']:.4g} W = " if "friction_power" in attributes else ""
        efficiency = (
            f"efficiency of the mesh {attributes['mesh_efficiency']:.3%}"
            if "mesh_efficiency" in attributes
            else "of wedged or locked teeth, which have no efficiency"
        )
        rows.append(
            ("friction loss", f"{watts}{attributes['friction_loss']:.3%} of the drive's work, {efficiency}", "")
        )
    return rows


def _sliding(dataset) -> list[Row]:
    """The fastest sliding, and specific sliding where it is largest in size, at the start of either gear's active
    profile."""
    if "specific_sliding" not in dataset:
        return []
    speed = (
        f"{float(abs(dataset['sliding_speed']).max()) / KILO:.4g} m/s at most; " if "sliding_speed" in dataset else ""
    )
    lowest = dataset["specific_sliding"].min("path_point").values
    return [("sliding", f"{speed}specific sliding {lowest[0]:.3g} pinion, {lowest[1]:.3g} wheel", "")]


def _contact_loss(dataset) -> list[Row]:
    """Of the drive flanks; nothing where they never touch, as where the wheel drives."""
    attributes = dataset.attrs
    count = attributes.get("contact_loss_count")
    if not count or not dataset["normal_force"].max() > 0.0:
        return []
    return [
        (
            "contact of the drive flanks lost" if "coast_normal_force" in dataset else "contact lost",
            (
                f"{count} time{'s' * (count > 1)}, {attributes['contact_loss_share']:.2%} of the time, by up to"
                f" {attributes['contact_loss_opening'] * MICROMETRES:.3g} um"
            ),
            "",
        )
    ]


def solver_rows(dataset) -> list[Row]:
    """How the steps were solved."""
    rows = []
    if dataset.sizes["time"]:
        iterations = dataset["newton_iterations"]
        rows.append(
            (
                "Newton iterations per step",
                f"{float(iterations.mean()):.2f} on average, {int(iterations.max())} at most",
                "",
            )
        )
    return rows + _rungs(dataset.attrs)


def stage_rows(dataset) -> list[Row]:
    """Wall time of each stage that the result carries."""
    return [(label, f"{dataset.attrs[name]:.2f}", "s") for name, label in STAGES.items() if name in dataset.attrs]


def _root_stress(attributes) -> list[Row]:
    """Largest root stress of either gear with its place, where the scene asks for it."""
    rows = []
    for gear in ("pinion", "wheel"):
        name = f"largest_root_stress_{gear}"
        if name in attributes:
            place = (
                f"at mesh cycle {attributes[f'{name}_mesh_phase']:.4g}, tooth of pair {attributes[f'{name}_pair']},"
                f" {attributes[f'{name}_fillet']} side"
            )
            rows.append((f"largest root stress, {gear}", f"{attributes[name]:.4g} MPa {place}", ""))
    return rows


def _estimated_error(attributes) -> list[Row]:
    """The target, the estimated error, the setting that limits it and the chosen settings; nothing without a target."""
    if "target" not in attributes:
        return []
    parts = {name.removeprefix(ESTIMATED): error for name, error in attributes.items() if name.startswith(ESTIMATED)}
    worst = max(parts, key=parts.__getitem__)
    settings = (
        f"{attributes['element']}, flank elements {attributes['flank_element_size']:.3g} mm,"
        f" {attributes['contact_nodes']} contact nodes over {attributes['contact_length']:.3g} mm,"
        f" {attributes['steps_per_mesh_cycle']} steps per mesh cycle"
    )
    judged = "T_E and T_EPP"
    if "slices" in attributes:
        judged, settings = (
            "T_E, T_EPP, line load",
            f"{settings}, {attributes['slices']} slices on {attributes['layers']} layers",
        )
    return [
        (f"estimated error of {judged}", f"{attributes['estimated_error']:.2%}, target {attributes['target']:.3%}", ""),
        ("what limits it", f"{worst}: {parts[worst]:.2%}", ""),
        ("settings chosen", settings, f"by {attributes['target_runs']} runs"),
        *(("remark", remark, "") for remark in attributes["target_remarks"].splitlines()),
    ]


def _rungs(attributes) -> list[Row]:
    """How many steps needed a fallback of their route's own method; nothing where none did."""
    own = PUBLISHED if attributes.get("condensation") == EVERY_STEP else NEWTON
    used = {name.removeprefix(RUNG): int(count) for name, count in attributes.items() if name.startswith(RUNG)}
    used.pop(own, None)
    if not used:
        return []
    return [("steps solved by fallbacks", ", ".join(f"{count} by {rung}" for rung, count in used.items()), "")]
