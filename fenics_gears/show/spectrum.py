"""Orders of a record and their sources: the mesh, a turn of either gear, waves on the flanks."""

from __future__ import annotations

from dataclasses import dataclass
from math import lcm

import numpy as np

from fenics_gears.scene.data import Scene
from fenics_gears.show.panels import GREY, PALETTE

MESH, PINION, WHEEL, BOTH, HUNTING = "mesh", "turn of the pinion", "turn of the wheel", "turn of either gear", "hunting tooth"
COLOURS = {MESH: PALETTE[0], PINION: PALETTE[1], WHEEL: PALETTE[2], BOTH: PALETTE[5], HUNTING: GREY}


@dataclass(frozen=True)
class OrderLines:
    """Amplitudes (n,) of the transmission error by order (n,), turns of the pinion being order 1; without the mean.

    ``exact``: of whole hunting tooth periods, so that each line stands alone; else of a record in Hann's window, where a line spreads over
    its neighbours and may show 15 % too low.
    """

    orders: np.ndarray
    amplitudes: np.ndarray
    exact: bool

    def at(self, order: float) -> float:
        """Amplitude of the line nearest to an order."""
        return float(self.amplitudes[np.argmin(np.abs(self.orders - order))])


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
    """The source of an order, by what it repeats with: the mesh, a turn of the pinion, of the wheel, of either, or the hunting tooth."""
    turns = order, order * teeth[1] / teeth[0]
    if _whole(order / teeth[0]):
        return MESH
    pinion, wheel = (_whole(each) for each in turns)
    return BOTH if pinion and wheel else PINION if pinion else WHEEL if wheel else HUNTING


def _whole(number: float) -> bool:
    return abs(number - round(number)) < 1e-6


def known_orders(scene: Scene) -> list[tuple[float, str]]:
    """Orders with a known cause, in words: run-out of either gear and waves on its flanks."""
    errors, run_out, found = scene.flank_errors, scene.eccentricity, []
    for name, turns in (("pinion", 1.0), ("wheel", scene.gears.pinion.teeth / scene.gears.wheel.teeth)):
        if run_out is not None and getattr(run_out, name) is not None:
            found.append((turns, f"run-out of the {name}"))
        waves = None if errors is None else getattr(errors, name).waviness
        if waves is not None:
            found.append((waves.waves * turns, f"ghost order: {waves.waves} waves on the {name}"))
    return found
