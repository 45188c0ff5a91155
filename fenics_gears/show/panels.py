"""What all pictures share: palette, fonts, the heading, panels over mesh cycles and their axes."""

from __future__ import annotations

import functools
import textwrap
from collections.abc import Callable, Sequence

import matplotlib
import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from fenics_gears.show.run_scene import conditions, scene_of

# Okabe and Ito's palette without its yellow, which is too pale for a line: told apart with any colour vision.
PALETTE = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#56B4E9", "#E69F00")
DARK, GREY = "#222222", "#8C8C8C"
WARNING = "#B00020"
DOTS_PER_INCH = 150

_STYLE = {
    "font.size": 12.0,
    "axes.titlesize": 12.5,
    "axes.titlelocation": "left",
    "axes.titlepad": 8.0,
    "axes.edgecolor": DARK,
    "axes.spines.top": False,
    "axes.formatter.useoffset": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.color": "#E3E3E3",
    "grid.linewidth": 0.8,
    "lines.linewidth": 1.8,
    "legend.frameon": False,
    "legend.fontsize": 11.5,
    "figure.dpi": DOTS_PER_INCH,
}


def styled(draw: Callable) -> Callable:
    """Run a drawing function in the style of these pictures, whatever the settings of the user's matplotlib are."""

    @functools.wraps(draw)
    def inside(*arguments, **options):
        with matplotlib.rc_context():
            matplotlib.rcdefaults()
            matplotlib.rcParams.update(_STYLE)
            return draw(*arguments, **options)

    return inside


def panels(dataset: xr.Dataset, subject: str, heights: Sequence[float]) -> tuple[Figure, list[Axes]]:
    """A figure with one panel per height (inches) above each other, all over the recorded mesh cycles, and its heading."""
    figure = Figure(figsize=(10.0, 1.6 + sum(heights)), layout="constrained")
    figure.get_layout_engine().set(w_pad=0.12, h_pad=0.1)
    axes = figure.subplots(len(heights), sharex=True, squeeze=False, gridspec_kw={"height_ratios": heights})[:, 0]
    _heading(figure, dataset, subject)
    phase = dataset["mesh_phase"].values
    axes[-1].set_xlim(phase[0], phase[-1])
    axes[-1].set_xlabel("Time (mesh cycles since the start)")
    axes[-1].xaxis.set_major_locator(MaxNLocator(nbins=10, steps=[1, 2, 2.5, 5, 10]))
    return figure, list(axes)


def _heading(figure: Figure, dataset: xr.Dataset, subject: str) -> None:
    """Subject and scene, the operating conditions, and, where it applies, that the run is incomplete."""
    title = " ".join(str(dataset.attrs.get("title", "")).split())
    lines = [textwrap.shorten(f"{subject}: {title}" if title else subject, 92, placeholder=" …")]
    scene = scene_of(dataset)
    if scene is not None:
        lines += textwrap.wrap(conditions(scene), 92, break_long_words=False)
    complete = bool(dataset.attrs.get("complete", 1))
    if not complete:
        lines.append(f"INCOMPLETE RUN: stopped at mesh cycle {dataset['mesh_phase'].values[-1]:.2f}")
    # A scene's title may hold dollar signs that are no formula.
    figure.suptitle(
        "\n".join(lines), x=0.012, ha="left", fontsize=14, color=DARK if complete else WARNING, parse_math=False
    )


def limits(values: np.ndarray, least: float) -> tuple[float, float]:
    """Ends of an axis around the finite values; not closer than ``least``, so that rounding errors do not fill a panel."""
    finite = values[np.isfinite(values)]
    low, high = (float(finite.min()), float(finite.max())) if finite.size else (0.0, 0.0)
    half = 0.5 * max(1.12 * (high - low), least)
    return 0.5 * (low + high) - half, 0.5 * (low + high) + half


def legend(axes: Axes, columns: int, location: str = "lower right") -> None:
    """Legend above the panel, where no curve can be."""
    side = 1.0 if location.endswith("right") else 0.0
    axes.legend(loc=location, bbox_to_anchor=(side, 1.0), ncol=columns, borderaxespad=0.1, handlelength=1.6, columnspacing=1.4)
