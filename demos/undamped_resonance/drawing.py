"""Transmission error and time without contact against mesh frequency, with coast flanks and without."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, NullFormatter

from demos.undamped_resonance.sweeps import WITH, WITHOUT, Sweep
from fenics_gears.show.panels import GREY, PALETTE, legend, styled

# The curves lie on each other where contact is kept: the wider one shows behind the other.
WIDTHS, SIZES = {WITH: 4.5, WITHOUT: 1.6}, {WITH: 9.0, WITHOUT: 5.5}
COLOURS = {WITH: PALETTE[0], WITHOUT: PALETTE[1]}
SHADE = "#F3EBDD"


@styled
def draw(curves: Mapping[str, Sweep]) -> Figure:
    """Above the transmission error, filled where contact was kept, open where it was lost, crossed where the run has no
    meaning; below how much of the time the drive flanks did not touch."""
    figure = Figure(figsize=(10.0, 7.6), layout="constrained")
    figure.get_layout_engine().set(w_pad=0.12, h_pad=0.1)
    above, below = figure.subplots(2, sharex=True, gridspec_kw={"height_ratios": [1.6, 1.0]})
    figure.suptitle(
        "The paper's pair without damping, through its first torsional resonance: where contact is lost",
        x=0.012,
        ha="left",
        fontsize=14,
    )
    micrometres = curves[WITH].base_radius * 1e3
    for name, curve in curves.items():
        _line(above, curve, curve.amplitude * micrometres, COLOURS[name], name)
        below.plot(curve.frequency, 100.0 * curve.share, color=COLOURS[name], linewidth=WIDTHS[name])
    _marks(above)
    _shade(above, below, curves[WITH])
    above.set_ylabel("Transmission error, peak to peak,\non the wheel's base circle (µm)")
    above.set_yscale("log")
    above.yaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    above.yaxis.set_major_formatter(lambda value, _: f"{value:g}")
    above.yaxis.set_minor_formatter(NullFormatter())
    below.set_ylabel("Time without contact\nof the drive flanks (%)")
    below.set_ylim(bottom=0.0)
    below.set_xlabel("Mesh frequency (Hz)")
    below.set_xlim(curves[WITH].frequency[0], curves[WITH].frequency[-1])
    legend(above, columns=3, location="lower left")
    return figure


def _line(axes: Axes, curve: Sweep, values: np.ndarray, colour: str, name: str) -> None:
    axes.plot(curve.frequency, values, color=colour, linewidth=WIDTHS[name], label=name)
    kept, open_ = ~curve.lost, curve.lost & ~curve.meaningless
    axes.plot(curve.frequency[kept], values[kept], "o", color=colour, markersize=SIZES[name])
    axes.plot(curve.frequency[open_], values[open_], "o", color=colour, markerfacecolor="white", markersize=SIZES[name])
    axes.plot(
        curve.frequency[curve.meaningless],
        values[curve.meaningless],
        "x",
        color=colour,
        markersize=9,
        markeredgewidth=2.4,
        zorder=4,
    )


def _marks(axes: Axes) -> None:
    """Entries of the legend that say what a mark means, without colour."""
    marks = {
        "contact kept": ("o", GREY),
        "contact lost": ("o", "white"),
        "lost beyond the backlash: no meaning": ("x", GREY),
    }
    for label, (mark, face) in marks.items():
        axes.plot([], [], mark, color=GREY, markerfacecolor=face, markersize=7, markeredgewidth=1.6, label=label)


def _shade(above: Axes, below: Axes, curve: Sweep) -> None:
    """A band over the frequencies at which contact is lost."""
    if not curve.lost.any():
        return
    middles = 0.5 * (curve.frequency[:-1] + curve.frequency[1:])
    edges = np.concatenate((curve.frequency[:1], middles, curve.frequency[-1:]))
    for axes in (above, below):
        for low, high in zip(edges[:-1][curve.lost], edges[1:][curve.lost]):
            axes.axvspan(low, high, color=SHADE, linewidth=0.0, zorder=0)
    above.fill_between([], [], color=SHADE, label="contact lost, with coast flanks")
