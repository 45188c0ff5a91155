"""Spectra by mesh order: transmission error and mesh force, with a turn of the pinion and of the wheel where the record is long enough."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import lcm

import numpy as np

from fenics_gears.results.contact_variables import largest_normal_force
from fenics_gears.show.panels import GREY, PALETTE
from fenics_gears.show.report.page import Block, Plot, Section, Table, Words
from fenics_gears.show.report.plotting import Curve, bars, layout, plot
from fenics_gears.show.report.run import Run
from fenics_gears.show.spectrum import COLOURS, MESH, OrderLines, order_lines, origin
from fenics_gears.show.units import in_unit

MESH_ORDERS, LISTED_ORDERS, FOLLOWED_ORDERS = 10.5, 10, 4
CYCLES_TO_FOLLOW = 8
# Lines below this part of the largest are the solver's tolerance.
LEAST_PART = 1e-5
# Of the largest force; what varies by less is the solver's tolerance.
LEAST_VARIATION = 1e-6
ERROR, FORCE, BETWEEN = "Transmission error", "Mesh force", "between mesh orders"


def spectra(run: Run) -> Section:
    """Amplitudes over mesh orders, their table, and how they change from cycle to cycle in long records."""
    heading = "Spectra by mesh order"
    if not run.has_curves or run.cycles < 1.0 - 1e-9:
        return Section(
            "spectra",
            heading,
            [Words("Less than one mesh cycle is stored; its harmonics are not to be told from one another.", warns=not run.complete)],
        )
    signals = _signals(run)
    found = {name: spectrum(run, values) for name, (values, _) in signals.items()}
    blocks: list[Block] = []
    followed = _cycle_by_cycle(run, signals)
    if run.scene is not None and run.scene.speed_ramp is not None:
        blocks.append(
            Words(
                "The mesh frequency changes through the record: orders stay in place, resonances pass through them. "
                + (
                    "See the orders cycle by cycle."
                    if followed
                    else f"Records of {CYCLES_TO_FOLLOW} mesh cycles and more have the orders cycle by cycle."
                )
            )
        )
    for name, (_, unit) in signals.items():
        blocks.append(_plot(run, name, unit, found[name]))
    if FORCE not in signals:
        blocks.append(Words("The force of the mesh does not vary: nothing but a constant couple acts on it."))
    blocks.append(_table(signals, {name: each.lines for name, each in found.items()}))
    blocks += followed
    return Section("spectra", heading, blocks)


def _signals(run: Run) -> dict[str, tuple[np.ndarray, str]]:
    """Values (time,) and unit of what is analysed."""
    error = in_unit(run.dataset["transmission_error"], "rad")
    if np.isfinite(run.micrometres):
        signals = {ERROR: (error * run.micrometres, "µm")}
    else:
        signals = {ERROR: (error * 1e6, "µrad")}
    if "normal_force" in run.dataset and largest_normal_force(run.dataset):
        force = in_unit(run.dataset["normal_force"], "N")
        coast = in_unit(run.dataset["coast_normal_force"], "N") if "coast_normal_force" in run.dataset else 0.0
        # Without inertia and friction the load alone sets the force; what varies of it then is round-off.
        if np.ptp(force - coast) > LEAST_VARIATION * largest_normal_force(run.dataset):
            signals[FORCE] = (force - coast, "N")
    return signals


def _plot(run: Run, name: str, unit: str, found: Spectrum) -> Plot:
    import plotly.graph_objects as go

    lines, kinds = found.lines, found.origins
    shown = (lines.orders <= MESH_ORDERS) & (lines.amplitudes > LEAST_PART * lines.amplitudes.max(initial=0.0))
    spacing = lines.orders[0] if len(lines.orders) else 1.0
    width = min(0.12, 0.8 * spacing)
    traces = [
        bars(go, kind, lines.orders[own], lines.amplitudes[own], {**COLOURS, BETWEEN: GREY}[kind], width)
        for kind in dict.fromkeys([*COLOURS, BETWEEN])
        if (own := shown & (kinds == kind)).any()
    ]
    figure = go.Figure(traces, layout("Mesh order (events a mesh cycle)", f"Amplitude ({unit})", legend=len(traces) > 1))
    figure.update_layout(barmode="overlay", margin_t=48, updatemenus=[_scales()])
    figure.update_xaxes(range=[0, MESH_ORDERS], dtick=1, showgrid=False)
    figure.update_yaxes(rangemode="tozero")
    return Plot(name, figure, _note(run, name, found), 320)


def _scales() -> dict:
    """Buttons for a linear and a logarithmic scale."""
    choices = {"linear": "linear", "logarithmic": "log"}
    buttons = [
        {"label": label, "method": "relayout", "args": [{"yaxis.type": kind, "yaxis.autorange": True}]} for label, kind in choices.items()
    ]
    return {
        "type": "buttons", "direction": "right", "buttons": buttons, "x": 1.0, "xanchor": "right", "y": 1.03, "yanchor": "bottom",
        "showactive": True, "pad": {"r": 0, "t": 0, "b": 0}, "font": {"size": 12}, "bgcolor": "white", "bordercolor": "#C4C9CE",
    }  # fmt: skip


@dataclass(frozen=True)
class Spectrum:
    """Lines over mesh orders, what each comes back with (n,), and words on the record they are of."""

    lines: OrderLines
    origins: np.ndarray
    record: str


def spectrum(run: Run, values: np.ndarray) -> Spectrum:
    """The mesh orders of values (time,): of whole hunting tooth periods where these are stored at a steady speed, so that what comes with a
    turn of either gear stands apart; else of whole mesh cycles."""
    scene = run.scene
    if scene is not None and scene.speed_ramp is None:
        teeth = scene.gears.pinion.teeth, scene.gears.wheel.teeth
        found = order_lines(values, run.cycles, teeth)
        if found is not None and found.exact:
            periods = int(run.cycles * (1 + 1e-9)) // lcm(*teeth)
            record = f"of {periods} hunting tooth period{'s' if periods > 1 else ''} ({lcm(*teeth)} mesh cycles each)"
            return Spectrum(
                replace(found, orders=found.orders / teeth[0]), np.array([origin(order, teeth) for order in found.orders]), record
            )
    lines = order_lines(values, run.cycles, (1, 1))
    origins = np.where(np.abs(lines.orders - np.round(lines.orders)) < 1e-6, MESH, BETWEEN)
    whole = int(run.cycles * (1 + 1e-9))
    words = (
        f"of {whole} whole mesh cycle{'s' if whole > 1 else ''}"
        if lines.exact
        else f"of {run.cycles:.4g} mesh cycles in Hann's window, where a line spreads over its neighbours"
    )
    return Spectrum(lines, origins, words)


def _note(run: Run, name: str, found: Spectrum) -> str:
    sides = ", drive flanks positive, coast flanks negative" if "coast_normal_force" in run.dataset and name == FORCE else ""
    return f"Amplitudes of the harmonics, without the mean{sides}; {found.record}.{_beyond(found.lines)}"


def _beyond(lines: OrderLines) -> str:
    """A sentence where the largest line is not in the picture."""
    if not len(lines.orders):
        return ""
    order = lines.orders[np.argmax(lines.amplitudes)]
    return f" The largest of all is at order {order:.4g}, beyond the picture: {lines.amplitudes.max():.4g}." if order > MESH_ORDERS else ""


def _table(signals: dict, lines: dict[str, OrderLines]) -> Table:
    headings = ["Mesh order", *(f"{name} ({unit})" for name, (_, unit) in signals.items())]
    highest = int(min(LISTED_ORDERS, max(each.orders[-1] for each in lines.values())))
    rows = [[str(order), *(f"{_amplitude(each, order):.4g}" for each in lines.values())] for order in range(1, highest + 1)]
    return Table(headings, rows, "Amplitudes of the mesh orders")


def _amplitude(lines: OrderLines, order: float) -> float:
    return float(lines.amplitudes[np.argmin(np.abs(lines.orders - order))])


def _cycle_by_cycle(run: Run, signals: dict) -> list[Plot]:
    """Amplitudes of the first mesh orders in each mesh cycle of a long record, over its mesh frequency where that changes."""
    count = int(run.cycles * (1 + 1e-9))
    if count < CYCLES_TO_FOLLOW:
        return []
    steps = (run.steps - 1) / run.cycles
    ends = np.round(steps * np.arange(count + 1)).astype(int)
    if abs(steps - round(steps)) > 1e-6 or steps < 2 * FOLLOWED_ORDERS:
        return []
    ramp = "mesh_frequency" in run.dataset
    axis = in_unit(run.dataset["mesh_frequency"], "Hz") if ramp else run.dataset["mesh_phase"].values
    middle = np.array([axis[first : last + 1].mean() for first, last in zip(ends, ends[1:])])
    title = "Mesh frequency (Hz)" if ramp else "Middle of the mesh cycle (mesh cycles since the start)"
    plots = []
    for name, (values, unit) in signals.items():
        each = [order_lines(values[first : last + 1], 1.0, (1, 1)).amplitudes[:FOLLOWED_ORDERS] for first, last in zip(ends, ends[1:])]
        curves = [Curve(f"order {order}", middle, part, PALETTE[order - 1]) for order, part in enumerate(np.array(each).T, 1)]
        plots.append(plot(f"{name}: mesh orders cycle by cycle", curves, title, f"Amplitude ({unit})"))
    return plots
