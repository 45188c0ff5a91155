"""Noise figures of a train: levels of the overall transmission error by the orders of its meshes and shafts."""

import numpy as np
import xarray as xr

from fenics_gears import MICRORADIANS, OVERALL, carried_train, overall_orders, spectrum
from fenics_gears.charts import DARK, PALETTE, WORDS, Chart, Curve, stems

DECIBELS = 60.0
# Harmonics whose levels are written beside their lines.
NAMED = 3


def train_figures(result: xr.Dataset) -> xr.Dataset:
    """Amplitudes (urad of the last shaft) and levels (dB re 1 urad) over `order`, events in a turn of the first shaft;
    beside each its meshes, harmonic and frequency (Hz)."""
    found = overall_orders(result, carried_train(result), turns=True)
    amplitudes = MICRORADIANS * np.array([each.amplitude for each in found])
    words = "amplitude of the lag of the last shaft"
    of_levels = f"level of the {words}"

    def over(values, **labels) -> tuple:
        return ("order",), np.array(values), labels

    return xr.Dataset(
        {
            f"{OVERALL}_amplitude": over(amplitudes, units="urad", long_name=words),
            f"{OVERALL}_level": over(spectrum.level(amplitudes), units="dB re 1 urad", long_name=of_levels),
        },
        {
            "order": over([each.order for each in found], units="1", long_name="events in a turn of the first shaft"),
            "meshes": over(np.array([each.meshes for each in found], dtype=object), long_name="meshes that have it"),
            "place": over([each.place for each in found], long_name="place of the first of them in the train"),
            "harmonic": over([each.harmonic for each in found], units="1", long_name="multiple of the mesh frequency"),
            "frequency": over([each.frequency for each in found], units="Hz", long_name="frequency"),
        },
        {"window": "none, over whole cycles of each mesh", "references": "amplitudes of 1 urad of the last shaft"},
    )


def train_charts(figures: xr.Dataset) -> list[Chart]:
    """Levels over orders, a colour for each mesh, in the order of the train."""
    orders, levels = figures["order"].values, figures[f"{OVERALL}_level"].values
    top = float(levels.max())
    foot = top - DECIBELS
    heard = levels > foot
    meshes = figures["meshes"].values
    curves = [
        Curve(str(name), *stems(orders[of], levels[of], foot - 1.0), colour, width=2.6)
        for name, colour in zip(dict.fromkeys(meshes[np.argsort(figures["place"].values)]), (*PALETTE, *PALETTE))
        if (of := heard & (meshes == name)).any()
    ]
    named = heard & (figures["harmonic"].values <= NAMED)
    words = [f"{each:.1f} dB" for each in levels[named]]
    curves.append(Curve("levels", orders[named], levels[named], DARK, mode=WORDS, listed=False, words=words))
    return [
        Chart(
            "Overall transmission error", curves, "Order (events in a turn of the first shaft)",
            "Level of the amplitude (dB re 1 µrad)", height=420, x_range=(0.0, 1.05 * float(orders[heard].max())),
            y_range=(foot, top + 5.0),
        )
    ]  # fmt: skip
