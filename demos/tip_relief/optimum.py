"""The relief with the least peak-to-peak transmission error, and how flat that minimum is."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

from scipy.optimize import direct, minimize

from demos.tip_relief.design import LINEAR, Bench, Design

DEPTHS, LENGTHS = (10.0, 50.0), (0.6, 1.6)
"""Where the best is searched: um, and parts of the double contact."""
MOST_DEPTHS, MOST_LENGTHS = (1.0, 80.0), (0.2, 1.8)
"""How far it is looked for the ends of what is nearly as good."""
# So that a step of the search means as much in depth as in length.
UNIT_DEPTH = 30.0  # um
SEARCHED = 100
"""Reliefs tried all over the range; then the best of them is improved."""
STEP = 0.03
TOLERANCE = {"xatol": 0.005, "fatol": 0.01}
"""Of depth (in 30 um) and length, and of the transmission error (um)."""
ALLOWED = 1.0  # um
"""How much worse than the best a relief may be that is called as good."""


@dataclass(frozen=True)
class Optimum:
    """The best relief, what it leaves (um, peak to peak), and from which depth (um) to which and length to which at
    most ALLOWED more is left."""

    design: Design
    peak_to_peak: float
    depths: tuple[float, float]
    lengths: tuple[float, float]


def optimum(bench: Bench, shape: str = LINEAR) -> Optimum:
    """The best by dividing rectangles (DIRECT), since the peak-to-peak value has a long valley with kinks, and from
    there by Nelder and Mead."""

    def left(place) -> float:
        return bench.peak_to_peak(Design(UNIT_DEPTH * place[0], place[1], shape))

    bounds = [tuple(end / UNIT_DEPTH for end in DEPTHS), LENGTHS]
    start = direct(left, bounds, maxfun=SEARCHED).x
    around = [start, start + [STEP, 0.0], start - [0.0, STEP]]
    place = minimize(
        left, start, method="Nelder-Mead", bounds=bounds, options=TOLERANCE | {"initial_simplex": around}
    ).x
    found = Design(UNIT_DEPTH * float(place[0]), float(place[1]), shape)
    return _with_ranges(bench, found)


def _with_ranges(bench: Bench, found: Design) -> Optimum:
    least = bench.peak_to_peak(found)

    def excess(field: str, value: float) -> float:
        return bench.peak_to_peak(replace(found, **{field: value})) - least - ALLOWED

    depths = tuple(_crossing(partial(excess, "depth"), found.depth, end) for end in MOST_DEPTHS)
    lengths = tuple(_crossing(partial(excess, "length"), found.length, end) for end in MOST_LENGTHS)
    return Optimum(found, least, depths, lengths)


def _crossing(excess: Callable[[float], float], inside: float, end: float) -> float:
    """Where the excess becomes positive between a place inside and an end, within a fiftieth of their distance; the end
    where it never does."""
    if excess(end) <= 0.0:
        return end
    step = 0.02 * abs(end - inside)
    outside = end
    while abs(outside - inside) > step:
        middle = 0.5 * (inside + outside)
        inside, outside = (middle, outside) if excess(middle) <= 0.0 else (inside, middle)
    return 0.5 * (inside + outside)
