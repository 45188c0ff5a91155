"""Two pictures: what a relief leaves over depth, length and load; and the loaded transmission error under it, as Harris
drew it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from demos.tip_relief.design import LONG, SHORT, Bench, Design
from demos.tip_relief.findings import DRAWN, HARRIS_LOADS, Map
from demos.tip_relief.optimum import ALLOWED, Optimum
from fenics_gears.show.panels import DARK, GREY, PALETTE, legend, styled

COLOURS = dict(zip(DRAWN, PALETTE))
STYLES = {"true involutes": (0, (1, 1.4)), "short relief": (0, (5, 2)), "best relief": "-"}
LEVELS = (2.0, 4.0, 8.0, 12.0, 16.0, 20.0, 24.0)
LEFT = "Peak to peak (µm)"
LENGTH = "Length of the relief (1: all of the double contact)"


@styled
def draw_choice(
    maps: Mapping[str, Map],
    best: Mapping[str, Optimum],
    curves: Mapping[tuple[str, str], tuple[np.ndarray, np.ndarray]],
    loads: tuple[np.ndarray, Mapping[tuple[str, str], np.ndarray]],
) -> Figure:
    """Maps and optima by friction; curves (mesh cycles, um) by friction and design; loads (N m), and what is left (um)
    at them by friction and design."""
    figure = Figure(figsize=(13.0, 11.0), layout="constrained")
    figure.get_layout_engine().set(w_pad=0.1, h_pad=0.1)
    figure.suptitle(
        "Tip relief chosen for the least peak-to-peak transmission error, on the wheel's base circle\n"
        "The paper's gears, 437 N m, quasi-static; linear relief, the same depth on both gears",
        x=0.012, ha="left", fontsize=15,
    )  # fmt: skip
    above, below = figure.subplots(2, 2, gridspec_kw={"height_ratios": [1.15, 1.0]})
    scale = Normalize(0.0, max(float(each.left.max()) for each in maps.values()))
    for axes, (friction, found) in zip(above, maps.items()):
        shades = _draw_map(axes, found, best[friction], scale)
        axes.set_title(f"{friction}: least {best[friction].peak_to_peak:.1f} µm")
    figure.colorbar(shades, ax=list(above), pad=0.01).set_label(LEFT)
    above[0].set_ylabel("Depth at the tip (µm)")
    _draw_curves(below[0], curves)
    _draw_loads(below[1], *loads)
    return figure


def _draw_map(axes: Axes, found: Map, best: Optimum, scale: Normalize):
    shades = axes.pcolormesh(found.lengths, found.depths, found.left, norm=scale, cmap="viridis_r", shading="gouraud")
    lines = axes.contour(found.lengths, found.depths, found.left, levels=LEVELS, colors="white", linewidths=1.0)
    axes.clabel(lines, fmt="%g µm", fontsize=10)
    for length, words in ((SHORT, "short"), (LONG, "long")):
        axes.axvline(length, color="white", linewidth=1.0, linestyle=":")
        axes.annotate(
            words,
            (length, found.depths[-1]),
            xytext=(5, -14),
            textcoords="offset points",
            color="white",
            va="top",
            fontsize=12,
            fontweight="bold",
        )
    axes.plot(best.design.length, best.design.depth, "o", color=PALETTE[1], markeredgecolor="white", markersize=10)
    axes.contour(
        found.lengths, found.depths, found.left, levels=[best.peak_to_peak + ALLOWED], colors=PALETTE[1], linewidths=2.2
    )
    axes.annotate(
        f"best: {best.design.depth:.0f} µm, length {best.design.length:.2f}\nwithin the line: at most 1 µm worse",
        (best.design.length, best.design.depth),
        xytext=(0.97, 0.03), textcoords="axes fraction", ha="right", color=DARK, fontsize=11,
        bbox={"facecolor": "white", "edgecolor": "none", "alpha": 0.88},
        arrowprops={"arrowstyle": "-", "color": "white"},
    )  # fmt: skip
    axes.set_xlabel(LENGTH)
    axes.grid(False)
    return shades


def _draw_curves(axes: Axes, curves: Mapping[tuple[str, str], tuple[np.ndarray, np.ndarray]]) -> None:
    for (friction, design), (phase, error) in curves.items():
        axes.plot(
            phase,
            error - error.mean(),
            color=COLOURS[friction],
            linestyle=STYLES[design],
            label=f"{friction}, {design}",
        )
    axes.set_title("Before and after, at 437 N m", pad=46.0)
    axes.set_xlabel("Time (mesh cycles)")
    axes.set_ylabel("Transmission error\nless its mean (µm)")
    axes.set_xlim(0.0, 1.0)
    legend(axes, columns=2, location="lower left")


def _draw_loads(axes: Axes, torques: np.ndarray, left: Mapping[tuple[str, str], np.ndarray]) -> None:
    for (friction, design), values in left.items():
        axes.plot(torques, values, color=COLOURS[friction], linestyle=STYLES[design], label=f"{friction}, {design}")
    axes.axvline(0.5 * torques[-1], color=GREY, linewidth=1.0)
    axes.annotate(
        "chosen for\nthis load",
        (0.5 * torques[-1], axes.get_ylim()[1]),
        xytext=(5, -2),
        textcoords="offset points",
        va="top",
        fontsize=11,
        color=DARK,
    )
    axes.set_title("What the same reliefs leave at other loads", pad=64.0)
    axes.set_xlabel("Torque on the wheel (N m)")
    axes.set_ylabel(LEFT)
    axes.set_xlim(0.0, torques[-1])
    axes.set_ylim(0.0, 1.1 * max(values.max() for values in left.values()))
    legend(axes, columns=2, location="lower left")


@styled
def draw_harris_map(
    bench: Bench, designs: Mapping[str, Design | None], loads: Sequence[float] = HARRIS_LOADS
) -> Figure:
    """The transmission error over a mesh cycle under each design, one line a load (in parts of the bench's torque)."""
    from matplotlib import colormaps

    figure = Figure(figsize=(13.0, 5.8), layout="constrained")
    figure.get_layout_engine().set(w_pad=0.1, h_pad=0.1)
    figure.suptitle(
        "Harris map: transmission error under load, on the wheel's base circle\n"
        "The paper's gears without friction on stiff shafts and bearings, quasi-static; one line a torque",
        x=0.012, ha="left", fontsize=15,
    )  # fmt: skip
    panels = figure.subplots(1, len(designs), sharey=True)
    for axes, (name, design) in zip(panels, designs.items()):
        for load in loads:
            phase, error = bench.error(design, load)
            colour = colormaps["viridis"](0.9 * (1.0 - load / loads[-1]))
            chosen = load == 1.0
            axes.plot(phase, error, color=PALETTE[1] if chosen else colour, linewidth=2.6 if chosen else 1.6)
            axes.annotate(
                f"{bench.torque(load):.3g} N m",
                (phase[-1], error[-1]),
                xytext=(4, 0),
                textcoords="offset points",
                va="center",
                fontsize=10,
                color=DARK,
                annotation_clip=False,
            )
        axes.set_title(name if design is None else f"{name}: {design.depth:.0f} µm, length {design.length:.2g}")
        axes.set_xlim(0.0, 1.0)
        axes.set_xlabel("Time (mesh cycles)")
    panels[0].set_ylabel("Transmission error (µm)")
    panels[0].set_ylim(bottom=0.0)
    return figure
