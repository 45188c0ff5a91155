"""Orders of a record and their sources: the mesh, a turn of either gear, waves on the flanks.

Windows are taken from `scipy.signal.windows`, their figures from F. J. Harris, On the use of windows for harmonic
analysis, Proc. IEEE 66 (1978).
"""

from dataclasses import dataclass
from math import lcm

import numpy as np
import xarray as xr

from fenics_gears.inputs.tree import GEARS
from fenics_gears.scene.data import Scene

from .contact_variables import largest_normal_force, mesh_force

MESH = "mesh"
PINION = "turn of the pinion"
WHEEL = "turn of the wheel"
BOTH = "turn of either gear"
HUNTING = "hunting tooth"
BETWEEN = "between mesh orders"
# Factors of the cosines; a line on a bin spreads over as many bins on either side as there are cosines. A line midway
# between bins is 36 % too low without a window, 15 % in Hann's, 0.1 % in the flat top.
NO_WINDOW = "none"
HANN = "hann"
FLAT_TOP = "flat-top"
WINDOWS = {
    NO_WINDOW: (1.0,),
    HANN: (0.5, 0.5),
    FLAT_TOP: (0.21557895, 0.41663158, 0.277263158, 0.083578947, 0.006947368),
}
# Of the largest force; what varies less is round-off.
LEAST_VARIATION = 1e-6


@dataclass(frozen=True)
class OrderLines:
    """Amplitudes of a signal (n,) by order (n,), turns of the pinion being order 1; without the mean.

    `exact`: of whole hunting tooth periods without a window, so that each line is in one bin; else a line spreads over
    `spread` bins on either side. `bandwidth`: the window's equivalent noise bandwidth in bins.
    """

    orders: np.ndarray
    amplitudes: np.ndarray
    exact: bool
    spread: int = 0
    bandwidth: float = 1.0

    def at(self, order: float) -> float:
        return float(self.amplitudes[np.argmin(np.abs(self.orders - order))])

    @property
    def spacing(self) -> float:
        return float(self.orders[0])

    def square(self, order: float) -> float:
        """Square of the amplitude of the line at an order, from all that the window spreads it over; within 0.2 % also
        between bins."""
        reach = self.spread + (0.6 if self.spread else 0.1)
        near = np.abs(self.orders - order) <= reach * self.spacing
        return float((self.amplitudes[near] ** 2).sum() / self.bandwidth)


def order_lines(
    error: np.ndarray, cycles: float, teeth: tuple[int, int], window: str | None = None
) -> OrderLines | None:
    """Orders of an error (n + 1,), in its own unit, over mesh cycles from its first to its last value; `teeth` of
    pinion and wheel. None where the record is shorter than a turn of the pinion.

    window: one of `WINDOWS`, laid over the whole record; None takes whole hunting tooth periods without a window where
    the record has them, else Hann's.
    """
    steps = len(error) - 1
    period = lcm(*teeth)
    if cycles < teeth[0] * (1.0 - 1e-9) or steps < 2:
        return None
    whole = int(cycles * (1.0 + 1e-9)) // period
    used = round(steps * whole * period / cycles) if whole else steps
    exact = window is None and bool(whole) and abs(used - steps * whole * period / cycles) < 1e-6
    length = used if exact else steps
    name = NO_WINDOW if exact else window or HANN
    # The mean by the window's own weights: of a line between bins any other leaves a constant, which spreads over the
    # lowest orders.
    values = error[-length - 1 : -1]
    weights = weights_of(name, length)
    values = values - np.average(values, weights=weights)
    amplitudes = 2.0 * np.abs(np.fft.rfft(values * weights)) / weights.sum()
    orders = np.arange(len(amplitudes)) * teeth[0] * steps / (cycles * length)
    bandwidth = length * (weights**2).sum() / weights.sum() ** 2
    return OrderLines(orders[1:], amplitudes[1:], exact, len(WINDOWS[name]) - 1, bandwidth)


def weights_of(window: str, length: int) -> np.ndarray:
    """Weights (length,) of one of `WINDOWS`, periodic."""
    turn = 2.0 * np.pi * np.arange(length) / length
    return sum((-1) ** place * factor * np.cos(place * turn) for place, factor in enumerate(WINDOWS[window]))


def level(amplitude: np.ndarray) -> np.ndarray:
    """Level in dB of an amplitude (peak, not r.m.s.) re 1; minus infinity for none."""
    with np.errstate(divide="ignore"):
        return 20.0 * np.log10(np.asarray(amplitude))


def origin(order: float, teeth: tuple[int, int]) -> str:
    """The source of an order, by what it repeats with: the mesh, a turn of the pinion, of the wheel, of either, or the
    hunting tooth."""
    turns = order, order * teeth[1] / teeth[0]
    if _whole(order / teeth[0]):
        return MESH
    pinion, wheel = (_whole(each) for each in turns)
    return BOTH if pinion and wheel else PINION if pinion else WHEEL if wheel else HUNTING


def _whole(number: float) -> bool:
    return abs(number - round(number)) < 1e-6


def known_orders(scene: Scene) -> list[tuple[float, str]]:
    """Orders with a known cause, in words: run-out of either gear and waves on its flanks."""
    errors = scene.flank_errors
    run_out = scene.eccentricity
    known = []
    teeth = scene.gears.teeth
    for name, turns in zip(GEARS, (1.0, teeth[0] / teeth[1])):
        if run_out is not None and getattr(run_out, name) is not None:
            known.append((turns, f"run-out of the {name}"))
        waves = None if errors is None else getattr(errors, name).waviness
        if waves is not None:
            known.append((waves.waves * turns, f"ghost order: {waves.waves} waves on the {name}"))
    return known


def varying_mesh_force(result: xr.Dataset) -> np.ndarray | None:
    """The mesh force (time,), N, of a result; None where it has none, or where it varies by round-off alone."""
    if "normal_force" not in result:
        return None
    force = mesh_force(result)
    varies = force.size and np.ptp(force) > LEAST_VARIATION * largest_normal_force(result)
    return force if varies else None
