"""Charts of orders: spectra of transmission error and mesh force by their source, and mesh orders from cycle to
cycle."""

from dataclasses import dataclass, replace
from math import inf, lcm

import numpy as np

from fenics_gears.effects import common_period
from fenics_gears.results.pairs import shown
from fenics_gears.results.spectrum import (
    BOTH,
    HUNTING,
    MESH,
    PINION,
    WHEEL,
    OrderLines,
    known_orders,
    order_lines,
    origin,
    varying_mesh_force,
)

from .chart import BARS, Chart, Curve, Flag
from .motion import error_values
from .panels import GREY, PALETTE
from .run import ShownRun

MESH_ORDERS = 10.5
FOLLOWED_ORDERS = 4
CYCLES_TO_FOLLOW = 8
# Of the picture by orders of the pinion: mesh orders and decades that it shows. Contact is solved to 1e-4 um.
MESH_ORDERS_SHOWN = 4.5
DECADES = 3
LEAST_AMPLITUDE = 1e-4
# Lines below this part of the largest are the solver's tolerance.
LEAST_PART = 1e-5
COLOURS = {MESH: PALETTE[0], PINION: PALETTE[1], WHEEL: PALETTE[2], BOTH: PALETTE[5], HUNTING: GREY}
ERROR = "Transmission error"
FORCE = "Mesh force"
BETWEEN = "between mesh orders"
OF_ERROR = "Orders of the transmission error"


@dataclass(frozen=True)
class Spectrum:
    """Lines over mesh orders, the source of each (n,), and a description of the record."""

    lines: OrderLines
    origins: np.ndarray
    record: str


def signals_of(run: ShownRun) -> dict[str, tuple[np.ndarray, str]]:
    """Values (time,) and units of the analysed curves."""
    signals = {ERROR: error_values(run)}
    force = varying_mesh_force(run.dataset)
    if force is not None:
        signals[FORCE] = (force, "N")
    return signals


def order_spectrum(run: ShownRun) -> Chart | None:
    """Amplitudes of the transmission error over orders of the pinion's shaft; None for a record shorter than its
    turn."""
    if "transmission_error" not in run.dataset or run.scene is None:
        return None
    # Where cycles differ, all settled ones are analysed; where they are alike, only those that are shown.
    run = run.settled if 1 < common_period(run.scene) < inf else replace(run, dataset=shown(run.dataset))
    values, unit = error_values(run)
    teeth = run.scene.gears.pinion.teeth, run.scene.gears.wheel.teeth
    lines = order_lines(values, run.cycles, teeth)
    if lines is None:
        return None
    known = known_orders(run.scene)
    highest = min(max([MESH_ORDERS_SHOWN * teeth[0], *(1.1 * order for order, _ in known)]), lines.orders[-1])
    top = max(float(lines.amplitudes[lines.orders <= highest].max()), 10.0 * LEAST_AMPLITUDE)
    bottom = max(LEAST_AMPLITUDE, top * 10.0**-DECADES)
    seen = (lines.orders <= highest) & (lines.amplitudes > bottom)
    caption = f"{OF_ERROR}, {run.cycles:.4g} mesh cycles"
    if lines.exact:
        kinds = np.array([origin(order, teeth) for order in lines.orders])
        curves = _by_origin(lines, kinds, seen, 0.004 * highest, 0.0025 * highest)
    else:
        caption += f" (Hann's window; repeats after {lcm(*teeth)})"
        low = lines.orders <= highest
        curves = [Curve("amplitude", lines.orders[low], lines.amplitudes[low], PALETTE[0])]
    return Chart(
        caption, curves, "Order (events a turn of the pinion)", f"Amplitude ({unit})", logarithmic="y", height=500,
        x_range=(0.0, highest), y_range=(bottom, 1.5 * top), flags=_flags(lines, teeth[0], known, bottom, highest),
    )  # fmt: skip


def _flags(lines: OrderLines, teeth: int, known: list[tuple[float, str]], bottom: float, highest: float) -> list[Flag]:
    """Mesh orders, orders with one known cause, and orders a turn of the pinion from a mesh order where they stand
    out."""
    flags = [
        Flag(each * teeth, lines.at(each * teeth), "mesh" if each == 1 else f"{each} × mesh", PALETTE[0])
        for each in range(1, int(highest / teeth) + 1)
    ]
    flags += [Flag(order, lines.at(order), words) for order, words in known]
    sides = {teeth - 1.0: "mesh − 1", teeth + 1.0: "mesh + 1"} if lines.exact else {}
    beside = [(order, lines.at(order), words) for order, words in sides.items()]
    return flags + [Flag(order, height, words, COLOURS[PINION]) for order, height, words in beside if height > bottom]


def _by_origin(lines: OrderLines, kinds: np.ndarray, seen: np.ndarray, wide: float, narrow: float) -> list[Curve]:
    curves = []
    for kind, colour in {**COLOURS, BETWEEN: GREY}.items():
        if (own := seen & (kinds == kind)).any():
            width = wide if kind == MESH else narrow
            curves.append(Curve(kind, lines.orders[own], lines.amplitudes[own], colour, width=width, mode=BARS))
    return curves


def mesh_order_chart(run: ShownRun, name: str, unit: str, spectrum: Spectrum) -> Chart:
    """Amplitudes over mesh orders."""
    lines = spectrum.lines
    shown = (lines.orders <= MESH_ORDERS) & (lines.amplitudes > LEAST_PART * lines.amplitudes.max(initial=0.0))
    spacing = lines.orders[0] if len(lines.orders) else 1.0
    width = min(0.12, 0.8 * spacing)
    both = "coast_normal_force" in run.dataset and name == FORCE
    sides = ", drive flanks positive, coast flanks negative" if both else ""
    note = f"Amplitudes of the harmonics, without the mean{sides}; {spectrum.record}.{_beyond(lines)}"
    curves = _by_origin(lines, spectrum.origins, shown, width, width)
    title = "Mesh order (events a mesh cycle)"
    return Chart(name, curves, title, f"Amplitude ({unit})", note, height=320, x_range=(0.0, MESH_ORDERS))


def spectrum(run: ShownRun, values: np.ndarray) -> Spectrum:
    """The mesh orders of values (time,). Where whole hunting tooth periods are stored at a steady speed, they are
    taken, so that orders of either gear's rotation are separate; else whole mesh cycles."""
    scene = run.scene
    if scene is not None and scene.speed_ramp is None:
        teeth = scene.gears.pinion.teeth, scene.gears.wheel.teeth
        amplitudes = order_lines(values, run.cycles, teeth)
        if amplitudes is not None and amplitudes.exact:
            periods = int(run.cycles * (1 + 1e-9)) // lcm(*teeth)
            record = f"of {periods} hunting tooth period{'s' if periods > 1 else ''} ({lcm(*teeth)} mesh cycles each)"
            origins = np.array([origin(order, teeth) for order in amplitudes.orders])
            return Spectrum(replace(amplitudes, orders=amplitudes.orders / teeth[0]), origins, record)
    lines = order_lines(values, run.cycles, (1, 1))
    origins = np.where(np.abs(lines.orders - np.round(lines.orders)) < 1e-6, MESH, BETWEEN)
    whole = int(run.cycles * (1 + 1e-9))
    record = f"of {run.cycles:.4g} mesh cycles in Hann's window, where a line spreads over its neighbours"
    if lines.exact:
        record = f"of {whole} whole mesh cycle{'s' if whole > 1 else ''}"
    return Spectrum(lines, origins, record)


def _beyond(lines: OrderLines) -> str:
    if not len(lines.orders):
        return ""
    order = lines.orders[np.argmax(lines.amplitudes)]
    if order <= MESH_ORDERS:
        return ""
    return f" The largest of all is at order {order:.4g}, beyond the picture: {lines.amplitudes.max():.4g}."


def orders_by_cycle(run: ShownRun, signals: dict[str, tuple[np.ndarray, str]]) -> list[Chart]:
    """Amplitudes of the first mesh orders in each mesh cycle of a long record."""
    cycles = run.whole_cycles
    if len(cycles) < CYCLES_TO_FOLLOW or cycles[0].stop - 1 < 2 * FOLLOWED_ORDERS:
        return []
    middle, title = run.cycle_axis
    charts = []
    for name, (values, unit) in signals.items():
        each = [order_lines(values[cycle], 1.0, (1, 1)).amplitudes[:FOLLOWED_ORDERS] for cycle in cycles]
        curves = [
            Curve(f"order {order}", middle, part, colour)
            for order, (part, colour) in enumerate(zip(np.array(each).T, PALETTE), 1)
        ]
        charts.append(Chart(f"{name}: mesh orders cycle by cycle", curves, title, f"Amplitude ({unit})"))
    return charts
