"""Charts of motion and forces: transmission error, shafts, load and speed where they vary; forces of the mesh, of each
tooth pair, and their reactions on the shafts."""

from collections.abc import Iterator

import numpy as np

from .chart import BAND, LEAST_SHARE, Chart, Curve, Second, of_variables, over_time, span
from .panels import DARK, PALETTE, factor
from .run import ShownRun

# Smallest spans shown. Contact is solved to 1e-4 um and to 1e-6 of the transmitted force; what is smaller is no curve.
LEAST_LENGTH = 0.1  # um
LEAST_ANGLE = 1e-3  # urad
ERROR = "Transmission error"


def motion_charts(run: ShownRun) -> list[Chart]:
    """All motions that the result has."""
    return [transmission_error(run), *error_by_cycle(run), *_shafts(run)]


def error_values(run: ShownRun) -> tuple[np.ndarray, str]:
    """Transmission error (time,) and its unit: µm on the wheel's base circle, µrad where that is not known."""
    if np.isfinite(run.micrometres):
        return run.values("transmission_error", "rad") * run.micrometres, "µm"
    return run.values("transmission_error", "µrad"), "µrad"


def transmission_error(run: ShownRun) -> Chart:
    """The transmission error over the mesh cycles."""
    values, unit = error_values(run)
    note = ""
    second = None
    place = ""
    if unit == "µm":
        turned = factor("rad", "µrad") / run.micrometres
        note = (
            f"Length on the wheel's base circle; 1 µm is {turned:.4g} µrad of the wheel. Positive where the wheel lags."
        )
        second = Second("Angle of the wheel (µrad)", turned)
        place = " on the wheel's base circle"
    least = LEAST_SHARE * float(np.abs(values).max())
    caption = f"{ERROR}{place}: {_peak_to_peak(run, values, unit)}"
    curves = [("transmission error", values, PALETTE[0])]
    return over_time(run, caption, f"{ERROR} ({unit})", curves, least=least, note=note, second=second, height=380)


def _peak_to_peak(run: ShownRun, values: np.ndarray, unit: str) -> str:
    attributes = run.dataset.attrs
    if not run.complete or "peak_to_peak_transmission_error" not in attributes:
        return f"peak to peak of what is stored {np.ptp(values):#.4g} {unit}"
    value = attributes["peak_to_peak_transmission_error"] * (run.micrometres if unit == "µm" else factor("rad", "µrad"))
    cycles = attributes.get("settled_cycles", 0.0)
    over = f" over {cycles:.4g} cycles" if cycles > np.ptp(run.window) * (1 + 1e-9) else ""
    return f"peak to peak {value:#.4g} {unit}{over}"


def error_by_cycle(run: ShownRun) -> list[Chart]:
    """Least and largest transmission error of every mesh cycle of the record, where cycles are not all shown."""
    if run.shows_all or len(run.whole_cycles) < 2:
        return []
    values, unit = error_values(run)
    middle, title = run.cycle_axis
    edges = np.array([(values[each].min(), values[each].max()) for each in run.whole_cycles]).T
    mean = np.array([values[each].mean() for each in run.whole_cycles])
    curves = [
        Curve("from least to largest of a mesh cycle", middle, edges, PALETTE[0], width=1.0, mode=BAND),
        Curve("mean of a mesh cycle", middle, mean, DARK),
    ]
    caption = f"{ERROR} over all {len(middle)} mesh cycles"
    least = LEAST_SHARE * float(np.abs(values).max())
    return [Chart(caption, curves, title, f"{ERROR} ({unit})", least=least, height=280)]


def wheels_shaft(run: ShownRun) -> list[Chart]:
    """Displacement of the wheel's shaft: off the line of action with friction; without, it moves only along it."""
    name, words = ("centre_y", "off") if "friction_force" in run.dataset else ("centre_x", "along")
    if name not in run.dataset:
        return []
    values = run.values(name, "µm")[:, run.dataset["gear"].values.tolist().index("wheel")]
    caption = f"Displacement of the wheel's shaft {words} the line of action"
    curves = [("wheel", values, PALETTE[1])]
    return [over_time(run, caption, "Displacement (µm)", curves, least=LEAST_LENGTH, height=240)]


def _shafts(run: ShownRun) -> list[Chart]:
    caption = "Displacement of the gears' centres"
    sides = {"centre_x": "along", "centre_y": "off"}
    # Without friction gears that do not tilt stay on the line of action.
    if not {"friction_force", "tilt_x"} & set(run.dataset):
        del sides["centre_y"]
    centres = [
        of_variables(run, f"{caption} {words} the line of action", "Displacement", "µm", {name: ""}, least=LEAST_LENGTH)
        for name, words in sides.items()
    ]
    of_gears = [
        ("Displacement of the gears along their axes", "Displacement", "µm", "axial_position", LEAST_LENGTH),
        ("Tilt of the gears about the line of action", "Tilt", "µrad", "tilt_x", LEAST_ANGLE),
        ("Tilt of the gears in the plane of action", "Tilt", "µrad", "tilt_y", LEAST_ANGLE),
        ("Rotation of the hubs from their nominal motion", "Rotation", "µrad", "rotation", LEAST_ANGLE),
    ]
    of_one = [
        ("Rotation of the output shaft's end", "Rotation", "µrad", {"shaft_end_rotation": "rotation"}, LEAST_ANGLE),
        ("Torque on the wheel's shaft", "Torque", "N m", {"wheel_couple": "torque"}, 1e-6),
        ("Mesh frequency", "Mesh frequency", "Hz", {"mesh_frequency": "mesh frequency"}, 0.0),
    ]
    charts = [
        of_variables(run, words, what, unit, {name: ""}, least=least) for words, what, unit, name, least in of_gears
    ]
    charts += [
        of_variables(run, words, what, unit, names, least=least, colours=PALETTE[3:], height=300)
        for words, what, unit, names, least in of_one
    ]
    return sum(centres + charts, [])


COAST_NOTE = "Coast flanks are drawn downwards."
SHARES_UNKNOWN = "Where several rigid pairs touch at once their shares are not determined."


def force_charts(run: ShownRun) -> list[Chart]:
    """All forces that the result has."""
    names = {"drive_flank_opening": "drive flanks", "coast_flank_opening": "coast flanks"}
    options = {"least": 0.1, "height": 300}
    openings = of_variables(run, "Smallest distance of the flanks", "Distance", "µm", names, **options)
    return [*mesh_forces(run), *pair_forces(run), *_reactions(run), *openings]


def mesh_forces(run: ShownRun) -> list[Chart]:
    """Normal and friction force of the mesh, on either side of the teeth."""
    if "normal_force" not in run.dataset:
        return []
    drive = run.values("normal_force", "N")
    curves = [("normal force", drive, PALETTE[0])]
    note = ""
    if "coast_normal_force" in run.dataset:
        curves = [
            ("drive flanks", drive, PALETTE[0]),
            ("coast flanks (drawn downwards)", -run.values("coast_normal_force", "N"), PALETTE[1]),
        ]
        note = COAST_NOTE
    options = {"least": span(curves), "height": 240, "note": note}
    normal = over_time(run, "Normal force of the mesh", "Normal force (N)", curves, **options)
    names = {"friction_force": "drive flanks", "coast_friction_force": "coast flanks"}
    return [normal, *of_variables(run, "Friction force of the mesh", "Friction force", "N", names)]


def pair_forces(run: ShownRun) -> Iterator[Chart]:
    """Shares of the tooth pairs in normal and in friction force."""
    for name, caption in (
        ("pair_normal_force", "Load sharing: normal force of each tooth pair"),
        ("pair_friction_force", "Friction force of each tooth pair"),
    ):
        if name not in run.dataset:
            continue
        curves = [(words, values, PALETTE[number % len(PALETTE)]) for words, values, number in run.of_pairs(name, "N")]
        note = SHARES_UNKNOWN if np.isnan(run.dataset[name].values).any() else ""
        if name == "pair_normal_force":
            coast = run.of_pairs("pair_coast_normal_force", "N") if "pair_coast_normal_force" in run.dataset else []
            curves += [
                (f"{words}, coast flanks", -values, PALETTE[number % len(PALETTE)]) for words, values, number in coast
            ]
            note = f"{COAST_NOTE} {note}".strip() if coast else note
            # First, so that the pairs are drawn upon it.
            curves.insert(0, ("all drive flanks" if coast else "all pairs", run.values("normal_force", "N"), DARK))
        if curves:
            yield over_time(run, caption, "Force (N)", curves, least=span(curves), note=note, height=380)


def shaft_torques(run: ShownRun) -> list[Chart]:
    """Torque of either gear on its shaft."""
    return of_variables(run, "Torque of either gear on its shaft", "Torque", "N m", {"reaction_couple": ""})


def _reactions(run: ShownRun) -> list[Chart]:
    sides = {"reaction_x": "along", "reaction_y": "off"} if "friction_force" in run.dataset else {"reaction_x": "along"}
    charts = [
        of_variables(run, f"Reaction of either gear on its shaft {words} the line of action", "Force", "N", {name: ""})
        for name, words in sides.items()
    ]
    charts += [
        of_variables(
            run, f"{words} forces of points on the wheel", "Force", "N", {f"wheel_support_{words.lower()}": ""}
        )
        for words in ("Radial", "Tangential")
    ]
    return [*sum(charts, []), *shaft_torques(run)]
