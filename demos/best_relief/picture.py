"""Maps of the goal by brute force, with what `gears optimize` tried and found."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.figure import Figure

from fenics_gears.show.panels import DARK, PALETTE, styled

if TYPE_CHECKING:
    from demos.best_relief.compare import Compared

DEPTH, LENGTH = "tip_relief.depth", "tip_relief.length_on_path"
LEVELS = np.arange(2.0, 30.0, 2.0)


@styled
def drawn(every: Mapping[str, Compared]) -> Figure:
    """A panel for each condition, by its words."""
    rows = -(-len(every) // 2)
    figure = Figure(figsize=(13.0, 0.9 + 5.2 * rows), layout="constrained")
    figure.get_layout_engine().set(w_pad=0.1, h_pad=0.12)
    figure.suptitle(
        "Best tip relief of the paper's gears: found by gears optimize, over a map by brute force\nColour and lines: "
        "transmission error, peak to peak (µm), quasi-static at 437 N m",
        x=0.012, ha="left", fontsize=15,
    )  # fmt: skip
    top = max(each.map.max() for each in every.values())
    panels = np.ravel(figure.subplots(rows, 2, sharex=True, sharey=True, squeeze=False))
    for axes, (words, each) in zip(panels, every.items()):
        shades = axes.pcolormesh(
            each.lengths, each.depths, each.map, cmap="viridis_r", shading="gouraud", vmin=0.0, vmax=top
        )
        lines = axes.contour(each.lengths, each.depths, each.map, levels=LEVELS, colors="white", linewidths=1.0)
        axes.clabel(lines, fmt="%g", fontsize=10)
        tried = [evaluation.values for evaluation in each.found.tried]
        axes.plot(
            [values[LENGTH] for values in tried],
            [values[DEPTH] for values in tried],
            ".",
            color=DARK,
            markersize=3.5,
            label="tried",
        )
        depth, length, goal = each.least_of_map
        axes.plot(
            length,
            depth,
            "s",
            color="white",
            markeredgecolor=DARK,
            markersize=9,
            label=f"best of the grid, {goal:.1f} µm",
        )
        best = each.found.chosen
        axes.plot(
            best.values[LENGTH],
            best.values[DEPTH],
            "o",
            color=PALETTE[1],
            markeredgecolor="white",
            markersize=11,
            label=f"found, {next(iter(best.goals.values())):.1f} µm",
        )
        axes.set_title(words, pad=30.0)
        axes.legend(
            loc="lower left", bbox_to_anchor=(0.0, 1.0), ncol=3, borderaxespad=0.1, handletextpad=0.3, columnspacing=1.2
        )
        axes.grid(False)
        axes.set(xlim=(each.lengths[0], each.lengths[-1]), ylim=(each.depths[0], each.depths[-1]))
    for axes in panels[-2:]:
        axes.set_xlabel("Length of the relief on the path of contact (mm)")
    for axes in panels[::2]:
        axes.set_ylabel("Depth at the tip (µm)")
    figure.colorbar(shades, ax=list(panels), pad=0.01, aspect=40).set_label("Transmission error, peak to peak (µm)")
    return figure
