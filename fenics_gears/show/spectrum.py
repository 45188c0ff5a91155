"""The transmission error by orders: what comes with the mesh, with a turn of either gear, and with waves on the flanks."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, lcm

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from fenics_gears.effects import common_period
from fenics_gears.results.pairs import shown
from fenics_gears.results.settled import of_settled
from fenics_gears.scene.data import Scene
from fenics_gears.show.panels import DARK, GREY, PALETTE, legend, panels, styled
from fenics_gears.show.run_scene import scene_of
from fenics_gears.show.units import factor, in_unit

MESH, PINION, WHEEL, BOTH, HUNTING = "mesh", "turn of the pinion", "turn of the wheel", "turn of either gear", "hunting tooth"
COLOURS = {MESH: PALETTE[0], PINION: PALETTE[1], WHEEL: PALETTE[2], BOTH: PALETTE[5], HUNTING: GREY}
MESH_ORDERS_SHOWN = 4.5
# Contact is solved to 1e-4 um; lines below a thousandth of the largest only fill the picture.
LEAST_AMPLITUDE, DECADES = 1e-4, 3  # um

_LEADER = {"arrowstyle": "-", "linewidth": 0.8, "shrinkB": 3.0}
_LABEL = {"textcoords": "offset points", "bbox": {"facecolor": "white", "edgecolor": "none", "pad": 1.0}}


@dataclass(frozen=True)
class OrderLines:
    """Amplitudes (n,) of the transmission error by order (n,), turns of the pinion being order 1; without the mean.

    ``exact``: of whole hunting tooth periods, so that each line stands alone; else of a record in Hann's window, where a line spreads over
    its neighbours and may show 15 % too low.
    """

    orders: np.ndarray
    amplitudes: np.ndarray
    exact: bool


def order_lines(error: np.ndarray, cycles: float, teeth: tuple[int, int]) -> OrderLines | None:
    """Orders of an error (n + 1,), in its own unit, over mesh cycles from its first to its last value; `teeth` of pinion and wheel.

    None where the record is shorter than a turn of the pinion.
    """
    steps, period = len(error) - 1, lcm(*teeth)
    if cycles < teeth[0] * (1.0 - 1e-9) or steps < 2:
        return None
    whole = int(cycles * (1.0 + 1e-9)) // period
    used = round(steps * whole * period / cycles) if whole else steps
    exact = bool(whole) and abs(used - steps * whole * period / cycles) < 1e-6
    length = used if exact else steps
    values = error[-length - 1 : -1] - error[-length - 1 : -1].mean()
    window = np.ones(length) if exact else 0.5 - 0.5 * np.cos(2.0 * np.pi * (np.arange(length) + 0.5) / length)
    amplitudes = 2.0 * np.abs(np.fft.rfft(values * window)) / window.sum()
    orders = np.arange(len(amplitudes)) * teeth[0] * steps / (cycles * length)
    return OrderLines(orders[1:], amplitudes[1:], exact)


def origin(order: float, teeth: tuple[int, int]) -> str:
    """What an order comes back with: the mesh, a turn of the pinion, of the wheel, of either, or only the hunting tooth."""
    turns = order, order * teeth[1] / teeth[0]
    if _whole(order / teeth[0]):
        return MESH
    pinion, wheel = (_whole(each) for each in turns)
    return BOTH if pinion and wheel else PINION if pinion else WHEEL if wheel else HUNTING


def _whole(number: float) -> bool:
    return abs(number - round(number)) < 1e-6


@styled
def order_spectrum(dataset: xr.Dataset) -> Figure | None:
    """Amplitudes (µm on the wheel's base circle) over orders of the pinion's shaft; None for a record shorter than its turn."""
    scene, radius = scene_of(dataset), dataset.attrs.get("base_radius_wheel")
    if "transmission_error" not in dataset or scene is None or not radius:
        return None
    # Where cycles are not alike all that count show their orders; where they are, no more than is shown.
    dataset = of_settled(dataset) if 1 < common_period(scene) < inf else shown(dataset)
    phase = dataset["mesh_phase"].values
    error = in_unit(dataset["transmission_error"], "rad") * radius * factor("mm", "µm")
    teeth = scene.gears.pinion.teeth, scene.gears.wheel.teeth
    lines = order_lines(error, float(phase[-1] - phase[0]), teeth)
    if lines is None:
        return None
    figure, (axes,) = panels(dataset, "Orders of the transmission error", [5.2])
    _draw_axes(axes, lines, teeth, _known_orders(scene))
    if lines.exact:
        _draw_lines(axes, lines, teeth)
    else:
        axes.plot(lines.orders, lines.amplitudes, color=PALETTE[0])
        axes.set_title(f"{phase[-1] - phase[0]:.4g} mesh cycles, in Hann's window: the pattern repeats after {lcm(*teeth)}")
    _name_mesh_orders(axes, teeth[0])
    _name_orders(axes, lines, _known_orders(scene))
    if lines.exact:
        _name_sidebands(axes, lines, teeth[0])
    return figure


def _draw_axes(axes: Axes, lines: OrderLines, teeth: tuple[int, int], known: list[tuple[float, str]]) -> None:
    highest = min(max([MESH_ORDERS_SHOWN * teeth[0], *(1.1 * order for order, _ in known)]), lines.orders[-1])
    shown = lines.amplitudes[lines.orders <= highest]
    top = max(float(shown.max()), 10.0 * LEAST_AMPLITUDE)
    axes.set_yscale("log")
    axes.set_ylim(max(LEAST_AMPLITUDE, top * 10.0**-DECADES), 6.0 * top)
    axes.set_xlim(0.0, highest)
    axes.set_ylabel("Amplitude on the wheel's base circle (µm)")
    axes.set_xlabel("Order (events a turn of the pinion)")


def _draw_lines(axes: Axes, lines: OrderLines, teeth: tuple[int, int]) -> None:
    bottom, (_, highest) = axes.get_ylim()[0], axes.get_xlim()
    seen = (lines.orders <= highest) & (lines.amplitudes > bottom)
    kinds = np.array([origin(order, teeth) for order in lines.orders])
    for kind, colour in COLOURS.items():
        own = seen & (kinds == kind)
        if not own.any():
            continue
        axes.vlines(lines.orders[own], bottom, lines.amplitudes[own], color=colour, linewidth=2.4 if kind == MESH else 1.4)
        axes.plot(lines.orders[own], lines.amplitudes[own], "o", color=colour, markersize=5 if kind == MESH else 3, label=kind)
    legend(axes, columns=5)


def _name_mesh_orders(axes: Axes, teeth: int) -> None:
    top, (_, highest) = axes.get_ylim()[1], axes.get_xlim()
    for multiple in range(1, int(highest / teeth) + 1):
        words = "mesh" if multiple == 1 else f"{multiple} × mesh"
        place = {"xytext": (0, -4), "textcoords": "offset points", "ha": "center", "va": "top"}
        axes.annotate(words, (multiple * teeth, top), color=PALETTE[0], fontsize=11, **place)


def _known_orders(scene: Scene) -> list[tuple[float, str]]:
    """Orders that one cause is known for, with the words for it: run-out of either gear and the waves on its flanks."""
    errors, run_out, found = scene.flank_errors, scene.eccentricity, []
    for name, turns in (("pinion", 1.0), ("wheel", scene.gears.pinion.teeth / scene.gears.wheel.teeth)):
        if run_out is not None and getattr(run_out, name) is not None:
            found.append((turns, f"run-out of the {name}"))
        waves = None if errors is None else getattr(errors, name).waviness
        if waves is not None:
            found.append((waves.waves * turns, f"ghost order: {waves.waves} waves\non the {name}"))
    return found


def _name_orders(axes: Axes, lines: OrderLines, known: list[tuple[float, str]]) -> None:
    for order, words in known:
        height = lines.amplitudes[int(np.argmin(np.abs(lines.orders - order)))]
        # Once a turn is at the picture's edge, and one gear's line beside the other's.
        beside = {"xytext": (40, 12 if order == 1.0 else 36), "ha": "left"} if order <= 1.0 else {"xytext": (0, 30), "ha": "center"}
        axes.annotate(words, (order, height), fontsize=11, arrowprops=_LEADER | {"color": DARK}, **beside, **_LABEL)


def _name_sidebands(axes: Axes, lines: OrderLines, teeth: int) -> None:
    """A turn of the pinion more or less than the mesh order, where it stands out of the picture's ground."""
    for side, words in ((-1.0, "mesh − 1"), (1.0, "mesh + 1")):
        order = teeth + side
        height = lines.amplitudes[int(np.argmin(np.abs(lines.orders - order)))]
        if height > axes.get_ylim()[0]:
            beside = {"xytext": (8 * side, 44), "ha": "left" if side > 0 else "right"}
            colour = COLOURS[PINION]
            axes.annotate(words, (order, height), color=colour, fontsize=11, arrowprops=_LEADER | {"color": colour}, **beside, **_LABEL)
