"""How the gears move: transmission error, shafts, and what the scene lets vary."""

from __future__ import annotations

import numpy as np

from fenics_gears.show.curves import LEAST_LENGTH, LEAST_SHARE
from fenics_gears.show.panels import PALETTE
from fenics_gears.show.report.page import Plot, Section, Words
from fenics_gears.show.report.plotting import over_time
from fenics_gears.show.report.run import TOO_FEW, Run
from fenics_gears.show.units import factor, in_unit


def motion(run: Run) -> Section:
    """Curves of all motions that the result has."""
    if not run.has_curves:
        return Section("motion", "Transmission error and motion", [Words(TOO_FEW, warns=True)])
    return Section("motion", "Transmission error and motion", [_transmission_error(run), *_shafts(run), *_varying(run)])


def _transmission_error(run: Run) -> Plot:
    error = in_unit(run.dataset["transmission_error"], "rad")
    if np.isfinite(run.micrometres):
        values, unit = error * run.micrometres, "µm"
        turned = f"{factor('rad', 'µrad') / run.micrometres:.4g}"
        note = f"Length on the wheel's base circle; 1 µm is {turned} µrad of the wheel. Positive where the wheel lags."
    else:
        values, unit, note = error * factor("rad", "µrad"), "µrad", ""
    curves = [("transmission error", values, PALETTE[0])]
    return over_time(
        run.dataset,
        "Transmission error",
        f"Transmission error ({unit})",
        curves,
        least=LEAST_SHARE * float(np.abs(values).max()),
        note=note,
        height=360,
    )


def _shafts(run: Run) -> list[Plot]:
    dataset, plots = run.dataset, []
    along = {"centre_x": "along the line of action", "centre_y": "off the line of action"}
    for name, words in along.items():
        if name in dataset:
            plots.append(_both(run, name, "µm", f"Displacement of the gears' centres {words}", "Displacement (µm)", LEAST_LENGTH))
    if "rotation" in dataset:
        plots.append(_both(run, "rotation", "µrad", "Rotation of the hubs from their nominal motion", "Rotation (µrad)", 1e-3))
    if "shaft_end_rotation" in dataset:
        values = in_unit(dataset["shaft_end_rotation"], "µrad")
        plots.append(
            over_time(dataset, "Rotation of the output shaft's end", "Rotation (µrad)", [("shaft end", values, PALETTE[2])], least=1e-3)
        )
    return plots


def _both(run: Run, name: str, unit: str, caption: str, y_title: str, least: float) -> Plot:
    values = in_unit(run.dataset[name].transpose("time", "gear"), unit)
    curves = [(str(gear), each, colour) for gear, each, colour in zip(run.dataset["gear"].values, values.T, PALETTE)]
    return over_time(run.dataset, caption, y_title, curves, least=least)


def _varying(run: Run) -> list[Plot]:
    """Load and speed, where they vary."""
    dataset, plots = run.dataset, []
    if "wheel_couple" in dataset:
        values = in_unit(dataset["wheel_couple"], "N m")
        plots.append(over_time(dataset, "Couple on the wheel's shaft", "Couple (N m)", [("couple", values, PALETTE[3])], least=1e-6))
    if "mesh_frequency" in dataset:
        plots.append(
            over_time(
                dataset, "Mesh frequency", "Mesh frequency (Hz)", [("mesh frequency", in_unit(dataset["mesh_frequency"], "Hz"), PALETTE[3])]
            )
        )
    return plots
