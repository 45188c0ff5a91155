"""Transmission error and forces of the tooth pairs of three pairs, with inertia and without, over two mesh cycles."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from fenics_gears.show.panels import GREY, PALETTE, styled

CURVES = {"static": ("without inertia", GREY, 1.4), "at_speed": ("at speed", PALETTE[0], 1.8)}


@styled
def picture(pairs) -> Figure:
    """One column a pair (`pairs.Pair`): transmission error above, forces of the tooth pairs below."""
    figure = Figure(figsize=(13.0, 7.0), layout="constrained")
    figure.get_layout_engine().set(w_pad=0.12, h_pad=0.1)
    axes = figure.subplots(2, len(pairs), sharex=True, squeeze=False)
    figure.suptitle(
        "Three real pairs, each gear with an inertia of its own, at their mesh frequencies",
        x=0.012,
        ha="left",
        fontsize=14,
    )
    for column, pair in enumerate(pairs):
        above, below = axes[:, column]
        for name, (label, colour, width) in CURVES.items():
            run = getattr(pair, name)
            phase = run.mesh_phase.values - run.mesh_phase.values[0]
            above.plot(
                phase,
                1e3 * run.attrs["base_radius_wheel"] * run.transmission_error.values,
                color=colour,
                linewidth=width,
                label=label,
            )
            force = 1e-3 * run.pair_normal_force.values
            below.plot(phase, np.where(force > 0.0, force, np.nan), color=colour, linewidth=width)
        above.set_title(f"{pair.row[0]}, {pair.row[1]} Hz")
        below.set_xlabel("Mesh cycles")
        below.set_ylim(bottom=0.0)
    axes[0, 0].set_ylabel("Transmission error on the\nwheel's base circle (µm)")
    axes[1, 0].set_ylabel("Normal force of\neach tooth pair (kN)")
    figure.legend(*axes[0, 0].get_legend_handles_labels(), loc="upper right", ncol=2)
    return figure
