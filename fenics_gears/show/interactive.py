"""Charts drawn by plotly, to be zoomed in a browser.

Only its browser library is used: plotly's Python objects take longer to make than everything else of a page.
"""

import html
from textwrap import wrap
from typing import Any

import numpy as np

from .chart import BAND, BARS, WORDS, Chart, Curve
from .panels import DARK, GREY, MOST_POINTS, thinned

FONT = "system-ui, -apple-system, 'Segoe UI', Roboto, 'Helvetica Neue', Arial, 'Liberation Sans', sans-serif"
GRID = "#E9ECEF"
# More digits than a screen shows; curves such as the transmission error vary by a hundredth of their mean.
DIGITS = 7
POWERS = np.array([float(f"1e{n}") for n in range(300)])
# Pixels, and letters in a row of a legend on a usual page.
LEGEND_ROW = 19
LETTERS_A_ROW = 120
FLAG_ROW = 17
# Of a letter of an axis' title, and of a further line of it.
LETTER = 7.0
LINE = 17


def legend_rows(chart: Chart) -> int:
    """Rows of a legend; plotly sets names in columns as wide as the longest."""
    names = [curve.name for curve in chart.curves if curve.listed]
    columns = max(1, LETTERS_A_ROW // (max(map(len, names), default=0) + 8))
    return -(-len(names) // columns) if chart.has_legend else 0


def height(chart: Chart) -> int:
    """Pixels of a chart with all its legend."""
    return chart.height + LEGEND_ROW * max(0, legend_rows(chart) - 1)


def figure(chart: Chart) -> dict:
    """A chart as plotly's browser library reads it."""
    traces = [trace for curve in chart.curves for trace in _traces(curve, chart)]
    if chart.field is not None:
        field = chart.field
        scale = [[place / (len(field.colours) - 1), colour] for place, colour in enumerate(field.colours)]
        lowest = min(0.0, float(np.nanmin(field.values, initial=0.0)))
        bar = {"title": {"text": escaped(field.title), "side": "right"}, "thickness": 14}
        cells = {"x": numbers(field.x), "y": numbers(field.y), "z": numbers(field.values, 4)}
        look = {"colorscale": scale, "zmin": lowest, "zmax": field.limit, "colorbar": bar, "hoverongaps": False}
        traces.insert(0, {"type": "heatmap", "name": ""} | look | cells)
    layout = _layout(chart)
    if chart.flags:
        _flag(layout, chart)
    beside = [each for curve in chart.curves if len(curve.words) for each in _words(curve)]
    layout["annotations"] = layout.get("annotations", []) + beside
    return {"data": traces, "layout": layout}


def _layout(chart: Chart) -> dict:
    axis = {
        "gridcolor": GRID, "linecolor": GREY, "showline": True, "ticks": "outside", "tickcolor": GREY, "ticklen": 4,
        "zerolinecolor": "#C4C9CE", "zerolinewidth": 1, "exponentformat": "none", "separatethousands": True,
    }  # fmt: skip
    # A title that is longer than its axis would be cut off.
    beside = wrap(chart.y_title, int(height(chart) / LETTER)) or [""]
    texts = escaped(chart.x_title), "<br>".join(map(escaped, beside))
    titles = [{"text": text, "font": {"size": 13.5}} for text in texts]
    x = axis | {"title": titles[0] | {"standoff": 8}, "hoverformat": ".5~g"}
    y = axis | {"title": titles[1] | {"standoff": 6}, "hoverformat": ",.5~g"}
    if chart.x_range is not None:
        x["range"] = list(chart.x_range)
    bars = any(curve.mode == BARS for curve in chart.curves)
    if bars:
        x["showgrid"] = False
    if chart.field is not None or chart.equal:
        x |= {"showgrid": False, "zeroline": False}
        y |= {"showgrid": False, "zeroline": False}
    if chart.limits is not None:
        y["range"] = np.log10(chart.limits).tolist() if "y" in chart.logarithmic else list(chart.limits)
        if not 1e-3 <= max(map(abs, chart.limits)) < 1e6:
            y["exponentformat"] = "e"
    elif bars:
        y["rangemode"] = "tozero"
    for name, each in (("x", x), ("y", y)):
        if name in chart.logarithmic:
            each["type"] = "log"
    if chart.equal:
        y |= {"scaleanchor": "x", "scaleratio": 1}
    extra = {"barmode": "overlay", "updatemenus": [_scales(chart)]} if bars else {}
    legend = {"orientation": "h", "x": 0, "xanchor": "left", "y": 1.02, "yanchor": "bottom", "font": {"size": 12.5}}
    return {
        "template": "none",
        "font": {"family": FONT, "size": 13, "color": DARK},
        # One left margin for all charts, so that the time axes of charts below each other match; above, room for
        # plotly's buttons and the legend below them.
        "margin": {
            "l": 80 + LINE * (len(beside) - 1),
            "r": 16,
            "t": max(48 if bars else 26, 21 + LEGEND_ROW * legend_rows(chart)),
            "b": 46,
        },
        "showlegend": chart.has_legend,
        "legend": legend,
        "hovermode": "closest" if chart.field is not None or chart.equal else "x",
        "paper_bgcolor": "white",
        "plot_bgcolor": "white",
        "xaxis": x,
        "yaxis": y,
    } | extra


def _scales(chart: Chart) -> dict:
    choices = {"linear": "linear", "logarithmic": "log"}
    buttons = [
        {"label": label, "method": "relayout", "args": [{"yaxis.type": kind, "yaxis.autorange": True}]}
        for label, kind in choices.items()
    ]
    return {
        "type": "buttons", "direction": "right", "buttons": buttons, "x": 1.0, "xanchor": "right", "y": 1.03,
        "yanchor": "bottom",
        "active": int("y" in chart.logarithmic), "pad": {"r": 0, "t": 0, "b": 0}, "font": {"size": 12},
        "bgcolor": "white", "bordercolor": "#C4C9CE",
    }  # fmt: skip


def _flag(layout: dict, chart: Chart) -> None:
    rows = chart.flag_rows
    inside = height(chart) - layout["margin"]["t"] - layout["margin"]["b"]
    end = 1.0 - FLAG_ROW * (max(rows) + 1) / inside
    layout["yaxis"]["domain"] = [0.0, end]
    tops = [1.0 - FLAG_ROW * (max(rows) - row + 1) / inside for row in rows]
    place = {"xref": "x", "yref": "paper"}
    layout["shapes"] = [
        {"type": "line", "x0": flag.x, "x1": flag.x, "y0": end - 0.06, "y1": top}
        | {"line": {"color": flag.colour, "width": 0.8}}
        | place
        for flag, top in zip(chart.flags, tops)
    ]
    at = {"showarrow": False, "xanchor": "left", "yanchor": "bottom"} | place
    layout["annotations"] = [
        {"x": flag.x, "y": top, "text": escaped(flag.words), "font": {"color": flag.colour, "size": 12}} | at
        for flag, top in zip(chart.flags, tops)
    ]


def _words(curve: Curve) -> list[dict]:
    """Words next to the points of a curve."""
    up = ("top" in curve.beside) - ("bottom" in curve.beside)
    right = ("right" in curve.beside) - ("left" in curve.beside)
    at: dict[str, Any] = {"xanchor": ("center", "left", "right")[right], "yanchor": ("middle", "bottom", "top")[up]}
    at |= {"xshift": 7 * right, "yshift": 5 * up}
    look = {"font": {"size": 12, "color": DARK}, "bgcolor": "rgba(255, 255, 255, 0.8)", "borderpad": 1}
    look["showarrow"] = False
    return [
        {"x": x, "y": y, "text": escaped(words)} | at | look
        for words, x, y in zip(curve.words, numbers(curve.x), numbers(curve.y))
    ]


def escaped(text: str) -> str:
    """Text that plotly shows as it is; some tags it would take for its own."""
    return html.escape(text, quote=False)


def numbers(values: np.ndarray, digits: int = DIGITS) -> list:
    """Values of any shape as a list of numbers with as many digits as a chart shows, None where there is none; words
    stay words.

    >>> numbers(np.array([[1234567.0, -0.00123456], [np.nan, 0.0]]), 3)
    [[1230000.0, -0.00123], [None, 0.0]]
    """
    array = np.asarray(values)
    if array.dtype.kind not in "fiub":
        return [escaped(str(each)) for each in array]
    array = array.astype(float)
    known = np.isfinite(array)
    sizes = np.log10(np.abs(array), where=known & (array != 0.0), out=np.full(array.shape, digits - 1.0))
    places = digits - 1 - np.floor(sizes).astype(int)
    # Exact powers of ten, by which a rounded integer is the nearest number to its decimals.
    up, down = (POWERS[np.clip(each, 0, len(POWERS) - 1)] for each in (places, -places))
    rounded = np.rint(np.where(known, array, 0.0) * up / down) / up * down
    return (rounded if known.all() else np.where(known, rounded, None)).tolist()


def _traces(curve: Curve, chart: Chart) -> list[dict]:
    if curve.mode == WORDS:
        return []
    named = {"name": escaped(curve.name), "showlegend": curve.listed and chart.has_legend}
    line = {"color": curve.colour, "width": curve.width, "dash": curve.dash}
    if curve.mode == BARS:
        bars = {"marker": {"color": curve.colour, "line": {"width": 0}}, "width": curve.width}
        return [{"type": "bar", "x": numbers(curve.x), "y": numbers(curve.y)} | bars | named]
    if curve.mode == BAND:
        edges = [
            {"type": "scatter", "x": numbers(curve.x), "y": numbers(edge), "mode": "lines", "line": line} | named
            for edge in curve.y
        ]
        return [edges[0] | {"showlegend": False}, edges[1] | {"fill": "tonexty"}]
    places = _places(curve, chart)
    x, y = (numbers(np.asarray(values)[places]) for values in (curve.x, curve.y))
    marker = {"color": curve.colour, "size": 7}
    if curve.words:
        marker = {"size": 9, "color": "white", "line": {"color": curve.colour, "width": 1.6}}
    filled = {"fill": "toself", "fillcolor": curve.fill} if curve.fill else {}
    hover = {"hoverinfo": "skip"} if chart.equal else {}
    drawn = {"type": "scatter", "x": x, "y": y, "mode": curve.mode, "line": line, "marker": marker}
    return [drawn | {"connectgaps": False} | filled | hover | named]


def _places(curve: Curve, chart: Chart) -> np.ndarray:
    """Points of a curve that are drawn: of a long one all in the range that is shown first, and few of the rest."""
    y = np.asarray(curve.y, dtype=float)
    if chart.x_range is None or len(y) <= MOST_POINTS:
        return thinned(y)
    shown = np.flatnonzero(chart.in_range(curve.x))
    return np.union1d(thinned(y), shown) if len(shown) <= MOST_POINTS else thinned(y)
