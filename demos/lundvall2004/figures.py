"""The paper's Figs. 2, 4, 5, 6, 8, 9 and 10: solid with friction, dashed without, dotted static."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from demos.lundvall2004.measured import PRINTED, READ, WITH, WITHOUT, Measured, base_pair, peak_to_peak
from fenics_gears.system.output import write_whole
from fenics_gears.show.panels import DARK, DOTS_PER_INCH, GREY, PALETTE, legend, limits, styled

LINES = {
    WITH: {"color": PALETTE[0], "linestyle": "-", "label": "μ = 0.1"},
    WITHOUT: {"color": PALETTE[1], "linestyle": (0, (5, 2)), "label": "μ = 0"},
}
STATIC = {"color": DARK, "linestyle": ":", "label": "static, μ = 0"}
READINGS = {READ: "J = 24.5 N mm s², as read here", PRINTED: "J = 24.5 kg mm², as printed"}
HIGHEST_SHOWN = 4001.0  # Hz
RELIEVED = "modified pair, 31 µm"


def draw_figure(name: str, measured: Measured, directory: Path) -> Path:
    """Draw a figure, one of `FIGURES`, and save it as PNG; returns the file."""
    return write_whole(directory / f"{name}.png", lambda aside: _save(FIGURES[name](measured), aside))


@styled
def figure02(measured: Measured) -> Figure:
    """Static transmission error and shaft displacement."""
    return _errors_and_displacement(
        measured.study("figure02"), "Fig. 2: static transmission error and shaft displacement d_y2"
    )


@styled
def figure05(measured: Measured) -> Figure:
    """The same at 200 Hz."""
    return _errors_and_displacement(
        measured.study("figure05"), "Fig. 5: transmission error and shaft displacement d_y2 at 200 Hz"
    )


@styled
def figure04(measured: Measured) -> Figure:
    """Quasi-static reactions."""
    return _reactions(measured, "figure04", "Fig. 4: quasi-static reactions on the pinion's shaft")


@styled
def figure08(measured: Measured) -> Figure:
    """Quasi-static reactions of the modified pair."""
    return _reactions(measured, "figure08", f"Fig. 8: quasi-static reactions on the pinion's shaft, {RELIEVED}")


@styled
def figure06(measured: Measured) -> Figure:
    """Peak-to-peak transmission error against mesh frequency."""
    figure, (axes,) = _figure("Fig. 6: peak-to-peak transmission error against mesh frequency", [4.6])
    _draw_frequencies(axes, measured.curves(READ, "06"), measured.study("figure02"))
    return figure


@styled
def figure10(measured: Measured) -> Figure:
    """The same of the modified pair, on the axes of Fig. 6."""
    figure, (axes,) = _figure(f"Fig. 10: peak-to-peak transmission error against mesh frequency, {RELIEVED}", [4.6])
    _draw_frequencies(axes, measured.curves(READ, "10"), measured.study("figure09_static").sel(depth=31.0))
    axes.set_ylim(0.0, 1.05 * peak_to_peak(measured.curves(READ, "06"), WITH).max())
    return figure


@styled
def figure09(measured: Measured) -> Figure:
    """Peak-to-peak transmission error against relief depth."""
    figure, (axes,) = _figure("Fig. 9: peak-to-peak transmission error against relief depth", [4.6])
    _draw_depths(axes, measured.study("figure09_dynamic"), measured.study("figure09_static"))
    return figure


@styled
def readings_of_inertia(measured: Measured) -> Figure:
    """Figs. 6, 10 and 9 under both readings of J, side by side."""
    figure = Figure(figsize=(15.0, 13.0), layout="constrained")
    figure.suptitle("Figs. 6, 10 and 9 under both readings of the moment of inertia J", x=0.012, ha="left", fontsize=14)
    axes = figure.subplots(3, 2, sharey="row")
    static, depths = measured.study("figure02"), measured.study("figure09_static")
    for column, (reading, name) in enumerate(READINGS.items()):
        above, middle, below = axes[:, column]
        _draw_frequencies(above, measured.curves(reading, "06"), static)
        _draw_frequencies(middle, measured.curves(reading, "10"), depths.sel(depth=31.0))
        _draw_depths(below, measured.study(f"{reading}figure09_dynamic"), depths)
        for each, figure_number in ((above, "Fig. 6"), (middle, "Fig. 10"), (below, "Fig. 9")):
            each.set_title(f"{figure_number}: {name}")
            each.get_legend().remove()
    for row in axes:
        row[0].set_ylim(0.0, 1.05 * max(np.max(line.get_ydata()) for each in row for line in each.get_lines()))
    axes[0, 1].legend(loc="upper left")
    axes[2, 1].legend(loc="upper right")
    return figure


@styled
def undamped(measured: Measured) -> Figure:
    """Contact force and transmission error without damping, where contact is lost."""
    frequency = 215.0
    figure, (above, below) = _figure(f"Without damping, {frequency:g} Hz: contact is lost", [2.6, 2.6])
    for friction, line in LINES.items():
        run = measured.run("undamped", mesh_frequency=frequency, friction=friction)
        above.plot(run.mesh_phase, run.normal_force, **line)
        below.plot(run.mesh_phase, run.transmission_error, **line)
    _label(above, "Normal force (N)")
    _label(below, "Transmission error (rad)", base_pair().wheel.base_radius)
    _over_cycles(below, run.mesh_phase.values)
    legend(above, columns=2)
    return figure


def _errors_and_displacement(study: xr.Dataset, heading: str) -> Figure:
    figure, (above, below) = _figure(heading, [3.4, 2.8])
    for friction, line in LINES.items():
        curves = study.sel(friction=friction)
        above.plot(study.mesh_phase, curves.transmission_error, **line)
        below.plot(study.mesh_phase, curves.centre_y.sel(gear="wheel"), **line)
    above.set_ylim(*limits(study.transmission_error.values, 0.0))
    _label(above, "T_E (rad)", base_pair().wheel.base_radius)
    _label(below, "d_y2 (mm)", 1.0)
    legend(above, columns=2)
    _over_cycles(below, study.mesh_phase.values)
    return figure


def _reactions(measured: Measured, name: str, heading: str) -> Figure:
    figure, axes = _figure(heading, [2.2, 2.2, 2.2])
    shown = {"reaction_x": "R_x1 (N)", "reaction_y": "R_y1 (N)", "reaction_couple": "C_z1 (N mm)"}
    for friction, line in LINES.items():
        run = measured.run(name, friction=friction).sel(gear="pinion")
        for each, variable in zip(axes, shown):
            each.plot(run.mesh_phase - run.mesh_phase[0], run[variable], **line)
    for each, variable in zip(axes, shown):
        _label(each, shown[variable])
    legend(axes[0], columns=2)
    _over_cycles(axes[-1], (run.mesh_phase - run.mesh_phase[0]).values)
    return figure


def _draw_frequencies(axes: Axes, curve: xr.Dataset, static: xr.Dataset) -> None:
    """T_EPP over mesh frequency up to HIGHEST_SHOWN, and thin lines at the static values."""
    curve = curve.sel(mesh_frequency=slice(None, HIGHEST_SHOWN))
    frequency = curve.mesh_frequency.values
    for friction, line in LINES.items():
        axes.plot(frequency, peak_to_peak(curve, friction), **line)
        still = float(static.peak_to_peak_transmission_error.sel(friction=friction))
        axes.axhline(still, color=line["color"], linewidth=1.4, linestyle=(0, (1, 2)), label=f"static, {line['label']}")
    axes.set_xscale("log")
    axes.set_xlim(frequency[0], frequency[-1])
    axes.xaxis.set_major_formatter(lambda value, _: f"{value:g}")
    axes.set_xlabel("Mesh frequency (Hz)")
    axes.set_ylim(bottom=0.0)
    _label(axes, "T_EPP (rad)", base_pair().wheel.base_radius)
    legend(axes, columns=4)


def _draw_depths(axes: Axes, dynamic: xr.Dataset, static: xr.Dataset) -> None:
    """T_EPP over relief depth, with the optima marked."""
    curves = [(dynamic, friction, line | {"label": f"200 Hz, {line['label']}"}) for friction, line in LINES.items()]
    curves += [
        (static, WITHOUT, STATIC),
        (
            static,
            WITH,
            {"color": GREY, "linestyle": ":", "linewidth": 1.2, "label": "static, μ = 0.1 (not in the paper)"},
        ),
    ]
    for study, friction, line in curves:
        error = peak_to_peak(study, friction)
        axes.plot(study.depth, error, **line)
        axes.plot(study.depth[error.argmin()], error.min(), "o", color=line["color"], markersize=5)
    axes.set_xlim(0.0, 50.0)
    axes.set_ylim(bottom=0.0)
    axes.set_xlabel("Largest depth of the relief (µm)")
    _label(axes, "T_EPP (rad)", base_pair().wheel.base_radius)
    legend(axes, columns=2)


def _figure(heading: str, heights: Sequence[float]) -> tuple[Figure, list[Axes]]:
    """A figure with one panel per height (inches) above each other."""
    figure = Figure(figsize=(10.0, 1.2 + sum(heights)), layout="constrained")
    figure.get_layout_engine().set(w_pad=0.12, h_pad=0.1)
    figure.suptitle(heading, x=0.012, ha="left", fontsize=14)
    return figure, list(
        figure.subplots(len(heights), sharex=True, squeeze=False, gridspec_kw={"height_ratios": heights})[:, 0]
    )


def _label(axes: Axes, name: str, millimetres: float | None = None) -> None:
    """Name the axis; with `millimetres` per unit, a second axis in micrometres beside it."""
    axes.set_ylabel(name)
    axes.ticklabel_format(axis="y", style="sci", scilimits=(-2, 4), useMathText=True)
    if millimetres is not None:
        scale = millimetres * 1e3
        axes.secondary_yaxis("right", functions=(lambda v: v * scale, lambda v: v / scale)).set_ylabel(
            "(µm)" if millimetres == 1.0 else "On the wheel's base circle (µm)"
        )


def _over_cycles(axes: Axes, phase: np.ndarray) -> None:
    axes.set_xlim(phase[0], phase[-1])
    axes.set_xlabel("Time (mesh cycles)")


@styled
def _save(figure: Figure, path: Path) -> None:
    figure.savefig(path, dpi=DOTS_PER_INCH, metadata={"Software": None})


FIGURES: dict[str, Callable[[Measured], Figure]] = {
    draw.__name__: draw
    for draw in (figure02, figure04, figure05, figure06, figure08, figure09, figure10, readings_of_inertia, undamped)
}
