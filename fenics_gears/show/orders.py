"""The chart of orders: the spectrum of the transmission error by what its lines come from."""

from dataclasses import replace
from math import inf, lcm

import numpy as np

from fenics_gears.effects import common_period
from fenics_gears.results.pairs import shown
from fenics_gears.results.spectrum import (
    BETWEEN,
    BOTH,
    HUNTING,
    MESH,
    PINION,
    WHEEL,
    OrderLines,
    known_orders,
    order_lines,
    origin,
)

from .chart import BARS, Chart, Curve, Flag
from .motion import error_values
from .panels import GREY, PALETTE
from .run import ShownRun

# Of the picture by orders of the pinion: mesh orders and decades that it shows. Contact is solved to 1e-4 um.
MESH_ORDERS_SHOWN = 4.5
DECADES = 3
LEAST_AMPLITUDE = 1e-4
COLOURS = {MESH: PALETTE[0], PINION: PALETTE[1], WHEEL: PALETTE[2], BOTH: PALETTE[5], HUNTING: GREY, BETWEEN: GREY}
OF_ERROR = "Orders of the transmission error"


def order_spectrum(run: ShownRun) -> Chart | None:
    """Amplitudes of the transmission error over orders of the pinion's shaft; None for a record shorter than its
    turn."""
    if "transmission_error" not in run.dataset or run.scene is None:
        return None
    # Where cycles differ, all settled ones are analysed; where they are alike, only those that are shown.
    run = run.settled if 1 < common_period(run.scene) < inf else replace(run, dataset=shown(run.dataset))
    values, unit = error_values(run)
    teeth = run.scene.gears.teeth
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
        curves = bars_by_origin(lines, kinds, seen, 0.004 * highest, 0.0025 * highest)
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


def bars_by_origin(lines: OrderLines, kinds: np.ndarray, seen: np.ndarray, wide: float, narrow: float) -> list[Curve]:
    """The lines that are `seen` (n,) as bars, a curve for each source among `kinds` (n,): mesh orders `wide`, others
    `narrow`, in orders."""
    curves = []
    for kind, colour in COLOURS.items():
        if (own := seen & (kinds == kind)).any():
            width = wide if kind == MESH else narrow
            curves.append(Curve(kind, lines.orders[own], lines.amplitudes[own], colour, width=width, mode=BARS))
    return curves
