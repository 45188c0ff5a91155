"""Curves as plotly figures that look alike: light ground, units on both axes, colours that any eye tells apart."""

from __future__ import annotations

import html
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import xarray as xr

from fenics_gears.show.panels import DARK, GREY, PALETTE, limits
from fenics_gears.show.report.page import Plot
from fenics_gears.show.report.thinning import MOST_POINTS, thinned

FONT = "system-ui, -apple-system, 'Segoe UI', Roboto, 'Helvetica Neue', Arial, 'Liberation Sans', sans-serif"
GRID = "#E9ECEF"
TIME, MESH_CYCLES = "time", "Time (mesh cycles since the start)"
# More digits than a screen shows; curves such as the transmission error vary by a hundredth of their mean.
DIGITS = 7


@dataclass(frozen=True)
class Curve:
    """Values (n,) over places (n,) of the first axis, both numbers or, for places, words."""

    name: str
    x: np.ndarray
    y: np.ndarray
    colour: str = PALETTE[0]
    dash: str = "solid"
    width: float = 1.6
    mode: str = "lines"


def plot(
    caption: str,
    curves: Sequence[Curve],
    x_title: str,
    y_title: str,
    *,
    least: float = 0.0,
    note: str = "",
    height: int = 300,
    linked: str = "",
) -> Plot:
    """Curves over one axis. `least`: the smallest span that the second axis shows."""
    import plotly.graph_objects as go

    drawn = [_trace(go, curve) for curve in curves]
    longest = max((len(curve.x) for curve in curves), default=0)
    if longest > MOST_POINTS:
        note = f"{note} {_thinning(longest)}".strip()
    figure = go.Figure(drawn, layout(x_title, y_title, legend=len(curves) > 1))
    values = np.concatenate([np.asarray(curve.y, dtype=float) for curve in curves]) if curves else np.zeros(0)
    if np.isfinite(values).any():
        figure.update_yaxes(range=list(limits(values, least or 1e-300)))
        if not 1e-3 <= np.nanmax(np.abs(values)) < 1e6:
            figure.update_yaxes(exponentformat="e")
    return Plot(caption, figure, note, height, linked)


def over_time(dataset: xr.Dataset, caption: str, y_title: str, curves: Sequence[tuple[str, np.ndarray, str]], **options) -> Plot:
    """Curves of name, values (time,) and colour over the mesh cycles; plots of this kind are zoomed together."""
    phase = dataset["mesh_phase"].values
    return plot(
        caption, [Curve(name, phase, values, colour) for name, values, colour in curves], MESH_CYCLES, y_title, linked=TIME, **options
    )


def layout(x_title: str, y_title: str, *, legend: bool) -> dict:
    """The look that all plots share."""
    axis = {
        "gridcolor": GRID, "linecolor": GREY, "showline": True, "ticks": "outside", "tickcolor": GREY, "ticklen": 4,
        "zerolinecolor": "#C4C9CE", "zerolinewidth": 1, "exponentformat": "none", "separatethousands": True,
    }  # fmt: skip
    return {
        "template": "none",
        "font": {"family": FONT, "size": 13, "color": DARK},
        # One left margin for all plots, so that the time axes of plots below each other match; above, room for plotly's buttons and the
        # legend below them.
        "margin": {"l": 80, "r": 16, "t": 40 if legend else 26, "b": 46},
        "showlegend": legend,
        "legend": {"orientation": "h", "x": 0, "xanchor": "left", "y": 1.02, "yanchor": "bottom", "font": {"size": 12.5}},
        "hovermode": "x",
        "paper_bgcolor": "white",
        "plot_bgcolor": "white",
        "xaxis": axis | {"title": {"text": escaped(x_title), "font": {"size": 13.5}, "standoff": 8}, "hoverformat": ".5~g"},
        "yaxis": axis | {"title": {"text": escaped(y_title), "font": {"size": 13.5}, "standoff": 6}, "hoverformat": ",.5~g"},
    }


def escaped(text: str) -> str:
    """Text that plotly shows as it is; some tags it would take for its own."""
    return html.escape(text, quote=False)


def numbers(values: np.ndarray) -> list:
    """Values (n,) as a list of numbers with as many digits as are seen, None where there is none; words stay words."""
    array = np.asarray(values)
    if array.dtype.kind not in "fiub":
        return [escaped(str(each)) for each in array]
    return [float(f"{each:.{DIGITS}g}") if np.isfinite(each) else None for each in array.astype(float).tolist()]


def _trace(go, curve: Curve):
    places = thinned(np.asarray(curve.y, dtype=float))
    line = {"color": curve.colour, "width": curve.width, "dash": curve.dash}
    marker = {"color": curve.colour, "size": 7}
    x, y = (numbers(np.asarray(values)[places]) for values in (curve.x, curve.y))
    return go.Scatter(x=x, y=y, name=escaped(curve.name), mode=curve.mode, line=line, marker=marker, connectgaps=False)


def _thinning(steps: int) -> str:
    return f"Of {steps:,} steps the smallest and the largest of each of {MOST_POINTS // 2:,} slices are drawn: every peak is there."


def bars(go, name: str, x: np.ndarray, y: np.ndarray, colour: str, width: float):
    """A trace of bars at places (n,), of one width."""
    return go.Bar(x=numbers(x), y=numbers(y), name=escaped(name), marker={"color": colour, "line": {"width": 0}}, width=width)
