"""Transmission error over speed and load without relief and with it, and the one over the other."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm, Normalize
from matplotlib.figure import Figure

from demos.cluster_study.gain import Gain
from fenics_gears.show.panels import DARK, styled

TICKS = (50, 100, 200, 400, 1000)  # Hz
DESIGN_TORQUE = 437.0  # N m
LEVELS = (2.0, 5.0, 10.0, 20.0, 40.0)  # um
RATIOS = (0.25, 0.5, 1.0, 2.0, 4.0)


@styled
def draw(found: Gain) -> Figure:
    """Three maps over mesh frequency and torque."""
    figure = Figure(figsize=(15.0, 6.2), layout="constrained")
    figure.get_layout_engine().set(w_pad=0.1, h_pad=0.1)
    values = np.concatenate([found.without_relief.ravel(), found.with_relief.ravel()])
    figure.suptitle(
        "A tip relief of 28 µm, chosen for 437 N m, over speed and load\n"
        f"The paper's pair with friction, on its shafts and bearings; {values.size} runs shared by the processes of "
        f"mpirun",
        x=0.012, ha="left", fontsize=15,
    )  # fmt: skip
    plain, relieved, ratio = figure.subplots(1, 3, sharey=True)
    shades = LogNorm(values.min(), values.max())
    for axes, left, words in (
        (plain, found.without_relief, "true involutes"),
        (relieved, found.with_relief, "with tip relief"),
    ):
        drawn = _map(axes, found, left, shades, "viridis_r", f"Transmission error, {words}")
        lines = axes.contour(found.frequencies, found.torques, left, levels=LEVELS, colors="white", linewidths=1.0)
        axes.clabel(lines, fmt="%g µm", fontsize=10)
    bar = figure.colorbar(
        drawn, ax=[plain, relieved], location="bottom", pad=0.02, shrink=0.7, ticks=[2, 5, 10, 20, 50, 100]
    )
    bar.ax.xaxis.set_major_formatter(lambda value, _: f"{value:g}")
    bar.ax.minorticks_off()
    bar.set_label("Peak to peak, on the wheel's base circle (µm)")
    furthest = max(float(np.abs(np.log2(found.ratio)).max()), 0.5)
    gained = _map(
        ratio, found, np.log2(found.ratio), Normalize(-furthest, furthest), "RdBu_r", "With relief over without"
    )
    lines = ratio.contour(
        found.frequencies, found.torques, found.ratio, levels=[0.3, 0.6, 1.0], colors=DARK, linewidths=[0.9, 0.9, 2.2]
    )
    ratio.clabel(lines, fmt="%g", fontsize=11)
    bar = figure.colorbar(gained, ax=ratio, location="bottom", pad=0.02, ticks=np.log2(RATIOS))
    bar.ax.set_xticklabels([f"{each:g}" for each in RATIOS])
    bar.set_label("Ratio (blue: the relief helps, red: it harms)")
    plain.set_ylabel("Torque on the wheel (N m)")
    figure.legend(*ratio.get_legend_handles_labels(), loc="upper right")
    return figure


def _map(axes: Axes, found: Gain, values: np.ndarray, shades, colours: str, title: str):
    drawn = axes.pcolormesh(found.frequencies, found.torques, values, norm=shades, cmap=colours, shading="gouraud")
    axes.axhline(
        DESIGN_TORQUE,
        color=DARK,
        linewidth=1.6,
        linestyle=":",
        label=f"{DESIGN_TORQUE:g} N m, for which the relief was chosen",
    )
    axes.set_xscale("log")
    axes.set_xticks(TICKS, [str(tick) for tick in TICKS])
    axes.minorticks_off()
    axes.set_xlabel("Mesh frequency (Hz)")
    axes.set_title(title)
    axes.grid(False)
    return drawn
