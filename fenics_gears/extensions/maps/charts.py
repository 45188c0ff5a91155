"""Charts of a map over loads and speeds: Harris map, numbers over load and over speed, Campbell diagram, waterfalls."""

from collections.abc import Sequence

import numpy as np
import xarray as xr

from fenics_gears import HARMONIC_NAMES, spectrum
from fenics_gears.charts import (
    BAND,
    DARK,
    GREY,
    LINES,
    MARKED_LINES,
    MARKERS,
    PALETTE,
    WORDS,
    Chart,
    Curve,
    harris_map,
    shades,
    span,
    stems,
    words_apart,
)

MESH_ORDERS = 5
SPEED = "Mesh frequency (Hz)"
FREQUENCY = "Frequency (Hz)"
# Of a waterfall: decibels from the base line to the highest line, which is as high as so many steps of the speed.
DECIBELS = 40.0
STEPS_HIGH = 2.5
# Room right of and above the lines of a Campbell diagram for their words, in parts of the axes.
BESIDE = 1.12
# A line from the first axis' zero on, in parts of its end.
FROM_ZERO = np.array([0.0, 1.0])
# Natural frequencies that differ by less between loads are drawn as one line.
ALIKE = 0.005
# Least distance of words, in parts of the second axis.
WORDS_APART = 0.035
# A vibration that is damped more has no resonance: its response falls from standstill on.
MOST_DAMPED = 0.5**0.5


def map_pictures(map_data: xr.Dataset) -> dict[str, tuple[str, list[Chart]]]:
    """Subject and charts of each picture for which a map (`map_results`) has data, by file name."""
    several = map_data.sizes["load"] > 1
    pictures: dict[str, tuple[str, list[Chart]]] = {}
    if "transmission_error" in map_data:
        error = map_data["transmission_error"]
        without_mean = (error - error.mean("mesh_phase")).assign_attrs(error.attrs)
        whole = harris_map(error, f"Transmission error by {map_data['load'].attrs['long_name']}")
        charts = [whole, harris_map(without_mean, "The same, each curve without its mean")]
        pictures["harris_map.png"] = ("Harris map", charts)
    if several:
        pictures["over_load.png"] = ("Quasi-static, over the load", over_load(map_data))
    if "mesh_frequency" in map_data.coords:
        if map_data.sizes["mesh_frequency"] > 1:
            pictures["over_speed.png"] = ("Steady speeds", over_speed(map_data))
        pictures["campbell.png"] = ("Campbell diagram", [campbell(map_data)])
        unit = map_data["load"].attrs["units"]
        for load in map_data["load"].values if map_data.sizes["mesh_frequency"] > 1 else ():
            name = f"waterfall_{load:g}_{unit.replace(' ', '_')}.png"
            charts = waterfall(map_data.sel(load=load))
            pictures[name] = (f"Waterfall at {load:g} {unit}", charts)
    return pictures


def over_load(map_data: xr.Dataset) -> list[Chart]:
    """Transmission error peak to peak, its harmonics and the mesh stiffness over the load."""
    map_data = map_data.sortby("load")
    harmonics = {
        f"{number} × mesh": map_data[name] for number, name in enumerate(HARMONIC_NAMES, 1) if name in map_data
    }
    stiffness = {
        words: map_data[name]
        for name, words in (("mean_mesh_stiffness", "secant"), ("mean_mesh_stiffness_tangent", "tangent"))
        if name in map_data
    }
    kinds = (
        ({"": map_data["peak_to_peak_transmission_error"]}, "Transmission error, peak to peak", "Peak to peak (µm)"),
        (harmonics, "Harmonics of the transmission error", "Amplitude (µm)"),
        (stiffness, "Mesh stiffness over the face width, mean of the mesh cycle", "N/(mm µm)"),
    )
    axis = f"{map_data['load'].attrs['long_name'].capitalize()} ({map_data['load'].attrs['units']})"
    return [_curves(curves, "load", axis, *titles) for curves, *titles in kinds if curves]


def over_speed(map_data: xr.Dataset) -> list[Chart]:
    """Dynamic factor, transmission error and mesh force over the speed, a curve for each load."""
    map_data = map_data.sortby(["load", "mesh_frequency"])
    kinds = {
        "dynamic_factor_by_force": (
            "Dynamic factor: largest force of a tooth pair over that without inertia",
            "Dynamic factor",
        ),
        "dynamic_peak_to_peak_transmission_error": ("Transmission error, peak to peak", "Peak to peak (µm)"),
        "dynamic_rms_transmission_error": ("Transmission error without its mean, r.m.s.", "R.m.s. (µm)"),
        "dynamic_rms_normal_force": ("Mesh force without its mean, r.m.s.", "R.m.s. (N)"),
    }
    of_loads = {
        name: {
            f"{load:g} {map_data['load'].attrs['units']}": map_data[name].sel(load=load)
            for load in map_data["load"].values
        }
        for name in kinds
        if name in map_data
    }
    return [
        _curves(curves, "mesh_frequency", _speed(map_data), *kinds[name], shades(len(curves)))
        for name, curves in of_loads.items()
    ]


def _curves(
    curves: dict[str, xr.DataArray],
    over: str,
    x_title: str,
    caption: str,
    y_title: str,
    colours: Sequence[str] = PALETTE,
) -> Chart:
    drawn = [
        Curve(name, values[over].values, values.values, colour, mode=MARKED_LINES)
        for (name, values), colour in zip(curves.items(), colours)
    ]
    return Chart(caption, drawn, x_title, y_title, height=270, least=span([(each.name, each.y, "") for each in drawn]))


def _speed(map_data: xr.Dataset) -> str:
    of_pinion = 100.0 * float(map_data["pinion_speed"][0] / map_data["mesh_frequency"][0])
    return f"{SPEED}; 100 Hz are {of_pinion:.4g} rpm of the pinion"


def campbell(map_data: xr.Dataset) -> Chart:
    """Frequency over speed: mesh orders as lines from the origin, natural frequencies level, marked where an order
    meets one that contact excites."""
    fastest = float(map_data["mesh_frequency"].max())
    largest = float(np.nanmax(map_data["natural_frequency"], initial=0.0))
    top = max(1.1 * fastest, min(MESH_ORDERS * fastest, 1.2 * largest))
    orders = np.arange(1, MESH_ORDERS + 1)
    ends = np.minimum(fastest, top / orders)
    curves = [
        Curve("mesh orders", end * FROM_ZERO, order * end * FROM_ZERO, PALETTE[0], listed=order == 1)
        for order, end in zip(orders, ends)
    ]
    named = [f"{order} ×" for order in orders]
    curves.append(Curve("orders", ends, orders * ends, DARK, mode=WORDS, listed=False, words=named, beside="right"))
    modes = map_data[["natural_frequency", "damping_ratio", "excited", "motion"]].dropna("load")
    modes = modes.isel(mode=map_data["natural_frequency"].min("load").values < top)
    low = modes["natural_frequency"].min("load").values
    high = modes["natural_frequency"].max("load").values
    curves += _natural_frequencies(low, high, modes, fastest, top)
    middle = 0.5 * (low + high)
    resonant = middle[modes["excited"].values.astype(bool) & (modes["damping_ratio"].min("load").values < MOST_DAMPED)]
    x = resonant[:, None] / orders
    y = np.outer(resonant, np.ones(len(orders)))
    if (x <= fastest).any():
        curves.append(Curve("resonances", x[x <= fastest], y[x <= fastest], PALETTE[1], mode=MARKERS))
    ranges = {"x_range": (0.0, BESIDE * fastest), "y_range": (0.0, 1.06 * top)}
    return Chart("", curves, _speed(map_data), FREQUENCY, height=560, **ranges)


def _natural_frequencies(low: np.ndarray, high: np.ndarray, modes: xr.Dataset, fastest: float, top: float):
    """A level line of each mode, or a band from its lowest to its highest frequency among the loads, and its words;
    modes of one frequency are named once."""
    curves: list[Curve] = []
    said: dict[str, tuple[float, dict]] = {}
    for least, most, excited, motion in zip(low, high, modes["excited"].values, modes["motion"].values):
        name, colour = ("natural frequencies", PALETTE[1]) if excited else ("not excited by contact", GREY)
        kind = {"mode": BAND} if (spread := most > (1.0 + ALIKE) * least) else {"mode": LINES, "dash": "dash"}
        edges = np.array([[least] * 2, [most] * 2]) if spread else np.full(2, 0.5 * (least + most))
        listed = name not in {each.name for each in curves}
        curves.append(Curve(name, fastest * FROM_ZERO, edges, colour, listed=listed, **kind))
        words = f"{least:.0f} to {most:.0f} Hz" if spread else f"{0.5 * (least + most):.0f} Hz"
        said[words] = most, {**said.get(words, (0, {words: 0}))[1], **({motion: 0} if motion else {})}
    places = [(0.0, height, ", ".join(words)) for height, words in said.values()]
    return [*curves, words_apart(places, WORDS_APART * top, "top right")] if places else curves


def waterfall(map_data: xr.Dataset) -> list[Chart]:
    """Spectra of transmission error and mesh force one above the other by speed, at one load."""
    signals = (("transmission_error", "Transmission error", "1 µm"), ("mesh_force", "Mesh force", "1 N"))
    map_data = map_data.sortby("mesh_frequency")
    amplitudes = (
        (map_data[f"{name}_amplitude"].transpose("mesh_frequency", "order").values, *words) for name, *words in signals
    )
    return [_waterfall(map_data, *each) for each in amplitudes if np.nanmax(each[0], initial=0.0) > 0.0]


def _waterfall(map_data: xr.Dataset, amplitudes: np.ndarray, signal: str, reference: str) -> Chart:
    speeds = map_data["mesh_frequency"].values
    orders = map_data["order"].values
    levels = spectrum.level(amplitudes)
    widest = MESH_ORDERS * speeds[-1]
    highest = float(np.nanmax(levels))
    high = STEPS_HIGH * float(np.median(np.diff(speeds)))
    curves = []
    for speed, own, colour in zip(speeds, levels, shades(len(speeds))[::-1]):
        seen = np.isfinite(own) & (own > highest - DECIBELS) & (orders * speed <= widest)
        x, y = stems(
            np.concatenate([[0.0], orders[seen] * speed, [widest]]),
            np.concatenate([[speed], speed + high * (1.0 + (own[seen] - highest) / DECIBELS), [speed]]),
            speed,
        )
        curves.append(Curve(f"{speed:g} Hz", x, y, colour, width=1.2, listed=False))
    for natural in np.unique(np.round(np.nan_to_num(map_data["natural_frequency"].values), 1)):
        if 0.0 < natural < widest:
            x = np.full(2, natural)
            y = np.array([0.0, speeds[-1] + high])
            curves.append(Curve("natural frequencies", x, y, PALETTE[1], "dash", 1.0, listed=False))
    rays = np.arange(1, MESH_ORDERS + 1)
    top = speeds[-1] + 1.1 * high
    x = rays * speeds[-1]
    y = np.full(len(rays), top)
    words = [f"{ray} × mesh" for ray in rays]
    curves.append(Curve("orders", x, y, DARK, mode=WORDS, listed=False, words=words, beside="top left"))
    caption = (
        f"{signal}: base lines are at their speed; height is the level of the amplitude, {DECIBELS:g} dB up to the"
        f" highest line, {highest:.1f} dB re {reference}; dashed: natural frequencies"
    )
    ranges = {"x_range": (0.0, widest), "y_range": (max(0.0, speeds[0] - 0.3 * high), top + 0.5 * high)}
    return Chart(caption, curves, FREQUENCY, SPEED, height=480, **ranges)
