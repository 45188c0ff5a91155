"""Charts of noise figures: levels over mesh orders with their sidebands, mesh orders over a speed ramp."""

import numpy as np
import xarray as xr

from fenics_gears.charts import DARK, GREY, PALETTE, WORDS, Chart, Curve, stems

from .figures import SIGNALS

ORDERS_SHOWN = 5.5
FOLLOWED = 5
DECIBELS = 60.0
# Sidebands with less of their line's energy are round-off.
LEAST_RATIO = 1e-8


def noise_charts(figures: xr.Dataset) -> list[Chart]:
    return [
        _followed(figures, name) if "part" in figures.dims else _levels(figures, name)
        for name in SIGNALS
        if f"{name}_level" in figures
    ]


def _titles(name: str) -> tuple[str, str]:
    unit, words = SIGNALS[name]
    return words[0].upper() + words[1:], f"Level of the amplitude (dB re 1 {unit.replace('um', 'µm')})"


def _levels(figures: xr.Dataset, name: str) -> Chart:
    orders = figures["order"].values[figures["order"].values <= ORDERS_SHOWN]
    levels = figures[f"{name}_level"].values[: len(orders)]
    mesh = np.abs(orders - np.round(orders)) < 1e-6
    top = float(levels.max())
    foot = top - DECIBELS
    between, whole = ((orders[shown], levels[shown]) for shown in (~mesh & (levels > foot), mesh & (levels > foot)))
    caption, title = _titles(name)
    if f"{name}_sideband_ratio" in figures:
        ratios = figures[f"{name}_sideband_ratio"].sel(harmonic=slice(1, ORDERS_SHOWN))
        beside = [
            f"{10.0 * np.log10(float(ratio)):+.1f}\u00a0dB at order {int(ratio['harmonic'])}"
            for ratio in ratios
            if ratio > LEAST_RATIO
        ]
        caption += f"; energy of the sidebands against that of their mesh order: {', '.join(beside)}" if beside else ""
    curves = [
        Curve("between mesh orders", *stems(*between, foot - 1.0), GREY, width=0.8),
        Curve("mesh orders", *stems(*whole, foot - 1.0), PALETTE[0], width=2.6),
        Curve("levels", *whole, DARK, mode=WORDS, listed=False, words=[f"{each:.1f} dB" for each in whole[1]]),
    ]
    drawn = [curve for curve in curves if len(curve.x)]
    ranges = {"x_range": (0.0, ORDERS_SHOWN), "y_range": (foot, top + 5.0)}
    return Chart(caption, drawn, "Mesh order", title, height=420, **ranges)


def _followed(figures: xr.Dataset, name: str) -> Chart:
    caption, title = _titles(name)
    colours = (*PALETTE, DARK)
    curves = [
        Curve(
            f"{order} × mesh",
            figures["mesh_frequency"].values,
            figures[f"{name}_level"].sel(order=order).values,
            colour,
        )
        for order, colour in zip(figures["order"].values[:FOLLOWED], colours)
    ]
    return Chart(caption, curves, "Mesh frequency (Hz)", title, height=420)
