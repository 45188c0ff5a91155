"""The summary that is printed when a run ends."""

import math
from collections.abc import Iterator, Sequence

from fenics_gears.contact.step_solver import NEWTON
from fenics_gears.inputs.tree import GEARS
from fenics_gears.system.progress import seconds_in_words

from .key_numbers import HARMONIC_NAMES
from .numbers import ESTIMATED, RUNG
from .validity import FEWER_THAN_THE_PERIOD, NO_MEANING

MICROMETRES = 1e3
KILO = 1e3
# So many natural frequencies are printed.
LOWEST = 6
# Share of the mesh's deflection from which the twist of the bodies on their bores is told.
NOTABLE_TWIST = 0.25
# Lengths (um) that are round-off of positions.
ROUND_OFF = 1e-6
Row = tuple[str, str, str]
# A row whose words have their units.
Said = Iterator[tuple[str, str]]
# Where pressure is told apart from the peak contact pressure, as it does not converge there.
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
    """Rows of label, value, unit: results, solver, times, warnings. Warnings that make the numbers wrong are first.
    `stages`: names and seconds, in place of the times of the result."""
    said = dataset.attrs.get("warnings", "").splitlines()
    first = [warning for warning in said if NO_MEANING in warning or FEWER_THAN_THE_PERIOD in warning]
    spent = [(name, seconds_in_words(seconds), "") for name, seconds in stages] or stage_rows(dataset)
    return [
        *(("WARNING", warning, "") for warning in first),
        *result_rows(dataset),
        *solver_rows(dataset),
        *spent,
        *(("WARNING", warning, "") for warning in said if warning not in first),
    ]


def four_digits(value: float) -> str:
    """A number as it is printed: never with a power of ten below a million."""
    return f"{value:.0f}" if 1e4 <= abs(value) < 1e6 else f"{value:.4g}"


def what_is_there(dataset, steps: int, cycles: int) -> str:
    """How much of a run of so many steps and mesh cycles a result has that ended before it."""
    last = dataset.isel(time=-1)
    return (
        f"{dataset.sizes['time'] - 1} of its {steps} steps are there, up to {float(last['time']):.4g} s (mesh cycle"
        f" {float(last['mesh_phase']):.2f} of {cycles}), and all numbers are of these"
    )


def result_rows(dataset) -> list[Row]:
    """The results, the most important first; rows without a number in this run are left out."""
    of_numbers = (
        _transmission_error, _harmonics, _stiffness, _pair_force, _face, _shafts, _proposed, _pressure, _root_stress,
        _power,
    )  # fmt: skip
    said = [line for part in of_numbers for line in part(dataset.attrs)]
    said += [*_sliding(dataset), *_contact_loss(dataset), *_estimated_error(dataset.attrs)]
    return [(label, words, "") for label, words in said]


def _transmission_error(numbers) -> Said:
    """As length at the wheel's base circle and as angle of the wheel."""
    for name, label in (("peak_to_peak", "peak to peak"), ("mean", "mean")):
        angle = numbers.get(f"{name}_transmission_error", math.nan)
        length = angle * numbers["base_radius_wheel"] * MICROMETRES
        known = f"{length:.4g} um = {angle:.5g} rad" if abs(length) > ROUND_OFF else "0 um"
        yield f"transmission error, {label}", known if math.isfinite(angle) else "not determined"


def _harmonics(numbers) -> Said:
    amplitudes = [numbers[name] for name in HARMONIC_NAMES if name in numbers]
    if max(amplitudes, default=0.0) >= ROUND_OFF:
        yield f"harmonics of the mesh, 1 to {len(amplitudes)}", f"{', '.join(f'{each:.3g}' for each in amplitudes)} um"


def _stiffness(numbers) -> Said:
    """The tangent, which small vibrations have; the secant counts gaps of relief and misalignment as deflection."""
    if "mean_mesh_stiffness_tangent" in numbers:
        yield "mesh stiffness, mean tangent", f"{numbers['mean_mesh_stiffness_tangent']:.4g} N/(mm um)"
        yield "mesh stiffness, mean secant", _secant(numbers)
        yield from _bore_twist(numbers)


def _secant(numbers) -> str:
    if "mean_mesh_stiffness" not in numbers:
        return "none: wedges and friction press flanks that do not approach"
    single = numbers.get("single_pair_stiffness")
    one = "" if single is None else f"; {single:.4g} at most while one tooth pair carries"
    return f"{numbers['mean_mesh_stiffness']:.4g} N/(mm um), force over deflection{one}"


def _bore_twist(numbers) -> Said:
    """Where much of the deflection is no tooth's: ISO 6336-1 and most measurements are without it."""
    twist = numbers.get("bore_twist_stiffness", math.inf)
    share = numbers["mean_mesh_stiffness_tangent"] / twist
    if share >= NOTABLE_TWIST:
        without = f"about {share:.0%} of the deflection, {twist:.3g} N/(mm um)"
        yield "twist of the bodies on their bores", f"{without}; c_gamma of ISO 6336-1 is without it"


def _pair_force(numbers) -> Said:
    if not numbers.get("largest_pair_force"):
        return
    place = f"at mesh cycle {numbers['largest_pair_force_mesh_phase']:.4g}"
    yield "largest force of a tooth pair", f"{four_digits(numbers['largest_pair_force'])} N {place}"
    if "dynamic_factor_by_force" in numbers:
        by = "dynamic_factor_by_stress"
        stress = f", {numbers[by]:.3f} by root stress" if by in numbers else ""
        factor = f"{numbers['dynamic_factor_by_force']:.3f} by force of a tooth pair{stress}"
        yield "dynamic factor", f"{factor}, over that without inertia"
    if "dynamic_factor_unknown" in numbers:
        yield "dynamic factor", numbers["dynamic_factor_unknown"]


def _face(numbers) -> Said:
    if "overlap_ratio" in numbers:
        overlap = f"overlap ratio {numbers['overlap_ratio']:.4g}"
        yield "contact ratio", f"{numbers['total_contact_ratio']:.4g} in all, {overlap}"
    if "face_load_factor" in numbers:
        of = "of the line load averaged over the mesh cycle"
        yield "face load factor K_Hbeta", f"{numbers['face_load_factor']:.3f}, {of}"
    if "largest_line_load_factor" in numbers:
        edges = f", {numbers['edge_line_load_factor']:.3f} at edges" if "edge_line_load_factor" in numbers else ""
        largest = f"{numbers['largest_line_load_factor']:.3f} away from edges{edges}"
        yield "largest line load / even line load", largest
    if "transverse_load_factor" in numbers:
        yield "transverse load factor K_Halpha", f"{numbers['transverse_load_factor']:.3f}"


def _shafts(numbers) -> Said:
    if "largest_bearing_force" in numbers:
        for kind, over in (("inclination", ", over the common face"), ("offset", "")):
            planes = (numbers[f"mean_axis_{kind}_{plane}"] for plane in ("in_plane", "out_of_plane"))
            inside, outside = (round(each, 6) + 0.0 for each in planes)
            words = f"{inside:.4g} um in the plane of action, {outside:.4g} um out of it{over}"
            yield f"{kind} of the axes, mean", words
        balls = numbers.get("largest_rolling_element_force")
        rolling = "" if balls is None else f", of a rolling element {four_digits(balls)} N"
        yield "largest force of a bearing", f"{four_digits(numbers['largest_bearing_force'])} N{rolling}"
        if "natural_frequencies" in numbers:
            yield "natural frequencies", _frequencies(numbers["natural_frequencies"].splitlines())


def _proposed(numbers) -> Said:
    if "proposed_face_load_factor" in numbers:
        amounts = (f'{name} = "{numbers[f"proposed_{name}"]:.1f} um"' for name in ("helix_slope", "crowning"))
        yield "for an even line load, in [lead_modifications]", f"pinion = {{ {', '.join(amounts)} }}"
        yield "face load factor K_Hbeta with it", f"{numbers['proposed_face_load_factor']:.3f}"


def _frequencies(lines: list[str]) -> str:
    each = (line.partition(" ") for line in lines[:LOWEST])
    said = ", ".join(f"{float(hertz):.4g} Hz" + (f" ({motion})" if motion else "") for hertz, _, motion in each)
    return f"{said}; {len(lines)} in all" if len(lines) > LOWEST else said


def _pressure(numbers) -> Said:
    if not numbers.get("peak_contact_pressure") or "peak_contact_pressure_diameter" not in numbers:
        return
    flank = ", coast flank" if numbers["peak_contact_pressure_flank"] == "coast" else ""
    if end := numbers.get("peak_contact_pressure_beside"):
        flank += f", near the {end} of its active profile, where lines of contact end"
    apart = [words for name, words in APART.items() if f"peak_{name}_pressure" in numbers]
    yield (
        "peak contact pressure" + (f", without {' and '.join(apart)}" if apart else ""),
        f"{numbers['peak_contact_pressure']:.4g} MPa at mesh cycle {numbers['peak_contact_pressure_mesh_phase']:.4g},"
        f" pinion's diameter {numbers['peak_contact_pressure_diameter']:.4g} mm{flank}",
    )
    if "peak_kink_pressure" in numbers:
        yield "pressure at kinks of relief", f"{numbers['peak_kink_pressure']:.4g} MPa, more on a finer mesh"


def _root_stress(numbers) -> Said:
    for gear in GEARS:
        name = f"largest_root_stress_{gear}"
        if name in numbers:
            place = f"at mesh cycle {numbers[f'{name}_mesh_phase']:.4g}, tooth of pair {numbers[f'{name}_pair']}"
            yield f"largest root stress, {gear}", f"{numbers[name]:.4g} MPa {place}, {numbers[f'{name}_fillet']} side"


def _power(numbers) -> Said:
    if "input_power" in numbers:
        yield "input power", f"{numbers['input_power'] / KILO:.4g} kW"
    if "friction_loss" in numbers:
        watts = f"{numbers['friction_power']:.4g} W = " if "friction_power" in numbers else ""
        efficiency = "of wedged or locked teeth, which have no efficiency"
        if "mesh_efficiency" in numbers:
            efficiency = f"efficiency of the mesh {numbers['mesh_efficiency']:.3%}"
        yield "friction loss", f"{watts}{numbers['friction_loss']:.3%} of the drive's work, {efficiency}"


def _sliding(dataset) -> Said:
    if "specific_sliding" in dataset:
        speed = ""
        if "sliding_speed" in dataset:
            speed = f"{float(abs(dataset['sliding_speed']).max()) / KILO:.4g} m/s at most; "
        lowest = dataset["specific_sliding"].min("path_point").values
        yield "sliding", f"{speed}specific sliding {lowest[0]:.3g} pinion, {lowest[1]:.3g} wheel"


def _contact_loss(dataset) -> Said:
    """Of the drive flanks; nothing where they never touch, as where the wheel drives."""
    numbers = dataset.attrs
    count = numbers.get("contact_loss_count")
    if count and dataset["normal_force"].max() > 0.0:
        yield (
            "contact of the drive flanks lost" if "coast_normal_force" in dataset else "contact lost",
            f"{count} time{'s' * (count > 1)}, {numbers['contact_loss_share']:.2%} of the time, by up to"
            f" {numbers['contact_loss_opening'] * MICROMETRES:.3g} um",
        )


def _estimated_error(numbers) -> Said:
    if "target" not in numbers:
        return
    parts = {name.removeprefix(ESTIMATED): error for name, error in numbers.items() if name.startswith(ESTIMATED)}
    worst = max(parts, key=parts.__getitem__)
    judged = "T_E and T_EPP"
    over_face = ""
    if "slices" in numbers:
        judged = "T_E, T_EPP, line load"
        over_face = f", {numbers['slices']} slices on {numbers['layers']} layers"
    yield f"estimated error of {judged}", f"{numbers['estimated_error']:.2%}, target {numbers['target']:.3%}"
    yield "what limits it", f"{worst}: {parts[worst]:.2%}"
    yield (
        "settings chosen",
        f"{numbers['element']}, flank elements {numbers['flank_element_size']:.3g} mm, {numbers['contact_nodes']}"
        f" contact nodes over {numbers['contact_length']:.3g} mm, {numbers['steps_per_mesh_cycle']} steps per mesh"
        f" cycle{over_face} by {numbers['target_runs']} runs",
    )
    for remark in numbers["target_remarks"].splitlines():
        yield "remark", remark


def solver_rows(dataset) -> list[Row]:
    """How the steps were solved, with the fallbacks of their route's own method where some needed them."""
    rows = []
    numbers = dataset.attrs
    if dataset.sizes["time"]:
        iterations = dataset["newton_iterations"]
        mean = float(iterations.mean())
        most = int(iterations.max())
        rows.append(("Newton iterations per step", f"{mean:.2f} on average, {most} at most", ""))
    used = {name.removeprefix(RUNG): int(count) for name, count in numbers.items() if name.startswith(RUNG)}
    used.pop(NEWTON, None)
    if used:
        rows.append(("steps solved by fallbacks", ", ".join(f"{count} by {rung}" for rung, count in used.items()), ""))
    return rows


def stage_rows(dataset) -> list[Row]:
    """Wall time of each stage of a run."""
    return [(label, f"{dataset.attrs[name]:.2f}", "s") for name, label in STAGES.items() if name in dataset.attrs]
