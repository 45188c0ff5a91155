"""Sidebands of mesh harmonics: the orders around them at whole turns of either gear."""

from dataclasses import dataclass

import numpy as np

from fenics_gears import spectrum

# Sidebands on either side of a mesh harmonic that count.
SIDEBANDS = 6
# An amplitude that is so small a part of the largest is none.
ROUND_OFF = 1e-9


@dataclass(frozen=True)
class Sidebands:
    """A mesh harmonic with its sidebands: the square of its own amplitude, and the sums of squares of the amplitudes at
    shaft orders around it. One that belongs to either gear counts with both, and once in `all`."""

    line: float
    pinion: float
    wheel: float
    all: float

    @property
    def ratio(self) -> float:
        """Sum of squares of all sidebands over the square of the line; not a number without a line."""
        return self.all / self.line if self.line > 0.0 else np.nan


def sidebands(lines: spectrum.OrderLines, teeth: tuple[int, int], harmonic: int) -> Sidebands | None:
    """The first SIDEBANDS on either side of a mesh harmonic, no further than half-way to the next; None where the
    record cannot tell them apart."""
    at_sides = [_beside(teeth[0], harmonic, turn) for turn in (1.0, teeth[0] / teeth[1])]
    every = np.unique(np.round(np.concatenate([*at_sides, [harmonic * teeth[0]]]), 9))
    if np.diff(every).min() < (2 * lines.spread + 1) * lines.spacing * (1.0 - 1e-6) or every[-1] > lines.orders[-1]:
        return None
    squares = {order: lines.square(order) for order in every}
    first, second = (sum(squares[order] for order in np.round(orders, 9)) for orders in at_sides)
    line = squares[float(harmonic * teeth[0])]
    # Of the mesh in a quasi-static force that varies with the load alone, round-off is all there is.
    there = line > (ROUND_OFF * lines.amplitudes.max()) ** 2
    return Sidebands(line if there else 0.0, first, second, sum(squares.values()) - line)


def _beside(teeth: int, harmonic: int, turn: float) -> np.ndarray:
    """Orders of the sidebands by a shaft that turns `turn` times as often as the pinion's."""
    away = turn * np.arange(1, SIDEBANDS + 1)
    away = away[away < 0.5 * teeth]
    return harmonic * teeth + np.concatenate([-away, away])
