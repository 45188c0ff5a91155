"""Transmission error and force of a tooth pair of three pairs, with inertia and without, over two mesh cycles."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

CURVES = {"static": ("without inertia", "0.55", 1.2), "at_speed": ("at speed", "C0", 1.6)}


def picture(pairs) -> Figure:
    """One column a pair (`pairs.Pair`): transmission error above, forces of the tooth pairs below."""
    figure = Figure(figsize=(12.0, 6.0), layout="constrained")
    axes = figure.subplots(2, len(pairs), sharex=True)
    for column, pair in enumerate(pairs):
        for name, (label, colour, width) in CURVES.items():
            run = getattr(pair, name)
            phase = run.mesh_phase.values - run.mesh_phase.values[0]
            axes[0, column].plot(phase, 1e3 * run.attrs["base_radius_wheel"] * run.transmission_error.values, color=colour, lw=width, label=label)
            force = 1e-3 * run.pair_normal_force.values
            force = np.where(force > 0.0, force, np.nan)
            axes[1, column].plot(phase, force, color=colour, lw=width)
        axes[0, column].set_title(pair.at_speed.attrs["title"], fontsize=11)
        axes[1, column].set_xlabel("mesh cycles")
        axes[1, column].set_ylim(bottom=0.0)
    axes[0, 0].set_ylabel("transmission error (um)")
    axes[1, 0].set_ylabel("force of each tooth pair (kN)")
    axes[0, 0].legend(frameon=False, fontsize=9)
    for each in axes.flat:
        each.spines[["top", "right"]].set_visible(False)
    return figure
