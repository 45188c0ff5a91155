"""Vibration against mesh frequency, on the way up and on the way down."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from matplotlib.figure import Figure

from demos.speed_ramp.sweeps import Sweep
from fenics_gears.show.panels import DARK, PALETTE, styled

LABELS = {"up": "speed rising", "down": "speed falling"}
REACHED = {"up": "steady speed, reached from below", "down": "steady speed, reached from above"}
# Where an arrow shows which way a ramp goes, Hz.
ARROWS = {"up": (194.0, 198.0), "down": (188.0, 184.0)}
COLOURS = {"up": PALETTE[0], "down": PALETTE[1]}


@styled
def draw(
    ramps: Mapping[str, Sweep], frequencies: np.ndarray, steady: Mapping[str, np.ndarray], base_radius: float
) -> Figure:
    """Ramps as lines, runs at the steady mesh `frequencies` (Hz) that a ramp leads to as rings; `base_radius` of the
    wheel, mm."""
    length = 1e3 * base_radius
    figure = Figure(figsize=(10.0, 6.0), layout="constrained")
    figure.get_layout_engine().set(w_pad=0.12, h_pad=0.1)
    axes = figure.subplots()
    figure.suptitle(
        "Two vibrations at one speed: which one depends on where the speed comes from\n"
        "The paper's gears at 100 N m with 0.6 % damping; their teeth leave each other on the upper branch",
        x=0.02, ha="left", fontsize=13,
    )  # fmt: skip
    for name, passed in ramps.items():
        axes.plot(passed.frequency, length * passed.amplitude, color=COLOURS[name], label=LABELS[name])
        axes.plot(
            frequencies,
            length * steady[name],
            "o",
            color=COLOURS[name],
            markerfacecolor="white",
            markersize=7,
            label=REACHED[name],
        )
        order = np.argsort(passed.frequency)
        tail, tip = (
            (at, length * np.interp(at, passed.frequency[order], passed.amplitude[order]) + 6.0) for at in ARROWS[name]
        )
        axes.annotate(
            "",
            tip,
            tail,
            arrowprops={"arrowstyle": "-|>", "color": COLOURS[name], "linewidth": 2.0, "mutation_scale": 18},
        )
    axes.set_xlabel("Mesh frequency (Hz)")
    axes.set_ylabel("Transmission error, peak to peak,\non the wheel's base circle (µm)")
    axes.set_xlim(150.0, 260.0)
    axes.set_ylim(bottom=0.0)
    axes.tick_params(colors=DARK)
    axes.legend(loc="upper right")
    return figure
